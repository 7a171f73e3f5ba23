#include "integrate/chain_system.hpp"

#include <algorithm>
#include <limits>

#include "chain/gather.hpp"
#include "error.hpp"

namespace catena {
Backend choose_backend(Scene const& scene, Communicator const& communicator) {
    Backend const asked = scene.solver.backend;
    if (asked == Backend::cuda || asked == Backend::cuda_levels)
        throw not_in_this_version("solver.backend: " + std::string(name_of(asked)) + " (use serial, segments or openmp)");
    if (scene.solver.gpu_levels != "auto") throw not_in_this_version("solver.gpu_levels: " + scene.solver.gpu_levels);
    if (asked != Backend::automatic) return asked;
    // Threads pay once each has some thousand bodies' work (README, "Numbers").
    std::int64_t constexpr worth_threads = 4096;
    return openmp_is_built() && choose_threads(scene, communicator) > 1 && scene.bodies() / communicator.size() >= worth_threads
               ? Backend::openmp
               : Backend::segments;
}

int choose_threads(Scene const& scene, Communicator const& communicator) {
    if (scene.solver.threads > 0) return scene.solver.threads;
    return cores_of_rank(communicator);
}

ChainSystem::ChainSystem(Scene const& scene, Axes axes, Communicator const& communicator)
    : scene_(scene), communicator_(communicator), backend_(choose_backend(scene, communicator)) {
    executor_ = backend_ == Backend::openmp ? openmp_executor(choose_threads(scene, communicator)) : serial_executor();
    groups_ = make_groups(scene, axes, scene.solver.handles, backend_ == Backend::serial, communicator);
    for (auto const& group : groups_) {
        auto solver = make_tree_solver(*group, *executor_, communicator);
        if (group->beads) {
            absolute_.push_back(make_bead_dynamics(*group, scene, *executor_, communicator, std::move(solver)));
            beads_ = absolute_.back().get();
        } else if (axes == Axes::world) {
            absolute_.push_back(make_body_dynamics(*group, scene, *executor_, communicator, std::move(solver)));
        } else {
            joint_.push_back(std::make_unique<JointDynamics>(*group, scene, *executor_, communicator, std::move(solver)));
            joint_states_.push_back(make_joint_state(*group, scene));
            joint_rates_.push_back(joint_.back()->make_rates());
        }
    }
    if (scene.forces.openmm) make_openmm();
}

void ChainSystem::make_openmm() {
    if (!beads_)
        throw InputError("OpenMM computes forces on beads and the scene has none", scene_.file + ": forces.openmm",
                         "add a bead chain or remove forces.openmm");
    BeadSystem system;
    system.chain_offset.push_back(0);
    for (int const index : beads_->group().chain) {
        ChainSpec const& chain = scene_.chains[index];
        std::int64_t const first = system.size();
        system.mass.insert(system.mass.end(), chain.beads.mass.begin(), chain.beads.mass.end());
        system.residue.insert(system.residue.end(), chain.beads.residue.begin(), chain.beads.residue.end());
        for (std::int64_t k = 1; k < static_cast<std::int64_t>(chain.size()); ++k)
            system.links.push_back({first + k - 1, first + k, chain.beads.length[k]});
        system.chain_name.push_back(chain.name);
        system.chain_offset.push_back(system.size());
    }
    system.first_of_rank = beads_->group().first_of_rank();
    system.box = scene_.box;
    system.scene_file = scene_.file;
    openmm_force_ = Field<3>(beads_->group().size);
    openmm_ = make_openmm_force(*scene_.forces.openmm, system, communicator_);
}

void ChainSystem::forces_and_matrices(StepTimeline* timeline) {
    double const start = seconds_now();
    auto const note = [&](char const* name, char const* lane, double begin, double end) {
        if (timeline) timeline->phases.push_back({name, lane, begin - start, end - start});
    };
    if (openmm_) openmm_->begin(beads_->bead_positions());
    double const begun = seconds_now();
    for (auto const& group : absolute_) group->assemble_matrices();
    double const assembled = seconds_now();
    for (auto const& group : absolute_) group->set_simple_forces();
    double const simple = seconds_now();
    if (openmm_) add_openmm_forces();
    double const finished = seconds_now();
    note("matrix sweep", "catena", begun, assembled);
    note("simple forces", "catena", assembled, simple);
    matrix_seconds_ += assembled - begun;
    seconds_["matrix sweep"] += assembled - begun;
    seconds_["kinematics and loads"] += simple - assembled;
    if (!openmm_) return;
    Interval const ran = openmm_->last_evaluation();
    hidden_seconds_ += std::max(0.0, std::min(assembled, ran.end) - std::max(begun, ran.begin));
    note("hand over positions", "catena", start, begun);
    note("wait for forces", "catena", simple, finished);
    note("forces", "openmm", ran.begin, ran.end);
    seconds_["forces"] += ran.end - ran.begin;
    seconds_["waiting for forces"] += (finished - simple) + (begun - start);
}

void ChainSystem::add_openmm_forces() {
    std::int64_t const n = beads_->group().size;
    for (std::int64_t k = 0; k < n; ++k) openmm_force_.set(k, Vec3::zero());
    openmm_->finish(openmm_force_.view());
    View<3> const forces = beads_->bead_forces();
    for (std::int64_t k = 0; k < n; ++k) forces.store(k, forces.load(k) + openmm_force_[k]);
}

void ChainSystem::evaluate() {
    for (auto const& group : absolute_) group->update_configuration();
    forces_and_matrices(nullptr);
    for (auto const& group : absolute_) {
        group->observe(0.0);
        group->evaluate();
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) joint_[i]->evaluate(joint_states_[i], joint_rates_[i]);
}

double ChainSystem::residual() {
    double worst = 0;
    for (auto const& group : absolute_) worst = larger(worst, group->residual());
    for (auto const& group : joint_) worst = larger(worst, group->residual());
    return worst;
}

// Each merge adds rounding of a few eps of its terms, and terms pass through at most `depth` merges. c = 32 covers the
// constants of 6x6 handles (factorisation, two triangular solves, leaf).
double ChainSystem::residual_bound() const {
    std::int64_t depth = 1;
    for (SolverReport const& r : solver_reports()) depth = std::max(depth, r.depth);
    return 32.0 * static_cast<double>(depth) * std::numeric_limits<double>::epsilon() / 2;
}

std::vector<AbsoluteDynamics*> ChainSystem::absolute() const {
    std::vector<AbsoluteDynamics*> all;
    for (auto const& group : absolute_) all.push_back(group.get());
    return all;
}
std::vector<JointDynamics*> ChainSystem::joint() const {
    std::vector<JointDynamics*> all;
    for (auto const& group : joint_) all.push_back(group.get());
    return all;
}

std::vector<SolverReport> ChainSystem::solver_reports() const {
    std::vector<SolverReport> reports;
    auto const add = [&](ChainSolver const& solver) {
        SolverReport r = solver.report();
        r.backend = name_of(backend_);
        r.handles = name_of(scene_.solver.handles);
        reports.push_back(r);
    };
    for (auto const& group : absolute_) add(group->solver());
    for (auto const& group : joint_) add(group->solver());
    return reports;
}

}  // namespace catena
