// Collective operations between ranks: the few that Catena needs. Floating-point data that affect
// the state are gathered, never reduced, because the order of a sum must not depend on the number
// of ranks.
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

/// Message to another rank. Both ranks know its length.
struct Outgoing {
    int to;
    std::span<std::byte const> bytes;
};
/// Message from another rank. Both ranks know its length.
struct Incoming {
    int from;
    std::span<std::byte> bytes;
};

/// Interface of communication between ranks. All functions are collective unless stated otherwise.
class Communicator {
  public:
    virtual ~Communicator() = default;
    /// Index of this rank, and number of ranks. Local.
    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Number of ranks on this rank's host, and index of this rank among them. Local.
    virtual int ranks_on_host() const = 0;
    virtual int rank_on_host() const = 0;
    /// Number of ranks of this host that may run on the same cores as this rank. Ranks without core
    /// binding share all cores. Local.
    virtual int ranks_on_cores() const = 0;

    /// Gathers the blocks of all ranks, one after the other in rank order, on every rank.
    /// `bytes_of_rank[r]`: length of rank r's block, known to all ranks.
    virtual void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                            std::vector<std::int64_t> const& bytes_of_rank) const = 0;
    /// Gathers as all_gather() does, on rank 0 alone (`all` may be empty elsewhere).
    virtual void gather(std::span<std::byte const> own, std::span<std::byte> all,
                        std::vector<std::int64_t> const& bytes_of_rank) const = 0;
    /// Copies rank 0's bytes to every rank.
    virtual void broadcast(std::span<std::byte> data) const = 0;
    /// Sends to rank `to` and receives from rank `from`; a negative rank means no message. Only the
    /// two partners of a message take part. Both know its length.
    virtual void exchange(std::span<std::byte const> send, int to, std::span<std::byte> receive,
                          int from) const = 0;
    /// Exchanges all given messages, at most one from a rank to another. Ranks without messages
    /// must also call it. The default implementation needs exchange() alone and proceeds in rounds.
    virtual void exchange_all(std::span<Outgoing const> out, std::span<Incoming const> in) const;
    /// Returns the largest value over the ranks, which is exact in any order. NaN counts as the
    /// largest.
    virtual double max(double value) const = 0;
    /// Returns the sum over the ranks.
    virtual std::int64_t sum(std::int64_t value) const = 0;
    /// Waits for all ranks.
    virtual void barrier() const = 0;
    /// Number of collectives and exchanges in which this rank took part, for reports. Local.
    virtual std::int64_t rounds() const = 0;
    /// Traffic of this rank so far; zero if the communicator does not count. Local.
    virtual Traffic traffic() const { return {}; }
    /// Adds messages that ranks exchange by another path, as if this communicator had sent them.
    /// Local.
    virtual void tally(Traffic const&) const {}
    /// Algorithm of all_gather(); it does not affect the gathered bytes. Local.
    virtual GatherWay const& gather_way() const;
    /// True if messages may bypass this communicator from GPU to GPU. Local.
    virtual bool may_be_passed_by() const { return true; }
    /// Terminates every rank at once, after an error that other ranks cannot know of. Local.
    [[noreturn]] virtual void abort(int status) const = 0;
};

/// Returns the communicator of a single rank; it sends no messages.
std::unique_ptr<Communicator> serial_communicator();

/// Returns the communicator of MPI_COMM_WORLD. It initialises MPI, and finalises it in its
/// destructor. In a build without MPI, or outside mpirun, the result is the serial communicator.
/// Throws InputError if mpirun started a build without MPI.
std::unique_ptr<Communicator> world_communicator(int* argc, char*** argv);

/// Number of cores for this rank. The cores are those to which it is bound (by a job, a container
/// or a launcher), divided by the number of ranks bound to the same ones.
int cores_of_rank(Communicator const&);

/// Returns rank 0's environment variable; empty if it is not set. Launchers copy variables to other
/// hosts only if told to. Collective.
std::string variable_of_first_rank(Communicator const&, char const* name);

/// Name and version of the message-passing library; "none" in a build without one.
std::string message_passing_library();

/// View of values as bytes.
template <class T>
std::span<std::byte const> bytes_of(std::span<T const> values) {
    return std::as_bytes(values);
}

}  // namespace catena
