// Sizes drawn from a distribution: masses, lengths and radii of generated bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "generate/random.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Probability distribution of a positive number.
class Distribution {
  public:
    enum class Kind : std::uint8_t { fixed, uniform, log_uniform, normal, choice };

    /// Distribution that always yields `value` and consumes no random numbers.
    Distribution(double value)
        : values_{value} {}  // NOLINT(google-explicit-constructor): a number is a distribution
    Distribution(Kind kind, std::vector<double> values) : kind_(kind), values_(std::move(values)) {}

    bool is_fixed() const { return kind_ == Kind::fixed; }
    /// Draws a number above 0; non-positive normal numbers are drawn again.
    double draw(Draws& draws) const;

  private:
    Kind kind_ = Kind::fixed;
    /// Parameters. fixed: value. uniform and log_uniform: least, most. normal: mean, standard
    /// deviation. choice: all values.
    std::vector<double> values_;
};

/// Reads a number above 0, `{uniform: [a, b]}`, `{log_uniform: [a, b]}`, `{normal: [mean, sd]}` or
/// `{choice: [a, b, ...]}`. Throws InputError otherwise.
Distribution read_distribution(Node const& node);

/// Random streams for the sizes of one body, independent of the stream for its geometry.
enum class SizeStream : std::uint64_t { mass = 1, length = 2, radius = 3 };
/// Draws a size of the body (from 0) from the stream `stream`.
inline double draw_size(Distribution const& of, std::uint64_t seed, std::int64_t body,
                        SizeStream stream) {
    Draws draws(seed, body, static_cast<std::uint64_t>(stream));
    return of.draw(draws);
}

}  // namespace catena::scene
