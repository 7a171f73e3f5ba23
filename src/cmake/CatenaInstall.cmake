# cmake --install: headers in include/catena, the library, the executable, and what find_package(catena) needs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(catena_config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/catena")

install(TARGETS catena EXPORT catenaTargets)
if(TARGET catena_hdf5)
    install(TARGETS catena_hdf5 EXPORT catenaTargets)
endif()
install(EXPORT catenaTargets NAMESPACE catena:: DESTINATION "${catena_config_dir}")

# The public headers include only the standard library and each other (src/catena/README.md). The others stay inside.
set(catena_headers catena errors forces scene simulation solver types version)
list(TRANSFORM catena_headers REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/src/catena/\\1.hpp")
install(FILES ${catena_headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/catena")

if(OpenMM_LIBRARY)
    get_filename_component(CATENA_OPENMM_DIR "${OpenMM_INCLUDE_DIR}" DIRECTORY)
endif()
configure_package_config_file("${PROJECT_SOURCE_DIR}/src/cmake/catenaConfig.cmake.in" "${PROJECT_BINARY_DIR}/catenaConfig.cmake"
    INSTALL_DESTINATION "${catena_config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/catenaConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/catenaConfig.cmake" "${PROJECT_BINARY_DIR}/catenaConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/src/cmake/FindOpenMM.cmake" DESTINATION "${catena_config_dir}")
