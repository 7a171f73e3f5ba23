// One call of the program: the ranks it runs on, what it prints and how it ends.
#pragma once

#include <functional>

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

class Session {
  public:
    /// Sets up the log. InputError when --json names a file that cannot be.
    Session(Communicator const&, CommonOptions const&);

    Communicator const& communicator() const { return communicator_; }
    /// The scene with the options' overrides.
    Scene load(std::string const& file) const;
    /// Prints the text on rank 0 unless --quiet, writes --json. The exit status: 0, 1 where the
    /// outcome is not valid, 3 where it is not whole. Collective.
    int conclude(Outcome const&) const;

  private:
    Communicator const& communicator_;
    CommonOptions const& options_;
};

/// Initialises the ranks, reads the command line, runs `execute` and turns whatever is thrown into
/// one line on standard error and an exit status, the same on every rank: 2 for InputError, else 1.
int guarded(int argc, char** argv,
            std::function<int(Communicator const&, Request const&)> const& execute);

}  // namespace catena::command
