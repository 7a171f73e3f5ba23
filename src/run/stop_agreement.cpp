#include "run/stop_agreement.hpp"

#include <algorithm>
#include <utility>

#include "integrate/timeline.hpp"

namespace catena {
namespace {

/// mpirun grants a second between a termination and the kill: a look must fit in with room for the
/// checkpoint.
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
    // The fewest steps that any rank would go on before the next look; none: stop.
    double const agreed = -communicator_.max(own != 0 ? 0.0 : -affordable);
    if (agreed == 0) return static_cast<int>(communicator_.max(own));
    looked_ = n;
    looked_at_ = now;
    next_ = n + static_cast<std::int64_t>(agreed);
    return 0;
}

}  // namespace catena
