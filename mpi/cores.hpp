// Core binding of a rank.
#pragma once

#include <sched.h>

namespace catena {

/// Set of cores of the operating system.
struct CoreSet {
    cpu_set_t cores;
    /// False if the operating system did not return the cores: a host may have more than fit in a
    /// set.
    bool known;

    friend bool operator==(CoreSet const& a, CoreSet const& b) {
        return a.known == b.known && CPU_EQUAL(&a.cores, &b.cores);
    }
};
/// Returns the cores to which the calling thread is bound.
CoreSet cores_bound_to();

}  // namespace catena
