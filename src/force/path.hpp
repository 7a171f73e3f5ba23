// PathChoice: how positions and forces travel between the chains and OpenMM.
//
// They stay on the GPU (`device`), a worker thread computes the forces while the caller continues
// (`host`), or the caller computes them (`inline`). The scene names the path. `auto` uses the GPU
// if it can, else it tries the two others and keeps the faster one.
#pragma once

#include <string>
#include <vector>

#include "force/openmm_force.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Chooses the path, by trial if the scene says `auto`.
class PathChoice {
  public:
    /// `asked`: "auto", "device", "host" or "inline". `may_compare`: true if host and inline are
    /// both worth trying. `why_no_device`: reason why positions and forces cannot stay on the GPU,
    /// empty if they can. Throws InputError for any other value of `asked`, and for a device that
    /// is not available.
    PathChoice(std::string const& asked, bool may_compare, std::string const& why_no_device,
               std::string const& scene_file);

    bool on_device() const { return device_; }
    /// True if the next evaluation runs on the worker.
    bool runs_on_worker() const;
    /// Records the seconds from begin to end of an evaluation, whatever the caller did in between.
    void note(double seconds);
    /// Ends the comparison once both paths have been tried often enough. The path with the smaller
    /// median time of the slowest rank is kept. Collective in that call.
    void settle(Communicator const&);
    /// Returns the choice and its reason, for people.
    std::string text() const;
    /// The path of the next evaluation: "device", "host" or "inline".
    std::string name() const { return device_ ? "device" : runs_on_worker() ? "host" : "inline"; }

    /// Evaluations per path in the comparison. The first does not count, because it builds the
    /// Context or the thread.
    static int constexpr trials = 6;

  private:
    bool device_, trying_, worker_ = false;
    // times of the evaluations on either path, s
    std::vector<double> inline_, host_;  // seconds
    // medians of the slowest rank, s; 0 before settle()
    double inline_median_ = 0, host_median_ = 0;
    std::string asked_, why_no_device_;
};

}  // namespace catena
