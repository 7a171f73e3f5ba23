// A step of chains of point beads, part by part, for whatever carries it out: loop after loop over
// all chains (BeadDynamics), or a block of threads that takes whole chains through everything, so
// that a step is one launch.
//
// A `Way` has each_bead(action) and each_bead(make, take) for take(k, make(k)), where make is long,
// each_link(action) and each_tip(action), from_inboard() and from_outboard() for the positions of
// neighbours elsewhere, assemble() for the matrices of the directions of now, project(momentum,
// out) and close(bias, tip_bias, out), which solve for them.
#pragma once

#include "dca/body_leaf.hpp"
#include "dca/tree_sweeps.hpp"
#include "dynamics/bead_part.hpp"
#include "dynamics/constrained_step.hpp"

namespace catena {

template <class Way, class Fields = BeadFields>
struct BeadStep {
    BeadChainsIn<Fields> c;
    Way way;

    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void update_configuration() const {
        way.from_inboard();
        way.from_outboard();
        way.each_link([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_direction(k); });
        way.each_tip([c = c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_direction(i); });
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void assemble_matrices() const { way.assemble(); }

    /// out = P (v + h M^-1 f): the solver with momenta in the place of forces gives velocities in
    /// the place of accelerations.
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void project(double h, typename Fields::template Found<3> out) const {
        way.each_bead([c = c, h] CATENA_LAMBDA(std::int64_t k) { c.set_momentum(k, h); });
        way.project(c.momentum, out);
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void kick(double h) const { project(h, c.velocity); }

    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void drift(double h, int sweeps) const {
        way.each_bead([c = c, h] CATENA_LAMBDA(std::int64_t k) { c.drift(k, h); });
        for (int sweep = 0; sweep < sweeps; ++sweep) close(h);
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void close(double h) const {
        way.from_inboard();
        way.each_bead([c = c] CATENA_LAMBDA(std::int64_t k) { c.set_excess(k); });
        way.each_tip([c = c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_excess(i); });
        way.close(c.bias, c.tip_bias, c.change);
        way.each_bead(
            [c = c, per_step = 1.0 / h] CATENA_LAMBDA(std::int64_t k) { c.close(k, per_step); });
    }
    CATENA_EITHER_SIDE
    CATENA_HD_IN_PLACE void thermalise(Thermostat const& t, std::uint64_t step) const {
        way.each_bead(
            [c = c, t, step] CATENA_LAMBDA(std::int64_t k) { return c.noise(k, t.seed, step); },
            [c = c, t] CATENA_LAMBDA(std::int64_t k, Vec3 const& noise) {
                c.thermalise(k, t.keep, t.spread, noise);
            });
    }
};

/// The way of a block of whole chains.
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

/// A whole step on one block's chains, or (bead_part.hpp) on those that a team of threads keeps in
/// registers.
template <class Leaf>
struct StepOfChains {
    static constexpr int K = Leaf::K;
    dca::TreeSweeps<Leaf> sweeps;
    BeadChains chains;
    ConstrainedStep step;
    bool forces_are_ahead = false;  // `forces` are to be taken; else they are in the chains' array
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
