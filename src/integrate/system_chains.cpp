// Construction of the chains of a scene, with their dynamics and solvers.
#include "integrate/system_chains.hpp"

#include <algorithm>
#include <utility>

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

/// Throws InputError if articulated handles do not support this group. Validation has already
/// refused chains with links or closed tips.
void refuse_articulated(ChainGroup const& group, bool implicit) {
    if (!group.beads && !group.linked && !group.ends.has_tips() && group.axes == Axes::joint &&
        !implicit)
        return;
    throw InputError(
        implicit                    ? "articulated handles and implicit joints"
        : group.axes == Axes::joint ? "articulated handles and chains with links or closed tips"
                                    : "articulated handles and absolute coordinates",
        "solver.handles: articulated",
        "use integrator rk4, dormand-prince or velocity-verlet, or handles projected or full");
}

/// Throws InputError for chains with loops in absolute coordinates.
void refuse_loops_in_absolute_coordinates(Scene const& scene, Axes axes) {
    for (ChainSpec const& chain : scene.chains)
        if (chain.has_loops() && axes == Axes::world)
            throw InputError("loops in absolute coordinates", scene.file + ": chain " + chain.name,
                             "use an integrator in joint coordinates, such as rk4");
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

SystemChains::SystemChains(Scene const& scene, Axes axes, Communicator const& communicator,
                           double implicit_step, dca::Shares const& shares)
    : axes_(axes),
      implicit_step_(implicit_step),
      scene_(scene),
      communicator_(communicator),
      backend_(choose_backend(scene, communicator)) {
    scene::refuse_unsupported_branches(scene);
    refuse_loops_in_absolute_coordinates(scene, axes);
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
    if (!openmm_) return;
    std::vector<BeadHost*> hosts;
    for (auto const& group : absolute_) hosts.push_back(group.get());
    for (auto const& group : joint_) hosts.push_back(group.get());
    openmm_->find_hosts(hosts);
}

// GPU memory is freed in the context in which it was allocated.
SystemChains::~SystemChains() { is_current(); }

bool SystemChains::is_current() noexcept { return !openmm_ || openmm_->make_current(); }

std::vector<ChainGroup const*> SystemChains::bead_groups() const {
    std::vector<ChainGroup const*> found;
    for (bool const absolute : {true, false})
        for (auto const& group : groups_)
            if (is_absolute(*group) == absolute && (group->beads || group->carried.in_scene))
                found.push_back(group.get());
    return found;
}

void SystemChains::make_openmm() {
    std::vector<ChainGroup const*> const groups = bead_groups();
    ChainsOnDevice chains{no_gpu_asked_for, -1};
    if (backend_ == Backend::cuda) {
        bool const absolute =
            std::all_of(groups.begin(), groups.end(),
                        [this](ChainGroup const* group) { return is_absolute(*group); });
        chains = {absolute ? "" : "some beads are carried by bodies in joint coordinates",
                  cuda::chosen_device()};
    }
    openmm_ = std::make_unique<OpenMmEvaluation>(scene_, communicator_, groups, chains);
    make_current();
}

/// Must be called before anything is allocated on the GPU.
void SystemChains::require_gpu_memory() const {
    std::int64_t needed = gpu_reserve;
    if (scene_.solver.handles == Handles::articulated)
        needed += cuda::stacks(stack_of_articulated_handles);
    for (auto const& group : groups_)
        needed += cuda::memory_needed(*group, scene_, backend_, communicator_).sum();
    refuse_cuda<cuda::TooLittleMemory>(
        communicator_, name_of(backend_),
        cuda::too_little_memory(needed, cuda::free_memory(communicator_)), without_memory);
}

void SystemChains::make_current() {
    if (!is_current()) throw ComputationError("OpenMM's CUDA context cannot be made current");
}

std::unique_ptr<AbsoluteDynamics> SystemChains::make_absolute(ChainGroup const& group) const {
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
std::unique_ptr<JointDynamics> SystemChains::make_joint(ChainGroup const& group) const {
    if (backend_ == Backend::cuda)
        return cuda::make_joint_dynamics(group, scene_, *executor_, communicator_);
    return make_joint_dynamics(group, scene_, *executor_, communicator_, make_solver(group),
                               implicit_step_);
}
std::unique_ptr<ChainSolver> SystemChains::make_solver(ChainGroup const& group) const {
    if (backend_ == Backend::cuda_levels)
        return dca::make_level_solver(group, communicator_, scene_.solver.levels_on_gpu(),
                                      cuda::make_levels, dca::host_levels(*executor_));
    return make_tree_solver(group, *executor_, communicator_);
}

std::size_t SystemChains::index_of(ChainGroup const& group) const {
    auto const found = std::find_if(groups_.begin(), groups_.end(),
                                    [&](auto const& g) { return g.get() == &group; });
    return static_cast<std::size_t>(found - groups_.begin());
}

BeadSystem const& SystemChains::beads() const {
    static BeadSystem const none;
    return openmm_ ? openmm_->beads() : none;
}

std::vector<AbsoluteDynamics*> SystemChains::absolute() const {
    std::vector<AbsoluteDynamics*> all;
    for (auto const& group : absolute_) all.push_back(group.get());
    return all;
}
std::vector<JointDynamics*> SystemChains::joint() const {
    std::vector<JointDynamics*> all;
    for (auto const& group : joint_) all.push_back(group.get());
    return all;
}

void SystemChains::wait() const {
    for (auto const& group : absolute_) group->solver().wait();
    for (auto const& group : joint_) group->solver().wait();
}
std::vector<SolverReport> SystemChains::solver_reports() const {
    std::vector<SolverReport> reports;
    auto const add = [&](ChainSolver const& solver) {
        SolverReport r = solver.report();
        r.backend = name_of(backend_);
        if (r.handles.empty()) r.handles = name_of(scene_.solver.handles);
        reports.push_back(r);
    };
    for (auto const& group : absolute_) add(group->solver());
    for (auto const& group : joint_) add(group->solver());
    return reports;
}

std::vector<BodyResults> results_of(SystemChains const& chains) {
    std::vector<BodyResults> all;
    for (AbsoluteDynamics* const group : chains.absolute()) all.push_back(group->results());
    for (JointDynamics* const group : chains.joint()) all.push_back(group->results());
    return all;
}

}  // namespace catena
