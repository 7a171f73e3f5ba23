// Implements the copies of `bench sampling` on their grid.
#include "bench/sampling_copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bench/generated.hpp"
#include "console/text.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "error.hpp"
#include "reader/load_scene.hpp"

namespace catena::command {
namespace {

/// Distance between copies in units of the root-mean-square displacement: five standard deviations
/// of two chains' distance along an axis.
constexpr double clear_of_chance = 4;

/// Returns the scene with its chain repeated and without a box. Throws InputError if it has several
/// chains.
Scene copies_of(BenchRequest const& request) {
    std::vector<std::string> overrides = overrides_of(request);
    overrides.push_back(fmt::format("chains[0].count={}", request.sampling.copies));
    for (char const* const of_a_box : {"box=none", "place=null", "chains[0].place=null"})
        overrides.emplace_back(of_a_box);
    std::string const& file = request.sampling.scene;
    Scene scene = file.empty() ? single_chain_scene(overrides) : load_scene(file, overrides);
    if (std::ssize(scene.chains) != request.sampling.copies)
        throw InputError("bench sampling takes a scene of one chain", scene.file,
                         "leave the others out, or add --dense to sample all chains in their box");
    return scene;
}

/// Returns the root-mean-square displacement of a mass in free Langevin motion within the time t.
double way(double kt, double mass, double friction, double t) {
    double const damped = friction * t;
    if (damped < 1e-4) return std::sqrt(3 * kt / mass) * t;
    return std::sqrt(6 * kt / (mass * friction) * (t + std::expm1(-damped) / friction));
}

/// Returns the sum of the values from `first` on.
double sum_of(std::vector<double> const& values, std::size_t first = 0) {
    return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(), 0.0);
}

/// Returns the name of the chain without the number of a copy.
std::string name_of_chain(std::string const& first, std::int64_t copies) {
    return copies > 1 && first.ends_with("-1") ? first.substr(0, first.size() - 2) : first;
}

}  // namespace

SamplingCopies::SamplingCopies(BenchRequest const& request, Communicator const& communicator,
                               Backend backend)
    : SampledChains(copies_of(request), communicator, backend) {}

std::string SamplingCopies::description() const {
    ChainSpec const& first = model().chains.front();
    return fmt::format("{} of {} ({} beads), without a box", counted(chains(), "copy", "copies"),
                       name_of_chain(first.name, chains()), first.size());
}

SamplingCopies::Ball SamplingCopies::ball(std::span<Vec3 const> x) const {
    std::vector<double> const& mass = model().chains.front().beads.mass;
    double const all = sum_of(mass);
    Ball found;
    for (std::size_t k = 0; k < x.size(); ++k)
        found.centre = plus_scaled(found.centre, mass[k] / all, x[k]);
    for (Vec3 const& each : x) found.reach = larger(found.reach, norm(each - found.centre));
    return found;
}

Vec3 SamplingCopies::place(std::int64_t copy) const {
    std::int64_t edge = 1;
    while (edge * edge * edge < chains()) ++edge;
    double const middle = 0.5 * static_cast<double>(edge - 1);
    auto const along = [&](std::int64_t index) { return static_cast<double>(index) - middle; };
    return {along(copy / (edge * edge)), along(copy / edge % edge), along(copy % edge)};
}

std::vector<Vec3> SamplingCopies::placed(std::vector<Vec3> positions, double spacing) const {
    std::size_t const n = model().chains.front().size();
    for (std::int64_t c = 0; c < chains(); ++c) {
        Vec3 const shift = spacing * place(c) - ball(of_chain(positions, c)).centre;
        for (std::size_t k = 0; k < n; ++k) {
            Vec3& x = positions[static_cast<std::size_t>(c) * n + k];
            x = x + shift;
        }
    }
    return positions;
}

double SamplingCopies::spacing(double time) const {
    BeadArrays const& chain = model().chains.front().beads;
    double const kt = model().boltzmann() * model().dynamics.temperature;
    return sum_of(chain.length, 1) + longest_cutoff() +
           clear_of_chance * way(kt, sum_of(chain.mass), model().dynamics.friction, time);
}

double SamplingCopies::extent(double time) const {
    Vec3 const corner = place(0);
    BeadArrays const& chain = model().chains.front().beads;
    return spacing(time) * std::abs(corner[0]) + 0.5 * sum_of(chain.length, 1);
}

CopyDistances SamplingCopies::distances(double time) const {
    return {.spacing = spacing(time), .rounding = rounding_at(extent(time))};
}

std::vector<Vec3> SamplingCopies::start(std::vector<Vec3> positions, double time) const {
    return placed(std::move(positions), spacing(time));
}

std::vector<Vec3> SamplingCopies::for_evaluation(std::vector<Vec3> positions) const {
    double reach = 0;
    for (std::int64_t c = 0; c < chains(); ++c)
        reach = larger(reach, ball(of_chain(positions, c)).reach);
    return placed(std::move(positions), 2 * reach + longest_cutoff() + 1);
}

double SamplingCopies::nearest(std::vector<Vec3> const& positions) const {
    std::vector<Ball> balls;
    for (std::int64_t c = 0; c < chains(); ++c) balls.push_back(ball(of_chain(positions, c)));
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t a = 0; a < chains(); ++a)
        for (std::int64_t b = a + 1; b < chains(); ++b) {
            Ball const &one = balls[static_cast<std::size_t>(a)],
                       &other = balls[static_cast<std::size_t>(b)];
            double gap = norm(one.centre - other.centre) - one.reach - other.reach;
            if (std::isnan(gap)) return gap;
            if (gap <= longest_cutoff()) {
                gap = std::numeric_limits<double>::infinity();
                for (Vec3 const& x : of_chain(positions, a))
                    for (Vec3 const& y : of_chain(positions, b)) gap = std::min(gap, norm(x - y));
            }
            least = std::min(least, gap);
        }
    return least;
}

}  // namespace catena::command
