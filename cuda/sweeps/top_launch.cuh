// Launch that performs both passes of the last two stages of a sweep (stage_kernels.cuh).
#pragma once

#include <map>

#include "cuda/device/clusters.hpp"
#include "cuda/device/launch.cuh"
#include "cuda/sweeps/stage_kernels.cuh"

namespace catena::cuda {

/// Memory and occupancy of such launches for one tree. It is valid for the GPU and the context of
/// that tree.
class TopLaunch {
  public:
    TopLaunch() = default;
    /// `most_bytes`: largest shared memory of a block.
    TopLaunch(dca::StagesTogether const& stages, dca::StageRecords const& records, int most_bytes)
        : up_(stages.numbers_up(records)),
          down_(stages.numbers_down(records)),
          launches_(stages.blocks()),
          items_(static_cast<int>(stages.upper->width)),
          forces_(static_cast<int>(stages.upper->forces)),
          most_bytes_(most_bytes) {}
    explicit operator bool() const { return launches_.size() > 0; }
    /// Returns the letters by which the blocks of the two stages exchange segments and forces.
    kernels::TopLaunchLetters letters() const {
        return {{up_.data(), items_}, {down_.data(), forces_}, launches_.data()};
    }
    /// True if the GPU runs all blocks of the grid at once and has `spare` multiprocessors left.
    /// The answer is cached per kernel, because a kernel and a tree have one grid.
    template <class Kernel>
    bool fits(Kernel* kernel, Grid const& grid, int spare) const {
        auto const [known, is_new] = fits_.try_emplace(reinterpret_cast<void const*>(kernel));
        if (is_new) known->second = asks_for(kernel, grid, spare);
        return known->second;
    }

  private:
    /// Queries the occupancy of a kernel.
    template <class Kernel>
    bool asks_for(Kernel* kernel, Grid const& grid, int spare) const {
        if (grid.shared_bytes > static_cast<std::size_t>(most_bytes_)) return false;
        allow_shared(kernel, grid.shared_bytes);
        int of_multiprocessor = 0;
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(
                  &of_multiprocessor, kernel, static_cast<int>(grid.threads), grid.shared_bytes),
              "report the number of resident blocks");
        return grid.blocks <=
               static_cast<unsigned>(of_multiprocessor * (multiprocessors() - spare));
    }

    Buffer<kernels::LetterBox> up_, down_;
    Buffer<unsigned> launches_;
    int items_ = 0, forces_ = 0;
    int most_bytes_ = 0;
    mutable std::map<void const*, bool> fits_;  // answers of fits(), by kernel
};

}  // namespace catena::cuda
