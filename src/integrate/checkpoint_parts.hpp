// The arrays of a checkpoint that hold the state of a system's bodies.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "chain/scene_windows.hpp"
#include "integrate/system_chains.hpp"
#include "io/array_part.hpp"

namespace catena {

/// One array of a checkpoint on this rank: `width` numbers per body, group by group. Groups without
/// the quantity hold zeros.
struct OwnArray {
    int width = 0;
    std::vector<std::vector<double>> of_group;
};
/// All arrays of a checkpoint, by name.
using OwnState = std::map<std::string, OwnArray>;

/// Collects, passes on and restores the arrays of a checkpoint. The system must outlive it.
class CheckpointParts {
  public:
    using Arrays = std::map<std::string, std::vector<double>>;

    explicit CheckpointParts(SystemChains const& system) : system_(system) {}

    /// Returns the state of this rank's bodies.
    OwnState own_state() const;
    /// Adds the accelerations of a joint group that an integrator carries from step to step.
    void add_rates(ChainGroup const&, JointRates const&, OwnState&) const;
    /// Passes an array to `take` on rank 0, in scene order and in parts of bounded size.
    /// Collective.
    void pass(OwnArray const&, std::function<void(ArrayPart const&)> const& take) const;
    /// Passes this rank's part of an array to `take` without exchange between ranks, in ascending
    /// order. All ranks have the same number of rounds. Collective.
    void pass_own(OwnArray const&,
                  std::function<void(std::vector<ArrayPart> const&)> const& take) const;
    /// Returns all arrays in scene order on rank 0, which is where set_state() needs them.
    /// Collective.
    Arrays gathered(OwnState const&) const;
    /// Sets the state from rank 0's arrays. Throws InputError if one is missing or of wrong length.
    /// Collective.
    void set_state(Arrays const&) const;
    /// Returns the accelerations that add_rates() stored, one entry per group of
    /// SystemChains::joint(). Collective.
    std::vector<JointRates> own_rates(Arrays const&) const;

  private:
    SceneWindows windows() const { return {system_.communicator(), system_.groups()}; }
    /// Throws InputError on every rank unless rank 0's arrays include these names with `widths`
    /// numbers per body. Collective.
    void require(Arrays const&, std::map<std::string, int> const& widths) const;
    /// Returns this rank's part of one array, group by group. Collective.
    std::vector<std::vector<double>> own_part(Arrays const&, std::string const& name,
                                              int width) const;
    /// Adds the numbers of one group's own bodies to an array of a checkpoint.
    void add(ChainGroup const&, std::vector<double> own, int width, std::string const& name,
             OwnState&) const;
    void set_absolute(Arrays const&, std::map<std::string, int> const& widths,
                      std::vector<std::vector<StateArray>> states) const;
    void set_joint(Arrays const&) const;

    SystemChains const& system_;
};

}  // namespace catena
