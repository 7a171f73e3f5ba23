// Measurement of the time that a rank spends in messages.
#include "mpi/timed_communicator.hpp"

#include <cstdlib>

#include "clock.hpp"

namespace catena {

class TimedCommunicator::Stopwatch {
  public:
    explicit Stopwatch(double& seconds) : seconds_(seconds), start_(seconds_now()) {}
    ~Stopwatch() { seconds_ += seconds_now() - start_; }
    Stopwatch(Stopwatch const&) = delete;
    Stopwatch& operator=(Stopwatch const&) = delete;

  private:
    double& seconds_;
    double start_;
};

void TimedCommunicator::all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                                   std::vector<std::int64_t> const& bytes_of_rank) const {
    Stopwatch const watch(seconds_);
    under_.all_gather(own, all, bytes_of_rank);
}

void TimedCommunicator::gather(std::span<std::byte const> own, std::span<std::byte> all,
                               std::vector<std::int64_t> const& bytes_of_rank) const {
    Stopwatch const watch(seconds_);
    under_.gather(own, all, bytes_of_rank);
}

void TimedCommunicator::broadcast(std::span<std::byte> data) const {
    Stopwatch const watch(seconds_);
    under_.broadcast(data);
}

void TimedCommunicator::exchange(std::span<std::byte const> send, int to,
                                 std::span<std::byte> receive, int from) const {
    Stopwatch const watch(seconds_);
    under_.exchange(send, to, receive, from);
}

void TimedCommunicator::exchange_all(std::span<Outgoing const> out,
                                     std::span<Incoming const> in) const {
    Stopwatch const watch(seconds_);
    under_.exchange_all(out, in);
}

double TimedCommunicator::max(double value) const {
    Stopwatch const watch(seconds_);
    return under_.max(value);
}

std::int64_t TimedCommunicator::sum(std::int64_t value) const {
    Stopwatch const watch(seconds_);
    return under_.sum(value);
}

void TimedCommunicator::barrier() const {
    Stopwatch const watch(seconds_);
    under_.barrier();
}

void TimedCommunicator::abort(int status) const {
    under_.abort(status);
    std::_Exit(status);  // GCC does not accept that a virtual function never returns
}

}  // namespace catena
