// Sizes drawn from a distribution: masses, lengths, radii of generated bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "generate/random.hpp"
#include "scene/node.hpp"

namespace catena::scene {

class Distribution {
  public:
    enum class Kind : std::uint8_t { fixed, uniform, log_uniform, normal, choice };

    /// Always `value`; draws nothing.
    Distribution(double value)
        : values_{value} {}  // NOLINT(google-explicit-constructor): a number is a distribution
    Distribution(Kind kind, std::vector<double> values) : kind_(kind), values_(std::move(values)) {}

    bool is_fixed() const { return kind_ == Kind::fixed; }
    /// Above 0: normal numbers are redrawn until they are.
    double draw(Draws& draws) const;

  private:
    Kind kind_ = Kind::fixed;
    std::vector<double> values_;  // fixed: value; (log-)uniform: least, most; normal: mean,
                                  // standard deviation; choice: all
};

/// A number above 0, `{uniform: [a, b]}`, `{log_uniform: [a, b]}`, `{normal: [mean, sd]}` or
/// `{choice: [a, b, ...]}`; InputError otherwise.
Distribution read_distribution(Node const& node);

/// Independent streams of one body beside the one that its generator draws its geometry from.
enum class SizeStream : std::uint64_t { mass = 1, length = 2, radius = 3 };
inline double draw_size(Distribution const& of, std::uint64_t seed, std::int64_t body,
                        SizeStream stream) {
    Draws draws(seed, body, static_cast<std::uint64_t>(stream));
    return of.draw(draws);
}

}  // namespace catena::scene
