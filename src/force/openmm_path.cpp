#include "force/openmm_path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"

namespace catena {

namespace {

/// Of all but the first.
double median(std::vector<double> seconds) {
    auto const begin = seconds.begin() + 1, middle = begin + (seconds.end() - begin) / 2;
    std::nth_element(begin, middle, seconds.end());
    return *middle;
}

}  // namespace

PathChoice::PathChoice(std::string const& asked, bool may_compare, std::string const& scene_file)
    : trying_(asked == "auto" && may_compare), worker_(asked != "inline"), asked_(asked) {
    if (asked == "device") throw not_in_this_version("forces.openmm.path: device (" + scene_file + ")");
    if (asked != "auto" && asked != "host" && asked != "inline")
        throw InputError(fmt::format("OpenMM's forces have no path \"{}\"", asked), scene_file + ": forces.openmm.path",
                         "take auto, host or inline");
}

bool PathChoice::runs_on_worker() const { return trying_ ? std::ssize(inline_) >= trials : worker_; }

void PathChoice::note(double seconds) {
    if (trying_) (runs_on_worker() ? host_ : inline_).push_back(seconds);
}

void PathChoice::settle(Communicator const& communicator) {
    if (!trying_ || std::ssize(host_) < trials) return;
    inline_median_ = communicator.max(median(inline_));
    host_median_ = communicator.max(median(host_));
    worker_ = host_median_ < inline_median_;
    trying_ = false;
}

std::string PathChoice::text() const {
    if (trying_) return fmt::format("auto: host or inline, whichever the first {} evaluations show to be faster", 2 * trials);
    std::string const taken = worker_ ? "host (a worker thread)" : "inline (the calling thread)";
    if (host_median_ == 0) return taken;
    return fmt::format("{}, the faster one: from begin to end {:.3g} ms on the worker, {:.3g} ms inline", taken, 1e3 * host_median_,
                       1e3 * inline_median_);
}

}  // namespace catena
