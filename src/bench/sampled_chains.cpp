// Implements the chains of `bench sampling`: what OpenMM's integrators can move, and the forces.
#include "bench/sampled_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "scene/branch_limits.hpp"
#include "structure/calvados2.hpp"
#include "terms/force_terms.hpp"

namespace catena::command {
namespace {

/// Throws InputError unless all chains are unbranched ones of beads with CALVADOS. OpenMM's own
/// integrators would ignore anything else.
void require_plain_chains(Scene const& scene) {
    auto const refuse = [&](std::string const& what, std::string const& remedy) {
        throw InputError(what, scene.file, remedy);
    };
    for (ChainSpec const& chain : scene.chains) {
        if (!chain.is_beads() || chain.base != Base::free || chain.tip != Tip::free ||
            chain.size() < 4)
            refuse("bench sampling takes a free chain of 4 beads or more",
                   "name a scene such as inputs/alpha-synuclein.yaml");
        if (scene::goes_by_paths(chain))
            refuse(fmt::format("bench sampling takes a chain without branches and cross-links, not "
                               "a {} one",
                               scene::kind_of_paths(chain)),
                   "name a scene such as inputs/alpha-synuclein.yaml");
    }
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

std::vector<Vec3> positions_of(Scene const& scene) {
    std::vector<Vec3> all;
    for (ChainSpec const& chain : scene.chains)
        all.insert(all.end(), chain.beads.position.begin(), chain.beads.position.end());
    return all;
}

}  // namespace

void warm_bonds(std::vector<Vec3>& positions, double kt, std::mt19937_64& draw) {
    std::normal_distribution<double> along_axis(0, std::sqrt(0.5 * kt / calvados2::bond_stiffness));
    for (Vec3& x : positions)
        for (int axis = 0; axis < 3; ++axis) x[axis] += along_axis(draw);
}

double longest_cutoff() {
    return std::max(calvados2::ashbaugh_hatch_cutoff, calvados2::yukawa_cutoff);
}

double rounding_at(double coordinate) {
    auto const x = static_cast<float>(coordinate);
    return 0.5 * static_cast<double>(std::nextafter(x, INFINITY) - x);
}

SampledChains::SampledChains(Scene scene, Communicator const& communicator, Backend backend)
    : scene_(std::move(scene)) {
    require_plain_chains(scene_);
    scene_.dynamics.integrator = Integrator::g_baoab;
    scene_.dynamics.fixman = false;
    for (ChainSpec& chain : scene_.chains) chain.velocities = StartVelocities::thermal;

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
}

std::span<Vec3 const> SampledChains::of_chain(std::vector<Vec3> const& all,
                                              std::int64_t chain) const {
    auto const first =
        static_cast<std::size_t>(beads_.chain_offset[static_cast<std::size_t>(chain)]);
    return std::span(all).subspan(first, scene_.chains[static_cast<std::size_t>(chain)].size());
}

void SampledChains::start_from(std::vector<Vec3> const& positions) {
    for (std::int64_t c = 0; c < chains(); ++c) {
        auto const x = of_chain(positions, c);
        scene_.chains[static_cast<std::size_t>(c)].beads.position.assign(x.begin(), x.end());
    }
}

Scene SampledChains::scene(double step, double time) {
    Scene scene = scene_;
    scene.dynamics.step = step;
    scene.dynamics.seed += runs_++;
    std::vector<Vec3> const all = start(positions_of(scene_), time);
    for (std::int64_t c = 0; c < chains(); ++c) {
        auto const x = of_chain(all, c);
        scene.chains[static_cast<std::size_t>(c)].beads.position.assign(x.begin(), x.end());
    }
    return scene;
}

std::vector<Vec3> SampledChains::forces(std::vector<Vec3> const& positions) {
    std::vector<Vec3> const at = for_evaluation(positions);
    Field<3> x(beads_.size()), force(beads_.size());
    for (std::int64_t k = 0; k < x.size(); ++k) x.set(k, at[static_cast<std::size_t>(k)]);
    evaluator_->begin(std::as_const(x).view());
    evaluator_->finish(force.view());
    std::vector<Vec3> found;
    for (std::int64_t k = 0; k < force.size(); ++k) found.push_back(force[k]);
    return found;
}

std::vector<ChainSample> SampledChains::sample(std::vector<Vec3> const& positions,
                                               BondMeasure measure) {
    std::vector<Vec3> const force = forces(positions);
    std::vector<ChainSample> samples;
    for (std::int64_t c = 0; c < chains(); ++c)
        samples.push_back(sample_chain(of_chain(positions, c), of_chain(force, c),
                                       scene_.chains[static_cast<std::size_t>(c)].beads.mass,
                                       measure));
    return samples;
}

std::vector<Vec3> SampledChains::centres(std::vector<Vec3> const& positions) const {
    std::vector<Vec3> found;
    for (std::int64_t c = 0; c < chains(); ++c) {
        std::vector<double> const& mass = scene_.chains[static_cast<std::size_t>(c)].beads.mass;
        auto const x = of_chain(positions, c);
        double all = 0;
        Vec3 sum = Vec3::zero();
        for (std::size_t k = 0; k < x.size(); ++k)
            all += mass[k], sum = plus_scaled(sum, mass[k], x[k]);
        found.push_back((1 / all) * sum);
    }
    return found;
}

}  // namespace catena::command
