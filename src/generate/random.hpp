// Random numbers of the generators. Each body has its own stream, so that body k does not depend on
// the length of its chain.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/linear.hpp"
#include "math/philox.hpp"
#include "math/rotation.hpp"

namespace catena::scene {

/// Seed of an independent stream, for copies of a chain and chains of a scene. Stream 0 has the
/// seed itself.
inline std::uint64_t seed_of_stream(std::uint64_t seed, std::uint64_t stream) {
    std::uint64_t z = stream * 0x9E3779B97F4A7C15u;  // finaliser of splitmix64; maps 0 to 0
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return seed ^ (z ^ (z >> 31));
}

/// Sequence of random numbers of one body (Philox counter-based generator). `attempt` selects
/// another sequence for the same body.
class Draws {
  public:
    Draws(std::uint64_t seed, std::int64_t body, std::uint64_t attempt = 0)
        : seed_(seed), body_(static_cast<std::uint64_t>(body)), attempt_(attempt) {}

    /// Uniform number in (0, 1) with 53 bits.
    double uniform() {
        if (count_ % 2 == 0) refill();
        std::uint32_t const* const w = block_.word + 2 * (count_++ % 2);
        return (static_cast<double>(((static_cast<std::uint64_t>(w[0]) << 32) | w[1]) >> 11) +
                0.5) *
               0x1p-53;
    }
    double between(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform point in a cube of edge 2 `half` around the origin.
    Vec3 in_cube(double half) {
        double const x = between(-half, half), y = between(-half, half), z = between(-half, half);
        return {{x, y, z}};
    }
    /// Uniform unit vector: uniform height, uniform longitude (Archimedes).
    Vec3 on_sphere() {
        double const z = between(-1, 1), longitude = 2 * pi * uniform(), r = std::sqrt(1 - z * z);
        return {{r * std::cos(longitude), r * std::sin(longitude), z}};
    }
    /// Uniform rotation (Shoemake 1992).
    Quat rotation() {
        double const u = uniform(), a = 2 * pi * uniform(), b = 2 * pi * uniform();
        double const s = std::sqrt(1 - u), t = std::sqrt(u);
        return normalized(Quat{s * std::sin(a), s * std::cos(a), t * std::sin(b), t * std::cos(b)});
    }

    static constexpr double pi = 3.14159265358979323846;

  private:
    void refill() {
        std::uint32_t constexpr tag = 64;  // differs from the tags of the stages of normal3
        block_ =
            philox({{static_cast<std::uint32_t>(body_),
                     static_cast<std::uint32_t>(body_ >> 32) | (tag << 16),
                     static_cast<std::uint32_t>(count_ / 2), static_cast<std::uint32_t>(attempt_)}},
                   static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32));
    }

    std::uint64_t seed_, body_, attempt_, count_ = 0;
    Philox4 block_{};
};

}  // namespace catena::scene
