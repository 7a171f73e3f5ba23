// The operators of a step in joint coordinates in any Space (JointOperator), and what a step is
// measured by.
#pragma once

#include "dynamics/joint/joint_evaluation.hpp"
#include "dynamics/joint/joint_noise.hpp"

namespace catena::joint_coordinates {

/// Applies one stage to all bodies, and sets relative motions unless the next update does so.
template <bool positions, class Space>
void accumulate(JointBodies<Space>& bodies, WeightedStage const& stage) {
    JointSteps const s = bodies.steps();
    bodies.template each_body<positions>(
        [&](JointLoops const& loops, auto... lanes) { loops.accumulate(s, stage, lanes...); },
        [s, stage] CATENA_LAMBDA(std::int64_t k) { s.template accumulate<positions>(k, stage); });
    bodies.motion.changed_state(!s.chains.left.motions);
}
template <bool positions, class Space>
void embedded_stage(JointBodies<Space>& bodies, EmbeddedStage const& stage) {
    EmbeddedSteps const s = bodies.embedded();
    bodies.template each_body<positions>(
        [&](JointLoops const& loops, auto... lanes) { loops.embedded_stage(s, stage, lanes...); },
        [s, stage] CATENA_LAMBDA(std::int64_t k) { s.template advance<positions>(k, stage); });
    bodies.motion.changed_state(!s.steps.chains.left.motions);
}
template <bool positions, class Space>
void drift_saved(JointBodies<Space>& bodies, double h) {
    JointSteps const s = bodies.steps();
    double const time = bodies.state.clock.now + h;
    bodies.space.for_each(bodies.group.size, [s, h, time] CATENA_LAMBDA(std::int64_t k) {
        s.template drift_saved<positions>(k, h, time);
    });
    bodies.motion.changed_state(!s.chains.left.motions);
}
template <bool positions, class Space>
void drift(JointBodies<Space>& bodies, double h) {
    JointSteps const s = bodies.steps();
    double const time = bodies.state.clock.now + h;
    bodies.space.for_each(bodies.group.size, [s, h, time] CATENA_LAMBDA(std::int64_t k) {
        s.template drift<positions>(k, h, time);
    });
    bodies.motion.changed_state(true);
}
template <class Space>
void kick(JointBodies<Space>& bodies, double h, bool by_saved) {
    JointSteps const s = bodies.steps();
    bodies.space.for_each(bodies.group.size, [s, h, by_saved] CATENA_LAMBDA(std::int64_t k) {
        s.kick(k, h, by_saved);
    });
    bodies.motion.changed_state(false);
}
template <class Space>
void kick_mean(JointBodies<Space>& bodies, double h) {
    JointSteps const s = bodies.steps();
    bodies.space.for_each(bodies.group.size,
                          [s, h] CATENA_LAMBDA(std::int64_t k) { s.kick_mean(k, h); });
    bodies.motion.changed_state(false);
}

/// Mixes velocities with normal noise, whose covariance is the inverse of the mass matrix at the
/// current coordinates, including the parts of springs and dampers. `step` keys the noise.
template <class Space>
void thermalise(JointBodies<Space>& bodies, Thermostat const& thermostat, std::uint64_t step) {
    ChainGroup const& group = bodies.group;
    bodies.loads.leave_beads();
    update_all(bodies, false);
    assemble_matrices(bodies);
    typename Space::template FieldOf<3>& force = bodies.force_of_noise();
    JointChains noisy = bodies.chains();
    noisy.force = force.view();
    bodies.space.for_each(
        group.size, [noisy, piece = bodies.pieces.data(), pieces = std::ssize(group.pieces),
                     seed = thermostat.seed, step] CATENA_LAMBDA(std::int64_t k) {
            set_noise(noisy, k, piece_of(piece, pieces, k).body_of(k), seed, step);
        });
    if (group.ends.has_tips()) bodies.tips.set_no_bias(bodies.motion.view());
    bodies.solver.solve({bodies.loads.torque.view(),
                         force.view(),
                         {},
                         bodies.loads.bias.view(),
                         of_tips(group, bodies.tips.bias())},
                        bodies.solution.accelerations());
    JointSteps const still = bodies.at_rest();
    bodies.exchange_ends(still.chains);
    bodies.space.for_each(group.size,
                          [still, state = bodies.state.now.view(), keep = thermostat.keep,
                           spread = thermostat.spread] CATENA_LAMBDA(std::int64_t k) {
                              still.mix(k, state, keep, spread);
                          });
    bodies.motion.changed_state(false);
}

/// One Newton step that closes tips and loops: the solver with openings instead of velocity terms.
template <class Space>
void project(JointBodies<Space>& bodies, bool velocities) {
    move(bodies);
    assemble_matrices(bodies);
    LoadsView open;
    if (bodies.group.ends.has_tips()) {
        bodies.tips.set_opening(bodies.motion.view(), velocities);
        open.tip_bias = bodies.tips.bias().view();
    }
    bodies.closed_loops.set_opening(velocities);
    open.loop_bias = bodies.closed_loops.bias().data();
    bodies.solver.solve(open, bodies.solution.accelerations());
    if (velocities && bodies.closed_loops.any() && !bodies.group.joints.drives.empty())
        bodies.closed_loops.refuse_parting(bodies.solution.alpha.view(),
                                           bodies.solution.acceleration.view());
    JointSteps const still = bodies.at_rest();
    bodies.exchange_ends(still.chains);
    bodies.space.for_each(bodies.group.size,
                          [still, state = bodies.state.now.view(), velocities] CATENA_LAMBDA(
                              std::int64_t k) { still.correct(k, state, velocities); });
}

/// JointDynamics::apply().
template <bool positions, class Space>
void apply(JointBodies<Space>& bodies, JointOperation const& op, double h) {
    double const duration = h / op.divisor;
    JointClock& clock = bodies.state.clock;
    switch (op.what) {
        case JointOperator::evaluate:
        case JointOperator::evaluate_again:
            throw std::logic_error("evaluations are not operators of JointDynamics");
        case JointOperator::assemble:
            return assemble_matrices(bodies);
        case JointOperator::set_rates:
            return bodies.set_rates(bodies.state.rates.view());
        case JointOperator::save:
            return bodies.set_rates(bodies.state.saved.view());
        case JointOperator::kick:
        case JointOperator::kick_saved:
            return kick(bodies, duration, op.what == JointOperator::kick_saved);
        case JointOperator::kick_mean:
            return kick_mean(bodies, duration);
        case JointOperator::drift:
            drift<positions>(bodies, duration);
            clock.now += duration;
            return;
        case JointOperator::drift_saved:
            drift_saved<positions>(bodies, duration);
            clock.now += duration;
            return;
        case JointOperator::noise:
            return thermalise(bodies, op.thermostat, op.number);
        case JointOperator::accumulate: {
            if (op.first) clock.start = clock.now;
            double const next = h / op.next;
            WeightedStage const s{op.first, op.last, duration, next, clock.start + next};
            accumulate<positions>(bodies, s);
            clock.now = s.time;
            return;
        }
        case JointOperator::embedded_stage:
            if (!bodies.state.pair) bodies.state.pair.emplace(bodies.group);
            embedded_stage<positions>(bodies, op.stage);
            clock.now = op.stage.time;
            return;
        case JointOperator::project:
            return project(bodies, false);
        case JointOperator::project_velocities:
            return project(bodies, true);
    }
}

template <class Space>
double largest_trouble(JointBodies<Space>& bodies) {
    return bodies.space.largest(
        bodies.group.size,
        [s = bodies.steps()] CATENA_LAMBDA(std::int64_t k) -> double { return s.trouble(k); });
}
template <class Space>
double largest_divergence(JointBodies<Space>& bodies, double length) {
    return bodies.space.largest(
        bodies.group.size, [s = bodies.embedded(), length] CATENA_LAMBDA(std::int64_t k) -> double {
            return s.stage_divergence(k, length);
        });
}
template <class Space>
double largest_speed(JointBodies<Space>& bodies, bool angular) {
    return bodies.space.largest(bodies.group.size,
                                [s = bodies.embedded(), angular] CATENA_LAMBDA(
                                    std::int64_t k) -> double { return s.speed(k, angular); });
}
template <class Space>
double largest_error(JointBodies<Space>& bodies, EmbeddedDifference const& d,
                     AllowedErrors const& allowed) {
    return bodies.space.largest(bodies.group.size,
                                [s = bodies.embedded(), d, allowed] CATENA_LAMBDA(
                                    std::int64_t k) -> double { return s.error(k, d, allowed); });
}

/// JointDynamics::largest().
template <class Space>
double largest(JointBodies<Space>& bodies, JointMeasure const& of) {
    switch (of.what) {
        case JointQuantity::trouble:
            return largest_trouble(bodies);
        case JointQuantity::opening:
            move(bodies);
            return larger(
                bodies.group.ends.has_tips() ? bodies.tips.error(bodies.motion.view()) : 0.0,
                bodies.closed_loops.error());
        case JointQuantity::divergence:
            return largest_divergence(bodies, of.length);
        case JointQuantity::angular_speed:
        case JointQuantity::linear_speed:
            return largest_speed(bodies, of.what == JointQuantity::angular_speed);
        case JointQuantity::error:
            return largest_error(bodies, of.difference, of.allowed);
    }
    throw std::logic_error("no such quantity");
}

}  // namespace catena::joint_coordinates
