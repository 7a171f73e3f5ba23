// A communicator that tells how long its ranks' messages took, so that what remains is a rank's own
// work.
#pragma once

#include "mpi/communicator.hpp"

namespace catena {

/// All calls go to another communicator, which must outlive it; their seconds, waiting for other
/// ranks included, are added up. No message goes past it from GPU to GPU.
class TimedCommunicator final : public Communicator {
  public:
    explicit TimedCommunicator(Communicator const& under) : under_(under) {}
    /// So far, on this rank.
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
    class Stopwatch;
    Communicator const& under_;
    mutable double seconds_ = 0;
};

}  // namespace catena
