// What a time was measured on.
#pragma once

#include <string>

namespace catena {

/// As the system names it ("Intel(R) Xeon(R) Platinum 8480+"); "unknown" where it does not.
std::string processor_name();
/// Hardware threads that this process sees.
int processor_threads();
/// Tasks of all programs that run or want to run on the machine's processors, this one included:
/// the median over some milliseconds; 1 where the system does not say.
int tasks_running();
/// Compiler and version, and the instruction set this library was compiled for.
std::string compiler_name();
std::string instruction_set();

}  // namespace catena
