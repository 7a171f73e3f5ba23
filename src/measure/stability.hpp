// Stability study: backward and forward errors of every backend on difficult chains, and their
// bounds, over several seeds.
//
// A backend's solution solves exactly a chain whose data and equations differ by its local
// residual. Its error is then the residual times the growth (growth.hpp). With the bound of the
// residual, 32 depth(tree) 2^-53, the bound of the error is 32 depth(tree) 2^-53 growth.
//
// Articulated bodies in double precision and other programs ("peers") solve the same chains.
// Refinement recovers the digits that the growth costs. Afterwards the error may be 4 times the
// smallest of theirs, or that of the residual's bound alone.
#pragma once

#include <functional>
#include <optional>

#include "measure/stability_cases.hpp"
#include "measure/timing.hpp"

namespace catena {

/// One backend with one kind of handles, over all seeds of a case.
struct StabilityPoint {
    std::string backend, handles;
    double residual = 0, residual_bound = 0, error = 0;  // medians over the seeds
    /// Residual and forward error divided by their bounds; largest over the seeds.
    double of_residual_bound = 0, of_bound = 0;
    std::string refused = {};  // reason why a seed has no answer; empty if all have one
    /// Errors after refinement, with the same meaning as above.
    struct Refined {
        double error = 0, of_residual_bound = 0, of_bound = 0;
        double cost = 0;  // time of the refinement step, divided by that of an evaluation; median
    };
    /// Errors after one step and after two; empty if chains or backend are not refined.
    std::vector<Refined> refined = {};
    /// Errors after as many steps as help, ten at most.
    std::optional<Refined> settled = {};
    int steps = 0;  // number of these steps, largest over the seeds
    bool is_articulated() const { return handles == "articulated"; }
    /// True if the residual is within its bound; with articulated handles, refinement may be
    /// needed.
    bool is_nearby() const {
        return of_residual_bound <= 1 ||
               (is_articulated() && settled && settled->of_residual_bound <= 1);
    }
    /// True if residual and forward error are within their bounds.
    bool holds() const { return refused.empty() && of_residual_bound <= 1 && of_bound <= 1; }
    /// True if residual and forward error are within their bounds, possibly after refinement.
    bool holds_refined() const {
        return holds() || (refused.empty() && settled && settled->of_residual_bound <= 1 &&
                           settled->of_bound <= 1);
    }
    /// Returns the error without refinement; infinite if a seed has no answer.
    double plain_error() const;
    /// Returns the error after as many steps of refinement as help; infinite if a seed has no
    /// answer.
    double last_error() const;
};

/// Another program's answer to a scene, in the layout of Solution::acceleration, or the reason why
/// there is none.
struct PeerAnswer {
    std::string name;
    std::vector<double> acceleration = {};
    std::string why_not = {};
};
/// Function that asks all peers. Their number and names must be the same at every call.
using AskPeers = std::function<std::vector<PeerAnswer>(StabilityCase const&, Scene const&)>;

/// Errors of one peer over all seeds of a case.
struct StabilityPeer {
    std::string name;
    double error = 0;          // median over the seeds
    std::string why_not = {};  // reason why a seed has no answer; empty if all have one
};

/// Verdict on a case. `valid`: within all bounds; `refined`: within them after refinement;
/// `articulated`: with articulated handles only. `beyond` and `lost`: beyond(), the residuals are
/// good and the errors are not. `lost` if others keep three digits. `invalid`: a bound is exceeded.
enum class Verdict { valid, refined, articulated, beyond, lost, invalid };

/// Result of study_stability() for one case.
struct StabilityStudy {
    std::string family, name, reference;
    std::int64_t bodies = 0;
    int seeds = 0;
    /// Condition number of the joint-space inertia (beads: links' matrix), up to largest_condition
    /// bodies; median.
    std::optional<double> condition;
    double growth = 1;  // growth.hpp; median
    /// Error of articulated bodies in double precision; median. It is infinite if they have no
    /// answer.
    double oracle_error = 0;
    std::vector<StabilityPoint> points;
    std::vector<StabilityPeer> peers = {};
    /// Returns the smallest error of articulated bodies in double precision and of the peers with
    /// an answer.
    double best_of_others() const;
    /// Returns the largest ratio of last_error() to its limit, over the points with or without
    /// articulated handles. The limit is the larger of 4 times best_of_others() and the bound of
    /// the residual. Without refinement the latter is multiplied by the growth. All values are
    /// medians.
    double against_peers(bool articulated = false) const;
    /// True if the equations of joint forces in double precision determine fewer than three digits
    /// of the answer.
    bool beyond() const { return growth * 0x1p-53 > 1e-3; }
    /// True if any equations in double precision do so, according to the condition number.
    bool ill_conditioned() const { return condition && *condition * 0x1p-53 > 1e-3; }
    /// Returns the largest error over the points without articulated handles; infinite if one has
    /// no answer.
    double worst(double (StabilityPoint::*error)() const) const;
    /// True if `holds` is true for all points with, or all without, articulated handles.
    bool all(bool articulated, std::function<bool(StabilityPoint const&)> const& holds) const;
    /// Returns the verdict on the case.
    Verdict verdict() const;
};
/// Returns the verdict in capitals, such as "VALID".
char const* name_of(Verdict);

/// Solves a case with all backends, handles and peers, for seeds 1 .. `seeds`. Backends and handles
/// that do not support the chain are left out.
StabilityStudy study_stability(StabilityCase const&, std::vector<Backend> const&,
                               std::vector<Handles> const&, int seeds, AskPeers const& peers = {});

}  // namespace catena
