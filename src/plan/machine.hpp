// Describes what can compute on this machine and how it is measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plan/calibration.hpp"

namespace catena::plan {

/// Arrangements of one machine with functions that measure them. Tests replace the functions.
struct Machine {
    /// Arrangements that use the same tree and give the same bits: one core first, then threads,
    /// then the GPU.
    std::vector<Arrangement> alike;
    /// Arrangements that use another tree; never chosen unless the user names them.
    std::vector<Arrangement> others;
    /// Threads of the host's share in cuda-levels.
    int threads = 1;
    /// Number of this rank's cores that no other program uses just now; 0 if this was not examined.
    int spare = 0;
    /// Reason why there is no GPU; empty if there is one.
    std::string no_gpu;
    /// Identifies the machine, its number of cores and the build; measured times are valid for this
    /// identity alone.
    std::string identity;

    /// Returns the seconds of the phases of an evaluation.
    std::function<PhaseSeconds(Family const&, std::int64_t bodies, Arrangement const&)> measure;
    /// Returns the seconds of the parts of a constrained step; for families in ground axes only.
    std::function<DriftSeconds(Family const&, std::int64_t bodies, Arrangement const&)>
        measure_drifts;
    /// Returns the seconds of the parts of a level of merges.
    std::function<LevelSeconds(Family const&, std::int64_t bodies, Place, int threads)>
        measure_levels;
    /// Returns the bytes that a GPU needs for chains of a family.
    std::function<double(Family const&, std::int64_t bodies)> gpu_memory;
    /// Returns the free bytes of the GPU.
    std::function<double()> free_gpu_memory;
    /// True if OpenMM can compute on the GPU.
    std::function<bool()> openmm_on_gpu;
};

/// Returns the machine of this rank. `threads` is the number of threads to consider; 0 means 2, 4,
/// 8, ... up to the number of the rank's cores.
Machine this_machine(Communicator const&, int threads);
/// Removes the GPU from the machine. The reason is kept if the machine had a GPU.
void without_gpu(Machine&, std::string const& reason);

}  // namespace catena::plan
