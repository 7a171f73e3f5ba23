// All-gather in two stages: ranks of a host through memory that they share, hosts by messages
// between their first ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mpi/mpi_handles.hpp"

namespace catena {

/// The ranks' hosts, in whatever order ranks lie on them; hosts are numbered by their first ranks,
/// the leaders.
struct Hosts {
    /// Collective. Ranks that do not share memory are on different hosts; those that do, but of
    /// different `colour`, count as such too.
    Hosts(MPI_Comm world, int colour);
    bool leads() const { return leaders != MPI_COMM_NULL; }

    MpiHandle ranks;    // of this host
    MpiHandle leaders;  // MPI_COMM_NULL elsewhere
    int count = 1;
    std::vector<int> of_rank;  // of the world
};

class HostGather {
  public:
    /// Takes so many bytes at a time, twice this of memory a host. Null on all ranks where some
    /// host has none to share. Collective.
    static std::unique_ptr<HostGather> make(MPI_Comm world, Hosts const&, std::int64_t piece);
    HostGather(HostGather const&) = delete;
    HostGather& operator=(HostGather const&) = delete;
    ~HostGather();

    /// Communicator::all_gather.
    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes_of_rank);

  private:
    /// Neighbours in the window that are neighbours in the world.
    struct Run {
        int first, end;  // ranks
    };
    struct Interval {
        std::int64_t begin, end;
        Interval within(Interval const& other) const;
        std::int64_t length() const { return end - begin; }
    };

    HostGather(Hosts const& hosts, std::int64_t piece);
    void lay_out(std::vector<std::int64_t> const& bytes_of_rank);
    void between_hosts(std::byte* window, Interval const& piece);
    void wait();

    Hosts const& hosts_;
    std::int64_t piece_;
    std::vector<int> order_;  // ranks as they lie in the window: host after host
    std::vector<Run> runs_;
    int rank_ = 0;
    Interval own_{0, 0};
    std::vector<std::int64_t> first_;  // of each rank's bytes in the world's order, and their sum
    std::vector<Interval> of_host_;    // in the window's order
    std::vector<int> counts_, places_;
    MPI_Win window_ = MPI_WIN_NULL;
    std::byte* memory_ = nullptr;
    bool second_half_ = false;
    Unwinding unwinding_;
};

}  // namespace catena
