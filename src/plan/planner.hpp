// Predicts how long an evaluation of a scene takes on every arrangement of a machine, from what was
// measured there and, where that is not enough, from what it measures now.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/level_plan.hpp"
#include "plan/machine.hpp"

namespace catena::plan {

struct Prediction {
    Arrangement arrangement;
    PhaseSeconds
        seconds{};  // of all groups; exchange between ranks and forces from outside are not in it
    bool alike = true;     // the same bits as the others that are
    std::string unusable;  // why there is none; empty where there is
};

class Planner {
  public:
    /// Measures chains of at most `largest` bodies, and of four times as many beads, which take
    /// that much less memory each, or bodies on a GPU, which few do not fill.
    Planner(Machine machine, Calibration known, std::int64_t largest)
        : machine_(std::move(machine)),
          calibration_(std::move(known)),
          known_(calibration_.points()),
          largest_(largest) {}

    Prediction predict(std::vector<Share> const&, Arrangement const&);
    /// Of the largest rank's chains in ground axes. Throws where the arrangement cannot be used.
    DriftSeconds predict_drifts(std::vector<Share> const&, Arrangement const&);
    /// Of those that give the same bits, and of the others.
    std::vector<Prediction> predict(std::vector<Share> const&);
    /// Precondition: there is a GPU, or `gpu` is the host's part too (to see what the host would
    /// gain by itself: nothing).
    LevelPlan plan_levels(std::vector<Share> const&, Place gpu = Place::gpu);
    /// Of cuda-levels, cut so.
    Prediction predict(std::vector<Share> const&, LevelPlan const&, GpuLevels);
    /// Measures every family at every size.
    void measure_everything();

    Machine const& machine() const { return machine_; }
    Calibration const& calibration() const { return calibration_; }
    /// Whether something was measured that had not been known.
    bool learned() const { return calibration_.points() > known_; }

  private:
    PhaseCurve const& phases_of(Family const&, Arrangement const&, std::int64_t bodies);
    DriftCurve const& drifts_of(Family const&, Arrangement const&, std::int64_t bodies);
    LevelCurve const& levels_of(Family const&, Place, std::int64_t bodies);
    std::int64_t largest(Family const& family, Arrangement const& arrangement) const {
        return family.beads() || uses_gpu(arrangement.backend) ? 4 * largest_ : largest_;
    }

    Machine machine_;
    Calibration calibration_;
    std::size_t known_;
    std::int64_t largest_;
};

/// The quickest of those that give the same bits; an earlier one where a later one gains less than
/// a tenth of the evaluation and `beside`, the seconds of a step that are the same on all of them:
/// so little is lost in a machine's noise. Precondition: one of them can be used.
Prediction const& quickest(std::vector<Prediction> const&, double beside = 0);

}  // namespace catena::plan
