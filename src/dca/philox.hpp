// Counter-based random numbers: Philox 4x32-10 (Salmon, Moraes, Dror, Shaw, SC'11), host and device. A number is a pure
// function of (seed, step, body, stage), so every rank, thread and restart draws the same.
#pragma once

#include <cmath>
#include <cstdint>

#include "dca/linear.hpp"

namespace catena {

struct Philox4 {
    std::uint32_t word[4];
};

CATENA_HD Philox4 philox(Philox4 counter, std::uint32_t key0, std::uint32_t key1) {
    for (int round = 0; round < 10; ++round) {
        std::uint64_t const a = std::uint64_t{0xD2511F53u} * counter.word[0];
        std::uint64_t const b = std::uint64_t{0xCD9E8D57u} * counter.word[2];
        counter = {{static_cast<std::uint32_t>(b >> 32) ^ counter.word[1] ^ key0, static_cast<std::uint32_t>(b),
                    static_cast<std::uint32_t>(a >> 32) ^ counter.word[3] ^ key1, static_cast<std::uint32_t>(a)}};
        key0 += 0x9E3779B9u;
        key1 += 0xBB67AE85u;
    }
    return counter;
}

// The mathematical libraries of hosts and devices round differently; these round alike everywhere.

/// Of u in (0, 1]: twice the series of atanh, of u scaled to within [sqrt(1/2), sqrt(2)).
CATENA_HD double log_of_uniform(double u) {
    int exponent = 0;
    double m = std::frexp(u, &exponent);
    if (m < 0.70710678118654752) {
        m *= 2;
        --exponent;
    }
    double const s = (m - 1) / (m + 1), z = s * s;
    double series = 1.0 / 21;
    CATENA_UNROLL
    for (int odd = 19; odd > 0; odd -= 2) series = fused(series, z, 1.0 / odd);
    double const e = exponent, ln2_high = 0x1.62e42fefa39efp-1, ln2_low = 0x1.abc9e3b39803fp-56;
    return fused(e, ln2_high, fused(e, ln2_low, 2 * s * series));
}

struct CosSin {
    double cos, sin;
};
/// Of 2 pi u, u in [0, 1]: Taylor's series within an eighth of a turn of the nearest quarter.
CATENA_HD CosSin cos_sin_of_turns(double u) {
    double const quarter = std::floor(4 * u + 0.5), x = (4 * u - quarter) * 1.57079632679489662, z = -x * x;
    double c = 1, s = 1;
    CATENA_UNROLL
    for (int k = 18; k > 0; k -= 2) {
        c = fused(c * z, 1.0 / ((k - 1) * k), 1.0);
        s = fused(s * z, 1.0 / (k * (k + 1)), 1.0);
    }
    s *= x;
    switch (static_cast<int>(quarter) & 3) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

/// What a draw is for; streams of different stages are independent.
enum class NoiseStage : std::uint32_t { start, start_angular, thermostat, thermostat_angular };

/// Three independent standard normal numbers for (seed, step, body, stage); body < 2^48 (Box-Muller on 53-bit uniforms).
CATENA_HD Vector<double, 3> normal3(std::uint64_t seed, std::uint64_t step, std::uint64_t body, NoiseStage stage) {
    double u[4];
    for (std::uint32_t half = 0; half < 2; ++half) {
        std::uint32_t const tag = (static_cast<std::uint32_t>(stage) << 1) | half;
        Philox4 const r = philox({{static_cast<std::uint32_t>(body), static_cast<std::uint32_t>(body >> 32) | (tag << 16),
                                   static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(step >> 32)}},
                                 static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
        for (int i = 0; i < 2; ++i) {
            std::uint64_t const bits = ((static_cast<std::uint64_t>(r.word[2 * i]) << 32) | r.word[2 * i + 1]) >> 11;
            u[2 * half + i] = (static_cast<double>(bits) + 0.5) * 0x1p-53;  // in (0, 1]
        }
    }
    double const ra = std::sqrt(-2.0 * log_of_uniform(u[0])), rb = std::sqrt(-2.0 * log_of_uniform(u[2]));
    CosSin const a = cos_sin_of_turns(u[1]), b = cos_sin_of_turns(u[3]);
    return {{ra * a.cos, ra * a.sin, rb * b.cos}};
}

}  // namespace catena
