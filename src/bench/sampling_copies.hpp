// Copies of one chain that are sampled side by side and never meet, with one evaluator of their
// forces for whatever moves them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "console/requests.hpp"
#include "force/openmm_force.hpp"
#include "measure/chain_sample.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

class SamplingCopies {
  public:
    /// The scene's one chain of beads with CALVADOS 2, as many times as asked for, without a box.
    /// InputError where the scene has anything else, and "built without OpenMM".
    SamplingCopies(BenchRequest const&, Communicator const&, Backend backend);

    /// As they stand for `time` ps of motion that starts now: on a cubic grid around the origin.
    /// Their distance is a chain's contour length, the longest cutoff and four times the
    /// root-mean-square way of a chain's centre, so that two meet once in a million. Every call has
    /// a seed of its own: velocities and noise that come again would push a chain the way it went
    /// before.
    Scene scene(double step, double time);
    double spacing(double time) const;
    /// The largest coordinate there, nm.
    double extent(double time) const;
    /// Where all start from now on, wherever they are: in the order of beads(), nm.
    void start_from(std::vector<Vec3> const& positions);

    /// OpenMM's forces on all beads but those of bonds, kJ/mol/nm. Copies are brought near each
    /// other before, which changes no force and keeps the digits of single precision.
    std::vector<Vec3> forces(std::vector<Vec3> const& positions);
    /// One a copy.
    std::vector<ChainSample> sample(std::vector<Vec3> const& positions, BondMeasure);
    /// A distance that no two beads of different copies are below, nm; the least distance itself
    /// where it is within the cutoff. Infinite for one copy, NaN where positions are not finite.
    double nearest(std::vector<Vec3> const& positions) const;
    static double cutoff();

    BeadSystem const& beads() const { return beads_; }
    std::int64_t copies() const { return std::ssize(scene_.chains); }
    std::int64_t beads_of_copy() const {
        return static_cast<std::int64_t>(scene_.chains.front().size());
    }
    Scene const& model() const { return scene_; }
    std::string platform() const { return evaluator_->platform(); }

  private:
    struct Ball {
        Vec3 centre = Vec3::zero();  // of mass
        double reach = 0;            // of the bead farthest from it
    };
    std::span<Vec3 const> of_copy(std::vector<Vec3> const& all, std::int64_t copy) const;
    Ball ball(std::span<Vec3 const> x) const;
    std::vector<Vec3> placed(std::vector<Vec3> positions, double spacing) const;
    Vec3 place(std::int64_t copy) const;  // on a grid of edge 1 around the origin

    Scene scene_;
    std::uint64_t runs_ = 0;
    BeadSystem beads_;
    std::unique_ptr<OpenMmForce> evaluator_;
};

}  // namespace catena::command
