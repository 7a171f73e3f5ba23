// RankForces: the forces on one rank's own beads, from a Context that holds all beads acting on
// them. Only files that see OpenMM's headers include this one.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "force/context.hpp"
#include "mpi/communicator.hpp"
#include "neighbours/device_path.hpp"
#include "neighbours/ghost_traffic.hpp"
#include "neighbours/pair_ranges.hpp"
#include "systems/model.hpp"

namespace catena {

/// Interface of all decompositions over ranks.
class RankForces {
  public:
    virtual ~RankForces() = default;
    /// Collects the positions that this rank needs. `own`: those of its own beads, in the order of
    /// BeadSystem::by_rank, nm, W. Collective, on the thread that may send messages.
    virtual void gather(std::span<Vec3 const> own) = 0;
    /// Computes the forces on own beads at the last gathered positions, kJ/mol/nm, W. It sends no
    /// messages, so any thread may call it. Throws ComputationError and what OpenMM throws.
    virtual void evaluate(std::span<Vec3> own_forces) = 0;
    /// Computes the energies of all forces, kJ/mol, each at the index of its group, on rank 0 at
    /// least. The positions are the last gathered ones, or those that `device` has. Collective.
    /// Throws SharedError on all ranks, or what OpenMM throws on rank 0 alone if no collective
    /// operation follows.
    virtual void find_energies(DevicePath* device, std::span<double> of_group) = 0;
    /// Returns what a path on which positions and forces stay on the GPU needs to know.
    virtual DevicePathPlan plan(bool /*overlap*/) { return {}; }
    /// Returns the Context of such a path; null if there is none.
    virtual ForceContext* device_context() { return nullptr; }
    /// Returns the path on which positions and forces stay on the GPU, which replaces gather() and
    /// evaluate(). Precondition: this object was made for it.
    virtual std::unique_ptr<DevicePath> device_path(bool /*overlap*/) { return nullptr; }
    /// Returns the forces on own beads at the last positions of the path, kJ/mol/nm, W.
    virtual std::vector<Vec3> forces_again() { return {}; }

    /// Makes the next exchange of positions rebuild the lists of ghosts, on this rank and all
    /// others.
    virtual void renew_ghosts() {}
    /// True if the next exchange of positions rebuilds the lists of ghosts.
    virtual bool ghosts_are_due() const { return false; }
    virtual GhostTraffic traffic() const { return {}; }
    /// Largest number of particles of a Context so far.
    virtual std::int64_t largest_context() const = 0;
    /// Number of Contexts made so far.
    virtual std::int64_t contexts() const = 0;
    /// True if every rank has every bead and computes a share of the pairs.
    virtual bool shares_pairs() const { return false; }
    /// Longest cutoff of the forces, nm; infinite if nothing is split or a force has no cutoff.
    virtual double reach() const { return std::numeric_limits<double>::infinity(); }
    /// Width by which lists of ghosts exceed the reach, nm; 0 if nothing is split or a force has no
    /// cutoff.
    virtual double skin() const { return 0; }
    /// Cutoffs and the beads they apply to, longest first; empty if nothing is split or a force has
    /// no cutoff.
    virtual std::vector<PairRange> ranges() const { return {}; }

    /// Skin of the lists of ghosts as a fraction of the reach.
    static double constexpr skin_of_reach = 0.125;
};

struct ForceLayer;

/// Arguments for making a RankForces; all references must outlive it. A rank without beads builds
/// nothing.
struct RankPlan {
    OpenMmModel const& model;
    OpenMmPlatform const& platform;
    BeadSystem const& beads;
    Communicator const& communicator;
    /// Edges of the box, nm, if the forces are periodic.
    std::optional<Vec3> box;
    /// True if ghosts are compared with a search among all beads at every evaluation.
    bool audit = false;
    /// Longest reach of other forces on these beads, nm: their lists of ghosts last as long.
    double longest_reach = 0;
    /// Path `device` with layers: placement of all of them, if not that of this System alone.
    std::optional<Placement> placement = std::nullopt;
    /// Context whose GPU context the new one shares and which must outlive it; null: none.
    ForceContext* home = nullptr;
};

/// Makes a Context of all beads on each rank: for one rank, or for `replicate`. On a GPU it
/// supports one rank only. Throws what OpenMM throws if it refuses the forces.
std::unique_ptr<RankForces> make_whole_forces(RankPlan const&);
/// Makes a Context of the rank's own beads and their ghosts. Ghosts are all beads that act within
/// reach + skin and the partners of own beads in bonded terms. Throws what OpenMM throws if it
/// refuses the forces. Precondition: every force can be split.
std::unique_ptr<RankForces> make_split_forces(RankPlan const&);
/// Makes the same decomposition as make_split_forces() for path `device`.
std::unique_ptr<RankForces> make_halo_forces(RankPlan const&);
/// Makes a force decomposition for path `device`. Each rank has a Context of all beads and computes
/// a share of the pairs; rank 0 computes all other forces. Preconditions: why_not_by_pairs() is
/// empty, every rank has beads.
std::unique_ptr<RankForces> make_pair_forces(RankPlan const&);
/// Returns why a System's pairs cannot be shared out over ranks; empty if they can.
std::string why_not_by_pairs(OpenMM::System const&);

/// Makes one RankForces per layer (systems/force_layers.hpp) with `make`, and one for the remaining
/// forces. Positions and forces pass through the host. `plan.model` is the System without the
/// layers' forces.
using MakeRankForces = std::unique_ptr<RankForces> (*)(RankPlan const&);
std::unique_ptr<RankForces> make_layered_forces(RankPlan const&,
                                                std::vector<ForceLayer> const& layers,
                                                MakeRankForces make);
/// Makes the same for path `device`: `make` makes whole or pair forces.
std::unique_ptr<RankForces> make_layers_on_device(RankPlan const&,
                                                  std::vector<ForceLayer> const& layers,
                                                  MakeRankForces make);

/// Throws ComputationError if one of `vectors` is not finite. `bead`: number of the bead that each
/// belongs to. `what`: subject of the message, such as "the position".
void check_finite(std::span<Vec3 const> vectors, std::span<std::int64_t const> bead,
                  char const* what);

}  // namespace catena
