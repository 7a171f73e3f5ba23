// Chains in absolute coordinates (positions of beads; poses of bodies on spherical joints) as the
// constrained integrators see them: every projection is a bias sweep of the divide-and-conquer
// solver, with impulses in the place of forces.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/solver.hpp"
#include "dynamics/constrained_step.hpp"
#include "kinematics/carried_beads.hpp"
#include "kinematics/link_geometry.hpp"

namespace catena {

/// What a tip's joint does to the last body, W; torque about the origin of its joint frame.
struct TipForce {
    std::int64_t chain = 0;  // of the scene
    Vector<double, 6>
        wrench{};  // constraint [torque, force]; in a plane: what the chain's own directions know
};

/// Accelerations and forces body by body, ground axes, for output and checks.
struct BodyResults {
    std::vector<Vec3> alpha;         // angular; empty for beads
    std::vector<Vec3> acceleration;  // of the centre of mass
    std::vector<Vector<double, 6>>
        joint_force;  // constraint [torque, force] on body k at its inboard joint
    std::vector<TipForce> tip_force;
};

/// Body by body, this rank's.
struct PotentialEnergy {
    std::vector<double> gravity, springs, fixman;  // fixman: where the scene asks for it
};

/// The larger of two; a NaN counts as the largest.
inline double larger(double a, double b) { return b > a || b != b ? b : a; }

/// A residual over the size of its terms.
inline double relative(double difference, double terms) {
    return terms == 0 ? 0.0 : std::abs(difference) / terms;
}

/// A field over last bodies, of any space; absent where the group has no jointed tips.
template <class Directions>
DirectionsView of_tips(ChainGroup const& group, Directions& field) {
    return group.has_tips() ? field.view() : DirectionsView{};
}

/// The group's chains on this rank.
std::vector<LocalPiece> local_pieces(ChainGroup const&, Scene const&);
/// And where they are held, rings that only begin here behind the others; `end(k)`: where the
/// outboard end of last body k starts, W.
template <class End>
std::vector<HeldTip> held_tips(ChainGroup const& group, End const& end) {
    std::vector<HeldTip> tips;
    for (LocalTip const& tip : group.tips) {
        Vec3 const start = end(tip.body), anchor = tip.joint.anchor.value_or(start);
        tips.push_back(
            {tip.body, anchor, tip.joint.length > 0 ? tip.joint.length : norm(anchor - start)});
    }
    for (std::size_t i = 0; i < group.rings.size(); ++i) {
        LocalRing const& ring = group.rings[i];
        if (ring.last < 0) tips.emplace_back();
        HeldTip& tip = ring.last < 0 ? tips.back() : tips[group.tip_index(ring.last)];
        tip.ring = static_cast<std::int64_t>(i);
        tip.first = ring.first;
    }
    return tips;
}
/// No springs.
PotentialEnergy potential_in(Vec3 const& gravity, ChainGroup const&, Field<3> const& position);

/// A named array of the state, `width` numbers a body.
struct StateArray {
    std::string name;
    int width = 0;
    std::vector<double> values;  // this rank's bodies, one after the other
};

class AbsoluteDynamics : public BeadHost {
  public:
    /// Directions and neighbours' positions for the current positions. Collective.
    virtual void update_configuration() = 0;
    /// Matrices at the configuration updated last. Needs no forces. Collective.
    virtual void assemble_matrices() = 0;
    /// Sets the forces of gravity, wrenches and joint springs at the configuration updated last.
    /// Collective.
    virtual void set_simple_forces() = 0;

    /// v <- P (v + h M^-1 f), P the projection on the joints' velocities at the current
    /// configuration. Collective.
    virtual void kick(double h) = 0;
    /// What kick(h) would make of the velocities, into a copy (see observed_state). Collective.
    virtual void observe(double h) = 0;
    /// Positions by h along the velocities, impulses along the joints of the configuration updated
    /// last added in `sweeps` quasi-Newton sweeps so that the joints close at the end; velocities
    /// become the drift's. Collective.
    virtual void drift(double h, int sweeps) = 0;
    /// One more sweep of the drift by h that was done last, as if it had been asked for at once;
    /// false: ask for it at once. Precondition: nothing but constraint_error() has been called
    /// since. Collective.
    virtual bool close_further(double /*h*/) { return false; }
    /// Velocities between those of before and noise, which kick() then projects.
    virtual void thermalise(Thermostat const&, std::uint64_t step) = 0;
    /// From x_n, where configuration, matrices and forces are ready, to x_n+1, where the
    /// configuration is. Collective.
    virtual void step(ConstrainedStep const& step) { take_step(*this, step); }
    /// Velocities of temperature kt, projected; matrices must be assembled. Collective.
    virtual void draw_velocities(double kt, std::uint64_t seed,
                                 std::vector<bool> const& of_chain) = 0;

    /// Largest violation of a joint over all ranks at the current positions: links relative to
    /// their length, other joints relative to the longest distance of a joint from its bodies'
    /// centres. Collective.
    virtual double constraint_error() = 0;

    /// Everything that a checkpoint needs.
    virtual std::vector<StateArray> state() const = 0;
    virtual void set_state(std::vector<StateArray> const&) = 0;
    /// `position`, for bodies `orientation`, and the velocities of the last observe(): `velocity`
    /// (W) and for bodies `omega` (B).
    virtual std::vector<StateArray> observed_state() const = 0;
    /// Accelerations and joint forces at the configuration, matrices and forces of now and the
    /// velocities observed last: one bias sweep. Collective.
    virtual void evaluate() = 0;
    /// Matrices and evaluate() together, where neither has anything to hide behind it. Collective.
    virtual void evaluate_at_once() {
        assemble_matrices();
        evaluate();
    }
    /// Seconds of the solver's part of evaluate_at_once() (ChainSolver::time_evaluations).
    /// Collective.
    virtual std::vector<double> time_at_once(int chained, int repeat) = 0;
    /// Of the last evaluate(), ground axes.
    virtual BodyResults results() const = 0;
    /// Largest local backward residual of the last evaluate() (src/dca/README.md, "Residuals"),
    /// over all ranks. Collective.
    virtual double residual() = 0;
    /// At the current positions. Collective.
    virtual PotentialEnergy potential() = 0;

    virtual ChainSolver& solver() const = 0;
};

std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&,
                                                     Executor const&, Communicator const&,
                                                     std::unique_ptr<ChainSolver>);
/// Rigid bodies on spherical joints, or on links among point beads.
std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const&, Scene const&,
                                                      Executor const&, Communicator const&,
                                                      std::unique_ptr<ChainSolver>,
                                                      double implicit_step = 0);

/// One array of the given name; throws ComputationError if it is not there.
StateArray const& array_named(std::vector<StateArray> const&, std::string const& name);

template <int D>
StateArray to_array(std::string const& name, ConstView<D> field, Executor const& executor) {
    StateArray a{name, D, std::vector<double>(static_cast<std::size_t>(field.size * D))};
    executor.for_each(field.size, [&](std::int64_t k) {
        for (int i = 0; i < D; ++i) a.values[static_cast<std::size_t>(k * D + i)] = field.at(k, i);
    });
    return a;
}
template <int D>
void from_array(StateArray const& a, View<D> field, Executor const& executor) {
    executor.for_each(field.size, [&](std::int64_t k) {
        for (int i = 0; i < D; ++i) field.at(k, i) = a.values[static_cast<std::size_t>(k * D + i)];
    });
}

}  // namespace catena
