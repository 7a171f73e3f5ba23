// All chains of a scene in its periodic box, sampled as they are: condensates and slabs.
#pragma once

#include <optional>

#include "bench/sampled_chains.hpp"
#include "math/executor.hpp"

namespace catena::command {

/// Chains that meet. Their energies, contacts and, in a box with one long edge, their density along
/// it are sampled, too.
class DenseChains final : public SampledChains {
  public:
    /// Reads the scene and relaxes its start if it asks for that. Throws InputError if it has no
    /// periodic box or anything that OpenMM's own integrators cannot move.
    DenseChains(BenchRequest const&, Communicator const&, Backend backend);

    /// Returns energies by term, kJ/mol per bead; numbers of pairs of unlinked beads within contact
    /// distances, per bead; and for a long box the density that a unit of mass sees around it, mean
    /// over slices across the long edge, mg/ml.
    std::vector<SystemValue> system_values(std::vector<Vec3> const& positions) override;
    /// Returns infinity, or NaN if positions are not finite: these chains may meet.
    double nearest(std::vector<Vec3> const& positions) const override;
    CopyDistances distances(double time) const override;
    std::string description() const override;
    std::int64_t copies() const override { return 1; }

  private:
    std::vector<Vec3> start(std::vector<Vec3> positions, double) const override {
        return positions;
    }
    std::vector<Vec3> for_evaluation(std::vector<Vec3> positions) const override {
        return positions;
    }

    std::unique_ptr<Executor> threads_;
};

/// Returns the number of pairs of points whose nearest images are within `radius`, nm, of each
/// other. Precondition: no edge of the box is below twice the radius.
std::int64_t pairs_within(std::vector<Vec3> const& positions, double radius, Vec3 const& box,
                          Executor const&);

/// Returns the axis of the one long edge of a box, at least twice as long as each other edge.
std::optional<int> long_axis(Vec3 const& box);

/// Returns the density that a unit of mass sees around it, mean over slices of about 1 nm across an
/// axis, in the unit of mass per nm^3. `mass`: per point.
double density_seen(std::vector<Vec3> const& positions, std::vector<double> const& mass,
                    Vec3 const& box, int axis);

}  // namespace catena::command
