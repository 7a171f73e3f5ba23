# Installs the build in BUILD_DIR into a prefix of its own, then configures, builds and runs the program here against it.
# cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D WORK_DIR=... -D GENERATOR=... -D C_COMPILER=... -D CXX_COMPILER=... -D BUILD_TYPE=... -P run.cmake

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGN " " command)
        message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${WORK_DIR}/prefix")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${SOURCE_DIR}" -B "${WORK_DIR}/build" "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
    "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")

run("${WORK_DIR}/build/consumer" "${SOURCE_DIR}/scene.yaml")
if(NOT output STREQUAL "two chains: 2 chains, 8 bodies\n")
    message(FATAL_ERROR "the program that uses the installed library printed:\n${output}")
endif()

execute_process(COMMAND "${WORK_DIR}/build/consumer" "${SOURCE_DIR}/missing.yaml" RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 2 OR NOT output MATCHES "missing.yaml")
    message(FATAL_ERROR "a missing scene gave status ${status} and:\n${output}")
endif()
