// Two-stage all-gather over an MPI shared-memory window.
#include "mpi/host_gather.hpp"

#include <algorithm>
#include <numeric>

namespace catena {
namespace {

/// Returns the communicator of the ranks that share memory with this rank.
MpiHandle shares_memory(MPI_Comm world) {
    MPI_Comm host = MPI_COMM_NULL;
    check_mpi(MPI_Comm_split_type(world, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host),
              "MPI_Comm_split_type");
    return MpiHandle(host);
}

/// Returns the part of a communicator with the given colour.
MpiHandle split(MPI_Comm communicator, int colour) {
    MPI_Comm part = MPI_COMM_NULL;
    check_mpi(MPI_Comm_split(communicator, colour, 0, &part), "MPI_Comm_split");
    return MpiHandle(part);
}

}  // namespace

Hosts::Hosts(MPI_Comm world, int colour)
    : ranks(split(shares_memory(world), colour)),
      leaders(split(world, ranks.rank() == 0 ? 0 : MPI_UNDEFINED)) {
    int numbers[2] = {0, 1};  // index of this host, number of hosts
    if (leads()) {
        numbers[0] = leaders.rank();
        numbers[1] = leaders.size();
    }
    check_mpi(MPI_Bcast(numbers, 2, MPI_INT, 0, ranks), "MPI_Bcast");
    count = numbers[1];
    int size = 1;
    check_mpi(MPI_Comm_size(world, &size), "MPI_Comm_size");
    of_rank.resize(static_cast<std::size_t>(size));
    check_mpi(MPI_Allgather(numbers, 1, MPI_INT, of_rank.data(), 1, MPI_INT, world),
              "MPI_Allgather");
}

HostGather::Interval HostGather::Interval::within(Interval const& other) const {
    std::int64_t const from = std::max(begin, other.begin);
    return {from, std::max(from, std::min(end, other.end))};
}

HostGather::HostGather(Hosts const& hosts, std::int64_t piece) : hosts_(hosts), piece_(piece) {
    auto const ranks = hosts.of_rank.size(), count = static_cast<std::size_t>(hosts.count);
    order_.resize(ranks);
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) {
        return hosts.of_rank[static_cast<std::size_t>(a)] <
               hosts.of_rank[static_cast<std::size_t>(b)];
    });
    for (int const rank : order_) {
        if (runs_.empty() || runs_.back().end != rank) runs_.push_back({rank, rank});
        ++runs_.back().end;
    }
    first_.resize(ranks + 1);
    of_host_.resize(count);
    counts_.resize(count);
    places_.resize(count);
}

std::unique_ptr<HostGather> HostGather::make(MPI_Comm world, Hosts const& hosts,
                                             std::int64_t piece) {
    std::unique_ptr<HostGather> made(new HostGather(hosts, piece));
    check_mpi(MPI_Comm_rank(world, &made->rank_), "MPI_Comm_rank");
    MPI_Aint const bytes = hosts.leads() ? static_cast<MPI_Aint>(2 * piece) : 0;
    int const failed =
        MPI_Win_allocate_shared(bytes, 1, MPI_INFO_NULL, hosts.ranks,
                                static_cast<void*>(&made->memory_), &made->window_) == MPI_SUCCESS
            ? 0
            : 1;
    if (failed != 0) made->window_ = MPI_WIN_NULL;
    int somewhere = 0;
    check_mpi(MPI_Allreduce(&failed, &somewhere, 1, MPI_INT, MPI_MAX, world), "MPI_Allreduce");
    if (somewhere != 0) {
        made->window_ =
            MPI_WIN_NULL;  // stays allocated: freeing it is collective among all ranks of a host
        return nullptr;
    }
    check_mpi(MPI_Win_set_errhandler(made->window_, MPI_ERRORS_RETURN), "MPI_Win_set_errhandler");
    check_mpi(MPI_Win_lock_all(MPI_MODE_NOCHECK, made->window_), "MPI_Win_lock_all");
    MPI_Aint size = 0;
    int unit = 1;
    check_mpi(
        MPI_Win_shared_query(made->window_, 0, &size, &unit, static_cast<void*>(&made->memory_)),
        "MPI_Win_shared_query");
    return made;
}

HostGather::~HostGather() {
    if (window_ == MPI_WIN_NULL || unwinding_) return;
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
}

/// Determines the positions of all bytes in world order and in window order.
void HostGather::lay_out(std::vector<std::int64_t> const& bytes_of_rank) {
    std::partial_sum(bytes_of_rank.begin(), bytes_of_rank.end(), first_.begin() + 1);
    std::fill(of_host_.begin(), of_host_.end(), Interval{0, 0});
    std::int64_t at = 0;
    int before = -1;
    for (int const rank : order_) {
        auto const r = static_cast<std::size_t>(rank);
        Interval& host = of_host_[static_cast<std::size_t>(hosts_.of_rank[r])];
        if (hosts_.of_rank[r] != before) host.begin = at;
        before = hosts_.of_rank[r];
        if (rank == rank_) own_ = {at, at + bytes_of_rank[r]};
        at += bytes_of_rank[r];
        host.end = at;
    }
}

void HostGather::gather(std::span<std::byte const> own, std::span<std::byte> all,
                        std::vector<std::int64_t> const& bytes_of_rank) {
    lay_out(bytes_of_rank);
    std::int64_t const total = first_.back();
    for (std::int64_t begin = 0; begin < total; begin += piece_) {
        Interval const piece{begin, std::min(begin + piece_, total)};
        // A rank that has passed both waits of a piece knows that all ranks have read the piece
        // before the previous one. Two halves therefore need no third wait.
        std::byte* const window = memory_ + (second_half_ ? piece_ : 0);
        second_half_ = !second_half_;
        Interval const mine = own_.within(piece);
        if (mine.length() > 0)
            std::copy_n(own.data() + (mine.begin - own_.begin), mine.length(),
                        window + (mine.begin - begin));
        wait();
        if (hosts_.leads() && hosts_.count > 1) between_hosts(window, piece);
        wait();
        std::int64_t at = 0;
        for (Run const& run : runs_) {
            std::int64_t const first = first_[static_cast<std::size_t>(run.first)];
            Interval const here{at, at + first_[static_cast<std::size_t>(run.end)] - first},
                part = here.within(piece);
            if (part.length() > 0)
                std::copy_n(window + (part.begin - begin), part.length(),
                            all.data() + first + (part.begin - at));
            at = here.end;
        }
    }
}

/// Exchanges the hosts' parts of a piece between their leaders.
void HostGather::between_hosts(std::byte* window, Interval const& piece) {
    for (std::size_t h = 0; h < of_host_.size(); ++h) {
        Interval const part = of_host_[h].within(piece);
        counts_[h] = static_cast<int>(part.length());
        places_[h] = part.length() > 0 ? static_cast<int>(part.begin - piece.begin) : 0;
    }
    check_mpi(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_BYTE, window, counts_.data(), places_.data(),
                             MPI_BYTE, hosts_.leaders),
              "MPI_Allgatherv between hosts");
}

/// Makes everything that the host's ranks wrote before this call visible to all of them after it.
void HostGather::wait() {
    check_mpi(MPI_Win_sync(window_), "MPI_Win_sync");
    check_mpi(MPI_Barrier(hosts_.ranks), "MPI_Barrier");
    check_mpi(MPI_Win_sync(window_), "MPI_Win_sync");
}

}  // namespace catena
