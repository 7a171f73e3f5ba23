// Stability study of all backends on difficult chains.
#include "measure/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <utility>

#include "clock.hpp"
#include "error.hpp"
#include "measure/growth.hpp"
#include "measure/solver_errors.hpp"
#include "scene/freedom.hpp"

namespace catena {
namespace {

// bodies up to which the reference has 113 bits, and above which the growth has one perturbation
constexpr std::int64_t largest_quad_here = 5000;
constexpr std::int64_t few_nudges_above = 100000;
constexpr int refinements = 2, most_refinements = 10;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Returns the median; NaN if a value is NaN.
double median(std::vector<double> const& values) {
    auto const number = [](double v) { return v == v; };
    return std::all_of(values.begin(), values.end(), number)
               ? spread_of(values).median
               : std::numeric_limits<double>::quiet_NaN();
}

/// Results of one backend with one kind of handles, over the seeds.
struct Variant {
    struct Errors {
        std::vector<double> residual, error, cost;
    };
    SolverSpec solver;
    std::array<Errors, refinements + 1> after;  // indexed by the number of refinement steps
    Errors settled;                             // after as many steps as help
    int steps = 0;                              // number of these steps, largest over the seeds
    std::vector<double> residual_bound, bound;
    std::string refused;
};

/// Returns all combinations that support the chain.
std::vector<Variant> variants_of(ChainSpec const& chain, std::vector<Backend> const& backends,
                                 std::vector<Handles> const& handles) {
    std::vector<Variant> all;
    for (Backend const backend : backends)
        for (Handles const kind : handles) {
            if (kind == Handles::articulated && !scene::takes_articulated_handles(chain)) continue;
            Variant variant;
            variant.solver.backend = backend;
            variant.solver.handles = kind;
            all.push_back(variant);
        }
    return all;
}

template <class Action>
double seconds_of(Action const& action) {
    double const start = seconds_now();
    action();
    return seconds_now() - start;
}

/// Solves one seed's scene and adds the errors to the variant.
void add(Variant& to, Scene& scene, ExactSolution const& exact) {
    auto const communicator = serial_communicator();
    scene.solver = to.solver;
    try {
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();  // allocates memory
        double const evaluation = seconds_of([&] {
            system.evaluate();
            system.wait();
        });
        to.residual_bound.push_back(system.residual_bound());
        to.bound.push_back(system.residual_bound() * exact.growth);
        auto const look = [&](Variant::Errors& errors) {
            errors.residual.push_back(system.residual());
            errors.error.push_back(
                largest_difference(scene, solution_of(system), exact.acceleration));
            return errors.error.back();
        };
        double before = look(to.after.front()), error = before;
        if (system.joint().empty()) return;
        auto const refine = [&] { return seconds_of([&] { system.refine(); }) / evaluation; };
        for (int step = 1; step <= refinements; ++step) {
            Variant::Errors& errors = to.after[static_cast<std::size_t>(step)];
            errors.cost.push_back(refine());
            before = std::exchange(error, look(errors));
        }
        int steps = refinements;
        Variant::Errors settled{{to.after.back().residual.back()}, {error}, {}};
        for (; steps < most_refinements && error > to.residual_bound.back() && error < before / 2;
             ++steps) {
            settled.cost.push_back(refine());
            before = std::exchange(error, look(settled));
            if (error <= before) continue;  // the known answer tells if the step helped
            settled.residual.pop_back();
            error = before;
        }
        to.settled.residual.push_back(settled.residual.back());
        to.settled.error.push_back(error);
        to.settled.cost.push_back(settled.cost.empty() ? to.after.back().cost.back()
                                                       : settled.cost.back());
        to.steps = std::max(to.steps, steps);
    } catch (ComputationError const& error) {
        to.refused = error.what();
    }
}

/// Returns the largest ratio of a value to its bound.
double largest_ratio(std::vector<double> const& values, std::vector<double> const& bounds) {
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i) worst = larger(worst, values[i] / bounds[i]);
    return worst;
}

/// Summarises a variant over its seeds.
StabilityPoint point_of(Variant const& v) {
    Variant::Errors const& plain = v.after.front();
    StabilityPoint point{name_of(v.solver.backend),
                         name_of(v.solver.handles),
                         median(plain.residual),
                         median(v.residual_bound),
                         median(plain.error),
                         largest_ratio(plain.residual, v.residual_bound),
                         largest_ratio(plain.error, v.bound),
                         v.refused};
    auto const refined = [&](Variant::Errors const& errors) {
        return StabilityPoint::Refined{median(errors.error),
                                       largest_ratio(errors.residual, v.residual_bound),
                                       largest_ratio(errors.error, v.bound), median(errors.cost)};
    };
    for (std::size_t i = 1; i < v.after.size() && !v.after[i].error.empty(); ++i)
        point.refined.push_back(refined(v.after[i]));
    if (!v.settled.error.empty()) point.settled = refined(v.settled);
    point.steps = v.steps;
    return point;
}

/// Results of one peer, over the seeds.
struct PeerErrors {
    std::string name, why_not;
    std::vector<double> error;
};

/// Adds a peer's answer for one seed.
void add(PeerErrors& to, PeerAnswer const& answer, Scene const& scene, Solution layout,
         ExactSolution const& exact) {
    to.name = answer.name;
    if (to.why_not.empty()) to.why_not = answer.why_not;
    if (to.why_not.empty() && answer.acceleration.size() != exact.acceleration.size())
        to.why_not = "its answer has another length";
    if (!to.why_not.empty()) return;
    layout.acceleration = answer.acceleration;
    to.error.push_back(largest_difference(scene, layout, exact.acceleration));
    if (!std::isfinite(to.error.back())) to.why_not = "its answer is not finite";
}

StabilityPeer peer_of(PeerErrors const& p) {
    return {p.name, p.why_not.empty() ? median(p.error) : infinite, p.why_not};
}

/// A case with one seed, its reference and the error of articulated bodies in double precision.
struct KnownCase {
    Scene scene;
    Solution layout;
    ExactSolution exact;
    double error_in_double = infinite;
};

/// Returns the error of articulated bodies in double precision; infinite if they find no answer.
double error_in_double(Scene const& scene, Solution layout, ExactSolution const& exact) {
    try {
        layout.acceleration = oracle_accelerations<double>(scene, {});
    } catch (ComputationError const&) {
        return infinite;
    }
    return largest_difference(scene, layout, exact.acceleration);
}

KnownCase known_case(StabilityCase const& which, int seed) {
    KnownCase known{which.scene(static_cast<std::uint64_t>(seed)), {}, {}};
    known.layout = layout_of(known.scene);
    known.exact = exact_solution(known.scene, known.layout, largest_quad_here,
                                 which.bodies > few_nudges_above ? 1 : 3);
    known.error_in_double = error_in_double(known.scene, known.layout, known.exact);
    return known;
}

/// Computes the references of all seeds concurrently, because an oracle has one thread per chain.
/// No times are measured meanwhile.
std::vector<KnownCase> known_cases(StabilityCase const& which, int seeds) {
    std::vector<std::future<KnownCase>> finding;
    for (int seed = 1; seed <= seeds; ++seed)
        finding.push_back(std::async(std::launch::async, known_case, which, seed));
    std::vector<KnownCase> known;
    for (std::future<KnownCase>& each : finding) known.push_back(each.get());
    return known;
}

}  // namespace

char const* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::valid:
            return "VALID";
        case Verdict::refined:
            return "REFINED";
        case Verdict::articulated:
            return "ARTICULATED";
        case Verdict::beyond:
            return "BEYOND";
        case Verdict::lost:
            return "LOST";
        default:
            return "INVALID";
    }
}

double StabilityPoint::plain_error() const { return refused.empty() ? error : infinite; }
double StabilityPoint::last_error() const {
    return refused.empty() && settled ? settled->error : plain_error();
}

double StabilityStudy::best_of_others() const {
    double best = std::isfinite(oracle_error) ? oracle_error : infinite;
    for (StabilityPeer const& peer : peers)
        if (peer.why_not.empty()) best = std::min(best, peer.error);
    return best;
}

double StabilityStudy::worst(double (StabilityPoint::*error)() const) const {
    double worst = 0;
    for (StabilityPoint const& p : points)
        if (!p.is_articulated()) worst = larger(worst, (p.*error)());
    return worst;
}

double StabilityStudy::against_peers(bool articulated) const {
    double const allowed = 4 * best_of_others();
    double worst = 0;
    for (StabilityPoint const& p : points) {
        if (p.is_articulated() != articulated) continue;
        double const bound = p.settled ? p.residual_bound : p.residual_bound * growth;
        if (double const error = p.last_error(); error != 0)
            worst = larger(worst, error / std::max(allowed, bound));
    }
    return worst;
}

bool StabilityStudy::all(bool articulated,
                         std::function<bool(StabilityPoint const&)> const& holds) const {
    return std::all_of(points.begin(), points.end(), [&](StabilityPoint const& p) {
        return p.is_articulated() != articulated || holds(p);
    });
}

/// If the equations of joint forces lose all digits, an answer must still be exact for a nearby
/// chain, or refused. The verdict then tells if articulated or other handles keep the digits.
Verdict StabilityStudy::verdict() const {
    if (points.empty()) return Verdict::invalid;
    bool const has_articulated = std::any_of(
        points.begin(), points.end(), [](StabilityPoint const& p) { return p.is_articulated(); });
    bool const articulated_good =
        all(true, &StabilityPoint::holds_refined) && against_peers(true) <= 1;
    bool const good = all(false, &StabilityPoint::holds_refined) && against_peers(false) <= 1;
    if (beyond()) {
        if (!all(false, &StabilityPoint::is_nearby) || !all(true, &StabilityPoint::is_nearby))
            return Verdict::invalid;
        if (good && articulated_good) return Verdict::refined;
        if (has_articulated && articulated_good) return Verdict::articulated;
        return best_of_others() <= 1e-3 && !ill_conditioned() ? Verdict::lost : Verdict::beyond;
    }
    if (!good || !articulated_good) return Verdict::invalid;
    return all(false, &StabilityPoint::holds) && all(true, &StabilityPoint::holds)
               ? Verdict::valid
               : Verdict::refined;
}

StabilityStudy study_stability(StabilityCase const& which, std::vector<Backend> const& backends,
                               std::vector<Handles> const& handles, int seeds,
                               AskPeers const& peers) {
    StabilityStudy study{which.family, which.name, {}, which.bodies, seeds, {}, 1, 0, {}};
    std::vector<PeerErrors> of_peers;
    std::vector<Variant> variants = variants_of(which.scene(1).chains.front(), backends, handles);
    if (variants.empty()) return study;
    std::vector<double> condition, growth, in_double;
    std::vector<KnownCase> known = known_cases(which, seeds);
    for (KnownCase& each : known) {
        Scene& scene = each.scene;
        ExactSolution const& exact = each.exact;
        study.reference = exact.by;
        growth.push_back(exact.growth);
        if (which.bodies <= largest_condition)
            condition.push_back(oracle::condition_estimate(scene.chains.front()));
        in_double.push_back(each.error_in_double);
        std::vector<PeerAnswer> const answers =
            peers ? peers(which, scene) : std::vector<PeerAnswer>{};
        of_peers.resize(answers.size());
        for (std::size_t i = 0; i < answers.size(); ++i)
            add(of_peers[i], answers[i], scene, each.layout, exact);
        for (Variant& variant : variants) add(variant, scene, exact);
    }
    study.growth = median(growth);
    if (!condition.empty()) study.condition = median(condition);
    study.oracle_error = median(in_double);
    for (Variant const& v : variants) study.points.push_back(point_of(v));
    for (PeerErrors const& p : of_peers) study.peers.push_back(peer_of(p));
    return study;
}

}  // namespace catena
