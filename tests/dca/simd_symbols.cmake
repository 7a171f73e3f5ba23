# Every function in the object of an instruction set has that set's name in its own: the linker keeps one of several of the same name.
execute_process(COMMAND "${NM}" --defined-only "${OBJECTS}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+ [TtWVuBbDd] [^\n]+" functions "${symbols}")
list(LENGTH functions count)
list(FILTER functions EXCLUDE REGEX "${LEVEL}")
if(count EQUAL 0 OR functions)
    message(FATAL_ERROR "${count} functions in ${OBJECTS}, without ${LEVEL} in their names: ${functions}")
endif()
