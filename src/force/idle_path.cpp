// Path `device` on a rank without beads.
#include "neighbours/device_path.hpp"
#include "neighbours/halo.hpp"

namespace catena {
namespace {

/// Takes part in the collective operations of the other ranks' paths, which have beads on GPUs.
class IdlePath final : public DevicePath {
  public:
    IdlePath(Halo& halo, bool overlap) : halo_(halo), overlap_(overlap) {}
    bool make_current() noexcept override { return true; }
    void begin(std::span<DeviceBeads* const>, bool) override {
        if (!overlap_) take_part();
    }
    void go_on(std::span<DeviceBeads* const>) override {
        if (overlap_) take_part();
    }
    void finish(std::span<DeviceBeads* const>) override {}
    void refuse_trouble() override { halo_.refuse_trouble(-1); }
    Clock clock() override { return {}; }
    std::vector<Vec3> positions() override { return {}; }

  private:
    /// Joins the collective calls of one evaluation, with empty arrays.
    void take_part() {
        if (halo_.are_used_up(false, -1)) halo_.make_lists({});
        halo_.carry({}, {});
        if (halo_.is_audited()) halo_.audit({}, {});
    }

    Halo& halo_;
    bool overlap_;
};

}  // namespace

std::unique_ptr<DevicePath> make_idle_path(Halo& halo, bool overlap) {
    return std::make_unique<IdlePath>(halo, overlap);
}

}  // namespace catena
