// Keeps a calibration between runs of the program: one file per machine in catena/ under
// $XDG_CACHE_HOME or ~/.cache. The cache only saves time. A file that cannot be read, or belongs to
// another machine or build, is ignored; a file that cannot be written is no error.
#pragma once

#include "plan/machine.hpp"

namespace catena::plan {

/// Returns the path of the machine's cache file; empty if neither XDG_CACHE_HOME nor HOME is set.
std::string cache_file(Machine const&);
/// Reads the machine's calibration; returns an empty one if the file is missing, invalid or belongs
/// to another machine.
Calibration read_cache(Machine const&);
/// Writes the calibration; returns false if the file could not be written.
bool write_cache(Machine const&, Calibration const&);

}  // namespace catena::plan
