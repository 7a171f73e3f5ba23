// Construction of a ChainSystem and evaluation of forces, matrices and accelerations.
#include "integrate/chain_system.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "chain/gather.hpp"
#include "cuda/device/gpu.hpp"
#include "cuda/dynamics.hpp"
#include "cuda/space/memory.hpp"
#include "error.hpp"
#include "mpi/collectives.hpp"
#include "mpi/thread_limit.hpp"
#include "scene/branch_limits.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// GPU memory that kernels, graphs and streams use, bytes.
constexpr std::int64_t gpu_reserve = std::int64_t{128} << 20;
/// Stack per thread of the sweeps' kernels with articulated handles, bytes (ptxas: 15,512 at most
/// on sm_90).
constexpr std::int64_t stack_of_articulated_handles = 16 << 10;
constexpr char const* without_gpu =
    "use auto, another backend, or a build with CUDA on a machine with a GPU";
constexpr char const* without_memory =
    "use more GPUs (ranks on several hosts), another backend, or fewer bodies";

/// Throws an Error with the text of the first rank that has a `reason`, on all ranks. Collective.
template <class Error = InputError>
void refuse_cuda(Communicator const& communicator, std::string const& backend,
                 std::string const& reason, char const* remedy) {
    RankText const first = first_text(communicator, reason);
    if (first.text.empty()) return;
    std::string text = first.text;
    if (communicator.size() > 1) text += ", rank " + std::to_string(first.rank);
    throw Error(text, "solver.backend: " + backend, remedy);
}

/// Updates the configuration of a group, for solve_once() or for other solutions.
void update(JointDynamics& group, bool to_solve_once) {
    to_solve_once ? group.update_to_solve_once() : group.update_configuration();
}

/// Throws InputError if articulated handles do not support this group. Validation has already
/// refused chains with links or closed tips.
void refuse_articulated(ChainGroup const& group, bool implicit) {
    if (!group.beads && !group.linked && !group.has_tips() && group.axes == Axes::joint &&
        !implicit)
        return;
    throw InputError(
        implicit                    ? "articulated handles and implicit joints"
        : group.axes == Axes::joint ? "articulated handles and chains with links or closed tips"
                                    : "articulated handles and absolute coordinates",
        "solver.handles: articulated",
        "use integrator rk4, dormand-prince or velocity-verlet, or handles projected or full");
}

}  // namespace

Backend choose_backend(Scene const& scene, Communicator const& communicator) {
    Backend const asked = scene.solver.backend;
    if (std::string const why = terms::why_host_alone(scene); uses_gpu(asked) && !why.empty())
        throw InputError(why, "solver.backend: " + std::string(name_of(asked)),
                         "use auto, segments, openmp or serial");
    if (uses_gpu(asked)) refuse_cuda(communicator, name_of(asked), cuda::why_not(), without_gpu);
    if (asked != Backend::automatic) return asked;
    // Threads pay if each has the work of some thousand bodies (tests/bench/README.md).
    std::int64_t constexpr worth_threads = 4096;
    return openmp_is_built() && choose_threads(scene, communicator) > 1 &&
                   scene.bodies() / communicator.size() >= worth_threads
               ? Backend::openmp
               : Backend::segments;
}

int choose_threads(Scene const& scene, Communicator const& communicator) {
    require_possible_threads(scene.solver.threads, scene.file + ": solver.threads");
    if (scene.solver.threads > 0) return scene.solver.threads;
    return cores_of_rank(communicator);
}

SimdLevel choose_simd_level(Scene const& scene, Communicator const& communicator) {
    std::vector<SimdLevel> const here = simd_levels();
    SimdLevel const asked = scene.solver.simd.value_or(here.back());
    bool const missing = std::find(here.begin(), here.end(), asked) == here.end();
    int const weakest =
        -static_cast<int>(communicator.max(-static_cast<double>(missing ? SimdLevel::off : asked)));
    if (communicator.max(missing ? 1 : 0) > 0)
        throw InputError(std::string(name_of(asked)) + " cannot run here", "solver.simd",
                         "use auto, or one of those that catena --version names");
    return static_cast<SimdLevel>(weakest);
}

ChainSystem::ChainSystem(Scene const& scene, Axes axes, Communicator const& communicator,
                         double implicit_step, dca::Shares const& shares)
    : scene_(scene),
      communicator_(communicator),
      axes_(axes),
      backend_(choose_backend(scene, communicator)),
      implicit_step_(implicit_step) {
    scene::refuse_unsupported_branches(scene);
    if (uses_gpu(backend_))
        refuse_cuda(communicator, name_of(backend_), cuda::choose_device(communicator),
                    without_gpu);
    bool const threads = backend_ == Backend::openmp || (uses_gpu(backend_) && openmp_is_built());
    SimdLevel const simd = choose_simd_level(scene, communicator);
    executor_ = threads ? openmp_executor(choose_threads(scene, communicator), simd)
                        : serial_executor(simd);
    groups_ = make_groups(scene, axes, scene.solver.handles, scene.solver.pairwise(), communicator,
                          {implicit_step > 0, shares, *executor_});
    if (scene.solver.handles == Handles::articulated)
        for (auto const& group : groups_) refuse_articulated(*group, implicit_step > 0);
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

// GPU memory is freed in the context in which it was allocated.
ChainSystem::~ChainSystem() { is_current(); }

bool ChainSystem::is_current() noexcept {
    DevicePath* const path = openmm_ ? openmm_->device_path() : nullptr;
    return path == nullptr || path->make_current();
}

/// Must be called before anything is allocated on the GPU.
void ChainSystem::require_gpu_memory() const {
    std::int64_t needed = gpu_reserve;
    if (scene_.solver.handles == Handles::articulated)
        needed += cuda::stacks(stack_of_articulated_handles);
    for (auto const& group : groups_)
        needed += cuda::memory_needed(*group, scene_, backend_, communicator_).sum();
    refuse_cuda<cuda::TooLittleMemory>(
        communicator_, name_of(backend_),
        cuda::too_little_memory(needed, cuda::free_memory(communicator_)), without_memory);
}

void ChainSystem::make_current() {
    if (!is_current()) throw ComputationError("OpenMM's CUDA context cannot be made current");
}

std::unique_ptr<AbsoluteDynamics> ChainSystem::make_absolute(ChainGroup const& group) const {
    if (backend_ == Backend::cuda) {
        auto const make = group.is_branched() ? cuda::make_branched_dynamics
                          : group.beads       ? cuda::make_bead_dynamics
                                              : cuda::make_rigid_dynamics;
        return make(group, scene_, *executor_, communicator_);
    }
    if (group.beads)
        return make_bead_dynamics(group, scene_, *executor_, communicator_, make_solver(group));
    return make_rigid_dynamics(group, scene_, *executor_, communicator_, make_solver(group),
                               implicit_step_);
}
std::unique_ptr<JointDynamics> ChainSystem::make_joint(ChainGroup const& group) const {
    if (backend_ == Backend::cuda)
        return cuda::make_joint_dynamics(group, scene_, *executor_, communicator_);
    return make_joint_dynamics(group, scene_, *executor_, communicator_, make_solver(group),
                               implicit_step_);
}
std::unique_ptr<ChainSolver> ChainSystem::make_solver(ChainGroup const& group) const {
    if (backend_ == Backend::cuda_levels)
        return dca::make_level_solver(group, communicator_, scene_.solver.levels_on_gpu(),
                                      cuda::make_levels, dca::host_levels(*executor_));
    return make_tree_solver(group, *executor_, communicator_);
}

void ChainSystem::forces_and_matrices(StepTimeline* timeline) {
    double const start = seconds_now();
    auto const note = [&](char const* name, char const* lane, double begin, double end) {
        // If there are several groups of chains, the last may finish before the first.
        if (timeline)
            timeline->phases.push_back({name, lane, begin - start, std::max(begin, end) - start});
    };
    if (openmm_) begin_openmm(timeline != nullptr);
    double const begun = seconds_now();
    for (auto const& group : absolute_) group->assemble_matrices();
    for (auto const& group : joint_) group->assemble_matrices();
    if (on_device())
        go_on_openmm();
    else if (openmm_ || timeline)
        wait();  // lets the clock include the whole sweep; the forces are waited for anyway
    double const assembled = seconds_now();
    for (auto const& group : absolute_) group->set_simple_forces();
    double const simple = seconds_now();
    if (openmm_) finish_openmm();
    if (added_forces_) added_forces_();
    for (auto const& group : absolute_) group->take_bead_forces();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    note("simple forces", "catena", assembled, simple);
    seconds_["kinematics and loads"] += simple - assembled;
    if (on_device()) {
        if (!timeline)
            return;  // the next evaluation reads the clock: no need to wait for the GPU now
        DevicePath::Clock const clock = read_device_clock();
        if (clock.openmm.end == 0) return;  // this rank has no beads
        note("matrix sweep", "catena", clock.chains.begin, clock.chains.end);
        note("forces", "openmm", clock.openmm.begin, clock.openmm.end);
        if (communicator_.size() > 1)
            note("exchange of positions", "messages", clock.exchange.begin, clock.exchange.end);
        return;
    }
    note("matrix sweep", "catena", begun, assembled);
    note_overlap(start, begun, assembled, simple, finished);
    if (!openmm_) return;
    Interval const ran = openmm_->last_evaluation(), brought = openmm_->last_gathering();
    // Path inline computes the forces before begin_openmm() returns. The time before them is that
    // of passing on positions.
    note("hand over positions", "catena", start,
         ran.end <= begun ? std::clamp(ran.begin, start, begun) : begun);
    if (communicator_.size() > 1)
        note("exchange of positions", "messages", brought.begin, brought.end);
    note("wait for forces", "catena", simple, finished);
    note("forces", "openmm", ran.begin, ran.end);
}

void ChainSystem::solve_joint_groups() {
    double const start = seconds_now();
    for (auto const& group : joint_) update(*group, solves_once());
    double const moved = seconds_now();
    if (openmm_) begin_openmm(false);
    double const begun = seconds_now();
    if (!solves_once())
        for (auto const& group : joint_) group->assemble_matrices();
    if (openmm_) wait();
    double const assembled = seconds_now();
    if (openmm_) finish_openmm();
    if (added_forces_) added_forces_();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    for (auto const& group : joint_) {
        if (solves_once())
            group->solve_once();
        else
            group->solve();
        for (int step = 0; step < scene_.solver.refine; ++step) group->refine(*executor_);
    }
    seconds_["kinematics and loads"] += moved - start;
    seconds_["bias sweep"] += seconds_now() - finished;
    note_overlap(moved, begun, assembled, assembled, finished);
}

void ChainSystem::solve_joint_groups_again() {
    double const start = seconds_now();
    for (auto const& group : joint_) group->solve_again();
    seconds_["bias sweep"] += seconds_now() - start;
}

void ChainSystem::refine() {
    for (auto const& group : joint_) {
        group->refine(*executor_);
        group->set_rates();
    }
}

double ChainSystem::correction() {
    double worst = 0;
    for (auto const& group : joint_) worst = larger(worst, group->correction());
    return worst;
}

void ChainSystem::close_tips(int corrections) {
    for (auto const& group : joint_) group->close_tips(corrections);
}

/// Positions are passed on from `start` to `begun`, matrices are assembled until `assembled`, and
/// forces are waited for from `waits` to `finished`.
void ChainSystem::note_overlap(double start, double begun, double assembled, double waits,
                               double finished) {
    matrix_seconds_ += assembled - begun;
    seconds_["matrix sweep"] += assembled - begun;
    if (!openmm_) return;
    Interval const ran = openmm_->last_evaluation(), brought = openmm_->last_gathering();
    double const exchange = communicator_.size() > 1 ? brought.end - brought.begin : 0.0;
    // Work that shares the forces' core delays them, so that nothing is hidden.
    bool const beside = openmm_->leaves_a_core() || uses_gpu(backend_);
    if (beside)
        hidden_seconds_ += std::max(0.0, std::min(assembled, ran.end) - std::max(begun, ran.begin));
    seconds_["forces"] += ran.end - ran.begin;
    seconds_["waiting for forces"] += (finished - waits) + (begun - start) - exchange;
    if (communicator_.size() > 1) seconds_["exchange"] += exchange;
}

void ChainSystem::evaluate(bool project) {
    for (auto const& group : absolute_) group->update_configuration();
    bool const at_once = !project && solves_once() && !terms::any_of([&](auto term) {
        return term.needs_matrices && terms::acts_in<decltype(term)>(scene_);
    });
    for (auto const& group : joint_) update(*group, at_once);
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
        if (at_once)
            group->solve_once();
        else
            group->solve();
        group->set_rates();
    }
}

double ChainSystem::residual() {
    double worst = 0;
    for (auto const& group : absolute_) worst = larger(worst, group->residual());
    for (auto const& group : joint_) worst = larger(worst, group->residual(*executor_));
    return worst;
}

// Each merge adds rounding of a few eps of its terms, and terms pass through at most `depth`
// merges. c = 32 covers the constants of 6x6 handles (factorisation, two triangular solves, leaf).
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
