#include "report/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "report/growth.hpp"
#include "report/solver_errors.hpp"

namespace catena {
namespace {

constexpr std::int64_t largest_quad_here = 5000;
constexpr std::int64_t few_nudges_above = 100000;
constexpr int refinements = 2;
constexpr double infinite = std::numeric_limits<double>::infinity();

double median(std::vector<double> const& values) {
    auto const number = [](double v) { return v == v; };
    return std::all_of(values.begin(), values.end(), number) ? spread_of(values).median : std::numeric_limits<double>::quiet_NaN();
}

/// One way to solve, over the seeds.
struct Variant {
    struct Errors {
        std::vector<double> residual, error, cost;
    };
    SolverSpec solver;
    std::array<Errors, refinements + 1> after;  // so many steps of refinement
    std::vector<double> residual_bound, bound;
    std::string refused;
};

std::vector<Variant> variants_of(std::vector<Backend> const& backends, std::vector<Handles> const& handles) {
    std::vector<Variant> all;
    for (Backend const backend : backends)
        for (Handles const kind : handles) {
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

void add(Variant& to, Scene& scene, ExactSolution const& exact) {
    auto const communicator = serial_communicator();
    scene.solver = to.solver;
    try {
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();  // the first one finds its memory
        double const evaluation = seconds_of([&] { system.evaluate(); });
        to.residual_bound.push_back(system.residual_bound());
        to.bound.push_back(system.residual_bound() * exact.growth);
        for (Variant::Errors& errors : to.after) {
            bool const first = &errors == to.after.data();
            if (!first && (system.joint().empty() || system.backend() == Backend::cuda)) break;
            if (!first) errors.cost.push_back(seconds_of([&] { system.refine(); }) / evaluation);
            errors.residual.push_back(system.residual());
            errors.error.push_back(largest_difference(scene, solution_of(system), exact.acceleration));
        }
    } catch (ComputationError const& error) {
        to.refused = error.what();
    }
}

double largest_ratio(std::vector<double> const& values, std::vector<double> const& bounds) {
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i) worst = larger(worst, values[i] / bounds[i]);
    return worst;
}

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
    for (std::size_t i = 1; i < v.after.size() && !v.after[i].error.empty(); ++i)
        point.refined.push_back({median(v.after[i].error), largest_ratio(v.after[i].residual, v.residual_bound),
                                 largest_ratio(v.after[i].error, v.bound), median(v.after[i].cost)});
    return point;
}

/// One peer, over the seeds.
struct PeerErrors {
    std::string name, why_not;
    std::vector<double> error;
};

void add(PeerErrors& to, PeerAnswer const& answer, Scene const& scene, Solution layout, ExactSolution const& exact) {
    to.name = answer.name;
    if (to.why_not.empty()) to.why_not = answer.why_not;
    if (to.why_not.empty() && answer.acceleration.size() != exact.acceleration.size()) to.why_not = "its answer is of another length";
    if (!to.why_not.empty()) return;
    layout.acceleration = answer.acceleration;
    to.error.push_back(largest_difference(scene, layout, exact.acceleration));
    if (!std::isfinite(to.error.back())) to.why_not = "its answer is not finite";
}

StabilityPeer peer_of(PeerErrors const& p) { return {p.name, p.why_not.empty() ? median(p.error) : infinite, p.why_not}; }

double error_in_double(Scene const& scene, Solution layout, ExactSolution const& exact) {
    try {
        layout.acceleration = oracle_accelerations<double>(scene, {});
    } catch (ComputationError const&) {
        return infinite;
    }
    return largest_difference(scene, layout, exact.acceleration);
}

}  // namespace

char const* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::valid:
            return "VALID";
        case Verdict::refined:
            return "REFINED";
        case Verdict::beyond:
            return "BEYOND";
        case Verdict::lost:
            return "LOST";
        default:
            return "INVALID";
    }
}

double StabilityPoint::plain_error() const { return refused.empty() ? error : infinite; }
double StabilityPoint::last_error() const { return refused.empty() && !refined.empty() ? refined.back().error : plain_error(); }

double StabilityStudy::best_of_others() const {
    double best = std::isfinite(oracle_error) ? oracle_error : infinite;
    for (StabilityPeer const& peer : peers)
        if (peer.why_not.empty()) best = std::min(best, peer.error);
    return best;
}

double StabilityStudy::worst(double (StabilityPoint::*error)() const) const {
    double worst = 0;
    for (StabilityPoint const& p : points) worst = larger(worst, (p.*error)());
    return worst;
}

double StabilityStudy::against_peers() const {
    double const allowed = 4 * best_of_others();
    double worst = 0;
    for (StabilityPoint const& p : points) {
        double const bound = p.refined.empty() ? p.residual_bound * growth : p.residual_bound;
        if (double const error = p.last_error(); error != 0) worst = larger(worst, error / std::max(allowed, bound));
    }
    return worst;
}

/// Where the equations lose all digits an answer must still be the exact one of a chain nearby, or refused; whether others keep them is
/// said.
Verdict StabilityStudy::verdict() const {
    bool const all_hold = std::all_of(points.begin(), points.end(), [](StabilityPoint const& p) { return p.holds(); });
    bool const nearby = std::all_of(points.begin(), points.end(), [](StabilityPoint const& p) { return p.of_residual_bound <= 1; });
    if (beyond()) return !nearby ? Verdict::invalid : best_of_others() <= 1e-3 ? Verdict::lost : Verdict::beyond;
    if (!(against_peers() <= 1)) return Verdict::invalid;
    if (all_hold) return Verdict::valid;
    bool const with_refinement =
        std::all_of(points.begin(), points.end(), [](StabilityPoint const& p) { return p.holds() || p.holds_refined(); });
    return with_refinement ? Verdict::refined : Verdict::invalid;
}

StabilityStudy study_stability(StabilityCase const& which, std::vector<Backend> const& backends, std::vector<Handles> const& handles,
                               int seeds, AskPeers const& peers) {
    StabilityStudy study{which.family, which.name, {}, which.bodies, seeds, {}, 1, 0, {}};
    std::vector<PeerErrors> of_peers;
    std::vector<Variant> variants = variants_of(backends, handles);
    std::vector<double> condition, growth, in_double;
    for (int seed = 1; seed <= seeds; ++seed) {
        Scene scene = which.scene(static_cast<std::uint64_t>(seed));
        Solution const layout = layout_of(scene);
        ExactSolution const exact = exact_solution(scene, layout, largest_quad_here, which.bodies > few_nudges_above ? 1 : 3);
        study.reference = exact.by;
        growth.push_back(exact.growth);
        if (which.bodies <= largest_condition) condition.push_back(oracle::condition_estimate(scene.chains.front()));
        in_double.push_back(error_in_double(scene, layout, exact));
        std::vector<PeerAnswer> const answers = peers ? peers(which, scene) : std::vector<PeerAnswer>{};
        of_peers.resize(answers.size());
        for (std::size_t i = 0; i < answers.size(); ++i) add(of_peers[i], answers[i], scene, layout, exact);
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
