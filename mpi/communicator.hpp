// How ranks speak: the few collectives that Catena needs. Floating-point data that feed the state
// are gathered, never reduced: the order of a sum must not depend on the number of ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mpi/gather_way.hpp"
#include "mpi/traffic.hpp"

namespace catena {

/// Messages between two ranks, both of which know the length.
struct Outgoing {
    int to;
    std::span<std::byte const> bytes;
};
struct Incoming {
    int from;
    std::span<std::byte> bytes;
};

class Communicator {
  public:
    virtual ~Communicator() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    virtual int ranks_on_host() const = 0;
    virtual int rank_on_host() const = 0;
    /// Ranks of this host that may run on the very cores that this one may: bound to none, all of
    /// them.
    virtual int ranks_on_cores() const = 0;

    /// Every rank gets the blocks of all ranks, one after the other in rank order.
    /// `bytes_of_rank[r]`: length of rank r's block, known to all.
    virtual void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                            std::vector<std::int64_t> const& bytes_of_rank) const = 0;
    /// As all_gather, on rank 0 alone (`all` may be empty elsewhere).
    virtual void gather(std::span<std::byte const> own, std::span<std::byte> all,
                        std::vector<std::int64_t> const& bytes_of_rank) const = 0;
    /// Rank 0's bytes to every rank.
    virtual void broadcast(std::span<std::byte> data) const = 0;
    /// Sends to rank `to` and receives from rank `from`; a negative rank means nobody. Both sides
    /// know the length.
    virtual void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                          int from) const = 0;
    /// Sends and receives all of these at once, at most one message from a rank to another one.
    /// Collective: ranks that have none call it too. As written here round by round, which nothing
    /// but exchange() is needed for.
    virtual void exchange_all(std::span<Outgoing const> out, std::span<Incoming const> in) const;
    /// Largest value over the ranks (exact in any order). NaN counts as the largest.
    virtual double max(double value) const = 0;
    virtual std::int64_t sum(std::int64_t value) const = 0;
    virtual void barrier() const = 0;
    /// How many messages rounds this rank took part in (collectives and exchanges), for reports.
    virtual std::int64_t rounds() const = 0;
    /// All of them so far; zero where nothing is counted.
    virtual Traffic traffic() const { return {}; }
    /// Counts messages that ranks exchange by another way as if they had gone by this one.
    virtual void tally(Traffic const&) const {}
    /// How all_gather goes; it changes no byte of what comes out.
    virtual GatherWay const& gather_way() const;
    /// Whether ranks' messages may also go from GPU to GPU, past this one.
    virtual bool may_be_passed_by() const { return true; }
    /// Ends every rank at once: for an error that other ranks cannot know of.
    [[noreturn]] virtual void abort(int status) const = 0;
};

/// One rank, no messages.
std::unique_ptr<Communicator> serial_communicator();

/// MPI_COMM_WORLD, MPI initialised and finalised by the owner; the serial one in a build without
/// MPI or outside mpirun. Throws InputError when started by mpirun in a build without MPI.
std::unique_ptr<Communicator> world_communicator(int* argc, char*** argv);

/// Cores this rank may use: those it is bound to (of a job, a container or a launcher's binding),
/// shared by the ranks that are bound to the same ones.
int cores_of_rank(Communicator const&);

/// Rank 0's environment variable, empty where there is none: launchers bring variables to other
/// hosts only when told to. Collective.
std::string variable_of_first_rank(Communicator const&, char const* name);

/// Name and version of the message-passing library, "none" without.
std::string message_passing_library();

template <class T>
std::span<std::byte const> bytes_of(std::span<T const> values) {
    return std::as_bytes(values);
}

}  // namespace catena
