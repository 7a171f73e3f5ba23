// Communicator over MPI. Data longer than the largest message are sent in pieces.
#include "mpi/mpi_communicator.hpp"

#include <mpi.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "error.hpp"
#include "mpi/cores.hpp"
#include "mpi/host_gather.hpp"
#include "mpi/launcher.hpp"
#include "mpi/mpi_handles.hpp"

namespace catena {
namespace {

/// MPI itself, from MPI_Init_thread to MPI_Finalize. It owns nothing if the caller had initialised
/// MPI.
class MpiLibrary {
  public:
    MpiLibrary(int* argc, char*** argv) {
        int initialised = 0;
        check_mpi(MPI_Initialized(&initialised), "MPI_Initialized");
        if (initialised != 0) return;
        // Selects ROMIO among Open MPI's two file implementations (io/all_writers.cpp).
        ::setenv("OMPI_MCA_io", "^ompio", 0);
        int provided = MPI_THREAD_SINGLE;
        // A lower level would suffice: only tests communicate from a thread other than the main
        // one, which waits meanwhile.
        check_mpi(MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
        owned_ = true;
        if (provided < MPI_THREAD_FUNNELED)
            throw ComputationError("MPI does not allow threads (" + message_passing_library() +
                                   "): use an MPI with MPI_THREAD_FUNNELED");
    }
    MpiLibrary(MpiLibrary&& other) noexcept : owned_(std::exchange(other.owned_, false)) {}
    MpiLibrary& operator=(MpiLibrary&&) = delete;
    ~MpiLibrary() {
        if (owned_ && !unwinding_) MPI_Finalize();
    }

  private:
    bool owned_ = false;
    Unwinding unwinding_;
};

/// Returns a duplicate of MPI_COMM_WORLD whose errors are returned, not fatal.
MpiHandle duplicate_of_world() {
    check_mpi(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN),
              "MPI_Comm_set_errhandler");
    MPI_Comm handle = MPI_COMM_NULL;
    check_mpi(MPI_Comm_dup(MPI_COMM_WORLD, &handle), "MPI_Comm_dup");
    return MpiHandle(handle);
}

/// Rank's index on its host, and numbers of ranks on the host and on the same cores.
struct OnHost {
    int rank = 0, ranks = 1, on_cores = 1;
};
/// Collective.
OnHost place_on_host(MPI_Comm world) {
    Hosts const hosts(world, 0);
    CoreSet const own = cores_bound_to();
    std::vector<CoreSet> all(static_cast<std::size_t>(hosts.ranks.size()));
    check_mpi(
        MPI_Allgather(&own, sizeof(own), MPI_BYTE, all.data(), sizeof(own), MPI_BYTE, hosts.ranks),
        "MPI_Allgather");
    return {hosts.ranks.rank(), hosts.ranks.size(),
            static_cast<int>(std::count(all.begin(), all.end(), own))};
}

/// Maps a double to an integer of the same order, with NaN above all.
std::int64_t ordered(double value) {
    if (std::isnan(value)) return std::numeric_limits<std::int64_t>::max();
    auto const bits = std::bit_cast<std::int64_t>(value);
    return bits >= 0 ? bits : bits ^ std::numeric_limits<std::int64_t>::max();
}
/// Inverse of ordered().
double from_ordered(std::int64_t key) {
    return std::bit_cast<double>(key >= 0 ? key : key ^ std::numeric_limits<std::int64_t>::max());
}

/// Throws if a received message does not have the expected length.
void require_length(MPI_Status const& status, std::size_t expected) {
    int count = 0;
    check_mpi(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
    if (static_cast<std::size_t>(count) != expected)
        throw std::logic_error("message of " + std::to_string(count) + " bytes where " +
                               std::to_string(expected) + " were expected");
}

/// Messages of any length, which MPI sends in pieces of at most `largest` bytes.
class MessagePieces {
  public:
    /// The communicator must outlive the object.
    MessagePieces(MPI_Comm ranks, std::size_t largest) : ranks_(ranks), largest_(largest) {}
    std::size_t largest() const { return largest_; }

    /// Calls action(piece) for consecutive pieces.
    template <class Byte, class Action>
    void for_each(std::span<Byte> bytes, Action action) const {
        for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), largest_)))
            action(bytes.first(std::min(bytes.size(), largest_)));
    }
    void broadcast(std::span<std::byte> data, int root) const {
        for_each(data, [&](std::span<std::byte> piece) {
            check_mpi(
                MPI_Bcast(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, root, ranks_),
                "MPI_Bcast");
        });
    }
    void send(std::span<std::byte const> data, int to) const {
        for_each(data, [&](std::span<std::byte const> piece) {
            check_mpi(
                MPI_Send(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, to, 0, ranks_),
                "MPI_Send");
        });
    }
    void receive(std::span<std::byte> data, int from) const {
        for_each(data, [&](std::span<std::byte> piece) {
            MPI_Status status;
            check_mpi(MPI_Recv(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, from, 0,
                               ranks_, &status),
                      "MPI_Recv");
            require_length(status, piece.size());
        });
    }
    /// Sends and receives at the same time. Data without bytes have no partner.
    void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                  int from) const {
        while (!send.empty() || !receive.empty()) {
            std::span const out = send.first(std::min(send.size(), largest_));
            std::span const in = receive.first(std::min(receive.size(), largest_));
            MPI_Status status;
            check_mpi(MPI_Sendrecv(out.data(), static_cast<int>(out.size()), MPI_BYTE,
                                   out.empty() ? MPI_PROC_NULL : to, 0, in.data(),
                                   static_cast<int>(in.size()), MPI_BYTE,
                                   in.empty() ? MPI_PROC_NULL : from, 0, ranks_, &status),
                      "MPI_Sendrecv");
            if (!in.empty()) require_length(status, in.size());
            send = send.subspan(out.size());
            receive = receive.subspan(in.size());
        }
    }

  private:
    MPI_Comm ranks_;
    std::size_t largest_;
};

/// Lengths of a gather's blocks; counts and offsets for MPI if the sum is short enough.
struct GatherBlocks {
    std::vector<std::int64_t> const& bytes;
    std::vector<int> count, first;
    bool short_enough = false;

    /// Block of a rank in `all`.
    std::span<std::byte> of(std::span<std::byte> all, int rank) const {
        auto const begin = std::accumulate(bytes.begin(), bytes.begin() + rank, std::int64_t{0});
        return all.subspan(static_cast<std::size_t>(begin),
                           static_cast<std::size_t>(bytes[static_cast<std::size_t>(rank)]));
    }
    /// True if the rank's data, `own`, already lie at their position in `all`.
    bool have(std::span<std::byte const> own, std::span<std::byte> all, int rank) const {
        return !own.empty() && own.data() == of(all, rank).data();
    }
};

/// Communicator over a duplicate of MPI_COMM_WORLD.
class MpiCommunicator final : public Communicator {
  public:
    MpiCommunicator(int* argc, char*** argv, MpiOptions const& options)
        : library_(argc, argv),
          world_(duplicate_of_world()),
          pieces_(world_, static_cast<std::size_t>(options.largest_message)),
          rank_(world_.rank()),
          size_(world_.size()),
          on_host_(place_on_host(world_)) {
        choose_way(options);
    }

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int ranks_on_host() const override { return on_host_.ranks; }
    int rank_on_host() const override { return on_host_.rank; }
    int ranks_on_cores() const override { return on_host_.on_cores; }
    std::int64_t rounds() const override { return rounds_; }
    Traffic traffic() const override { return traffic_; }
    void tally(Traffic const& messages) const override {
        rounds_ += messages.gathers + messages.exchanges;
        traffic_ += messages;
        if (messages.gathers > 0)
            traffic_ += way_.within_and_between_hosts(messages.gathered_bytes);
    }
    GatherWay const& gather_way() const override { return way_; }

    void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                    std::vector<std::int64_t> const& bytes_of_rank) const override {
        GatherBlocks const blocks = blocks_of(own, all, bytes_of_rank);
        ++rounds_;
        count_gather(static_cast<std::int64_t>(all.size()));
        if (two_stages_) return two_stages_->gather(own, all, bytes_of_rank);
        if (!blocks.short_enough) return all_gather_in_pieces(own, all, blocks);
        void const* const send = blocks.have(own, all, rank_) ? MPI_IN_PLACE : own.data();
        check_mpi(MPI_Allgatherv(send, static_cast<int>(own.size()), MPI_BYTE, all.data(),
                                 blocks.count.data(), blocks.first.data(), MPI_BYTE, world_),
                  "MPI_Allgatherv");
    }

    void gather(std::span<std::byte const> own, std::span<std::byte> all,
                std::vector<std::int64_t> const& bytes_of_rank) const override {
        GatherBlocks const blocks =
            rank_ == 0 ? blocks_of(own, all, bytes_of_rank) : blocks_of(own, {}, bytes_of_rank);
        ++rounds_;
        if (!blocks.short_enough) return gather_in_pieces(own, all, blocks);
        void const* const send =
            rank_ == 0 && blocks.have(own, all, rank_) ? MPI_IN_PLACE : own.data();
        check_mpi(MPI_Gatherv(send, static_cast<int>(own.size()), MPI_BYTE, all.data(),
                              blocks.count.data(), blocks.first.data(), MPI_BYTE, 0, world_),
                  "MPI_Gatherv");
    }

    void broadcast(std::span<std::byte> data) const override {
        ++rounds_;
        pieces_.broadcast(data, 0);
    }

    void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                  int from) const override {
        ++rounds_;
        if (to < 0) send = {};
        if (from < 0) receive = {};
        ++traffic_.exchanges;
        traffic_.sent_bytes += static_cast<std::int64_t>(send.size());
        pieces_.exchange(send, to, receive, from);
    }

    void exchange_all(std::span<Outgoing const> out, std::span<Incoming const> in) const override {
        ++rounds_;
        std::vector<MPI_Request> requests;
        std::vector<std::size_t> expected;  // bytes of the receives, which are the first requests
        for (Incoming const& m : in)
            pieces_.for_each(m.bytes, [&](std::span<std::byte> piece) {
                expected.push_back(piece.size());
                check_mpi(MPI_Irecv(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, m.from,
                                    0, world_, &requests.emplace_back()),
                          "MPI_Irecv");
            });
        for (Outgoing const& m : out)
            pieces_.for_each(m.bytes, [&](std::span<std::byte const> piece) {
                check_mpi(MPI_Isend(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, m.to, 0,
                                    world_, &requests.emplace_back()),
                          "MPI_Isend");
            });
        std::vector<MPI_Status> statuses(requests.size());
        check_mpi(MPI_Waitall(static_cast<int>(requests.size()), requests.data(), statuses.data()),
                  "MPI_Waitall");
        for (std::size_t i = 0; i < expected.size(); ++i) require_length(statuses[i], expected[i]);
    }

    MPI_Comm handle() const { return world_; }

    double max(double value) const override {
        return from_ordered(all_reduced(ordered(value), MPI_MAX));
    }
    std::int64_t sum(std::int64_t value) const override { return all_reduced(value, MPI_SUM); }

    void barrier() const override {
        ++rounds_;
        check_mpi(MPI_Barrier(world_), "MPI_Barrier");
    }

    [[noreturn]] void abort(int status) const override {
        MPI_Abort(world_, status);
        std::_Exit(status);
    }

  private:
    /// Selects the algorithm of all_gather().
    void choose_way(MpiOptions const& options) {
        GatherChoice const choice =
            options.gather ? *options.gather
                           : gather_choice(variable_of_first_rank(*this, "CATENA_GATHER"));
        int colour = choice.ranks_a_host > 0 ? on_host_.rank / choice.ranks_a_host : 0;
        if (!options.host_of_rank.empty())
            colour = options.host_of_rank[static_cast<std::size_t>(rank_)];
        hosts_ = std::make_unique<Hosts>(world_, colour);
        way_ = GatherWay::of(choice, size_, hosts_->count);
        if (way_.stages == 1) return;
        way_.leads = hosts_->leads();
        way_.piece = std::min(way_.piece, options.largest_message);
        two_stages_ = HostGather::make(world_, *hosts_, way_.piece);
        if (!two_stages_) way_ = way_.without_memory();
    }

    /// Counts an all_gather of `bytes` in all.
    void count_gather(std::int64_t bytes) const {
        ++traffic_.gathers;
        traffic_.gathered_bytes += bytes;
        traffic_ += way_.within_and_between_hosts(bytes);
    }

    /// Checks the lengths of a gather's blocks. `all` may be empty on ranks that receive nothing.
    GatherBlocks blocks_of(std::span<std::byte const> own, std::span<std::byte> all,
                           std::vector<std::int64_t> const& bytes) const {
        auto const total =
            static_cast<std::size_t>(std::accumulate(bytes.begin(), bytes.end(), std::int64_t{0}));
        if (bytes.size() != static_cast<std::size_t>(size_) ||
            own.size() != static_cast<std::size_t>(bytes[static_cast<std::size_t>(rank_)]) ||
            (!all.empty() && all.size() != total))
            throw std::logic_error(
                "gather: the blocks do not have the lengths that bytes_of_rank gives them");
        GatherBlocks blocks{bytes, {}, {}, total <= pieces_.largest()};
        if (!blocks.short_enough) return blocks;
        int first = 0;
        for (std::int64_t const b : bytes) {
            blocks.count.push_back(static_cast<int>(b));
            blocks.first.push_back(std::exchange(first, first + static_cast<int>(b)));
        }
        return blocks;
    }

    /// Gathers blocks of any length by one broadcast per rank.
    void all_gather_in_pieces(std::span<std::byte const> own, std::span<std::byte> all,
                              GatherBlocks const& blocks) const {
        if (!blocks.have(own, all, rank_))
            std::copy(own.begin(), own.end(), blocks.of(all, rank_).begin());
        for (int r = 0; r < size_; ++r) pieces_.broadcast(blocks.of(all, r), r);
    }

    /// Gathers blocks of any length on rank 0 by point-to-point messages.
    void gather_in_pieces(std::span<std::byte const> own, std::span<std::byte> all,
                          GatherBlocks const& blocks) const {
        if (rank_ != 0) {
            pieces_.send(own, 0);
            return;
        }
        if (!blocks.have(own, all, rank_)) std::copy(own.begin(), own.end(), all.begin());
        for (int r = 1; r < size_; ++r) pieces_.receive(blocks.of(all, r), r);
    }

    /// Reduces one integer over the ranks.
    std::int64_t all_reduced(std::int64_t value, MPI_Op operation) const {
        ++rounds_;
        std::int64_t result = 0;
        check_mpi(MPI_Allreduce(&value, &result, 1, MPI_INT64_T, operation, world_),
                  "MPI_Allreduce");
        return result;
    }

    MpiLibrary
        library_;  // declared before world_: MPI is finalised after its communicators are freed
    MpiHandle world_;
    MessagePieces pieces_;
    int rank_, size_;
    OnHost on_host_;
    std::unique_ptr<Hosts> hosts_;
    std::unique_ptr<HostGather> two_stages_;  // null: one stage
    GatherWay way_;
    mutable std::int64_t rounds_ = 0;
    mutable Traffic traffic_;
};

}  // namespace

MPI_Comm handle_of(Communicator const& communicator) {
    auto const* const by_mpi = dynamic_cast<MpiCommunicator const*>(&communicator);
    return by_mpi != nullptr ? by_mpi->handle() : MPI_COMM_NULL;
}

std::unique_ptr<Communicator> mpi_communicator(int* argc, char*** argv, MpiOptions const& options) {
    auto communicator = std::make_unique<MpiCommunicator>(argc, argv, options);
    Launch const launch = launch_environment();
    if (launch.size > 1 && communicator->size() == 1)
        throw InputError("every process sees itself alone",
                         "started with " + launch.evidence + ", but MPI counts 1 rank",
                         "use the mpirun that belongs to " + message_passing_library());
    return communicator;
}

// MPI is not initialised outside mpirun: a single rank does not need it and starts faster.
std::unique_ptr<Communicator> world_communicator(int* argc, char*** argv) {
    if (!launch_environment().found) return serial_communicator();
    return mpi_communicator(argc, argv);
}

std::string message_passing_library() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING] = "";
    int length = 0;
    check_mpi(MPI_Get_library_version(text, &length), "MPI_Get_library_version");
    std::string const name(text);
    return name.substr(0, name.find_first_of(",\n"));
}

}  // namespace catena
