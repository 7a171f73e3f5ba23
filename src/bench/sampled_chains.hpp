// Chains that `bench sampling` samples by several methods, with one evaluator of their forces for
// all.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <string>
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

/// Longest cutoff of the forces of CALVADOS, nm.
double longest_cutoff();

/// Distances of the copies of a row, nm.
struct CopyDistances {
    /// Smallest distance of two copies at any sample.
    double nearest = INFINITY;
    /// Distance of the copies at the start.
    double spacing = 0;
    /// Rounding of positions in single precision at the outermost possible bead.
    double rounding = 0;
};

/// A number that describes all chains at one moment.
struct SystemValue {
    std::string name, unit;
    double value = 0;
};

/// The chains and the start that all rows share.
class SampledChains {
  public:
    virtual ~SampledChains() = default;

    /// Returns the scene from which a row starts, ready for `time` ps of motion. Every call uses
    /// another seed: repeated velocities and noise would push a chain the same way again.
    Scene scene(double step, double time);
    /// Sets the positions from which all rows start, in the order of beads(), nm.
    void start_from(std::vector<Vec3> const& positions);

    /// Returns OpenMM's forces on all beads except those of bonds, kJ/mol/nm.
    std::vector<Vec3> forces(std::vector<Vec3> const& positions);
    /// Returns one sample per chain.
    std::vector<ChainSample> sample(std::vector<Vec3> const& positions, BondMeasure);
    /// Returns numbers of all chains together, after sample() of these positions; always the same
    /// ones.
    virtual std::vector<SystemValue> system_values(std::vector<Vec3> const& positions) = 0;
    /// Returns a distance, nm, that no two beads of different copies fall below; the smallest
    /// distance itself if it is within the cutoff. Returns infinity if there is none to keep, and
    /// NaN if positions are not finite.
    virtual double nearest(std::vector<Vec3> const& positions) const = 0;
    /// Returns the distances at the start of a row of `time` ps.
    virtual CopyDistances distances(double time) const = 0;
    /// Describes the chains and where they are, for the heading.
    virtual std::string description() const = 0;

    /// Returns the chains' centres of mass.
    std::vector<Vec3> centres(std::vector<Vec3> const& positions) const;
    /// Number of independent systems.
    virtual std::int64_t copies() const = 0;

    BeadSystem const& beads() const { return beads_; }
    std::int64_t chains() const { return std::ssize(scene_.chains); }
    Scene const& model() const { return scene_; }
    std::string platform() const { return evaluator_->platform(); }

  protected:
    /// Prepares the evaluator for the chains of the scene, which start from its positions. Throws
    /// InputError if OpenMM's own integrators cannot move them, and "built without OpenMM".
    SampledChains(Scene, Communicator const&, Backend backend);

    /// Returns the beads of a chain among all.
    std::span<Vec3 const> of_chain(std::vector<Vec3> const& all, std::int64_t chain) const;
    /// Returns positions from which a row of `time` ps starts.
    virtual std::vector<Vec3> start(std::vector<Vec3> positions, double time) const = 0;
    /// Returns positions with the same forces, for the evaluator.
    virtual std::vector<Vec3> for_evaluation(std::vector<Vec3> positions) const = 0;
    OpenMmForce& evaluator() { return *evaluator_; }

  private:
    Scene scene_;
    std::uint64_t runs_ = 0;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> evaluator_;
};

/// Returns the rounding error of a coordinate in single precision.
double rounding_at(double coordinate);

}  // namespace catena::command
