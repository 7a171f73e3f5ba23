// Memory of GPUs that other ranks write to: what a handful of numbers a rank need to be everywhere
// takes a kernel then, and the host does not wait. For ranks of one host, each on a GPU of its own,
// that reach each other's memory (NVLink, PCIe).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cuda/device/owners.hpp"
#include "math/host_device.hpp"
#include "mpi/communicator.hpp"

namespace catena::cuda {

inline constexpr int most_peers = 16;
inline constexpr int most_of_a_body = 16;  // numbers of a field

/// For kernels: where each rank has what pairs of ranks exchange. Rank r keeps for every rank s:
/// two boxes of `width` letters (cluster.cuh) that s fills in turns, how often s has come to r
/// without any (meet()), and how often they have exchanged.
struct PeerBoxes {
    double* base[most_peers] = {};  // of each rank
    int rank = 0, ranks = 0, width = 0;

    static std::int64_t numbers(int ranks, int width) {
        return std::int64_t{2} * ranks * (letter * width + 1);
    }
    /// Of rank `at`, filled by rank `from`.
    CATENA_HD double* box(int at, int from, unsigned long long times) const {
        return base[at] + (2 * from + static_cast<int>(times & 1)) * std::int64_t{letter} * width;
    }
    CATENA_HD unsigned long long* came(int to, int from) const { return counters(to) + from; }
    CATENA_HD unsigned long long* exchanged(int with) const {
        return counters(rank) + ranks + with;
    }

  private:
    static constexpr int letter = 2;  // numbers that it has room for
    CATENA_HD unsigned long long* counters(int at) const {
        return reinterpret_cast<unsigned long long*>(base[at] +
                                                     std::int64_t{2} * ranks * letter * width);
    }
};

/// Whether GPUs may write to each other's memory: ranks of one host with a GPU each, and
/// CATENA_GPU_EXCHANGE is not `host`. Collective.
bool gpus_may_write_to_each_other(Communicator const&);
/// `own`: what cudaMalloc gave on each rank. Each rank's memory as this rank reaches it, its own
/// among them; empty on all ranks where some rank does not reach some other: CUDA lets one context
/// of a process alone open what another process has on a GPU. Collective.
std::vector<void*> map_each_others(Communicator const&, void* own);
void unmap(std::vector<void*> const& base, int own_rank);

/// Of a rank, as long as the object is there; what was mapped is kept for the next one, because
/// memory that others have mapped is not to be freed.
class PeerMemory {
  public:
    /// Collective: null on all ranks where some cannot reach another's, where ranks share GPUs,
    /// where there is one rank, or where CATENA_GPU_EXCHANGE is `host`.
    static std::shared_ptr<PeerMemory> connect(Communicator const&);
    ~PeerMemory();
    PeerMemory(PeerMemory const&) = delete;
    PeerMemory& operator=(PeerMemory const&) = delete;

    int rank() const { return rank_; }
    int ranks() const { return ranks_; }
    /// No two have the same number; 0: unknown.
    unsigned long long context() const { return context_; }
    /// Places for exchanges of up to `width` numbers a pair: all ranks ask for the same ones in the
    /// same order.
    PeerBoxes boxes(int width);

  private:
    PeerMemory(int rank, std::vector<double*> base);

    int rank_, ranks_;
    unsigned long long context_;  // in which it is
    std::vector<double*> base_;   // of each rank
    std::int64_t used_ = 0;
};

}  // namespace catena::cuda
