// Copies of the motion of a system's bodies, for observers and frames.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "chain/scene_windows.hpp"
#include "integrate/system_chains.hpp"

namespace catena {

/// Motion of bodies in scene order.
struct SceneMotion {
    /// Position and velocity of the centre of mass or bead, W (nm, nm/ps); angular velocity in
    /// body axes, rad/ps.
    std::vector<Vec3> position, velocity, omega;
    std::vector<Quat> orientation;  // body axes in W; identity for beads
};
/// Consecutive bodies of the scene, from `first` on.
struct SceneBodies {
    std::int64_t first = 0;
    SceneMotion motion;
    /// Constraint wrench [torque, force] at the inboard joint, W; empty unless asked for.
    std::vector<Vector<double, 6>> joint_force;
    /// BodyArrays::q of each body; empty unless asked for, zeros in absolute coordinates.
    std::vector<std::array<double, 4>> joint_position;
    /// BodyArrays::qd of each body; present if joint_position is.
    std::vector<Vec3> joint_rate;
};
/// Columns of a row besides position and velocity: orientation and angular velocity, joint force,
/// joint coordinates and rates.
struct BodyColumns {
    bool turning = false, joint_forces = false, joint_states = false;
    /// Number of columns.
    int width() const {
        return (turning ? 13 : 6) + (joint_forces ? 6 : 0) + (joint_states ? 7 : 0);
    }
};
/// Motion of this rank's bodies at the time of Snapshots::own().
struct OwnBodies {
    BodyColumns columns;
    /// Rows of each group, one per body.
    std::vector<std::vector<double>> rows;
};
/// Motion of all bodies in scene order. Ranks other than 0 have no rows.
struct AllBodies {
    BodyColumns columns;
    std::vector<double> rows;
};

/// Takes and passes on copies of the motion of a system's bodies. The system must outlive it.
class Snapshots {
  public:
    using Take = std::function<void(SceneBodies const&)>;

    explicit Snapshots(SystemChains const& system) : system_(system) {}

    /// Copies the motion of this rank's bodies. `rows` is memory of an earlier copy that is used
    /// again. Collective if `joint_forces`.
    OwnBodies own(bool joint_forces, bool joint_states = false,
                  std::vector<std::vector<double>> rows = {}) const;
    /// Gathers all ranks' bodies. `rows` is memory of an earlier copy that is used again.
    /// Collective.
    AllBodies gathered(OwnBodies const&, std::vector<double> rows) const;
    /// Calls `take` on rank 0 with all bodies of the scene, in scene order and in parts of bounded
    /// size. Collective.
    void pass(OwnBodies const&, Take const& take) const;
    /// Passes bodies from the copy of rank 0. Rank 0 only.
    void pass(AllBodies const&, Take const& take) const;
    /// Passes this rank's bodies to `take`, in scene order, without exchange between ranks. Each
    /// round is of bounded size and consists of runs of consecutive bodies. All ranks have the same
    /// number of rounds. Collective.
    void pass_own(OwnBodies const&,
                  std::function<void(std::vector<SceneBodies> const&)> const& take) const;
    /// Returns the runs of consecutive bodies of the scene that this rank owns.
    std::vector<SceneWindows::Run> own_runs() const { return windows().own_runs(); }
    /// Returns the motion of all bodies on rank 0. Collective.
    SceneMotion motion() const;

  private:
    SceneWindows windows() const { return {system_.communicator(), system_.groups()}; }

    SystemChains const& system_;
};

}  // namespace catena
