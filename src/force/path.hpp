// How positions and forces travel: they stay on the GPU, or a worker thread computes OpenMM's
// forces while the caller goes on, or the caller itself does. The scene says which, or `auto` finds
// out: the GPU where it can be had, else by trying the two others.
#pragma once

#include <string>
#include <vector>

#include "force/openmm_force.hpp"
#include "mpi/communicator.hpp"

namespace catena {

class PathChoice {
  public:
    /// `asked`: "auto", "device", "host" or "inline". `may_compare`: whether host and inline are
    /// both worth trying. `why_no_device`: empty where positions and forces can stay on the GPU.
    /// Throws InputError for anything else, and for a device that cannot be had.
    PathChoice(std::string const& asked, bool may_compare, std::string const& why_no_device,
               std::string const& scene_file);

    bool on_device() const { return device_; }
    /// Whether the next evaluation runs on the worker.
    bool runs_on_worker() const;
    /// Takes the seconds from the begin of an evaluation to its end, whatever the caller did in
    /// between.
    void note(double seconds);
    /// Ends the comparison once both were tried often enough: the faster one by the slowest rank's
    /// median. Collective at that moment.
    void settle(Communicator const&);
    std::string text() const;
    /// "device", "host" or "inline": the next evaluation's.
    std::string name() const { return device_ ? "device" : runs_on_worker() ? "host" : "inline"; }

    /// Evaluations of either kind, the first of which (it builds the Context or the thread) does
    /// not count.
    static int constexpr trials = 6;

  private:
    bool device_, trying_, worker_ = false;
    std::vector<double> inline_, host_;  // seconds
    double inline_median_ = 0, host_median_ = 0;
    std::string asked_, why_no_device_;
};

}  // namespace catena
