// How far every backend can be trusted on a hard chain: backward and forward error beside their
// bounds, over several seeds.
//
// A backend has solved exactly a chain whose data and equations are off by its local residual; the
// answer is then off by the residual times the growth (growth.hpp). With the bound of the residual,
// 32 depth(tree) 2^-53, that bounds the error: 32 depth(tree) 2^-53 growth. Articulated bodies in
// double and other programs ("peers") solve the same chains: after refinement, which brings back
// what the growth took, the error may be 4 times the best of theirs, or that of the residual's
// bound alone.
#pragma once

#include <functional>
#include <optional>

#include "measure/stability_cases.hpp"
#include "measure/timing.hpp"

namespace catena {

struct StabilityPoint {
    std::string backend, handles;
    double residual = 0, residual_bound = 0, error = 0;  // medians over the seeds
    double of_residual_bound = 0,
           of_bound = 0;  // residual and forward error over their bounds, the largest of the seeds
    std::string refused = {};  // why a seed had no answer; empty: all had one
    struct Refined {
        double error = 0, of_residual_bound = 0, of_bound = 0;
        double cost = 0;  // of the step, over that of an evaluation; median
    };
    std::vector<Refined> refined =
        {};  // after one step and after two; empty: not for such chains or backends
    std::optional<Refined> settled = {};  // after as many as help, ten at most
    int steps = 0;                        // of these, the most of the seeds
    bool is_articulated() const { return handles == "articulated"; }
    bool is_nearby() const {
        return of_residual_bound <= 1 ||
               (is_articulated() && settled && settled->of_residual_bound <= 1);
    }
    bool holds() const { return refused.empty() && of_residual_bound <= 1 && of_bound <= 1; }
    bool holds_refined() const {
        return holds() || (refused.empty() && settled && settled->of_residual_bound <= 1 &&
                           settled->of_bound <= 1);
    }
    /// Of the answer as it comes, or of that after as many steps of refinement as help; infinite
    /// where there is none.
    double plain_error() const;
    double last_error() const;
};

/// Another program's answer to a scene, laid out as Solution::acceleration, or why there is none.
struct PeerAnswer {
    std::string name;
    std::vector<double> acceleration = {};
    std::string why_not = {};
};
/// Asks each of them; their number and names are always the same.
using AskPeers = std::function<std::vector<PeerAnswer>(StabilityCase const&, Scene const&)>;

struct StabilityPeer {
    std::string name;
    double error = 0;          // median over the seeds
    std::string why_not = {};  // of a seed without an answer; empty: all had one
};

enum class Verdict { valid, refined, articulated, beyond, lost, invalid };

struct StabilityStudy {
    std::string family, name, reference;
    std::int64_t bodies = 0;
    int seeds = 0;
    std::optional<double> condition;  // of the joint-space inertia (links' matrix), up to
                                      // largest_condition bodies; median
    double growth = 1;                // median
    double oracle_error =
        0;  // of articulated bodies in double; median; infinite where they find no answer
    std::vector<StabilityPoint> points;
    std::vector<StabilityPeer> peers = {};
    /// The least error of articulated bodies in double and of the peers that have one.
    double best_of_others() const;
    /// The worst last_error() of the points with or without articulated handles over what it may
    /// be: the larger of 4 times best_of_others() and the bound of the residual, where there is no
    /// refinement that times the growth; medians.
    double against_peers(bool articulated = false) const;
    /// The equations of joint forces in double determine fewer than three digits of the answer.
    bool beyond() const { return growth * 0x1p-53 > 1e-3; }
    /// So do any equations in double, as the condition number says.
    bool ill_conditioned() const { return condition && *condition * 0x1p-53 > 1e-3; }
    /// The worst over the points without articulated handles; infinite where one has no answer.
    double worst(double (StabilityPoint::*error)() const) const;
    /// Of the points with or without articulated handles.
    bool all(bool articulated, std::function<bool(StabilityPoint const&)> const& holds) const;
    Verdict verdict() const;
};
char const* name_of(Verdict);

StabilityStudy study_stability(StabilityCase const&, std::vector<Backend> const&,
                               std::vector<Handles> const&, int seeds, AskPeers const& peers = {});

}  // namespace catena
