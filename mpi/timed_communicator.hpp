// Communicator that measures the time of its messages; the remaining time is the rank's own work.
#pragma once

#include "mpi/communicator.hpp"

namespace catena {

/// Forwards all calls to another communicator, which must outlive it, and sums their times, waiting
/// for other ranks included. Messages do not bypass it from GPU to GPU.
class TimedCommunicator final : public Communicator {
  public:
    explicit TimedCommunicator(Communicator const& under) : under_(under) {}
    /// Time spent in messages so far on this rank, s.
    double seconds() const { return seconds_; }

    int rank() const override { return under_.rank(); }
    int size() const override { return under_.size(); }
    int ranks_on_host() const override { return under_.ranks_on_host(); }
    int rank_on_host() const override { return under_.rank_on_host(); }
    int ranks_on_cores() const override { return under_.ranks_on_cores(); }
    void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                    std::vector<std::int64_t> const& bytes_of_rank) const override;
    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes_of_rank) const override;
    void broadcast(std::span<std::byte> data) const override;
    void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                  int from) const override;
    void exchange_all(std::span<Outgoing const> out, std::span<Incoming const> in) const override;
    double max(double value) const override;
    std::int64_t sum(std::int64_t value) const override;
    void barrier() const override;
    std::int64_t rounds() const override { return under_.rounds(); }
    Traffic traffic() const override { return under_.traffic(); }
    void tally(Traffic const& traffic) const override { under_.tally(traffic); }
    GatherWay const& gather_way() const override { return under_.gather_way(); }
    bool may_be_passed_by() const override { return false; }
    [[noreturn]] void abort(int status) const override;

  private:
    /// Adds the time from construction to destruction.
    class Stopwatch;
    Communicator const& under_;
    mutable double seconds_ = 0;
};

}  // namespace catena
