// All-gather in two stages: ranks of a host exchange data through shared memory, hosts by messages
// between their first ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mpi/mpi_handles.hpp"

namespace catena {

/// Distribution of ranks over hosts, which may be in any order. Hosts are numbered in the order of
/// their first ranks, the leaders.
struct Hosts {
    /// Ranks that do not share memory are on different hosts. Ranks of one host with different
    /// `colour` count as different hosts too. Collective.
    Hosts(MPI_Comm world, int colour);
    /// True on the first rank of a host.
    bool leads() const { return leaders != MPI_COMM_NULL; }

    MpiHandle ranks;    // ranks of this host
    MpiHandle leaders;  // leaders of all hosts; MPI_COMM_NULL on other ranks
    /// Number of hosts.
    int count = 1;
    std::vector<int> of_rank;  // host of each rank of the world
};

/// Buffers of a two-stage all-gather.
class HostGather {
  public:
    /// Allocates shared memory of 2 `piece` bytes per host; gathers proceed in pieces of `piece`
    /// bytes. Returns null on all ranks if some host cannot allocate it. Collective.
    static std::unique_ptr<HostGather> make(MPI_Comm world, Hosts const&, std::int64_t piece);
    HostGather(HostGather const&) = delete;
    HostGather& operator=(HostGather const&) = delete;
    ~HostGather();

    /// Gathers as Communicator::all_gather().
    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes_of_rank);

  private:
    /// Ranks that are consecutive both in the window and in the world.
    struct Run {
        int first, end;  // ranks [first, end)
    };
    /// Half-open range of bytes.
    struct Interval {
        std::int64_t begin, end;
        /// Intersection with another interval.
        Interval within(Interval const& other) const;
        std::int64_t length() const { return end - begin; }
    };

    HostGather(Hosts const& hosts, std::int64_t piece);
    /// Determines the positions of all blocks.
    void lay_out(std::vector<std::int64_t> const& bytes_of_rank);
    /// Exchanges one piece between the leaders.
    void between_hosts(std::byte* window, Interval const& piece);
    /// Synchronises the ranks of the host and their shared memory.
    void wait();

    Hosts const& hosts_;
    /// Largest number of bytes per piece.
    std::int64_t piece_;
    std::vector<int> order_;  // ranks in window order: host by host
    /// Runs of `order_`.
    std::vector<Run> runs_;
    int rank_ = 0;
    /// This rank's bytes in window order.
    Interval own_{0, 0};
    /// First byte of each rank in world order, then their number.
    std::vector<std::int64_t> first_;
    std::vector<Interval> of_host_;  // bytes of each host in window order
    /// Counts and displacements for MPI, per host.
    std::vector<int> counts_, places_;
    MPI_Win window_ = MPI_WIN_NULL;
    std::byte* memory_ = nullptr;
    /// Selects the half of the shared memory for the next piece.
    bool second_half_ = false;
    Unwinding unwinding_;
};

}  // namespace catena
