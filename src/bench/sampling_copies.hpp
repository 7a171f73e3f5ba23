// Copies of one chain that are sampled side by side and never meet.
#pragma once

#include "bench/sampled_chains.hpp"

namespace catena::command {

/// The copies on a cubic grid around the origin, without a box. Their distance is a chain's contour
/// length, the longest cutoff and four times the root-mean-square displacement of a chain's centre,
/// so that two meet once in a million.
class SamplingCopies final : public SampledChains {
  public:
    /// Repeats the scene's one chain of beads with CALVADOS 2 as often as requested. Throws
    /// InputError if the scene holds anything else, and "built without OpenMM".
    SamplingCopies(BenchRequest const&, Communicator const&, Backend backend);

    /// Returns the distance of the grid, nm.
    double spacing(double time) const;
    /// Returns the largest coordinate of a bead on the grid, nm.
    double extent(double time) const;

    std::vector<SystemValue> system_values(std::vector<Vec3> const&) override { return {}; }
    double nearest(std::vector<Vec3> const& positions) const override;
    CopyDistances distances(double time) const override;
    std::string description() const override;
    std::int64_t copies() const override { return chains(); }

  private:
    /// A sphere around the centre of mass of a copy.
    struct Ball {
        /// Centre of mass, nm.
        Vec3 centre = Vec3::zero();
        /// Distance of the bead farthest from it, nm.
        double reach = 0;
    };
    Ball ball(std::span<Vec3 const> x) const;
    std::vector<Vec3> start(std::vector<Vec3> positions, double time) const override;
    /// Moves the copies close to each other, which changes no force and keeps the digits of single
    /// precision.
    std::vector<Vec3> for_evaluation(std::vector<Vec3> positions) const override;
    std::vector<Vec3> placed(std::vector<Vec3> positions, double spacing) const;
    /// Returns the place of a copy on a grid of edge 1 around the origin.
    Vec3 place(std::int64_t copy) const;
};

}  // namespace catena::command
