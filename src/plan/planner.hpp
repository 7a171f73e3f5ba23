// Predicts the time of a scene's evaluation on every arrangement of a machine. It uses earlier
// measurements and measures what they lack.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/level_plan.hpp"
#include "plan/machine.hpp"

namespace catena::plan {

/// Predicted time of one arrangement.
struct Prediction {
    Arrangement arrangement;
    /// Seconds of all groups, without exchange between ranks and external forces.
    PhaseSeconds seconds{};
    /// True if the arrangement gives the same bits as the others with this flag.
    bool alike = true;
    /// Reason why the arrangement cannot be used; empty if it can.
    std::string unusable;
};

/// Predicts times and keeps the measurements that it made for this.
class Planner {
  public:
    /// Measures sample chains of at most `largest` bodies. The limit is four times as many for
    /// beads, which need that much less memory each, and for GPUs, which few bodies do not fill.
    Planner(Machine machine, Calibration known, std::int64_t largest)
        : machine_(std::move(machine)),
          calibration_(std::move(known)),
          known_(calibration_.points()),
          largest_(largest) {}

    /// Predicts one arrangement.
    Prediction predict(std::vector<Share> const&, Arrangement const&);
    /// Predicts the parts of a constrained step of the largest rank's chains in ground axes. Throws
    /// an exception if the arrangement cannot be used.
    DriftSeconds predict_drifts(std::vector<Share> const&, Arrangement const&);
    /// Predicts every arrangement of the machine: first those that give the same bits, then the
    /// others.
    std::vector<Prediction> predict(std::vector<Share> const&);
    /// Plans the levels on the GPU. Precondition: the machine has a GPU, or `gpu` is Place::host,
    /// which shows that cuts of the host alone gain nothing.
    LevelPlan plan_levels(std::vector<Share> const&, Place gpu = Place::gpu);
    /// Predicts cuda-levels with this cut.
    Prediction predict(std::vector<Share> const&, LevelPlan const&, GpuLevels);
    /// Measures every family at every size.
    void measure_everything();

    Machine const& machine() const { return machine_; }
    Calibration const& calibration() const { return calibration_; }
    /// True if the planner has measured something that the initial calibration lacked.
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

/// Returns the quickest usable arrangement among those that give the same bits. An earlier one is
/// kept unless a later one saves a tenth of the evaluation plus `beside`. `beside` is the seconds
/// of a step that all arrangements share. Noise of the machine then costs little. Precondition: one
/// arrangement can be used.
Prediction const& quickest(std::vector<Prediction> const&, double beside = 0);

}  // namespace catena::plan
