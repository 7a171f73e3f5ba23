// Actions on rank 0 or on every rank whose failure is reported on all ranks.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "error.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Error that every rank knows of. All ranks then terminate regularly with status 1.
class SharedError : public ComputationError {
  public:
    using ComputationError::ComputationError;
};

/// Runs `action` on rank 0. An exception from it is thrown on every rank: InputError as InputError,
/// all others as SharedError. Collective.
template <class Action>
void on_first_rank(Communicator const& communicator, Action const& action) {
    std::int64_t message[2] = {0, 0};  // status, length of the text
    std::string text;
    if (communicator.rank() == 0) {
        try {
            action();
        } catch (InputError const& error) {
            message[0] = 2;
            text = error.what();
        } catch (std::exception const& error) {
            message[0] = 1;
            text = error.what();
        }
        message[1] = static_cast<std::int64_t>(text.size());
    }
    communicator.broadcast(std::as_writable_bytes(std::span(message)));
    if (message[0] == 0) return;
    text.resize(static_cast<std::size_t>(message[1]));
    communicator.broadcast(std::as_writable_bytes(std::span(text)));
    if (message[0] == 2) throw InputError(text);
    throw SharedError(text);
}

/// Runs `action` on every rank. An exception on one rank is thrown on all as SharedError; if
/// several ranks fail, the text is that of the last rank. Precondition: if `action` throws on one
/// rank, no other rank waits for that rank within it. Collective.
template <class Action>
void on_every_rank(Communicator const& communicator, Action const& action) {
    std::string text;
    bool failed = false;
    try {
        action();
    } catch (std::exception const& error) {
        failed = true;
        text = error.what();
    }
    int const rank = static_cast<int>(communicator.max(failed ? communicator.rank() : -1));
    if (rank < 0) return;
    auto const to_first = [&](std::span<std::byte> bytes) {
        if (rank == 0 || bytes.empty()) return;
        if (communicator.rank() == rank) communicator.exchange(bytes, 0, {}, -1);
        if (communicator.rank() == 0) communicator.exchange({}, -1, bytes, rank);
    };
    auto length = static_cast<std::int64_t>(text.size());
    to_first(std::as_writable_bytes(std::span(&length, 1)));
    if (communicator.rank() == 0) text.resize(static_cast<std::size_t>(length));
    to_first(std::as_writable_bytes(std::span(text)));
    on_first_rank(communicator, [&] { throw ComputationError(text); });
}

}  // namespace catena
