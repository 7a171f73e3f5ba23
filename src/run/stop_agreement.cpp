// Implements the agreement of ranks on the step after which they stop.
#include "run/stop_agreement.hpp"

#include <algorithm>
#include <utility>

#include "integrate/timeline.hpp"

namespace catena {
namespace {

/// Interval of the tests. mpirun waits a second between a termination and the kill, in which a test
/// and the checkpoint must fit.
constexpr double seconds_between_looks = 0.1;

}  // namespace

StopAgreement::StopAgreement(Communicator const& communicator, Wish wish, std::int64_t first_step)
    : communicator_(communicator),
      wish_(std::move(wish)),
      looked_(first_step - 1),
      next_(first_step),
      looked_at_(seconds_now()) {}

int StopAgreement::reason_at(std::int64_t n) {
    if (!wish_ || n < next_) return 0;
    ++looks_;
    int const own = wish_();
    double const steps = static_cast<double>(n - looked_), now = seconds_now();
    double const affordable = std::clamp(
        steps * seconds_between_looks / std::max(now - looked_at_, 1e-9), 1.0, 2 * steps);
    // Smallest number of steps that any rank would run before the next test; 0: stop.
    double const agreed = -communicator_.max(own != 0 ? 0.0 : -affordable);
    if (agreed == 0) return static_cast<int>(communicator_.max(own));
    looked_ = n;
    looked_at_ = now;
    next_ = n + static_cast<std::int64_t>(agreed);
    return 0;
}

}  // namespace catena
