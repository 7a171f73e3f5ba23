// One call of the program: the ranks that it runs on, what it prints and how it ends.
#pragma once

#include <functional>

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Loads scenes and prints outcomes for one command.
class Session {
  public:
    /// Starts the log. Throws InputError if --json names a file that cannot be written.
    Session(Communicator const&, CommonOptions const&);

    Communicator const& communicator() const { return communicator_; }
    /// Loads the scene with the options' overrides. Collective.
    Scene load(std::string const& file) const;
    /// Prints the text on rank 0 unless --quiet, and writes --json. Returns the exit status: 0, 1
    /// if the outcome is not valid, 3 if it is not whole. Collective.
    int conclude(Outcome const&) const;

  private:
    Communicator const& communicator_;
    CommonOptions const& options_;
};

/// Initialises the ranks, reads the command line and runs `execute`. Every exception becomes one
/// line on standard error and an exit status, the same on every rank: 2 for InputError, else 1.
int guarded(int argc, char** argv,
            std::function<int(Communicator const&, Request const&)> const& execute);

}  // namespace catena::command
