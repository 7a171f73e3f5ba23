// Interface of dynamics in absolute coordinates (positions of beads, poses of rigid bodies), as the
// constrained integrators use it. Every constraint projection is a bias sweep of the
// divide-and-conquer solver, with impulses instead of forces.
//
// Frames: W ground axes, B body axes. Units: nm, ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/solver.hpp"
#include "dynamics/body_loads.hpp"
#include "dynamics/constrained_step.hpp"
#include "kinematics/carried_beads.hpp"
#include "kinematics/link_geometry.hpp"

namespace catena {

/// Constraint force of a tip's joint on the last body, W; the torque is about the origin of the
/// joint frame.
struct TipForce {
    std::int64_t chain = 0;  // Index of the chain in the scene.
    /// Constraint [torque, force]. In a planar chain it includes only the directions that the
    /// chain's handles carry.
    Vector<double, 6> wrench{};
};

/// Tension of a cross-link of a chain of the scene; above 0 if it pulls.
struct CrossLinkTension {
    std::int64_t chain = 0;
    double tension = 0;
};

/// Accelerations and constraint forces of bodies, W, for output and checks.
struct BodyResults {
    std::vector<Vec3> alpha;         // Angular acceleration, rad/ps^2; empty for beads.
    std::vector<Vec3> acceleration;  // Acceleration of the centre of mass, nm/ps^2.
    /// Constraint [torque, force] on body k at its inboard joint.
    std::vector<Vector<double, 6>> joint_force;
    std::vector<TipForce> tip_force;
    /// Constraint force of each loop's joint on its inboard body or the ground, in the order of
    /// LocalLoops::own. The torque is about the origin of the joint frame.
    std::vector<TipForce> loop_force;
    /// Tension of each cross-link of the group, in the order of Branching::crosslinks.
    std::vector<CrossLinkTension> crosslink_tension;
};

/// The larger of two numbers; NaN if either is NaN.
inline double larger(double a, double b) { return b > a || b != b ? b : a; }

/// A residual divided by the size of its terms; 0 if all terms are 0.
inline double relative(double difference, double terms) {
    return terms == 0 ? 0.0 : std::abs(difference) / terms;
}

/// View of a field over last bodies, in any Space. It has no origin if the group has no jointed
/// tips.
template <class Directions>
DirectionsView of_tips(ChainGroup const& group, Directions& field) {
    return group.ends.has_tips() ? field.view() : DirectionsView{};
}

/// The parts of the group's chains on this rank, with the anchors of their bases.
std::vector<LocalPiece> local_pieces(ChainGroup const&, Scene const&);
/// Attachments of the group's tips on this rank. Rings that only begin on this rank follow at the
/// end. end(k) is the starting position of the outboard end of last body k, W.
template <class End>
std::vector<HeldTip> held_tips(ChainGroup const& group, End const& end) {
    std::vector<HeldTip> tips;
    for (LocalTip const& tip : group.ends.tips) {
        Vec3 const start = end(tip.body), anchor = tip.joint.anchor.value_or(start);
        tips.push_back(
            {tip.body, anchor, tip.joint.length > 0 ? tip.joint.length : norm(anchor - start)});
    }
    for (std::size_t i = 0; i < group.ends.rings.size(); ++i) {
        LocalRing const& ring = group.ends.rings[i];
        if (ring.last < 0) tips.emplace_back();
        HeldTip& tip = ring.last < 0 ? tips.back() : tips[group.ends.tip_index(ring.last)];
        tip.ring = static_cast<std::int64_t>(i);
        tip.first = ring.first;
    }
    return tips;
}

/// A named array of the state, with `width` numbers per body.
struct StateArray {
    std::string name;
    int width = 0;
    std::vector<double> values;  // Values of this rank's bodies, body after body.
};

/// Motion of this rank's bodies, W. The views are valid until the state changes. Point beads have
/// no `orientation` and `omega` (B).
struct ObservedMotion {
    ConstView<3> position, velocity;
    ConstView<4> orientation = {};
    ConstView<3> omega = {};
};

/// State and equations of motion of a group of chains in absolute coordinates. An integrator builds
/// a step from its operations; observers read results.
class AbsoluteDynamics : public BeadHost {
  public:
    /// Computes link directions and the neighbours' positions at the current positions. Collective.
    virtual void update_configuration() = 0;
    /// Assembles the matrices at the last updated configuration. Needs no forces, so that it may
    /// run while they are computed. Collective.
    virtual void assemble_matrices() = 0;
    /// Sets the forces of gravity, external wrenches and joint springs at the last updated
    /// configuration. Collective.
    virtual void set_simple_forces() = 0;

    /// Kick with constraint projection: v <- P (v + h M^-1 f). P projects on the velocities that
    /// the joints permit at the current configuration. Collective.
    virtual void kick(double h) = 0;
    /// Computes the velocities that kick(h) would produce, into a copy (observed()).
    /// Collective.
    virtual void observe(double h) = 0;
    /// Drift: moves positions by h along the velocities. `sweeps` quasi-Newton sweeps add impulses
    /// along the joints of the last updated configuration so that the joints close at the end.
    /// Velocities become the mean ones of the drift. Collective.
    virtual void drift(double h, int sweeps) = 0;
    /// Adds one sweep to the last drift, which had length h, with the same result as a drift with
    /// one more sweep. Returns false if it cannot: then repeat the drift. Precondition: only
    /// constraint_error() has been called since the drift. Collective.
    virtual bool close_further(double /*h*/) { return false; }
    /// Thermostat: mixes velocities with noise. The next kick() projects them.
    virtual void thermalise(Thermostat const&, std::uint64_t step) = 0;
    /// Takes a step from x_n to x_n+1. Configuration, matrices and forces must be up to date at
    /// x_n; at x_n+1 only the configuration is. Collective.
    virtual void step(ConstrainedStep const& step) { take_step(*this, step); }
    /// Draws projected thermal velocities of temperature kt (kJ/mol) for the chosen chains.
    /// Matrices must be assembled. Collective.
    virtual void draw_velocities(double kt, std::uint64_t seed,
                                 std::vector<bool> const& of_chain) = 0;

    /// Largest violation of a joint at the current positions, over all ranks. Links count relative
    /// to their length, other joints relative to the longest distance of a joint from its bodies'
    /// centres. Collective.
    virtual double constraint_error() = 0;

    /// The full state, as checkpoints store it.
    virtual std::vector<StateArray> state() const = 0;
    /// Restores a state from state(); arrays are found by name.
    virtual void set_state(std::vector<StateArray> const&) = 0;
    /// Returns what observers see: positions, and the velocities of the last observe(). Waits.
    virtual ObservedMotion observed() = 0;
    /// Computes accelerations and joint forces by one bias sweep. It uses the current
    /// configuration, matrices and forces and the last observed velocities. Collective.
    virtual void evaluate() = 0;
    /// Assembles matrices and calls evaluate(). Backends may fuse both, since there is no force
    /// computation to overlap with. Collective.
    virtual void evaluate_at_once() {
        assemble_matrices();
        evaluate();
    }
    /// Times the solver's part of evaluate_at_once(), in seconds (ChainSolver::time_evaluations()).
    /// Collective.
    virtual std::vector<double> time_at_once(int chained, int repeat) = 0;
    /// Results of the last evaluate(), W.
    virtual BodyResults results() const = 0;
    /// Largest local backward residual of the last evaluate() over all ranks (src/dca/README.md,
    /// "Residuals"). Collective.
    virtual double residual() = 0;
    /// Potential energy at the current positions. Collective.
    virtual PotentialEnergy potential() = 0;
    /// Takes the forces out of OpenMM's arrays, which its computation of energies overwrites.
    virtual void settle_forces() {}

    /// The solver, for its report and its checks.
    virtual ChainSolver& solver() const = 0;
};

/// Dynamics of point beads on links, on the host.
std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&,
                                                     Executor const&, Communicator const&,
                                                     std::unique_ptr<ChainSolver>);
/// Dynamics of rigid bodies on spherical joints, or on links together with point beads, on the
/// host. `implicit_step`: the step length h of implicit joint springs; 0 for explicit ones.
std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const&, Scene const&,
                                                      Executor const&, Communicator const&,
                                                      std::unique_ptr<ChainSolver>,
                                                      double implicit_step = 0);

/// The array with the given name. Throws ComputationError if the state has none.
StateArray const& array_named(std::vector<StateArray> const&, std::string const& name);

/// Copies a field over bodies into a named array.
template <int D>
StateArray to_array(std::string const& name, ConstView<D> field, Executor const& executor) {
    StateArray a{name, D, std::vector<double>(static_cast<std::size_t>(field.size * D))};
    executor.for_each(field.size, [&](std::int64_t k) {
        for (int i = 0; i < D; ++i) a.values[static_cast<std::size_t>(k * D + i)] = field.at(k, i);
    });
    return a;
}
/// Copies an array into a field over bodies.
template <int D>
void from_array(StateArray const& a, View<D> field, Executor const& executor) {
    executor.for_each(field.size, [&](std::int64_t k) {
        for (int i = 0; i < D; ++i) field.at(k, i) = a.values[static_cast<std::size_t>(k * D + i)];
    });
}

}  // namespace catena
