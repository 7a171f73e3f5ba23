// Counter-based random numbers for host and device: Philox 4x32-10 (Salmon, Moraes, Dror, Shaw,
// SC'11). A number is a pure function of (seed, step, body, stage), so every rank, thread and
// restart draws the same numbers.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/elementary.hpp"
#include "math/linear.hpp"

namespace catena {

/// Counter of the generator, and also one block of its output: 128 bits.
struct Philox4 {
    std::uint32_t word[4];
};

/// Returns the random block of `counter` under the 64-bit key (key0, key1): ten Philox rounds.
CATENA_HD Philox4 philox(Philox4 counter, std::uint32_t key0, std::uint32_t key1) {
    for (int round = 0; round < 10; ++round) {
        std::uint64_t const a = std::uint64_t{0xD2511F53u} * counter.word[0];
        std::uint64_t const b = std::uint64_t{0xCD9E8D57u} * counter.word[2];
        counter = {{static_cast<std::uint32_t>(b >> 32) ^ counter.word[1] ^ key0,
                    static_cast<std::uint32_t>(b),
                    static_cast<std::uint32_t>(a >> 32) ^ counter.word[3] ^ key1,
                    static_cast<std::uint32_t>(a)}};
        key0 += 0x9E3779B9u;
        key1 += 0xBB67AE85u;
    }
    return counter;
}

/// Purpose of a random number; streams of different stages are independent.
enum class NoiseStage : std::uint32_t {
    start,
    start_angular,
    thermostat,
    thermostat_angular,
    thermostat_joint,
    start_joint,
    conformation
};

/// Returns three independent standard normal numbers for (seed, step, body, stage). The method is
/// Box-Muller on 53-bit uniform numbers. Precondition: body < 2^48.
CATENA_HD Vector<double, 3> normal3(std::uint64_t seed, std::uint64_t step, std::uint64_t body,
                                    NoiseStage stage) {
    double u[4];
    for (std::uint32_t half = 0; half < 2; ++half) {
        std::uint32_t const tag = (static_cast<std::uint32_t>(stage) << 1) | half;
        Philox4 const r =
            philox({{static_cast<std::uint32_t>(body),
                     static_cast<std::uint32_t>(body >> 32) | (tag << 16),
                     static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(step >> 32)}},
                   static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
        for (int i = 0; i < 2; ++i) {
            std::uint64_t const bits =
                ((static_cast<std::uint64_t>(r.word[2 * i]) << 32) | r.word[2 * i + 1]) >> 11;
            u[2 * half + i] = (static_cast<double>(bits) + 0.5) * 0x1p-53;  // u in (0, 1]
        }
    }
    double const ra = std::sqrt(-2.0 * log_of_uniform(u[0])),
                 rb = std::sqrt(-2.0 * log_of_uniform(u[2]));
    CosSin const a = cos_sin_of_turns(u[1]), b = cos_sin_of_turns(u[3]);
    return {{ra * a.cos, ra * a.sin, rb * b.cos}};
}

}  // namespace catena
