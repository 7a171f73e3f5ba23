// Choice between the paths of OpenMM's forces.
#include "force/path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"

namespace catena {

namespace {

/// Returns the median of all times but the first.
double median(std::vector<double> seconds) {
    auto const begin = seconds.begin() + 1, middle = begin + (seconds.end() - begin) / 2;
    std::nth_element(begin, middle, seconds.end());
    return *middle;
}

}  // namespace

PathChoice::PathChoice(std::string const& asked, bool may_compare, std::string const& why_no_device,
                       std::string const& scene_file)
    : device_(why_no_device.empty() && (asked == "auto" || asked == "device")),
      trying_(asked == "auto" && may_compare && !device_),
      worker_(asked != "inline" && !device_),
      asked_(asked),
      why_no_device_(why_no_device) {
    std::string const where = scene_file + ": forces.openmm.path";
    if (asked == "device" && !device_)
        throw InputError(
            fmt::format("positions and forces cannot stay on a GPU: {}", why_no_device), where,
            "use auto, or chains of beads and of rigid domains, --backend cuda and "
            "forces.openmm.platform: CUDA on a machine with a GPU");
    if (asked != "auto" && asked != "device" && asked != "host" && asked != "inline")
        throw InputError(fmt::format("`{}` is not a path of OpenMM's forces", asked), where,
                         "use auto, device, host or inline");
}

bool PathChoice::runs_on_worker() const {
    return trying_ ? std::ssize(inline_) >= trials : worker_;
}

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
    std::string const no_device = asked_ == "auto" && why_no_device_ != no_gpu_asked_for
                                      ? fmt::format("; not device: {}", why_no_device_)
                                      : "";
    if (trying_)
        return fmt::format(
            "auto: host or inline, whichever the first {} evaluations show to be faster{}",
            2 * trials, no_device);
    if (device_) return "device (positions and forces stay on the GPU)";
    std::string const taken = worker_ ? "host (a worker thread)" : "inline (the calling thread)";
    if (host_median_ == 0) return taken + no_device;
    return fmt::format(
        "{}, the faster one: from begin to end {:.3g} ms on the worker, {:.3g} ms inline{}", taken,
        1e3 * host_median_, 1e3 * inline_median_, no_device);
}

}  // namespace catena
