// A calibration that outlives the program: a file for each machine under $XDG_CACHE_HOME or
// ~/.cache, in catena/. It only saves time: one that cannot be read or belongs to another machine
// or build is as good as none, and one that cannot be written is not missed.
#pragma once

#include "plan/machine.hpp"

namespace catena::plan {

/// Empty where there is no place for it.
std::string cache_file(Machine const&);
Calibration read_cache(Machine const&);
/// Whether it could be written.
bool write_cache(Machine const&, Calibration const&);

}  // namespace catena::plan
