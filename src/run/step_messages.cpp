// Implements the prediction of messages. It repeats the sequence of calls that integrators and
// solvers make.
#include "run/step_messages.hpp"

#include <algorithm>

#include "dynamics/body_loads.hpp"

namespace catena {
namespace {

/// Sum of messages. `times`: number of messages; `numbers`: doubles per unit or body.
class Sum {
  public:
    explicit Sum(Cut const& cut) : cut_(cut) {}
    /// Gathers of the shared units' data by all ranks.
    void gathers(std::int64_t times, std::int64_t numbers) {
        if (cut_.shared_units == 0) return;
        std::int64_t const all = bytes(cut_.shared_units * numbers);
        Traffic one = cut_.way.within_and_between_hosts(all);
        one.gathers = 1;
        one.gathered_bytes = all;
        traffic_ += one * times;
    }
    /// Calls of exchange_from_inboard: the last body of a rank is sent to the following rank.
    void from_inboard(std::int64_t times, std::int64_t numbers) {
        exchanges(times, numbers, cut_.outboard);
    }
    /// Exchanges in the opposite direction.
    void from_outboard(std::int64_t times, std::int64_t numbers) {
        exchanges(times, numbers, cut_.inboard);
    }
    /// Calls of RingEnds::take.
    void from_ring_ends(std::int64_t times, std::int64_t numbers) {
        traffic_.exchanges += times * cut_.ring_ends;
        traffic_.sent_bytes += times * bytes(cut_.ring_ends * numbers);
    }
    /// Sweeps of the tree with K directions per handle (segment.hpp, articulated.hpp).
    void matrix_sweeps(std::int64_t times, std::int64_t k, bool articulated = false) {
        gathers(times, of_matrices(k, articulated));
    }
    void bias_sweeps(std::int64_t times, std::int64_t k, bool articulated = false) {
        gathers(times, of_biases(k, articulated));
    }
    /// Matrix and bias sweeps that are fused.
    void evaluations(std::int64_t times, std::int64_t k) {
        gathers(times, of_matrices(k, false) + of_biases(k, false));
    }
    Traffic const& traffic() const { return traffic_; }

  private:
    // Doubles per unit: the matrices of a segment, of which the symmetric ones are stored once.
    static std::int64_t of_matrices(std::int64_t k, bool articulated) {
        return articulated ? 3 * k * k + k * (k + 1) / 2 : 2 * k * k + k;
    }
    static std::int64_t of_biases(std::int64_t k, bool articulated) {
        return (articulated ? 3 : 2) * k;
    }
    static std::int64_t bytes(std::int64_t numbers) {
        return numbers * static_cast<std::int64_t>(sizeof(double));
    }
    /// Exchanges between consecutive ranks that share a chain.
    void exchanges(std::int64_t times, std::int64_t numbers, bool sends) {
        if (!cut_.inboard && !cut_.outboard) return;
        traffic_.exchanges += times;
        if (sends) traffic_.sent_bytes += times * bytes(numbers);
    }
    Cut cut_;
    Traffic traffic_;
};

/// Equal to ChainSolver::at_once() of the group's solver.
bool solves_at_once(ChainGroup const& group) {
    return group.handles == Handles::projected && group.directions < 6 &&
           group.partition.trees.front().run_length > 1;
}

}  // namespace

Cut cut_of(ChainGroup const& group, GatherWay const& way) {
    auto const shown = std::count_if(group.ends.rings.begin(), group.ends.rings.end(),
                                     [](LocalRing const& ring) { return !ring.is_whole(); });
    return {std::ssize(group.schedule.shared), group.neighbours.inboard >= 0,
            group.neighbours.outboard >= 0, shown, way};
}

StepMessages::StepMessages(ChainGroup const& group, Scene const& scene)
    : integrator_(scene.dynamics.integrator),
      sweeps_(sweeps_a_step(scene.dynamics, has_closures(scene))),
      directions_(group.directions),
      articulated_(group.handles == Handles::articulated),
      absolute_(group.beads || group.linked || group.axes == Axes::world),
      beads_(group.beads),
      implicit_(!group.joints.implicit.empty()),
      linked_(group.linked),
      moving_meeting_(group.joints.moving_meeting()),
      tips_(group.has_closures()),
      fixman_(scene.dynamics.fixman),
      at_once_(!keeps_matrices(scene) && solves_at_once(group)),
      refinements_(scene.solver.refine) {
    BodyLoads const loads = group.beads ? BodyLoads() : make_body_loads(group, scene);
    joint_loads_ = loads.joint_loads;
    springs_ = loads.springs;
}

Traffic StepMessages::a_step(int sweeps, Cut const& cut, int parts,
                             SweepsAStep const& solved) const {
    return absolute_ ? absolute(sweeps, parts, cut) : joint(sweeps, cut, solved);
}

/// Messages of ConstrainedIntegrator::step. Each of its drifts has its sweeps, its configuration,
/// its matrices and a projection.
Traffic StepMessages::absolute(int sweeps, int parts, Cut const& cut) const {
    std::int64_t const drifts = (is_langevin(integrator_) ? 2 : 1) * parts,
                       closings = drifts * sweeps;
    Sum sum(cut);
    sum.matrix_sweeps(drifts, directions_);
    sum.bias_sweeps(drifts + closings, directions_);
    sum.from_inboard(closings, 3);
    sum.from_ring_ends(closings, 3);
    if (beads_ || linked_) {
        sum.from_ring_ends(drifts, 3);
        std::int64_t const forces = fixman_ ? 1 : 0;
        sum.from_inboard(drifts + forces, 3);
        sum.from_outboard(drifts + forces, 3);
    } else {
        if (springs_) sum.from_inboard(drifts, 4);
        if (implicit_) {  // rotors: those of kicks, of each closing's flight, and of what it adds
            sum.from_inboard(drifts + closings, 3);
            sum.from_inboard(closings, 4);
        }
        if (joint_loads_) sum.from_outboard(1, 3);
    }
    return sum.traffic();
}

/// Messages of JointDynamics: evaluations, and the corrections of jointed tips, which are
/// evaluations without loads.
Traffic StepMessages::joint(int corrections, Cut const& cut, SweepsAStep const& solved) const {
    auto const [matrices, biases, closings] = solved;
    std::int64_t const more = tips_ ? closings * (corrections + 1) : 0, motions = biases + more,
                       refinements = matrices * refinements_;
    std::int64_t const at_once = at_once_ ? matrices : 0;
    Sum sum(cut);
    sum.gathers(motions, 13);
    sum.from_ring_ends(motions, 13);
    if (moving_meeting_) sum.from_outboard(motions, 9);
    if (joint_loads_) sum.from_outboard(biases, 4);
    sum.evaluations(at_once, directions_);
    sum.matrix_sweeps(matrices - at_once + more, directions_, articulated_);
    sum.bias_sweeps(motions - at_once + refinements, directions_, articulated_);
    sum.from_inboard(motions + refinements, 4);
    sum.from_inboard(refinements, 8);
    sum.from_ring_ends(refinements, 8);
    return sum.traffic();
}

}  // namespace catena
