// Communicator of a single rank.
#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "mpi/communicator.hpp"

namespace catena {
namespace {

class SerialCommunicator final : public Communicator {
  public:
    int rank() const override { return 0; }
    int size() const override { return 1; }
    int ranks_on_host() const override { return 1; }
    int rank_on_host() const override { return 0; }
    int ranks_on_cores() const override { return 1; }

    void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                    std::vector<std::int64_t> const& bytes_of_rank) const override {
        if (bytes_of_rank.size() != 1 || own.size() != static_cast<std::size_t>(bytes_of_rank[0]) ||
            all.size() != own.size())
            throw std::logic_error(
                "gather: the blocks do not have the lengths that bytes_of_rank gives them");
        if (own.data() != all.data()) std::copy(own.begin(), own.end(), all.begin());
    }
    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes) const override {
        all_gather(own, all, bytes);
    }
    void broadcast(std::span<std::byte>) const override {}
    void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                  int from) const override {
        if (to == 0 && from == 0) std::copy(send.begin(), send.end(), receive.begin());
    }
    double max(double value) const override { return value; }
    std::int64_t sum(std::int64_t value) const override { return value; }
    void barrier() const override {}
    std::int64_t rounds() const override { return 0; }
    [[noreturn]] void abort(int status) const override { std::_Exit(status); }
};

}  // namespace

std::unique_ptr<Communicator> serial_communicator() {
    return std::make_unique<SerialCommunicator>();
}

}  // namespace catena
