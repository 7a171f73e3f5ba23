// GPU memory to which other ranks write directly. A few numbers that every rank needs then cost one
// kernel, and the host does not wait. This requires ranks of one host, each with its own GPU, whose
// GPUs reach each other's memory (NVLink, PCIe).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cuda/device/owners.hpp"
#include "math/host_device.hpp"
#include "mpi/communicator.hpp"

namespace catena::cuda {

/// Largest number of ranks that exchange directly.
inline constexpr int most_peers = 16;
/// Largest number of numbers per body in a field.
inline constexpr int most_of_a_body = 16;

/// Addresses, for kernels, of the memory by which pairs of ranks exchange. Rank r keeps for every
/// rank s two boxes of `width` letters (cluster.cuh), which s fills alternately. It also keeps two
/// counters: how often s has arrived at r without letters (meet()), and how often they have
/// exchanged.
struct PeerBoxes {
    /// Base address of each rank's boxes.
    double* base[most_peers] = {};
    int rank = 0, ranks = 0, width = 0;

    /// Returns the size of one rank's boxes and counters in doubles.
    static std::int64_t numbers(int ranks, int width) {
        return std::int64_t{2} * ranks * (letter * width + 1);
    }
    /// Returns the box of rank `at` that rank `from` fills at exchange number `times`.
    CATENA_HD double* box(int at, int from, unsigned long long times) const {
        return base[at] + (2 * from + static_cast<int>(times & 1)) * std::int64_t{letter} * width;
    }
    /// Returns the counter at rank `to` of the arrivals of rank `from`.
    CATENA_HD unsigned long long* came(int to, int from) const { return counters(to) + from; }
    /// Returns this rank's counter of exchanges with rank `with`.
    CATENA_HD unsigned long long* exchanged(int with) const {
        return counters(rank) + ranks + with;
    }

  private:
    static constexpr int letter = 2;  // doubles per letter
    CATENA_HD unsigned long long* counters(int at) const {
        return reinterpret_cast<unsigned long long*>(base[at] +
                                                     std::int64_t{2} * ranks * letter * width);
    }
};

/// True if GPUs may write to each other's memory. All ranks must be on one host with a GPU each,
/// and CATENA_GPU_EXCHANGE must not be `host`. Collective.
bool gpus_may_write_to_each_other(Communicator const&);
/// Maps each rank's allocation `own`, made by cudaMalloc, into this process. Returns the address of
/// every rank's memory as seen here, this rank's own included. The result is empty on all ranks if
/// any rank cannot map another's memory. CUDA lets only one context of a process open what another
/// process has allocated on a GPU. Collective.
std::vector<void*> map_each_others(Communicator const&, void* own);
/// Closes the mappings of the other ranks' memory.
void unmap(std::vector<void*> const& base, int own_rank);

/// A rank's memory for direct exchanges, and the other ranks' memory as mapped here. Mapped memory
/// is kept for the next object, because memory that others have mapped must not be freed.
class PeerMemory {
  public:
    /// Returns null on all ranks if some GPU cannot reach another, if ranks share GPUs or if there
    /// is only one rank. It also returns null if CATENA_GPU_EXCHANGE is `host`. Collective.
    static std::shared_ptr<PeerMemory> connect(Communicator const&);
    ~PeerMemory();
    PeerMemory(PeerMemory const&) = delete;
    PeerMemory& operator=(PeerMemory const&) = delete;

    int rank() const { return rank_; }
    int ranks() const { return ranks_; }
    /// Returns the unique number of the CUDA context of this memory, or 0 if it is unknown.
    unsigned long long context() const { return context_; }
    /// Reserves boxes for exchanges of up to `width` numbers per pair of ranks. All ranks must
    /// request the same boxes in the same order. Throws ComputationError if the memory is used up.
    PeerBoxes boxes(int width);

  private:
    PeerMemory(int rank, std::vector<double*> base);

    int rank_, ranks_;
    unsigned long long context_;  // number of the CUDA context that owns the memory
    std::vector<double*> base_;   // each rank's memory as mapped here
    std::int64_t used_ = 0;       // numbers already reserved
};

}  // namespace catena::cuda
