// Implements the choice of backend, threads and levels on the GPU from predicted times.
#include "plan/choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cuda/space/memory.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"
#include "plan/cache.hpp"
#include "scene/branch_limits.hpp"
#include "terms/force_terms.hpp"

namespace catena::plan {
namespace {

/// Returns why `auto` must not choose a GPU that is present; empty if it may.
std::string no_gpu_for(Scene const& scene, Machine const& machine) {
    if (!machine.no_gpu.empty()) return machine.no_gpu;
    if (scene.solver.refine > 0) return "refinement computes residuals on the host";
    return terms::why_host_alone(scene);
}
/// True if OpenMM is free to use the GPU for its forces, so that beads could stay there between
/// OpenMM and the solver.
bool forces_ask_for_gpu(Scene const& scene, Machine const& machine, int ranks) {
    if (!scene.forces.openmm || ranks > 1) return false;
    OpenMmSpec const& openmm = *scene.forces.openmm;
    bool const free = openmm.platform.empty() && openmm.device < 0 &&
                      (openmm.path == "auto" || openmm.path == "device");
    bool const beads = std::all_of(scene.chains.begin(), scene.chains.end(),
                                   [](ChainSpec const& chain) { return chain.is_beads(); });
    return free && beads && machine.openmm_on_gpu();
}

/// Returns a lower bound of the seconds per step that OpenMM's forces take on processors: a
/// microsecond per bead. Returns 0 if a GPU computes them.
double least_seconds_of_forces(Scene const& scene, Machine const& machine, int ranks) {
    if (!scene.forces.openmm) return 0;
    std::string const& platform = scene.forces.openmm->platform;
    if (platform.empty() ? machine.openmm_on_gpu() : platform != "CPU" && platform != "Reference")
        return 0;
    double constexpr a_bead = 1e-6;
    std::size_t beads = 0;
    for (ChainSpec const& chain : scene.chains) beads += chain.bead_count();
    return a_bead * static_cast<double>(beads) / ranks;
}

/// Formats a prediction, e.g. "segments 1.2 ms" or "cuda not: REASON".
std::string text_of(Prediction const& p) {
    return p.unusable.empty() ? fmt::format("{} {:.3g} ms", p.arrangement.name(),
                                            1e3 * p.seconds[typical_evaluation])
                              : fmt::format("{} not usable: {}", p.arrangement.name(), p.unusable);
}

/// Marks GPU arrangements as unusable if the device has too little memory for the scene. The margin
/// covers what a sample chain does not show: lists of short chains, OpenMM.
void refuse_what_does_not_fit(std::vector<Prediction>& predictions,
                              std::vector<Share> const& shares, Machine const& machine) {
    double constexpr reserve = 1 << 28, margin = 1.25;
    double needed = reserve;
    for (Share const& share : shares)
        needed += margin * machine.gpu_memory(share.family, share.bodies);
    for (Prediction& p : predictions)
        if (uses_gpu(p.arrangement.backend) && p.unusable.empty())
            p.unusable =
                cuda::too_little_memory(static_cast<std::int64_t>(needed),
                                        static_cast<std::int64_t>(machine.free_gpu_memory()));
}

/// Chooses the arrangement with the shortest predicted time and explains the choice.
Choice choose_backend(Scene const& scene, Axes axes, Planner& planner, int ranks) {
    std::string const no_gpu = no_gpu_for(scene, planner.machine());
    std::string const without = no_gpu.empty() ? "" : "; " + no_gpu;
    std::vector<Arrangement> usable = planner.machine().alike;
    if (!no_gpu.empty())
        std::erase_if(usable, [](Arrangement const& a) { return uses_gpu(a.backend); });
    std::string beside;
    if (int const spare = planner.machine().spare; spare > 0) {
        // Threads that wait for each other would also wait for other programs on the same cores.
        if (std::erase_if(usable, [&](Arrangement const& a) {
                return a.backend == Backend::openmp && a.threads > spare;
            }) > 0)
            beside = fmt::format("; other programs leave {} of {} cores free", spare,
                                 planner.machine().threads);
    }
    if (usable.size() == 1) return {usable.front(), {}, "auto: one core" + beside + without};
    std::vector<Share> const shares = shares_of(scene, axes, ranks);
    std::vector<Prediction> predictions;
    for (Arrangement const& each : usable) predictions.push_back(planner.predict(shares, each));
    bool const for_forces = no_gpu.empty() && forces_ask_for_gpu(scene, planner.machine(), ranks);
    double const forces = least_seconds_of_forces(scene, planner.machine(), ranks);
    if (forces > 0)
        beside += fmt::format(
            "; forces take at least {:.3g} ms, so gains below a tenth of the total are ignored",
            1e3 * forces);
    if (for_forces || uses_gpu(quickest(predictions, forces).arrangement.backend))
        refuse_what_does_not_fit(predictions, shares, planner.machine());
    auto const on_gpu = std::find_if(
        predictions.begin(), predictions.end(),
        [](Prediction const& p) { return uses_gpu(p.arrangement.backend) && p.unusable.empty(); });
    bool const with_forces = for_forces && on_gpu != predictions.end();
    Prediction const& best = with_forces ? *on_gpu : quickest(predictions, forces);
    std::string reason =
        std::string(with_forces ? "auto: on the GPU of OpenMM's forces, " : "auto: ") +
        "predicted " + text_of(best);
    for (Prediction const& p : predictions)
        if (&p != &best) reason += ", " + text_of(p);
    return {best.arrangement, {}, reason + beside + without};
}

/// Chooses how many levels of the pairwise tree the GPU assembles and disassembles.
Choice choose_levels(Scene const& scene, Axes axes, Planner& planner, int ranks) {
    LevelPlan const levels = planner.plan_levels(shares_of(scene, axes, ranks));
    GpuLevels const best = levels.best();
    return {
        {Backend::cuda_levels, planner.machine().threads},
        best,
        fmt::format("levels auto: {},{} of {} predicted {:.3g} ms, all {:.3g} ms, none {:.3g} ms",
                    best.up, best.down, levels.levels(), 1e3 * levels.seconds(best),
                    1e3 * levels.seconds({}), 1e3 * levels.seconds({0, 0}))};
}

/// True if the backend is cuda-levels and its number of levels is `auto`.
bool levels_are_open(SolverSpec const& solver) {
    return solver.backend == Backend::cuda_levels && solver.gpu_levels == "auto";
}

}  // namespace

bool leaves_open(Scene const& scene) {
    return scene.solver.backend == Backend::automatic || levels_are_open(scene.solver);
}

Choice choose(Scene const& scene, Axes axes, Planner& planner, int ranks) {
    SolverSpec const& solver = scene.solver;
    if (solver.backend == Backend::automatic) return choose_backend(scene, axes, planner, ranks);
    if (levels_are_open(solver) && planner.machine().no_gpu.empty())
        return choose_levels(scene, axes, planner, ranks);
    return {{solver.backend, solver.threads}, solver.levels_on_gpu(), "requested"};
}

Choice choose(Scene const& scene, Axes axes, Communicator const& communicator,
              std::string const& no_gpu) {
    Choice choice{
        {scene.solver.backend, scene.solver.threads}, scene.solver.levels_on_gpu(), "requested"};
    if (!leaves_open(scene)) return choice;
    with_planner(
        communicator, scene.solver.threads, largest_at_start, no_gpu,
        [&](Planner& planner) { choice = choose(scene, axes, planner, communicator.size()); });
    share(communicator, choice);
    return choice;
}

void with_planner(Communicator const& communicator, int threads, std::int64_t largest,
                  std::string const& no_gpu, std::function<void(Planner&)> const& action) {
    Machine machine = this_machine(communicator, threads);
    // Either every rank has a GPU, or no rank uses one.
    if (communicator.max(machine.no_gpu.empty() ? 0 : 1) > 0)
        without_gpu(machine, "not every rank has a GPU");
    if (!no_gpu.empty()) without_gpu(machine, no_gpu);
    on_first_rank(communicator, [&] {
        Planner planner(machine, read_cache(machine), largest);
        action(planner);
        if (planner.learned()) write_cache(machine, planner.calibration());
    });
}

void share(Communicator const& communicator, Choice& choice) {
    std::int64_t numbers[] = {static_cast<std::int64_t>(choice.arrangement.backend),
                              choice.arrangement.threads, choice.levels.up, choice.levels.down};
    broadcast(communicator, numbers);
    choice.arrangement = {static_cast<Backend>(numbers[0]), static_cast<int>(numbers[1])};
    choice.levels = {static_cast<int>(numbers[2]), static_cast<int>(numbers[3])};
    broadcast(communicator, choice.reason);
}

Scene with_choice(Scene scene, Choice const& choice) {
    if (!leaves_open(scene)) return scene;
    scene.solver.backend = choice.arrangement.backend;
    scene.solver.threads = choice.arrangement.threads;
    if (levels_are_open(scene.solver))
        scene.solver.gpu_levels =
            std::to_string(choice.levels.up) + "," + std::to_string(choice.levels.down);
    return scene;
}

void with_choice(Scene scene, Chooser const& choose, WithChoice const& action) {
    SolverSpec const asked = scene.solver;
    auto const attempt = [&](std::string const& no_gpu) {
        Choice const choice = choose(scene, no_gpu);
        scene = with_choice(std::move(scene), choice);
        action(scene, choice);
    };
    try {
        attempt("");
    } catch (cuda::TooLittleMemory const& error) {
        if (asked.backend != Backend::automatic) throw;
        scene.solver = asked;
        attempt(error.reason());
    }
}

}  // namespace catena::plan
