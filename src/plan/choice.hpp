// Resolves the value `auto` of solver.backend and of solver.gpu_levels on this machine.
#pragma once

#include <functional>
#include <string>

#include "chain/chain_group.hpp"
#include "plan/planner.hpp"

namespace catena::plan {

/// The arrangement that a computation uses, and why.
struct Choice {
    Arrangement arrangement;
    /// Levels on the GPU; used by cuda-levels only.
    GpuLevels levels;
    /// "requested", or for example "auto: predicted segments 1.2 ms, openmp, 8 threads 2 ms".
    std::string reason;
};

/// Largest sample chain, in bodies, that is measured before a computation starts. All measurements
/// together take a fraction of a second.
inline constexpr std::int64_t largest_at_start = 16384;

/// True if the scene leaves the backend or the levels on the GPU open.
bool leaves_open(Scene const&);

/// Chooses for the scene's evaluations by this rank's planner. `auto` only ever becomes one of the
/// arrangements that give the same bits, so it never changes a result.
Choice choose(Scene const&, Axes, Planner&, int ranks);
/// Chooses by this machine's planner, which reads the cache and writes new measurements to it.
/// Measures nothing if the scene leaves nothing open. `no_gpu` is the reason why the GPU must not
/// be chosen; empty if it may be. Returns the same choice on every rank; collective.
Choice choose(Scene const&, Axes, Communicator const&, std::string const& no_gpu = "");
/// Makes rank 0's planner for sample chains of up to `largest` bodies, runs `action` with it on
/// rank 0, and writes what it measured to the cache. Collective.
void with_planner(Communicator const&, int threads, std::int64_t largest, std::string const& no_gpu,
                  std::function<void(Planner&)> const& action);
/// Broadcasts rank 0's choice to every rank. Collective.
void share(Communicator const&, Choice&);

/// Returns the scene with the choice in place of everything that was left open.
Scene with_choice(Scene, Choice const&);
/// Runs `action` with the chosen scene. If a GPU that the user did not name turns out to be too
/// small (cuda::TooLittleMemory), chooses again without it and repeats `action`.
using Chooser = std::function<Choice(Scene const&, std::string const& no_gpu)>;
using WithChoice = std::function<void(Scene const&, Choice const&)>;
void with_choice(Scene, Chooser const&, WithChoice const& action);

}  // namespace catena::plan
