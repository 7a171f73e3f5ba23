// What one rank computes: the forces on its own beads, from a Context that holds them and whatever acts on them.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "force/openmm_context.hpp"
#include "force/openmm_model.hpp"

namespace catena {

class RankForces {
  public:
    /// The rank owns the beads `own`. `whole`: its Context holds every bead (one rank, or `replicate`); else its own beads and ghosts:
    /// every bead within reach + skin, renewed when a bead has moved so far that one might be missing. A rank without beads builds nothing.
    /// `box`: edges of the box where the forces are periodic. Throws what OpenMM throws if it refuses the forces.
    RankForces(OpenMmModel const& model, OpenMmPlatform const& platform, std::vector<std::int64_t> own, bool whole,
               std::optional<Vec3> const& box);

    /// Forces on own beads, in the order of `own`, at the positions of all beads. Throws ComputationError and what OpenMM throws.
    void evaluate(std::span<Vec3 const> all, std::span<Vec3> own_forces);

    /// The Context with every particle of the model in its order; nullptr if this rank has none.
    ForceContext* whole_context() { return whole_ ? context_.get() : nullptr; }

    std::int64_t largest_context() const { return largest_; }
    std::int64_t rebuilds() const { return rebuilds_; }
    double skin() const { return skin_; }
    double reach() const { return reach_; }

    /// Part of the reach by which the ghosts' list is wider: a list lasts until a bead has moved half of that.
    static double constexpr skin_of_reach = 0.125;

  private:
    bool list_is_good(std::span<Vec3 const> all) const;
    void rebuild(std::span<Vec3 const> all);
    std::vector<std::int64_t> ghost_beads(std::span<Vec3 const> all) const;
    std::unique_ptr<ForceContext> context_for(std::vector<std::int64_t> beads) const;

    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    std::vector<std::int64_t> own_;
    bool whole_;
    std::optional<Vec3> box_;
    std::vector<int> particle_of_bead_;
    std::vector<std::int64_t> partners_;  // beads of other ranks that share a bonded term with own ones
    double reach_ = std::numeric_limits<double>::infinity(), skin_ = 0;
    std::unique_ptr<ForceContext> context_;
    std::vector<Vec3> listed_;  // positions of all beads when the Context was made
    std::int64_t largest_ = 0, rebuilds_ = 0;
};

}  // namespace catena
