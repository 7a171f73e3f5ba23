// What `auto` becomes on this machine.
#pragma once

#include <functional>
#include <string>

#include "chain/chain_group.hpp"
#include "plan/planner.hpp"

namespace catena::plan {

struct Choice {
    Arrangement arrangement;
    GpuLevels levels;    // of cuda-levels
    std::string reason;  // "asked for"; "auto: 1.2 ms predicted; segments 2 ms, ..."
};

/// Of chains that are measured before a computation starts: a fraction of a second in all.
inline constexpr std::int64_t largest_at_start = 16384;

/// Whether the scene leaves something to be chosen: the backend, or levels on the GPU.
bool leaves_open(Scene const&);

/// For the scene's evaluations, by this rank's planner. `auto` is only ever one of the arrangements
/// that give the same bits, so that it never changes a result.
Choice choose(Scene const&, Axes, Planner&, int ranks);
/// The same with this machine's planner, which knows what is in the cache and keeps there what it
/// learns; nothing is measured where there is nothing to choose from. `no_gpu`: why the GPU is none
/// to choose; empty: it may be. The same on every rank; collective.
Choice choose(Scene const&, Axes, Communicator const&, std::string const& no_gpu = "");
/// Rank 0's planner of chains up to so many bodies; runs `action` with it there, and keeps what it
/// learned. Collective.
void with_planner(Communicator const&, int threads, std::int64_t largest, std::string const& no_gpu,
                  std::function<void(Planner&)> const& action);
/// Rank 0's to every rank.
void share(Communicator const&, Choice&);

/// The scene with everything that was open filled in.
Scene with_choice(Scene, Choice const&);
/// Does `action` with the scene filled in so. A GPU that nobody asked for and that turns out to be
/// too small (cuda::TooLittleMemory) is left out of the choice, and `action` done once more.
using Chooser = std::function<Choice(Scene const&, std::string const& no_gpu)>;
using WithChoice = std::function<void(Scene const&, Choice const&)>;
void with_choice(Scene, Chooser const&, WithChoice const& action);

}  // namespace catena::plan
