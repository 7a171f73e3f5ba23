// Particles of OpenMM's that several GPUs have, each at the same place of its arrays: positions on
// their way from the GPU whose bead one is to the others, and forces on their way back. A thread
// takes one number: i = 3 bead + direction, where beads are counted as they are sent or received,
// one message after the other. All addresses are GPUs'.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "math/host_device.hpp"
#include "neighbours/device_beads.hpp"

namespace catena {

/// Precondition of all of these: no more messages than this.
inline constexpr int most_messages = 16;

/// Positions as OpenMM computes with them, in single precision, to every other GPU.
struct SentPositions {
    float const* position = nullptr;  // x, y, z and a charge, a place after the other
    std::int32_t const* place = nullptr;
    int messages = 0;
    float* to[most_messages] = {};
    CATENA_HD void operator()(std::int64_t i) const {
        float const number = position[4 * static_cast<std::int64_t>(place[i / 3]) + i % 3];
        for (int m = 0; m < messages; ++m) to[m][i] = number;
    }
};

/// What rounding took away of them no force needs.
struct ArrivedPositions {
    float* position = nullptr;
    std::int32_t const* place = nullptr;
    float const* arrived = nullptr;
    CATENA_HD void operator()(std::int64_t i) const {
        position[4 * static_cast<std::int64_t>(place[i / 3]) + i % 3] = arrived[i];
    }
};

/// OpenMM's array of forces (DeviceParticles::force), and where beads are in it.
struct ForcesOnBeads {
    std::int64_t* force = nullptr;
    std::int64_t places = 0;
    std::int32_t const* place = nullptr;
    CATENA_HD std::int64_t& at(std::int64_t i) const {
        return force[place[i / 3] + i % 3 * places];
    }
};

/// A force on its way: as OpenMM has it, to the bit, or, where OpenMM finds forces in single
/// precision, in single precision.
template <class Number>
CATENA_HD Number on_its_way(std::int64_t force) {
    if constexpr (std::is_same_v<Number, float>)
        return DeviceParticles::is_number(force) ? static_cast<float>(force) : NAN;
    else
        return force;
}
CATENA_HD std::int64_t arrived_force(std::int64_t force) { return force; }
CATENA_HD std::int64_t arrived_force(float force) {
    float constexpr beyond = 9.2e18f;  // DeviceParticles::most, but for rounding
    return std::fabs(force) < beyond ? static_cast<std::int64_t>(force) : INT64_MAX;
}

/// Of forces on beads of others this GPU has found a part.
template <class Number>
struct SentForces {
    ForcesOnBeads forces;
    int messages = 0;
    std::int64_t end[most_messages] = {};  // beads in each message and those before
    Number* to[most_messages] = {};  // where bead 0 would be if the message had those before, too
    bool all = true;                 // false: zeros stay away, where ReturnedForces left some
    std::int64_t count() const { return messages > 0 ? end[messages - 1] : 0; }
    /// `box`: where its numbers go
    void add(std::int64_t beads, Number* box) {
        to[messages] = box - 3 * count();
        end[messages] = count() + beads;
        ++messages;
    }
    CATENA_HD void operator()(std::int64_t i) const {
        int message = 0;
        while (i / 3 >= end[message]) ++message;
        std::int64_t const force = forces.at(i);
        if (all || force != 0) to[message][i] = on_its_way<Number>(force);
    }
};

/// What others have found of the forces on own beads is added, in whole numbers: their order does
/// not matter. Leaves zeros where numbers were, for those that are not sent next time.
template <class Number>
struct ReturnedForces {
    ForcesOnBeads forces;
    Number* arrived = nullptr;  // x, y, z of each bead, one message after the other
    std::int64_t beads = 0;
    int messages = 0;
    CATENA_HD void operator()(std::int64_t i) const {
        std::int64_t& force = forces.at(i);
        std::int64_t sum = force;
        bool is_number = DeviceParticles::is_number(sum);
        for (int m = 0; m < messages; ++m) {
            Number& here = arrived[3 * m * beads + i];
            if (here == Number{0}) continue;
            std::int64_t const part = arrived_force(here);
            here = Number{0};
            is_number = is_number && DeviceParticles::is_number(part);
            sum = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) +
                                            static_cast<std::uint64_t>(part));
        }
        force = is_number ? sum : INT64_MAX;  // two that are none may add up to one
    }
};

}  // namespace catena
