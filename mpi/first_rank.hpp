// Actions on rank 0 or on every rank whose failure is reported on all ranks.
#pragma once

#include <string>

#include "error.hpp"
#include "mpi/collectives.hpp"

namespace catena {

/// Error that every rank knows of. All ranks then terminate regularly with status 1.
class SharedError : public ComputationError {
  public:
    using ComputationError::ComputationError;
};

/// Runs `action`. Returns an empty text, or 'i' (InputError) or 'e' (any other exception) followed
/// by the exception's text. Local.
template <class Action>
std::string failure_of(Action const& action) {
    try {
        action();
    } catch (InputError const& error) {
        return 'i' + std::string(error.what());
    } catch (std::exception const& error) {
        return 'e' + std::string(error.what());
    }
    return "";
}
/// Throws what failure_of() returned: InputError as InputError, all others as SharedError.
inline void throw_failure(std::string const& failure) {
    if (failure.empty()) return;
    if (failure.front() == 'i') throw InputError(failure.substr(1));
    throw SharedError(failure.substr(1));
}

/// Runs `action` on rank 0. An exception from it is thrown on every rank (throw_failure()).
/// Collective.
template <class Action>
void on_first_rank(Communicator const& communicator, Action const& action) {
    std::string failure = communicator.rank() == 0 ? failure_of(action) : "";
    broadcast(communicator, failure);
    throw_failure(failure);
}

/// Runs `action` on every rank. If it fails, the first rank's exception is thrown on all
/// (throw_failure()). Precondition: if `action` throws on one rank, no other rank waits for that
/// rank within it. Collective.
template <class Action>
void on_every_rank(Communicator const& communicator, Action const& action) {
    throw_failure(first_text(communicator, failure_of(action)).text);
}

}  // namespace catena
