// A step of chains of point beads as a sequence of parts. An execution policy runs them: loop after
// loop over all chains (BeadDynamics), or one block of threads that takes whole chains through the
// step in one launch.
//
// A policy `Way` has these members. each_bead(action), each_link(action), each_tip(action) and
// each_crosslink(action) run loops; each_bead(make, take) runs take(k, make(k)) with a long make().
// from_inboard() and from_outboard() fetch neighbours' positions. assemble() assembles the matrices
// for the current directions; project(momentum, out) and close(bias, tip_bias, out) solve with
// them.
#pragma once

#include "dca/body_leaf.hpp"
#include "dca/tree_sweeps.hpp"
#include "dynamics/bead_part.hpp"
#include "dynamics/constrained_step.hpp"

namespace catena {

/// The parts of a step, as take_step() calls them (constrained_step.hpp).
template <class Way, class Fields = BeadFields>
struct BeadStep {
    BeadChainsIn<Fields> c;
    Way way;

    /// Computes link directions at the current positions.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void update_configuration() const {
        way.from_inboard();
        way.from_outboard();
        way.each_link([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_direction(k); });
        way.each_tip([c = c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_direction(i); });
        way.each_crosslink([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_direction(k); });
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void assemble_matrices() const { way.assemble(); }

    /// Constraint projection out = P (v + h M^-1 f): with momenta instead of forces, the solver
    /// returns velocities instead of accelerations.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void project(double h, typename Fields::template Found<3> out) const {
        way.each_bead([c = c, h] CATENA_LAMBDA(std::int64_t k) { c.set_momentum(k, h); });
        way.project(c.momentum, out);
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void kick(double h) const { project(h, c.velocity); }

    /// Moves the beads for time h, then closes the links in `sweeps` sweeps.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void drift(double h, int sweeps) const {
        way.each_bead([c = c, h] CATENA_LAMBDA(std::int64_t k) { c.drift(k, h); });
        for (int sweep = 0; sweep < sweeps; ++sweep) close(h);
    }
    /// One quasi-Newton sweep that closes the links at the end of a drift of length h.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void close(double h) const {
        way.from_inboard();
        way.each_bead([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_excess(k); });
        way.each_tip([c = c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_excess(i); });
        way.each_crosslink([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_excess(k); });
        way.close(c.bias, c.tip_bias, c.change);
        way.each_bead(
            [c = c, per_step = 1.0 / h] CATENA_LAMBDA(std::int64_t k) { c.close(k, per_step); });
    }
    /// Mixes velocities with the thermostat's noise.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void thermalise(Thermostat const& t, std::uint64_t step) const {
        way.each_bead(
            [c = c, t, step] CATENA_LAMBDA(std::int64_t k) { return c.noise(k, t.seed, step); },
            [c = c, t] CATENA_LAMBDA(std::int64_t k, Vec3 const& noise) {
                c.thermalise(k, t.keep, t.spread, noise);
            });
    }
};

/// Execution policy of a block of threads that holds whole chains; it needs no exchange with
/// neighbours.
template <class Block, class Leaf>
struct WayOfBlock {
    Block const& block;
    dca::TreeSweeps<Leaf> const& sweeps;

    CATENA_EITHER_SIDE
    template <class Action>
    CATENA_HD void each_bead(Action const& action) const {
        block.each_body(action);
    }
    CATENA_EITHER_SIDE
    template <class Make, class Take>
    CATENA_HD void each_bead(Make const& make, Take const& take) const {
        block.each_body([make, take] CATENA_LAMBDA(std::int64_t k) { take(k, make(k)); });
    }
    CATENA_EITHER_SIDE
    template <class Action>
    CATENA_HD void each_link(Action const& action) const {
        block.each_body(action);
    }
    CATENA_EITHER_SIDE
    template <class Action>
    CATENA_HD void each_tip(Action const& action) const {
        block.each_tip(action);
    }
    CATENA_EITHER_SIDE
    template <class Action>
    CATENA_HD void each_crosslink(Action const&) const {}
    CATENA_HD void from_inboard() const {}
    CATENA_HD void from_outboard() const {}
    CATENA_EITHER_SIDE
    CATENA_HD void assemble() const { block.climb(dca::MatrixSweep<Leaf>{sweeps}); }
    CATENA_EITHER_SIDE
    CATENA_HD void project(View<3> momentum, View<3> out) const {
        block.climb_and_descend(
            dca::BiasSweep<Leaf>{sweeps, {{}, momentum, {}, {}, {}}, {{}, out, {}, {}}});
    }
    CATENA_EITHER_SIDE
    CATENA_HD void close(DirectionsView bias, DirectionsView tip_bias, View<3> out) const {
        block.climb_and_descend(
            dca::BiasSweep<Leaf>{sweeps, {{}, {}, {}, bias, tip_bias}, {{}, out, {}, {}}});
    }
};

/// A whole step of the chains of one block. If a team of threads keeps them in registers, it calls
/// step_of_part() (bead_part.hpp).
template <class Leaf>
struct StepOfChains {
    static constexpr int K = Leaf::K;
    dca::TreeSweeps<Leaf> sweeps;
    BeadChains chains;
    ConstrainedStep step;
    /// True if `forces` have not been summed into the chains' force array yet.
    bool forces_are_ahead = false;
    BeadForces forces;

    CATENA_EITHER_SIDE
    template <class Block>
    CATENA_HD void operator()(Block const& block) const {
        if constexpr (requires { block.place(); }) {
            step_of_part(block, *this);
        } else {
            if (forces_are_ahead)
                block.each_body([c = chains, f = forces] CATENA_LAMBDA(std::int64_t k) {
                    c.take_forces(k, f);
                });
            take_step(BeadStep<WayOfBlock<Block, Leaf>>{chains, {block, sweeps}}, step);
        }
    }
};

}  // namespace catena
