// Evaluation of forces, matrices and accelerations.
#include "integrate/system_evaluator.hpp"

#include <algorithm>

#include "terms/force_terms.hpp"

namespace catena {
namespace {

/// Updates the configuration of a group, for solve_once() or for other solutions.
void update(JointDynamics& group, bool to_solve_once) {
    to_solve_once ? group.update_to_solve_once() : group.update_configuration();
}

}  // namespace

void SystemEvaluator::forces_and_matrices(StepTimeline* timeline) {
    double const start = seconds_now();
    auto const note = [&](char const* name, char const* lane, double begin, double end) {
        // If there are several groups of chains, the last may finish before the first.
        if (timeline)
            timeline->phases.push_back({name, lane, begin - start, std::max(begin, end) - start});
    };
    if (openmm_) openmm_->begin(timeline != nullptr, times_);
    double const begun = seconds_now();
    for (auto const& group : absolute_) group->assemble_matrices();
    for (auto const& group : joint_) group->assemble_matrices();
    if (on_device())
        openmm_->go_on();
    else if (openmm_ || timeline)
        wait();  // lets the clock include the whole sweep; the forces are waited for anyway
    double const assembled = seconds_now();
    for (auto const& group : absolute_) group->set_simple_forces();
    double const simple = seconds_now();
    if (openmm_) openmm_->finish();
    if (added_forces_) added_forces_();
    for (auto const& group : absolute_) group->take_bead_forces();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    note("simple forces", "catena", assembled, simple);
    times_.seconds["kinematics and loads"] += simple - assembled;
    if (on_device()) {
        if (!timeline)
            return;  // the next evaluation reads the clock: no need to wait for the GPU now
        DevicePath::Clock const clock = openmm_->read_clock(times_);
        if (clock.openmm.end == 0) return;  // this rank has no beads
        note("matrix sweep", "catena", clock.chains.begin, clock.chains.end);
        note("forces", "openmm", clock.openmm.begin, clock.openmm.end);
        if (communicator_.size() > 1)
            note("exchange of positions", "messages", clock.exchange.begin, clock.exchange.end);
        return;
    }
    note("matrix sweep", "catena", begun, assembled);
    note_overlap(start, begun, assembled, simple, finished);
    if (!openmm_) return;
    Interval const ran = openmm_->force().last_evaluation(),
                   brought = openmm_->force().last_gathering();
    // Path inline computes the forces before begin_openmm() returns. The time before them is that
    // of passing on positions.
    note("hand over positions", "catena", start,
         ran.end <= begun ? std::clamp(ran.begin, start, begun) : begun);
    if (communicator_.size() > 1)
        note("exchange of positions", "messages", brought.begin, brought.end);
    note("wait for forces", "catena", simple, finished);
    note("forces", "openmm", ran.begin, ran.end);
}

void SystemEvaluator::solve_joint_groups() {
    double const start = seconds_now();
    for (auto const& group : joint_) update(*group, solves_once());
    double const moved = seconds_now();
    if (openmm_) openmm_->begin(false, times_);
    double const begun = seconds_now();
    if (!solves_once())
        for (auto const& group : joint_) group->assemble_matrices();
    if (openmm_) wait();
    double const assembled = seconds_now();
    if (openmm_) openmm_->finish();
    if (added_forces_) added_forces_();
    for (auto const& group : joint_) group->take_bead_forces();
    double const finished = seconds_now();
    for (auto const& group : joint_) {
        if (solves_once())
            group->solve_once();
        else
            group->solve();
        for (int step = 0; step < scene_.solver.refine; ++step) group->refine(*executor_);
    }
    times_.seconds["kinematics and loads"] += moved - start;
    times_.seconds["bias sweep"] += seconds_now() - finished;
    note_overlap(moved, begun, assembled, assembled, finished);
}

void SystemEvaluator::solve_joint_groups_again() {
    double const start = seconds_now();
    for (auto const& group : joint_) group->solve_again();
    times_.seconds["bias sweep"] += seconds_now() - start;
}

void SystemEvaluator::refine() {
    for (auto const& group : joint_) {
        group->refine(*executor_);
        group->set_rates();
    }
}

void SystemEvaluator::close_tips(int corrections) {
    for (auto const& group : joint_) group->close_tips(corrections);
}

/// Positions are passed on from `start` to `begun`, matrices are assembled until `assembled`, and
/// forces are waited for from `waits` to `finished`.
void SystemEvaluator::note_overlap(double start, double begun, double assembled, double waits,
                                   double finished) {
    times_.matrices += assembled - begun;
    times_.seconds["matrix sweep"] += assembled - begun;
    if (!openmm_) return;
    Interval const ran = openmm_->force().last_evaluation(),
                   brought = openmm_->force().last_gathering();
    double const exchange = communicator_.size() > 1 ? brought.end - brought.begin : 0.0;
    // Work that shares the forces' core delays them, so that nothing is hidden.
    bool const beside = openmm_->force().leaves_a_core() || uses_gpu(backend_);
    if (beside)
        times_.hidden += std::max(0.0, std::min(assembled, ran.end) - std::max(begun, ran.begin));
    times_.seconds["forces"] += ran.end - ran.begin;
    times_.seconds["waiting for forces"] += (finished - waits) + (begun - start) - exchange;
    if (communicator_.size() > 1) times_.seconds["exchange"] += exchange;
}

void SystemEvaluator::evaluate(bool project) {
    for (auto const& group : absolute_) group->update_configuration();
    bool const at_once = !project && solves_once() && !terms::any_of([&](auto term) {
        return term.needs_matrices && terms::acts_in<decltype(term)>(scene_);
    });
    for (auto const& group : joint_) update(*group, at_once);
    if (at_once)
        for (auto const& group : absolute_) group->set_simple_forces();
    else
        forces_and_matrices(nullptr);
    for (auto const& group : absolute_) {
        if (project) group->observe(0.0);
        if (at_once)
            group->evaluate_at_once();
        else
            group->evaluate();
    }
    for (auto const& group : joint_) {
        if (at_once)
            group->solve_once();
        else
            group->solve();
        group->set_rates();
    }
}

}  // namespace catena
