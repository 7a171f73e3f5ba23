# cmake --install: headers in include/catena, the library, the executable, and what find_package(catena) needs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(catena_config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/catena")

install(TARGETS catena EXPORT catenaTargets)
if(TARGET catena_hdf5)
    install(TARGETS catena_hdf5 EXPORT catenaTargets)
endif()
install(EXPORT catenaTargets NAMESPACE catena:: DESTINATION "${catena_config_dir}")

foreach(folder IN ITEMS src mpi)
    if(folder STREQUAL "src")
        set(destination "${CMAKE_INSTALL_INCLUDEDIR}/catena")
    else()
        set(destination "${CMAKE_INSTALL_INCLUDEDIR}/catena/${folder}")
    endif()
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}/" DESTINATION "${destination}" FILES_MATCHING PATTERN "*.hpp" PATTERN cmake EXCLUDE PATTERN command EXCLUDE)
endforeach()

if(OpenMM_LIBRARY)
    get_filename_component(CATENA_OPENMM_DIR "${OpenMM_INCLUDE_DIR}" DIRECTORY)
endif()
configure_package_config_file("${PROJECT_SOURCE_DIR}/src/cmake/catenaConfig.cmake.in" "${PROJECT_BINARY_DIR}/catenaConfig.cmake"
    INSTALL_DESTINATION "${catena_config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/catenaConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/catenaConfig.cmake" "${PROJECT_BINARY_DIR}/catenaConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/src/cmake/FindOpenMM.cmake" DESTINATION "${catena_config_dir}")
