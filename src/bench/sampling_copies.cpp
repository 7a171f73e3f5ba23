// Implements the copies of `bench sampling`: checks of the scene, the grid and the forces.
#include "bench/sampling_copies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bench/generated.hpp"
#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "reader/load_scene.hpp"
#include "scene/branch_limits.hpp"
#include "structure/calvados2.hpp"
#include "terms/force_terms.hpp"

namespace catena::command {
namespace {

/// Distance between copies in units of the root-mean-square displacement: five standard deviations
/// of two chains' distance along an axis.
constexpr double clear_of_chance = 4;

/// Returns the scene with its chain repeated and without a box.
Scene copies_of(BenchRequest const& request) {
    std::vector<std::string> overrides = overrides_of(request);
    overrides.push_back(fmt::format("chains[0].count={}", request.sampling.copies));
    overrides.emplace_back("box=none");
    std::string const& file = request.sampling.scene;
    return file.empty() ? single_chain_scene(overrides) : load_scene(file, overrides);
}

/// Throws InputError unless the scene is one chain of beads with CALVADOS 2. OpenMM's own
/// integrators would ignore anything else.
void require_one_plain_chain(Scene const& scene, std::int64_t copies) {
    auto const refuse = [&](std::string const& what, std::string const& remedy) {
        throw InputError(what, scene.file, remedy);
    };
    if (std::ssize(scene.chains) != copies)
        refuse("bench sampling takes a scene of one chain", "leave the others out");
    ChainSpec const& chain = scene.chains.front();
    if (!chain.is_beads() || chain.base != Base::free || chain.tip != Tip::free || chain.size() < 4)
        refuse("bench sampling takes a free chain of 4 beads or more",
               "name a scene such as inputs/alpha-synuclein.yaml");
    if (scene::goes_by_paths(chain))
        refuse(fmt::format("bench sampling takes a chain without branches and cross-links, not a "
                           "{} one",
                           scene::kind_of_paths(chain)),
               "name a scene such as inputs/alpha-synuclein.yaml");
    if (!scene.forces.openmm || scene.forces.openmm->builder.empty())
        refuse("bench sampling takes forces of CALVADOS 2 or 3, whose bonds OpenMM then computes",
               "add forces: {openmm: {builder: calvados2}}");
    terms::for_each([&](auto term) {
        if (!term.known_to_openmm && terms::acts_in<decltype(term)>(scene))
            refuse(fmt::format("{}, which OpenMM's own integrators ignore", term.name),
                   "leave them out");
    });
    if (!scene.dynamics.given)
        refuse("the scene has no dynamics section",
               "add dynamics: {integrator: g-baoab, step: 0.01}");
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

}  // namespace

void warm_bonds(std::vector<Vec3>& positions, double kt, std::mt19937_64& draw) {
    std::normal_distribution<double> along_axis(0, std::sqrt(0.5 * kt / calvados2::bond_stiffness));
    for (Vec3& x : positions)
        for (int axis = 0; axis < 3; ++axis) x[axis] += along_axis(draw);
}

double SamplingCopies::cutoff() {
    return std::max(calvados2::ashbaugh_hatch_cutoff, calvados2::yukawa_cutoff);
}

SamplingCopies::SamplingCopies(BenchRequest const& request, Communicator const& communicator,
                               Backend backend)
    : scene_(copies_of(request)) {
    require_one_plain_chain(scene_, request.sampling.copies);
    scene_.dynamics.integrator = Integrator::g_baoab;
    scene_.dynamics.fixman = false;
    for (ChainSpec& chain : scene_.chains) chain.velocities = StartVelocities::thermal;
    std::vector<Vec3> start;
    for (ChainSpec const& chain : scene_.chains)
        start.insert(start.end(), chain.beads.position.begin(), chain.beads.position.end());

    // This scene serves only to list the beads.
    Scene described = scene_;
    described.solver.backend = Backend::segments;
    described.forces.openmm->platform = "Reference";
    described.forces.openmm->path = "inline";
    beads_ = ChainSystem(described, Axes::world, communicator).beads();
    OpenMmSpec spec = *scene_.forces.openmm;
    spec.path = "inline";
    if (spec.platform.empty() && uses_gpu(backend)) spec.platform = "CUDA";
    evaluator_ = make_openmm_force(spec, beads_, communicator);
    start_from(start);
}

std::span<Vec3 const> SamplingCopies::of_copy(std::vector<Vec3> const& all,
                                              std::int64_t copy) const {
    auto const n = static_cast<std::size_t>(beads_of_copy());
    return std::span(all).subspan(static_cast<std::size_t>(copy) * n, n);
}

SamplingCopies::Ball SamplingCopies::ball(std::span<Vec3 const> x) const {
    std::vector<double> const& mass = scene_.chains.front().beads.mass;
    double const all = sum_of(mass);
    Ball found;
    for (std::size_t k = 0; k < x.size(); ++k)
        found.centre = plus_scaled(found.centre, mass[k] / all, x[k]);
    for (Vec3 const& each : x) found.reach = larger(found.reach, norm(each - found.centre));
    return found;
}

Vec3 SamplingCopies::place(std::int64_t copy) const {
    std::int64_t edge = 1;
    while (edge * edge * edge < copies()) ++edge;
    double const middle = 0.5 * static_cast<double>(edge - 1);
    auto const along = [&](std::int64_t index) { return static_cast<double>(index) - middle; };
    return {along(copy / (edge * edge)), along(copy / edge % edge), along(copy % edge)};
}

std::vector<Vec3> SamplingCopies::placed(std::vector<Vec3> positions, double spacing) const {
    auto const n = static_cast<std::size_t>(beads_of_copy());
    for (std::int64_t c = 0; c < copies(); ++c) {
        Vec3 const shift = spacing * place(c) - ball(of_copy(positions, c)).centre;
        for (std::size_t k = 0; k < n; ++k) {
            Vec3& x = positions[static_cast<std::size_t>(c) * n + k];
            x = x + shift;
        }
    }
    return positions;
}

void SamplingCopies::start_from(std::vector<Vec3> const& positions) {
    for (std::int64_t c = 0; c < copies(); ++c) {
        auto const x = of_copy(positions, c);
        scene_.chains[static_cast<std::size_t>(c)].beads.position.assign(x.begin(), x.end());
    }
}

double SamplingCopies::spacing(double time) const {
    BeadArrays const& chain = scene_.chains.front().beads;
    double const kt = scene_.boltzmann() * scene_.dynamics.temperature;
    return sum_of(chain.length, 1) + cutoff() +
           clear_of_chance * way(kt, sum_of(chain.mass), scene_.dynamics.friction, time);
}

double SamplingCopies::extent(double time) const {
    Vec3 const corner = place(0);
    BeadArrays const& chain = scene_.chains.front().beads;
    return spacing(time) * std::abs(corner[0]) + 0.5 * sum_of(chain.length, 1);
}

Scene SamplingCopies::scene(double step, double time) {
    Scene scene = scene_;
    scene.dynamics.step = step;
    scene.dynamics.seed += runs_++;
    std::vector<Vec3> all;
    for (ChainSpec const& chain : scene_.chains)
        all.insert(all.end(), chain.beads.position.begin(), chain.beads.position.end());
    all = placed(std::move(all), spacing(time));
    for (std::int64_t c = 0; c < copies(); ++c) {
        auto const x = of_copy(all, c);
        scene.chains[static_cast<std::size_t>(c)].beads.position.assign(x.begin(), x.end());
    }
    return scene;
}

std::vector<Vec3> SamplingCopies::forces(std::vector<Vec3> const& positions) {
    double reach = 0;
    for (std::int64_t c = 0; c < copies(); ++c)
        reach = larger(reach, ball(of_copy(positions, c)).reach);
    std::vector<Vec3> const near = placed(positions, 2 * reach + cutoff() + 1);
    Field<3> x(beads_.size()), force(beads_.size());
    for (std::int64_t k = 0; k < x.size(); ++k) x.set(k, near[static_cast<std::size_t>(k)]);
    evaluator_->begin(std::as_const(x).view());
    evaluator_->finish(force.view());
    std::vector<Vec3> found;
    for (std::int64_t k = 0; k < force.size(); ++k) found.push_back(force[k]);
    return found;
}

std::vector<ChainSample> SamplingCopies::sample(std::vector<Vec3> const& positions,
                                                BondMeasure measure) {
    std::vector<Vec3> const force = forces(positions);
    std::vector<ChainSample> samples;
    for (std::int64_t c = 0; c < copies(); ++c)
        samples.push_back(sample_chain(of_copy(positions, c), of_copy(force, c),
                                       scene_.chains[static_cast<std::size_t>(c)].beads.mass,
                                       measure));
    return samples;
}

double SamplingCopies::nearest(std::vector<Vec3> const& positions) const {
    std::vector<Ball> balls;
    for (std::int64_t c = 0; c < copies(); ++c) balls.push_back(ball(of_copy(positions, c)));
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t a = 0; a < copies(); ++a)
        for (std::int64_t b = a + 1; b < copies(); ++b) {
            Ball const &one = balls[static_cast<std::size_t>(a)],
                       &other = balls[static_cast<std::size_t>(b)];
            double gap = norm(one.centre - other.centre) - one.reach - other.reach;
            if (std::isnan(gap)) return gap;
            if (gap <= cutoff()) {
                gap = std::numeric_limits<double>::infinity();
                for (Vec3 const& x : of_copy(positions, a))
                    for (Vec3 const& y : of_copy(positions, b)) gap = std::min(gap, norm(x - y));
            }
            least = std::min(least, gap);
        }
    return least;
}

}  // namespace catena::command
