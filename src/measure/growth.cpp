// Reference accelerations and their sensitivity to rounding.
#include "measure/growth.hpp"

#include <algorithm>
#include <future>

#include "error.hpp"
#include "measure/nudged.hpp"

namespace catena {
namespace {

/// Relative size of perturbations. It is far above the rounding of 64 bits and far below what would
/// change the problem.
constexpr double nudge = 0x1p-48;

std::vector<double> joined(std::vector<double> a, std::vector<double> const& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace

ExactSolution exact_solution(Scene const& scene, Solution const& layout, std::int64_t largest_quad,
                             int nudges) {
    bool const quad = scene.bodies() <= largest_quad;
    std::future<std::vector<double>> widest;  // solutions run concurrently
    if (quad)
        widest = std::async(std::launch::async, [&] {
            return oracle_accelerations<oracle::Quad>(scene, layout.bead_force);
        });
    std::vector<double> wide;
    std::vector<std::vector<double>> moved(static_cast<std::size_t>(nudges));
    for (std::size_t c = 0; c < scene.chains.size(); ++c) {
        ChainSpec const& chain = scene.chains[c];
        oracle::Loads const loads = oracle_loads(scene, c, layout.bead_force);
        auto const found = oracle::aba<long double>(chain, loads);
        wide = joined(std::move(wide), joint_accelerations(chain, found));
        std::vector<std::future<std::vector<double>>> own(moved.size());
        for (std::size_t i = 0; i < own.size(); ++i)
            own[i] = std::async(std::launch::async, [&, i] {
                Nudged const n = nudged(i + 1, chain, loads, found, nudge);
                return joint_accelerations(n.chain, oracle::aba<long double>(n.chain, n.loads));
            });
        for (std::size_t i = 0; i < own.size(); ++i)
            moved[i] = joined(std::move(moved[i]), own[i].get());
    }
    ExactSolution exact;
    Solution there = layout;
    for (std::vector<double>& acceleration : moved) {
        there.acceleration = std::move(acceleration);
        exact.growth = larger(exact.growth, largest_difference(scene, there, wide) / nudge);
    }
    exact.by = quad ? "articulated bodies, 113 bits" : "articulated bodies, 64 bits";
    exact.acceleration = quad ? widest.get() : std::move(wide);
    return exact;
}

}  // namespace catena
