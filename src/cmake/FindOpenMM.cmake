# OpenMM, which has no CMake configuration of its own in Debian and in its Python wheel. Looked for in this order:
#   1. OPENMM_DIR, a variable or in the environment: a folder with include/, lib/ and lib/plugins/;
#   2. the `openmm` wheel of a Python: that of VIRTUAL_ENV, of build/venv in the source tree, else python3; for the Python package that of the
#      environment it is built for alone;
#   3. the system.
# Defines OpenMM::OpenMM, OpenMM_FOUND, OpenMM_VERSION, OpenMM_LIBRARY, OpenMM_INCLUDE_DIR, and OPENMM_MISSING_BECAUSE when a
# copy is there and cannot be used. A copy counts as found if a program links with it and prints its version.

function(_openmm_wheel result)
    set(pythons "$ENV{VIRTUAL_ENV}/bin/python" "${PROJECT_SOURCE_DIR}/build/venv/bin/python" python3)
    if(CATENA_HAVE_PYTHON)
        set(pythons "${Python_EXECUTABLE}")
    endif()
    foreach(python IN LISTS pythons)
        execute_process(COMMAND "${python}" -c "import sysconfig; print(sysconfig.get_paths()['platlib'])"
                        OUTPUT_VARIABLE packages OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
        if(status EQUAL 0 AND EXISTS "${packages}/OpenMM.libs/include/OpenMM.h")
            set(${result} "${packages}/OpenMM.libs" PARENT_SCOPE)
            return()
        endif()
    endforeach()
    set(${result} "" PARENT_SCOPE)
endfunction()

set(_openmm_root "${OPENMM_DIR}")
if(NOT _openmm_root)
    set(_openmm_root "$ENV{OPENMM_DIR}")
endif()
if(_openmm_root AND NOT EXISTS "${_openmm_root}/include/OpenMM.h")
    message(FATAL_ERROR "No OpenMM in OPENMM_DIR (${_openmm_root}/include/OpenMM.h is missing): name a folder that holds include/ and lib/, or leave OPENMM_DIR away")
endif()
if(NOT _openmm_root)
    _openmm_wheel(_openmm_root)
endif()

# What was found for another environment is searched for anew.
if(DEFINED CACHE{_openmm_searched} AND NOT "${_openmm_root}" STREQUAL "${_openmm_searched}")
    unset(OpenMM_INCLUDE_DIR CACHE)
    unset(OpenMM_LIBRARY CACHE)
endif()
set(_openmm_searched "${_openmm_root}" CACHE INTERNAL "")
if(_openmm_root)
    find_path(OpenMM_INCLUDE_DIR OpenMM.h PATHS "${_openmm_root}/include" NO_CACHE NO_DEFAULT_PATH)
    find_library(OpenMM_LIBRARY OpenMM PATHS "${_openmm_root}/lib" "${_openmm_root}/lib/${CMAKE_LIBRARY_ARCHITECTURE}" NO_CACHE NO_DEFAULT_PATH)
else()
    find_path(OpenMM_INCLUDE_DIR OpenMM.h NO_CACHE)
    find_library(OpenMM_LIBRARY OpenMM NO_CACHE)
endif()

if(OpenMM_INCLUDE_DIR AND OpenMM_LIBRARY AND NOT "${OpenMM_LIBRARY}" STREQUAL "${_openmm_checked_library}")
    file(WRITE "${CMAKE_BINARY_DIR}/CMakeFiles/openmm_version.cpp"
        "#include <OpenMM.h>\n#include <iostream>\nint main() { std::cout << OpenMM::Platform::getOpenMMVersion(); }\n")
    try_run(_openmm_ran _openmm_compiled "${CMAKE_BINARY_DIR}/CMakeFiles/openmm_version" "${CMAKE_BINARY_DIR}/CMakeFiles/openmm_version.cpp"
        CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${OpenMM_INCLUDE_DIR}" LINK_LIBRARIES "${OpenMM_LIBRARY}"
        COMPILE_OUTPUT_VARIABLE _openmm_compile_output RUN_OUTPUT_VARIABLE _openmm_run_output)
    if(_openmm_compiled AND "${_openmm_ran}" STREQUAL "0")
        string(STRIP "${_openmm_run_output}" _openmm_run_output)
        set(_openmm_checked_library "${OpenMM_LIBRARY}" CACHE INTERNAL "")
        set(_openmm_checked_version "${_openmm_run_output}" CACHE INTERNAL "")
    else()
        set(OPENMM_MISSING_BECAUSE "${OpenMM_LIBRARY} is there, but a program does not link with it or does not run (another C++ ABI?).")
        message(STATUS "${OPENMM_MISSING_BECAUSE}\n${_openmm_compile_output}${_openmm_run_output}")
        unset(_openmm_checked_library CACHE)
        unset(_openmm_checked_version CACHE)
    endif()
    unset(_openmm_ran CACHE)
    unset(_openmm_compiled CACHE)
endif()
if("${OpenMM_LIBRARY}" STREQUAL "${_openmm_checked_library}")
    set(OpenMM_VERSION "${_openmm_checked_version}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenMM REQUIRED_VARS OpenMM_LIBRARY OpenMM_INCLUDE_DIR OpenMM_VERSION VERSION_VAR OpenMM_VERSION)
if(OpenMM_FOUND AND NOT TARGET OpenMM::OpenMM)
    add_library(OpenMM::OpenMM SHARED IMPORTED)
    set_target_properties(OpenMM::OpenMM PROPERTIES IMPORTED_LOCATION "${OpenMM_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${OpenMM_INCLUDE_DIR}")
endif()
