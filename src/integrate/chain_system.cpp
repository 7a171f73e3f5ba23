#include "integrate/chain_system.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "chain/gather.hpp"
#include "cuda/dynamics.hpp"
#include "cuda/memory.hpp"
#include "cuda/solver.hpp"
#include "error.hpp"

namespace catena {
namespace {

/// What kernels, graphs and streams take by themselves.
constexpr std::int64_t gpu_reserve = std::int64_t{128} << 20;
constexpr char const* without_gpu = "use auto, another backend, or a build with CUDA on a machine with a GPU";
constexpr char const* without_memory = "use more GPUs (ranks on several hosts), another backend, or fewer bodies";

/// Ends all ranks together, with the words of the first that has a reason. Collective.
template <class Error = InputError>
void refuse_cuda(Communicator const& communicator, std::string const& backend, std::string const& reason, char const* remedy) {
    std::string own = reason, all(static_cast<std::size_t>(communicator.size()) * 200, ' ');
    own.resize(200, ' ');
    communicator.all_gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)),
                            std::vector<std::int64_t>(static_cast<std::size_t>(communicator.size()), 200));
    auto const found = all.find_first_not_of(' ');
    if (found == std::string::npos) return;
    std::string text = all.substr(found, 200 - found % 200);
    text.erase(text.find_last_not_of(' ') + 1);
    if (communicator.size() > 1) text += ", rank " + std::to_string(found / 200);
    throw Error(text, "solver.backend: " + backend, remedy);
}

}  // namespace

Backend choose_backend(Scene const& scene, Communicator const& communicator) {
    Backend const asked = scene.solver.backend;
    if (uses_gpu(asked) && scene.dynamics.fixman)
        throw InputError("the Fixman force is computed on the host", "solver.backend: " + std::string(name_of(asked)),
                         "use auto, segments, openmp or serial");
    if (uses_gpu(asked)) refuse_cuda(communicator, name_of(asked), cuda::why_not(), without_gpu);
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
    : scene_(scene), communicator_(communicator), axes_(axes), backend_(choose_backend(scene, communicator)) {
    if (uses_gpu(backend_)) refuse_cuda(communicator, name_of(backend_), cuda::choose_device(communicator), without_gpu);
    bool const threads = backend_ == Backend::openmp || (backend_ == Backend::cuda_levels && openmp_is_built());
    executor_ = threads ? openmp_executor(choose_threads(scene, communicator)) : serial_executor();
    groups_ = make_groups(scene, axes, scene.solver.handles, scene.solver.pairwise(), communicator);
    if (uses_gpu(backend_)) require_gpu_memory();
    if (scene.forces.openmm) make_openmm();
    for (auto const& group : groups_) {
        if (is_absolute(*group))
            absolute_.push_back(make_absolute(*group));
        else
            joint_.push_back(make_joint(*group));
    }
    if (openmm_) find_bead_hosts();
}

ChainSystem::~ChainSystem() { is_current(); }  // what it holds on the GPU is given back there

bool ChainSystem::is_current() noexcept {
    DevicePath* const path = openmm_ ? openmm_->device_path() : nullptr;
    return path == nullptr || path->make_current();
}

/// Before anything is there.
void ChainSystem::require_gpu_memory() const {
    std::int64_t needed = gpu_reserve;
    for (auto const& group : groups_) needed += cuda::memory_needed(*group, scene_, backend_, communicator_).sum();
    refuse_cuda<cuda::TooLittleMemory>(communicator_, name_of(backend_), cuda::too_little_memory(needed, cuda::free_memory(communicator_)),
                                       without_memory);
}

void ChainSystem::make_current() {
    if (!is_current()) throw ComputationError("OpenMM's CUDA context cannot be made current");
}

std::unique_ptr<AbsoluteDynamics> ChainSystem::make_absolute(ChainGroup const& group) const {
    if (backend_ == Backend::cuda) {
        auto const make = group.beads ? cuda::make_bead_dynamics : cuda::make_rigid_dynamics;
        return make(group, scene_, communicator_);
    }
    auto const make = group.beads ? make_bead_dynamics : make_rigid_dynamics;
    return make(group, scene_, *executor_, communicator_, make_solver(group));
}
std::unique_ptr<JointDynamics> ChainSystem::make_joint(ChainGroup const& group) const {
    if (backend_ == Backend::cuda) return cuda::make_joint_dynamics(group, scene_, communicator_);
    return make_joint_dynamics(group, scene_, *executor_, communicator_, make_solver(group));
}
std::unique_ptr<ChainSolver> ChainSystem::make_solver(ChainGroup const& group) const {
    if (backend_ == Backend::cuda_levels)
        return dca::make_level_solver(group, communicator_, scene_.solver.levels_on_gpu(), cuda::make_levels, dca::host_levels(*executor_));
    return make_tree_solver(group, *executor_, communicator_);
}

namespace {

/// The carried bead that stands at a point of body k (from its centre of mass, B); -1: none does.
std::int64_t bead_at(LinkedArrays const& linked, std::size_t k, Vec3 const& point) {
    double constexpr rounding = 1e-9;  // of positions that a file holds in decimals, turned into the body's axes
    for (std::int64_t i = linked.carried.offset[k]; i < linked.carried.offset[k + 1]; ++i) {
        Vec3 const at = linked.carried.position[static_cast<std::size_t>(i)];
        if (norm(at - point) <= rounding * (norm(at) + norm(point))) return i;
    }
    return -1;
}

}  // namespace

/// Every bead of the scene in the order of its chains.
void ChainSystem::describe_beads() {
    BeadSystem& system = bead_system_;
    system.chain_offset.push_back(0);
    for (ChainSpec const& chain : scene_.chains) {
        if (chain.bead_count() == 0) continue;
        std::int64_t const first = system.size();
        if (chain.is_beads()) {
            system.mass.insert(system.mass.end(), chain.beads.mass.begin(), chain.beads.mass.end());
            system.residue.insert(system.residue.end(), chain.beads.residue.begin(), chain.beads.residue.end());
            for (std::int64_t k = 1; k < static_cast<std::int64_t>(chain.size()); ++k)
                system.links.push_back({first + k - 1, first + k, chain.beads.length[static_cast<std::size_t>(k)]});
        } else {
            CarriedBeads const& carried = chain.carried();
            system.mass.insert(system.mass.end(), carried.mass.begin(), carried.mass.end());
            system.residue.insert(system.residue.end(), carried.residue.begin(), carried.residue.end());
            for (std::size_t k = 0; k < chain.size(); ++k) {
                std::int64_t const begin = carried.offset[k], end = carried.offset[k + 1];
                if (end - begin > 1) system.rigid.emplace_back(first + begin, first + end);
                if (k == 0) continue;
                if (chain.is_linked()) {
                    std::int64_t const from = bead_at(chain.linked, k - 1, chain.linked.outboard[k - 1]);
                    std::int64_t const to = bead_at(chain.linked, k, chain.linked.inboard[k]);
                    if (from >= 0 && to >= 0) system.links.push_back({first + from, first + to, chain.linked.length[k]});
                } else if (end > begin && begin > carried.offset[k - 1]) {
                    system.neighbours.emplace_back(first + begin - 1, first + begin);
                }
            }
        }
        system.chain_name.push_back(chain.name);
        system.chain_offset.push_back(system.size());
    }
    system.box = scene_.box;
    system.scene_file = scene_.file;
}

/// A rank owns the beads of its bodies, group after group.
void ChainSystem::order_beads_by_rank() {
    std::vector<std::int64_t> first_of_chain;
    std::int64_t beads = 0;
    for (ChainSpec const& chain : scene_.chains) {
        first_of_chain.push_back(beads);
        beads += static_cast<std::int64_t>(chain.bead_count());
    }
    auto const bead_of = [&](int chain, std::int64_t body) {  // first of a body's; body = size: one past the chain's last
        ChainSpec const& spec = scene_.chains[chain];
        if (spec.is_beads()) return first_of_chain[chain] + body;
        return first_of_chain[chain] + (spec.bead_count() == 0 ? 0 : spec.carried().offset[static_cast<std::size_t>(body)]);
    };
    std::vector<std::int64_t> order;
    bead_system_.first_of_rank = {0};
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        for (ChainGroup const* group : bead_groups_)
            for (dca::Piece const& piece : dca::pieces_of(group->partition, rank)) {
                int const chain = group->chain[piece.chain];
                for (std::int64_t i = bead_of(chain, piece.body); i < bead_of(chain, piece.body + piece.count); ++i) order.push_back(i);
            }
        bead_system_.first_of_rank.push_back(static_cast<std::int64_t>(order.size()));
    }
    if (!std::is_sorted(order.begin(), order.end())) bead_system_.by_rank = std::move(order);
}

/// Groups in absolute coordinates come first.
void ChainSystem::find_bead_groups() {
    for (bool const absolute : {true, false})
        for (auto const& group : groups_)
            if (is_absolute(*group) == absolute && (group->beads || group->carried_in_scene)) bead_groups_.push_back(group.get());
}

/// Before anything of the chains is on a GPU: where OpenMM computes there, they live in its context.
void ChainSystem::make_openmm() {
    find_bead_groups();
    if (bead_groups_.empty())
        throw InputError("OpenMM computes forces on beads and the scene has none", scene_.file + ": forces.openmm",
                         "add a bead chain, beads on bodies, or remove forces.openmm");
    describe_beads();
    order_beads_by_rank();
    std::int64_t const own = bead_system_.first_of_rank[communicator_.rank() + 1] - bead_system_.first_of_rank[communicator_.rank()];
    bead_position_ = Field<3>(own);
    openmm_force_ = Field<3>(own);
    ChainsOnDevice chains{no_gpu_asked_for, -1};
    if (backend_ == Backend::cuda) {
        bool const beads = std::all_of(bead_groups_.begin(), bead_groups_.end(), [](ChainGroup const* group) { return group->beads; });
        chains = {beads ? "" : "some beads are carried by rigid bodies", cuda::chosen_device()};
    }
    openmm_ = make_openmm_force(*scene_.forces.openmm, bead_system_, communicator_, chains);
    make_current();
}

void ChainSystem::find_bead_hosts() {
    std::vector<BeadHost*> hosts;
    for (auto const& group : absolute_) hosts.push_back(group.get());
    for (auto const& group : joint_) hosts.push_back(group.get());
    std::copy_if(hosts.begin(), hosts.end(), std::back_inserter(bead_hosts_), [&](BeadHost const* host) {
        return std::find(bead_groups_.begin(), bead_groups_.end(), &host->group()) != bead_groups_.end();
    });
    if (!openmm_->device_path()) return;
    for (BeadHost* host : bead_hosts_) device_beads_.push_back(host->on_device());
}

ConstView<3> ChainSystem::own_bead_positions() {
    std::int64_t next = 0;
    for (BeadHost* host : bead_hosts_) {
        ConstView<3> const positions = host->bead_positions();
        for (std::int64_t k = 0; k < positions.size; ++k) bead_position_.set(next++, positions.load(k));
    }
    return std::as_const(bead_position_).view();
}

void ChainSystem::forces_and_matrices(StepTimeline* timeline) {
    double const start = seconds_now();
    auto const note = [&](char const* name, char const* lane, double begin, double end) {
        if (timeline) timeline->phases.push_back({name, lane, begin - start, end - start});
    };
    if (openmm_) begin_openmm(timeline != nullptr);
    double const begun = seconds_now();
    for (auto const& group : absolute_) group->assemble_matrices();
    for (auto const& group : joint_) group->assemble_matrices();
    if (on_device())
        openmm_->device_path()->mark(device_beads_);
    else if (openmm_ || timeline)
        wait();  // so that the clock sees the sweep; the forces are waited for anyway
    double const assembled = seconds_now();
    for (auto const& group : absolute_) group->set_simple_forces();
    double const simple = seconds_now();
    if (openmm_) finish_openmm();
    for (auto const& group : absolute_) group->take_bead_forces();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    note("simple forces", "catena", assembled, simple);
    seconds_["kinematics and loads"] += simple - assembled;
    if (on_device()) {
        if (!timeline) return;  // the next evaluation asks: the GPU need not be waited for
        DevicePath::Clock const clock = read_device_clock();
        note("matrix sweep", "catena", clock.chains.begin, clock.chains.end);
        note("forces", "openmm", clock.openmm.begin, clock.openmm.end);
        return;
    }
    note("matrix sweep", "catena", begun, assembled);
    note_overlap(start, begun, assembled, simple, finished);
    if (!openmm_) return;
    Interval const ran = openmm_->last_evaluation(), brought = openmm_->last_gathering();
    note("hand over positions", "catena", start, begun);
    if (communicator_.size() > 1) note("exchange of positions", "messages", brought.begin, brought.end);
    note("wait for forces", "catena", simple, finished);
    note("forces", "openmm", ran.begin, ran.end);
}

void ChainSystem::solve_joint_groups() {
    double const start = seconds_now();
    for (auto const& group : joint_) group->update_configuration();
    double const moved = seconds_now();
    if (openmm_) begin_openmm(false);
    double const begun = seconds_now();
    for (auto const& group : joint_) group->assemble_matrices();
    if (openmm_) wait();
    double const assembled = seconds_now();
    if (openmm_) finish_openmm();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    for (auto const& group : joint_) group->solve();
    seconds_["kinematics and loads"] += moved - start;
    seconds_["bias sweep"] += seconds_now() - finished;
    note_overlap(moved, begun, assembled, assembled, finished);
}

void ChainSystem::refine() {
    for (auto const& group : joint_) {
        group->refine();
        group->set_rates();
    }
}

void ChainSystem::close_tips(int corrections) {
    for (auto const& group : joint_) group->close_tips(corrections);
}

/// Positions are handed over from `start` to `begun`, matrices assembled until `assembled`, forces waited for from `waits` to `finished`.
void ChainSystem::note_overlap(double start, double begun, double assembled, double waits, double finished) {
    matrix_seconds_ += assembled - begun;
    seconds_["matrix sweep"] += assembled - begun;
    if (!openmm_) return;
    Interval const ran = openmm_->last_evaluation(), brought = openmm_->last_gathering();
    double const exchange = communicator_.size() > 1 ? brought.end - brought.begin : 0.0;
    hidden_seconds_ += std::max(0.0, std::min(assembled, ran.end) - std::max(begun, ran.begin));
    seconds_["forces"] += ran.end - ran.begin;
    seconds_["waiting for forces"] += (finished - waits) + (begun - start) - exchange;
    if (communicator_.size() > 1) seconds_["exchange"] += exchange;
}

void ChainSystem::begin_openmm(bool timed) {
    if (!on_device()) {
        Traffic const before = communicator_.traffic();
        openmm_->begin(own_bead_positions());
        openmm_traffic_ += communicator_.traffic() - before;
        return;
    }
    if (clock_is_due_) read_device_clock();
    ++evaluations_since_clock_;
    clock_is_due_ = timed || !timed_before_ || evaluations_since_clock_ >= evaluations_a_clock;
    openmm_->device_path()->begin(device_beads_, clock_is_due_);
    timed_before_ = true;
}

DevicePath::Clock ChainSystem::read_device_clock() {
    clock_is_due_ = false;
    double const weight = static_cast<double>(std::exchange(evaluations_since_clock_, 0));  // it stands for those before it
    DevicePath::Clock const clock = openmm_->device_path()->clock();
    auto const length = [weight](double begin, double end) { return weight * std::max(0.0, end - begin); };
    double const matrices = length(clock.chains.begin, clock.chains.end);
    matrix_seconds_ += matrices;
    hidden_seconds_ += length(std::max(clock.chains.begin, clock.openmm.begin), std::min(clock.chains.end, clock.openmm.end));
    seconds_["matrix sweep"] += matrices;
    seconds_["forces"] += length(clock.openmm.begin, clock.openmm.end);
    seconds_["waiting for forces"] += length(clock.chains.end, clock.openmm.end);
    return clock;
}

void ChainSystem::finish_openmm() {
    if (on_device()) {
        openmm_->device_path()->finish(device_beads_);
        return;
    }
    for (std::int64_t k = 0; k < openmm_force_.size(); ++k) openmm_force_.set(k, Vec3::zero());
    openmm_->finish(openmm_force_.view());
    std::int64_t next = 0;
    for (BeadHost* host : bead_hosts_) {
        View<3> const forces = host->bead_forces();
        for (std::int64_t k = 0; k < forces.size; ++k) forces.store(k, forces.load(k) + openmm_force_[next++]);
    }
}

void ChainSystem::evaluate(bool project) {
    for (auto const& group : absolute_) group->update_configuration();
    for (auto const& group : joint_) group->update_configuration();
    bool const at_once = !project && !openmm_ && joint_.empty() && !scene_.dynamics.fixman;  // whose forces need the matrices
    if (at_once)
        for (auto const& group : absolute_) group->set_simple_forces();
    else
        forces_and_matrices(nullptr);
    for (auto const& group : absolute_) {
        if (project) group->observe(0.0);
        if (at_once)
            group->evaluate_at_once();
        else
            group->evaluate();
    }
    for (auto const& group : joint_) {
        group->solve();
        group->set_rates();
    }
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

void ChainSystem::check_forces() const {
    if (on_device()) openmm_->device_path()->refuse_trouble();
}

void ChainSystem::wait() const {
    for (auto const& group : absolute_) group->solver().wait();
    for (auto const& group : joint_) group->solver().wait();
}
void ChainSystem::measure(bool on) const {
    for (auto const& group : absolute_) group->solver().measure(on);
    for (auto const& group : joint_) group->solver().measure(on);
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
