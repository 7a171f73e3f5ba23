// Description of the machine and the compiler with which times were measured.
#pragma once

#include <string>

namespace catena {

/// Returns the processor's name from the system ("Intel(R) Xeon(R) Platinum 8480+"), else
/// "unknown".
std::string processor_name();
/// Returns the number of hardware threads that this process sees.
int processor_threads();
/// Returns the number of tasks of all programs that run or are ready to run, this one included. It
/// is the median over some milliseconds, and 1 if the system does not report it.
int tasks_running();
/// Returns compiler and version, such as "gcc 13.2.0".
std::string compiler_name();
/// Returns the instruction set for which this library was compiled.
std::string instruction_set();

}  // namespace catena
