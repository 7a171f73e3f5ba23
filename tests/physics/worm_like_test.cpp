// The generator `worm_like` against the discrete worm-like chain (src/dca/README.md, "Statistics of
// constrained chains").
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reader/load_scene.hpp"
#include "scene/scene.hpp"

namespace catena::test {
namespace {

struct Mean {
    double sum = 0, squares = 0, count = 0;
    void add(double x) { sum += x, squares += x * x, ++count; }
    double value() const { return sum / count; }
    double error() const { return std::sqrt((squares / count - value() * value()) / (count - 1)); }
};

double square_of(int links, double length, double cosine) {
    return length * length *
           (links * (1 + cosine) / (1 - cosine) -
            2 * cosine * (1 - std::pow(cosine, links)) / ((1 - cosine) * (1 - cosine)));
}

class WormLike : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Persistence, WormLike, ::testing::Values(0.5, 2, 10, 50));

TEST_P(WormLike, EndToEndDistanceIsThatOfTheDiscreteChain) {
    int constexpr seeds = 20000, beads = 101;
    double constexpr length = 1;
    Mean square, cosine;
    for (int seed = 1; seed <= seeds; ++seed) {
        Scene const scene = parse_scene(fmt::format("units: si\nchains: [{{name: a, generator: "
                                                    "{{worm_like: {{bodies: {}, persistence: {}, "
                                                    "length: {}, seed: {}}}}}}}]\n",
                                                    beads, GetParam(), length, seed),
                                        "scene.yaml");
        std::vector<Vec3> const& x = scene.chains[0].beads.position;
        Vec3 const across = x.back() - x.front();
        square.add(dot(across, across));
        Mean angles;
        for (std::size_t k = 1; k + 1 < x.size(); ++k)
            angles.add(dot(x[k + 1] - x[k], x[k] - x[k - 1]) / (length * length));
        cosine.add(angles.value());
    }
    double const expected = square_of(beads - 1, length, cosine.value());
    double const slope = (square_of(beads - 1, length, cosine.value() + cosine.error()) - expected);
    double const error = std::hypot(square.error(), slope);
    double const exact = std::exp(-length / GetParam());
    fmt::print(
        "persistence {}: <R^2> = {:.4f} +- {:.4f}, discrete chain {:.4f} ({:+.2f} standard "
        "errors); <cos> = {:.6f} +- {:.6f}, asked "
        "{:.6f}\n",
        GetParam(), square.value(), error, expected, (square.value() - expected) / error,
        cosine.value(), cosine.error(), exact);
    EXPECT_LE(std::abs(square.value() - expected), 3 * error);
    EXPECT_LE(std::abs(cosine.value() - exact), 3 * cosine.error());
    EXPECT_LE(error, 0.01 * expected);
}

}  // namespace
}  // namespace catena::test
