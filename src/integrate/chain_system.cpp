#include "integrate/chain_system.hpp"

#include <algorithm>
#include <limits>

#include "chain/gather.hpp"
#include "error.hpp"

namespace catena {
namespace {

std::vector<double> flat(std::vector<Vec3> const& values) {
    std::vector<double> out;
    out.reserve(3 * values.size());
    for (Vec3 const& v : values) out.insert(out.end(), v.data, v.data + 3);
    return out;
}
std::vector<Vec3> triples(std::vector<double> const& values) {
    std::vector<Vec3> out(values.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
    return out;
}

}  // namespace

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

ChainSystem::Snapshot ChainSystem::snapshot() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::vector<double> position(3 * n), velocity(3 * n), omega(3 * n), orientation(4 * n);
    for (std::size_t i = 0; i < n; ++i) orientation[4 * i] = 1.0;
    for (auto const& group : absolute_) {
        std::vector<StateArray> const state = group->state(), observed = group->observed_state();
        gather_to_scene(communicator_, group->group(), 3, array_named(state, "position").values, position);
        gather_to_scene(communicator_, group->group(), 3, array_named(observed, "velocity").values, velocity);
        if (group->group().beads) continue;
        gather_to_scene(communicator_, group->group(), 4, array_named(state, "orientation").values, orientation);
        gather_to_scene(communicator_, group->group(), 3, array_named(observed, "omega").values, omega);
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        BodyMotion const& motion = joint_[i]->motion(joint_states_[i]);
        std::vector<Vec3> x, v;
        for (std::int64_t k = 0; k < group.size; ++k) {
            Vector<double, 4> const q = motion.orientation[k];
            Mat3 const turn = to_matrix(Quat{q[0], q[1], q[2], q[3]});
            x.push_back(motion.origin[k] - turn * group.r1[k]);
            v.push_back(turn * (motion.velocity[k] - cross(motion.omega[k], group.r1[k])));
        }
        gather_to_scene(communicator_, group, 3, flat(x), position);
        gather_to_scene(communicator_, group, 3, flat(v), velocity);
        gather_to_scene(communicator_, group, 4, to_array<4>("", motion.orientation.view()).values, orientation);
        gather_to_scene(communicator_, group, 3, to_array<3>("", motion.omega.view()).values, omega);
    }
    Snapshot s{triples(position), triples(velocity), triples(omega), {}};
    for (std::size_t i = 0; i < n; ++i)
        s.orientation.push_back({orientation[4 * i], orientation[4 * i + 1], orientation[4 * i + 2], orientation[4 * i + 3]});
    return s;
}

std::vector<EnergyTerm> ChainSystem::potential_energy() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::vector<double> gravity(n), springs(n);
    auto const add = [&](ChainGroup const& group, PotentialEnergy const& e) {
        gather_to_scene(communicator_, group, 1, e.gravity, gravity);
        gather_to_scene(communicator_, group, 1, e.springs, springs);
    };
    for (auto const& group : absolute_) add(group->group(), group->potential());
    for (std::size_t i = 0; i < joint_.size(); ++i)
        add(joint_[i]->group(), joint_[i]->potential(joint_states_[i], joint_[i]->motion(joint_states_[i])));
    std::vector<EnergyTerm> terms{{"gravity", 0.0}, {"springs", 0.0}};
    for (double const e : gravity) terms[0].value += e;
    for (double const e : springs) terms[1].value += e;
    if (openmm_)
        for (EnergyTerm const& term : openmm_->energies()) terms.push_back(term);
    return terms;
}

std::vector<Vector<double, 6>> ChainSystem::joint_forces() {
    std::vector<double> all(communicator_.rank() == 0 ? static_cast<std::size_t>(6 * scene_.bodies()) : 0);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        std::vector<double> own;
        for (Vector<double, 6> const& w : r.joint_force) own.insert(own.end(), w.data, w.data + 6);
        gather_to_scene(communicator_, group, 6, own, all);
    };
    for (auto const& group : absolute_) add(group->group(), group->results());
    for (auto const& group : joint_) add(group->group(), group->results());
    std::vector<Vector<double, 6>> forces(all.size() / 6);
    for (std::size_t i = 0; i < all.size(); ++i) forces[i / 6][static_cast<int>(i % 6)] = all[i];
    return forces;
}

ChainSystem::Accelerations ChainSystem::accelerations() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::vector<double> joint(3 * n), body(3 * n), base(3 * n), bead_force;
    if (openmm_) bead_force.resize(3 * n);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        gather_to_scene(communicator_, group, 3, flat(r.acceleration), body);
    };
    for (auto const& group : absolute_) {
        add(group->group(), group->results());
        gather_to_scene(communicator_, group->group(), 3, flat(group->results().acceleration), joint);
        if (group.get() != beads_ || !openmm_) continue;
        gather_to_scene(communicator_, group->group(), 3, to_array<3>("", std::as_const(openmm_force_).view()).values, bead_force);
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        add(group, joint_[i]->results());
        gather_to_scene(communicator_, group, 3, to_array<3>("", std::as_const(joint_rates_[i]).qdd.view()).values, joint);
        std::vector<Vec3> of_base(static_cast<std::size_t>(group.size), Vec3::zero());
        for (std::size_t p = 0; p < group.pieces.size(); ++p)
            if (group.pieces[p].starts) of_base[group.pieces[p].local] = joint_rates_[i].base_acceleration[p];
        gather_to_scene(communicator_, group, 3, flat(of_base), base);
    }
    return {triples(joint), triples(body), triples(bead_force), triples(base), joint_forces()};
}

std::map<std::string, std::vector<double>> ChainSystem::state() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::map<std::string, std::vector<double>> arrays;
    auto const add = [&](ChainGroup const& group, std::string const& name, int width, std::vector<double> const& own) {
        auto& array = arrays[name];
        array.resize(n * static_cast<std::size_t>(width));
        gather_to_scene(communicator_, group, width, own, array);
    };
    for (auto const& group : absolute_)
        for (StateArray const& a : group->state()) add(group->group(), a.name, a.width, a.values);
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        JointState const& s = joint_states_[i];
        add(group, "q", 4, to_array<4>("", s.q.view()).values);
        add(group, "qd", 3, to_array<3>("", s.qd.view()).values);
        std::vector<Vec3> x(static_cast<std::size_t>(group.size), Vec3::zero()), v = x;
        for (std::size_t p = 0; p < group.pieces.size(); ++p)
            if (group.pieces[p].starts) {
                x[group.pieces[p].local] = s.base_position[p];
                v[group.pieces[p].local] = s.base_velocity[p];
            }
        add(group, "base_position", 3, flat(x));
        add(group, "base_velocity", 3, flat(v));
    }
    return arrays;
}

void ChainSystem::set_state(std::map<std::string, std::vector<double>> const& arrays) {
    auto const own = [&](ChainGroup const& group, std::string const& name, int width) {
        auto const found = arrays.find(name);
        if (found == arrays.end() || found->second.size() != static_cast<std::size_t>(scene_.bodies() * width))
            throw InputError("the checkpoint lacks the array " + name + " for this scene", "--restart",
                             "take a checkpoint of this scene and integrator");
        return take_from_scene(group, width, found->second);
    };
    for (auto const& group : absolute_) {
        std::vector<StateArray> state = group->state();
        for (StateArray& a : state) a.values = own(group->group(), a.name, a.width);
        group->set_state(state);
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        from_array<4>({"q", 4, own(group, "q", 4)}, joint_states_[i].q.view());
        from_array<3>({"qd", 3, own(group, "qd", 3)}, joint_states_[i].qd.view());
        std::vector<Vec3> const x = triples(own(group, "base_position", 3)), v = triples(own(group, "base_velocity", 3));
        for (std::size_t p = 0; p < group.pieces.size(); ++p) {
            joint_states_[i].base_position[p] = x[group.pieces[p].local];
            joint_states_[i].base_velocity[p] = v[group.pieces[p].local];
        }
    }
}

}  // namespace catena
