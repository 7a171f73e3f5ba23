// Random chains by the thousand against the oracles: joints, base, tip, loads, backend and handles
// are drawn from the seed, a failing chain is shrunk and described.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "oracle/oracle.hpp"
#include "scene/scene.hpp"
#include "tests/support/shrink.hpp"

namespace catena::test {

struct CampaignCase {
    std::uint64_t seed = 0;
    std::string kind;  // the table's row
    ChainSpec chain;
    oracle::Loads loads;
    Backend backend = Backend::serial;
    Handles handles = Handles::projected;
};
/// Joints that the chains of a campaign have: those of its first version, or each of those that
/// came later and all of them together, tips included. The chains of a seed do not change.
enum class CampaignJoints { first, later };
CampaignCase campaign_case(std::uint64_t seed, CampaignJoints joints = CampaignJoints::first);

/// Errors are relative to the largest component of each quantity: accelerations (joints, centres of
/// mass, angular, base) and constraint forces (torques, forces) by the articulated-body algorithm
/// in long double and, up to 12 bodies, by one dense system. Bounds: of errors 1e-11, and where
/// that is not kept the solver's residual bound times the growth of such residuals
/// (measure/nudged.hpp); of the residual the solver's own. Of a chain that its tip holds twice
/// (planar, on joints that keep its plane) accelerations alone: forces are not unique there.
struct CampaignErrors {
    double acceleration = 0, acceleration_bound = 0;
    double force = 0, force_bound = 0;
    double residual = 0, residual_bound = 0;
    double in_double = 0;  // of the articulated-body algorithm in double
    double oracles = 0;  // dense against articulated bodies, both in long double; 0 above 12 bodies
    bool good() const {
        return acceleration <= acceleration_bound && force <= force_bound &&
               residual <= residual_bound;
    }
    std::string text() const;
};
/// `solved`: the chain that the solver gets, the case's own but where a test wants a wrong answer.
CampaignErrors campaign_errors(CampaignCase const&, ChainSpec const& solved);

/// The smallest chain found for which `good` is false or throws; precondition: the case itself is
/// one.
Shrunk smallest_failing(CampaignCase const&, std::function<bool(CampaignCase const&)> const& good);

/// Runs seeds first to last, prints a table with a row a kind, and fails the test if a chain is not
/// good, the first of them shrunk.
void run_campaign(std::uint64_t first, std::uint64_t last,
                  CampaignJoints joints = CampaignJoints::first);

}  // namespace catena::test
