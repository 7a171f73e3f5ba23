# Installs the build in BUILD_DIR into a prefix of its own, then configures, builds and runs two projects against it: the program here and
# that of src/catena/README.md. Of each installed header, it checks what it includes.
# cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D WORK_DIR=... -D GENERATOR=... -D C_COMPILER=... -D CXX_COMPILER=... -D BUILD_TYPE=... -P run.cmake

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGN " " command)
        message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

function(build source folder)
    run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${source}" -B "${folder}" "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
        "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
    run("${CMAKE_COMMAND}" --build "${folder}")
endfunction()

# Writes the page's only block in `language` to `file`.
function(extract page language file)
    file(READ "${page}" text)
    set(fence "```${language}\n")
    string(LENGTH "${fence}" length)
    string(FIND "${text}" "${fence}" first)
    if(first EQUAL -1)
        message(FATAL_ERROR "${page} has no block in ${language}")
    endif()
    math(EXPR first "${first} + ${length}")
    string(SUBSTRING "${text}" ${first} -1 text)
    string(FIND "${text}" "```" last)
    string(SUBSTRING "${text}" 0 ${last} text)
    file(WRITE "${file}" "${text}")
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${WORK_DIR}/prefix")

# Few headers, which show nothing of the inside.
file(GLOB_RECURSE headers "${WORK_DIR}/prefix/include/*")
list(LENGTH headers count)
if(count EQUAL 0 OR count GREATER 15)
    message(FATAL_ERROR "${count} files are installed as headers: ${headers}")
endif()
foreach(header IN LISTS headers)
    file(STRINGS "${header}" includes REGEX "^#include")
    foreach(line IN LISTS includes)
        if(NOT line MATCHES "^#include (<[a-z_]+>|\"catena/[a-z_]+[.]hpp\")")
            message(FATAL_ERROR "${header} has ${line}")
        endif()
    endforeach()
endforeach()

build("${SOURCE_DIR}" "${WORK_DIR}/build")
run("${WORK_DIR}/build/consumer" "${SOURCE_DIR}/scene.yaml")
if(NOT output STREQUAL "8 bodies, 0 notes\n")
    message(FATAL_ERROR "the program that uses the installed library printed:\n${output}")
endif()

execute_process(COMMAND "${WORK_DIR}/build/consumer" "${SOURCE_DIR}/missing.yaml" RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 2 OR NOT output MATCHES "missing.yaml")
    message(FATAL_ERROR "a missing scene gave status ${status} and:\n${output}")
endif()

# Two rods that fall from the horizontal: M = [6 2; 2 1] kg m^2 and torques of 40 and 10 N m give 10 and -10 rad/s^2. The spring holds 5 J
# at the start, where the energy of gravity is 0.
set(page "${SOURCE_DIR}/../../src/catena/README.md")
extract("${page}" cpp "${WORK_DIR}/mine/main.cpp")
extract("${page}" cmake "${WORK_DIR}/mine/CMakeLists.txt")
build("${WORK_DIR}/mine" "${WORK_DIR}/mine/build")
run("${WORK_DIR}/mine/build/mine")
if(NOT output MATCHES "^accelerations 10[.]000000 -10[.]000000\nposition [^\n]*\nforce [^\n]*\nenergy 5[.]000000\n$")
    message(FATAL_ERROR "the program of src/catena/README.md printed:\n${output}")
endif()
