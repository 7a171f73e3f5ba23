# Installs the build in BUILD_DIR into a prefix of its own, then configures, builds and runs two projects against it: the program here and
# that of src/README.md.
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

build("${SOURCE_DIR}" "${WORK_DIR}/build")
run("${WORK_DIR}/build/consumer" "${SOURCE_DIR}/scene.yaml")
if(NOT output STREQUAL "two chains: 2 chains, 8 bodies\n")
    message(FATAL_ERROR "the program that uses the installed library printed:\n${output}")
endif()

execute_process(COMMAND "${WORK_DIR}/build/consumer" "${SOURCE_DIR}/missing.yaml" RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 2 OR NOT output MATCHES "missing.yaml")
    message(FATAL_ERROR "a missing scene gave status ${status} and:\n${output}")
endif()

# A rod that falls from the horizontal: a torque of 10 N m on a moment of inertia of 1 kg m^2 about the joint.
set(page "${SOURCE_DIR}/../../src/README.md")
extract("${page}" cpp "${WORK_DIR}/mine/main.cpp")
extract("${page}" cmake "${WORK_DIR}/mine/CMakeLists.txt")
build("${WORK_DIR}/mine" "${WORK_DIR}/mine/build")
run("${WORK_DIR}/mine/build/mine" "${SOURCE_DIR}/rod.yaml")
if(NOT output MATCHES "^body 1: (10|9\\.999999999|10\\.000000000)[0-9]*\n$")
    message(FATAL_ERROR "the program of src/README.md printed:\n${output}")
endif()
