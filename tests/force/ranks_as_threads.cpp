#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/force/ranks.hpp"

namespace catena::testing {

namespace {

/// What the threads see of each other. One runs at a time, until it waits for the others: OpenMM's
/// set-up of expressions is not safe on several threads of a process at once (ranks of mpirun are
/// processes).
struct Meeting {
    explicit Meeting(int ranks) : barrier(ranks), blocks(ranks), values(ranks), integers(ranks) {}
    std::barrier<> barrier;
    std::mutex turn;
    std::vector<std::span<std::byte const>> blocks;
    std::vector<double> values;
    std::vector<std::int64_t> integers;
};

class ThreadCommunicator final : public Communicator {
  public:
    ThreadCommunicator(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(meeting_.blocks.size()); }
    int ranks_on_host() const override { return size(); }
    int ranks_on_cores() const override { return size(); }
    int rank_on_host() const override { return rank(); }

    void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                    std::vector<std::int64_t> const&) const override {
        std::vector<std::byte> const copy(own.begin(), own.end());  // `own` may lie in `all`
        meeting_.blocks[rank_] = copy;
        barrier();
        auto to = all.begin();
        for (auto const& block : meeting_.blocks)
            if (!all.empty()) to = std::copy(block.begin(), block.end(), to);
        barrier();
    }
    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes) const override {
        all_gather(own, rank_ == 0 ? all : std::span<std::byte>{}, bytes);
    }
    void broadcast(std::span<std::byte> data) const override {
        if (rank_ == 0) meeting_.blocks[0] = data;
        barrier();
        if (rank_ != 0)
            std::copy(meeting_.blocks[0].begin(), meeting_.blocks[0].end(), data.begin());
        barrier();
    }
    void exchange(std::span<std::byte const> send, int, std::span<std::byte> receive,
                  int from) const override {
        meeting_.blocks[rank_] = send;
        barrier();
        if (from >= 0)
            std::copy(meeting_.blocks[from].begin(), meeting_.blocks[from].end(), receive.begin());
        barrier();
    }
    double max(double value) const override {
        meeting_.values[rank_] = value;
        barrier();
        double result = meeting_.values[0];
        for (double v : meeting_.values) result = std::isnan(v) || v > result ? v : result;
        barrier();
        return result;
    }
    std::int64_t sum(std::int64_t value) const override {
        meeting_.integers[rank_] = value;
        barrier();
        std::int64_t result = 0;
        for (std::int64_t v : meeting_.integers) result += v;
        barrier();
        return result;
    }
    void barrier() const override {
        ++rounds_;
        meeting_.turn.unlock();
        meeting_.barrier.arrive_and_wait();
        meeting_.turn.lock();
    }
    std::int64_t rounds() const override { return rounds_; }
    [[noreturn]] void abort(int status) const override { std::_Exit(status); }

  private:
    Meeting& meeting_;
    int rank_;
    mutable std::int64_t rounds_ = 0;
};

void on_threads(int ranks, std::function<void(Communicator const&)> const& body) {
    Meeting meeting(ranks);
    std::vector<std::thread> threads;
    for (int r = 0; r < ranks; ++r)
        threads.emplace_back([&, r] {
            std::lock_guard const turn(meeting.turn);
            ThreadCommunicator const communicator(meeting, r);
            body(communicator);
        });
    for (auto& thread : threads) thread.join();
}

}  // namespace

void on_ranks(std::function<void(Communicator const&)> const& body) {
    for (int const ranks : {1, 2, 3, 4, 6}) on_threads(ranks, body);
}

}  // namespace catena::testing
