// Whether a worker thread computes OpenMM's forces while the caller goes on, or the caller itself: said by the scene or found by trying
// both.
#pragma once

#include <string>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

class PathChoice {
  public:
    /// `asked`: "auto", "host" or "inline". `may_compare`: whether both are worth trying. Throws InputError for anything else.
    PathChoice(std::string const& asked, bool may_compare, std::string const& scene_file);

    /// Whether the next evaluation runs on the worker.
    bool runs_on_worker() const;
    /// Takes the seconds from the begin of an evaluation to its end, whatever the caller did in between.
    void note(double seconds);
    /// Ends the comparison once both were tried often enough: the faster one by the slowest rank's median. Collective at that moment.
    void settle(Communicator const&);
    std::string text() const;

    /// Evaluations of either kind, the first of which (it builds the Context or the thread) does not count.
    static int constexpr trials = 6;

  private:
    bool trying_, worker_ = false;
    std::vector<double> inline_, host_;  // seconds
    double inline_median_ = 0, host_median_ = 0;
    std::string asked_;
};

}  // namespace catena
