// The cores that a rank may run on.
#pragma once

#include <sched.h>

namespace catena {

struct CoreSet {
    cpu_set_t cores;
    bool known;  // to the operating system: a host may have more than fit a set

    friend bool operator==(CoreSet const& a, CoreSet const& b) {
        return a.known == b.known && CPU_EQUAL(&a.cores, &b.cores);
    }
};
/// Of the calling thread.
CoreSet cores_bound_to();

}  // namespace catena
