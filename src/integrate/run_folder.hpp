// The folder a run writes, on rank 0. What fails there (a full disk) ends all ranks in good order: every call is collective.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "error.hpp"
#include "integrate/observables.hpp"
#include "integrate/simulation.hpp"
#include "io/output.hpp"

namespace catena {

class RunFolder {
  public:
    /// Makes or opens the folder. `first_step`: the checkpoint's when restarting. Throws InputError on every rank.
    RunFolder(Scene const&, Communicator const&, RunOptions const&, std::int64_t first_step);

    /// The files that need the first state.
    void open(Topology const&, Frame const& first, std::vector<std::string> const& columns);
    void write(Frame const&, std::vector<double> const& observables);
    void write_checkpoint(Checkpoint const&);
    /// Closes the tables, writes summary, timeline and report.
    void finish(std::string const& summary, std::string const& timeline);

    std::string path(std::string const& name) const { return folder_ + "/" + name; }
    std::vector<std::string> const& topology_files() const { return topology_files_; }

  private:
    /// What a restart can begin with; empty: nothing.
    std::string newest_checkpoint() const;
    /// By rank 0; a ComputationError of its tells the way back as well.
    template <class Action>
    void on_disk(Action const& action);

    Scene const& scene_;
    Communicator const& communicator_;
    bool appends_ = false;
    std::int64_t first_step_;
    std::string folder_;
    std::unique_ptr<TrajectoryWriter> trajectory_;
    std::unique_ptr<ObservablesWriter> observables_;
    std::vector<std::string> topology_files_;
};

}  // namespace catena
