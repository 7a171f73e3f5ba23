// Copies of one chain that are sampled side by side and never meet, with one evaluator of their
// forces for all methods.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <vector>

#include "console/requests.hpp"
#include "force/openmm_force.hpp"
#include "measure/chain_sample.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Gives each bond of a chain a length as at the temperature; `kt` is in kJ/mol. A friction of
/// 0.01/ps would take hundreds of ps to do so. Each bead moves on its own: changes of length that
/// added up along a chain would push beads far apart in the sequence into each other. Lengths of
/// neighbouring bonds are correlated, which a few ps mend.
void warm_bonds(std::vector<Vec3>& positions, double kt, std::mt19937_64& draw);

/// The copies and their current start.
class SamplingCopies {
  public:
    /// Repeats the scene's one chain of beads with CALVADOS 2 as often as requested, without a box.
    /// Throws InputError if the scene holds anything else, and "built without OpenMM".
    SamplingCopies(BenchRequest const&, Communicator const&, Backend backend);

    /// Returns the copies on a cubic grid around the origin, ready for `time` ps of motion. Their
    /// distance is a chain's contour length, the longest cutoff and four times the root-mean-square
    /// displacement of a chain's centre, so that two meet once in a million. Every call uses
    /// another seed: repeated velocities and noise would push a chain the same way again.
    Scene scene(double step, double time);
    /// Returns the distance of the grid, nm.
    double spacing(double time) const;
    /// Returns the largest coordinate of a bead on the grid, nm.
    double extent(double time) const;
    /// Sets the positions from which all rows start, in the order of beads(), nm.
    void start_from(std::vector<Vec3> const& positions);

    /// Returns OpenMM's forces on all beads except those of bonds, kJ/mol/nm. Copies are first
    /// moved close to each other, which changes no force and keeps the digits of single precision.
    std::vector<Vec3> forces(std::vector<Vec3> const& positions);
    /// Returns one sample per copy.
    std::vector<ChainSample> sample(std::vector<Vec3> const& positions, BondMeasure);
    /// Returns a distance, nm, that no two beads of different copies fall below; the smallest
    /// distance itself if it is within the cutoff. Returns infinity for one copy and NaN if
    /// positions are not finite.
    double nearest(std::vector<Vec3> const& positions) const;
    /// Longest cutoff of the forces, nm.
    static double cutoff();

    BeadSystem const& beads() const { return beads_; }
    std::int64_t copies() const { return std::ssize(scene_.chains); }
    std::int64_t beads_of_copy() const {
        return static_cast<std::int64_t>(scene_.chains.front().size());
    }
    Scene const& model() const { return scene_; }
    std::string platform() const { return evaluator_->platform(); }

  private:
    /// A sphere around the centre of mass of a copy.
    struct Ball {
        /// Centre of mass, nm.
        Vec3 centre = Vec3::zero();
        /// Distance of the bead farthest from it, nm.
        double reach = 0;
    };
    std::span<Vec3 const> of_copy(std::vector<Vec3> const& all, std::int64_t copy) const;
    Ball ball(std::span<Vec3 const> x) const;
    std::vector<Vec3> placed(std::vector<Vec3> positions, double spacing) const;
    /// Returns the place of a copy on a grid of edge 1 around the origin.
    Vec3 place(std::int64_t copy) const;

    Scene scene_;
    std::uint64_t runs_ = 0;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> evaluator_;
};

}  // namespace catena::command
