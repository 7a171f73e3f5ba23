// Force decomposition over several GPUs that hold the same particles at the same places of OpenMM's
// arrays. Positions are sent from the GPU that owns a bead to the others, and forces on it are sent
// back. A thread processes one number, i = 3 bead + direction. Beads are counted in the order of
// sending or receiving, one message after the other. All addresses are in GPU memory.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "math/host_device.hpp"
#include "neighbours/device_beads.hpp"

namespace catena {

/// Largest number of messages of the loop bodies below.
inline constexpr int most_messages = 16;

/// Loop body that sends the positions with which OpenMM computes, in single precision, to every
/// other GPU.
struct SentPositions {
    float const* position = nullptr;  // x, y, z and charge of each place
    /// Place of each bead that is sent.
    std::int32_t const* place = nullptr;
    int messages = 0;
    float* to[most_messages] = {};
    CATENA_HD void operator()(std::int64_t i) const {
        float const number = position[4 * static_cast<std::int64_t>(place[i / 3]) + i % 3];
        for (int m = 0; m < messages; ++m) to[m][i] = number;
    }
};

/// Loop body that copies received positions to OpenMM's array. Rounding corrections are not sent,
/// because no force uses them.
struct ArrivedPositions {
    float* position = nullptr;
    std::int32_t const* place = nullptr;
    float const* arrived = nullptr;
    CATENA_HD void operator()(std::int64_t i) const {
        position[4 * static_cast<std::int64_t>(place[i / 3]) + i % 3] = arrived[i];
    }
};

/// OpenMM's array of forces (DeviceParticles::force) and the places of beads in it.
struct ForcesOnBeads {
    std::int64_t* force = nullptr;
    std::int64_t places = 0;
    std::int32_t const* place = nullptr;
    /// Component i % 3 of the force on bead i / 3.
    CATENA_HD std::int64_t& at(std::int64_t i) const {
        return force[place[i / 3] + i % 3 * places];
    }
};

/// Converts a force for sending. It is sent bitwise, or in single precision if OpenMM computes
/// forces in single precision.
template <class Number>
CATENA_HD Number on_its_way(std::int64_t force) {
    if constexpr (std::is_same_v<Number, float>)
        return DeviceParticles::is_number(force) ? static_cast<float>(force) : NAN;
    else
        return force;
}
/// Converts a received force; values that are not numbers become INT64_MAX.
CATENA_HD std::int64_t arrived_force(std::int64_t force) { return force; }
CATENA_HD std::int64_t arrived_force(float force) {
    float constexpr beyond = 9.2e18f;  // DeviceParticles::most up to rounding
    return std::fabs(force) < beyond ? static_cast<std::int64_t>(force) : INT64_MAX;
}

/// Returns the sum of two fixed-point forces. It is no number if one of them is none, although the
/// sum of two values that are no numbers may look like one.
CATENA_HD std::int64_t sum_of_forces(std::int64_t a, std::int64_t b) {
    if (!DeviceParticles::is_number(a) || !DeviceParticles::is_number(b)) return INT64_MAX;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// Loop body that sends the forces that this GPU has computed on beads of other ranks.
template <class Number>
struct SentForces {
    ForcesOnBeads forces;
    int messages = 0;
    std::int64_t end[most_messages] = {};  // number of beads in each message and all before it
    /// Address at which bead 0 would lie in each message if it also contained the beads of all
    /// earlier messages.
    Number* to[most_messages] = {};
    bool all = true;  // false: zeros are not sent; ReturnedForces left zeros there
    /// Number of beads in all messages.
    std::int64_t count() const { return messages > 0 ? end[messages - 1] : 0; }
    /// Appends a message of `beads` beads, whose numbers are written to `box`.
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

/// Loop body that adds the forces that other GPUs have computed on own beads. The sums are of
/// integers, so that their order does not matter. It leaves zeros in the buffers for components
/// that are not sent next time.
template <class Number>
struct ReturnedForces {
    ForcesOnBeads forces;
    Number* arrived = nullptr;  // x, y, z of each bead, one message after the other
    std::int64_t beads = 0;
    int messages = 0;
    CATENA_HD void operator()(std::int64_t i) const {
        std::int64_t& force = forces.at(i);
        for (int m = 0; m < messages; ++m) {
            Number& here = arrived[3 * m * beads + i];
            if (here == Number{0}) continue;
            force = sum_of_forces(force, arrived_force(here));
            here = Number{0};
        }
    }
};

}  // namespace catena
