// What can compute here, and how it is measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plan/calibration.hpp"

namespace catena::plan {

struct Machine {
    /// By the same tree, so that all give the same bits: one core first, then threads, then the
    /// GPU.
    std::vector<Arrangement> alike;
    /// By another tree: never chosen unasked.
    std::vector<Arrangement> others;
    int threads = 1;  // of the host's share in cuda-levels
    int spare = 0;  // of this rank's processors those that no other program wants just now; 0: not
                    // looked at
    std::string no_gpu;  // empty where there is one, else why not
    /// Times are those of this machine, this many cores and this program alone.
    std::string identity;

    std::function<PhaseSeconds(Family const&, std::int64_t bodies, Arrangement const&)> measure;
    /// Of a family in ground axes.
    std::function<DriftSeconds(Family const&, std::int64_t bodies, Arrangement const&)>
        measure_drifts;
    std::function<LevelSeconds(Family const&, std::int64_t bodies, Place, int threads)>
        measure_levels;
    /// Bytes that a GPU must have for chains of a family; those that are free.
    std::function<double(Family const&, std::int64_t bodies)> gpu_memory;
    std::function<double()> free_gpu_memory;
    /// Whether OpenMM can compute there.
    std::function<bool()> openmm_on_gpu;
};

/// `threads`: 0: as many as this rank has cores, and fewer; else this number alone.
Machine this_machine(Communicator const&, int threads);
/// Takes the GPU from it, for a reason where it has one.
void without_gpu(Machine&, std::string const& reason);

}  // namespace catena::plan
