// What one rank computes: the forces on its own beads, from a Context that holds whatever acts on
// them. For files that see OpenMM's headers.
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

class RankForces {
  public:
    virtual ~RankForces() = default;
    /// Brings the positions that this rank needs; `own`: those of its own beads, in the order of
    /// BeadSystem::by_rank. Collective, on the thread that may send messages.
    virtual void gather(std::span<Vec3 const> own) = 0;
    /// Forces on own beads at the positions gathered last, on any thread: it sends no messages.
    /// Throws ComputationError and what OpenMM throws.
    virtual void evaluate(std::span<Vec3> own_forces) = 0;
    /// On rank 0 at least the energies of its forces at the positions gathered last, or where
    /// `device` has them, kJ/mol, each in the place of its group. Collective; throws SharedError on
    /// all, or on rank 0 alone what OpenMM throws once nothing collective is left to do.
    virtual void find_energies(DevicePath* device, std::span<double> of_group) = 0;
    /// The path on which positions and forces stay on the GPU, in the place of gather() and
    /// evaluate(). Precondition: they are made for it.
    virtual std::unique_ptr<DevicePath> device_path(bool /*overlap*/) { return nullptr; }
    /// Forces on own beads at the positions that the path had last.
    virtual std::vector<Vec3> forces_again() { return {}; }

    /// Lists of ghosts are made anew when positions are brought next, here as on every other rank.
    virtual void renew_ghosts() {}
    virtual bool ghosts_are_due() const { return false; }
    virtual GhostTraffic traffic() const { return {}; }
    /// Particles of the largest Context so far, and how many were made.
    virtual std::int64_t largest_context() const = 0;
    virtual std::int64_t contexts() const = 0;
    /// Every bead is on each rank, which computes some of the pairs.
    virtual bool shares_pairs() const { return false; }
    /// How far forces reach, and by how much more ghosts' lists do, nm; where nothing is split, or
    /// forces have no end, infinite and 0.
    virtual double reach() const { return std::numeric_limits<double>::infinity(); }
    virtual double skin() const { return 0; }
    /// The longest first, where something is split and forces have an end.
    virtual std::vector<PairRange> ranges() const { return {}; }

    /// Part of the reach by which the ghosts' list is wider.
    static double constexpr skin_of_reach = 0.125;
};

struct ForceLayer;

/// What the ranks' shares are made from. A rank without beads builds nothing.
struct RankPlan {
    OpenMmModel const& model;
    OpenMmPlatform const& platform;
    BeadSystem const& beads;
    Communicator const& communicator;
    std::optional<Vec3> box;  // edges of the box where the forces are periodic
    bool audit = false;  // compares the ghosts with a search among all beads at every evaluation
    double longest_reach = 0;  // of other forces on these beads: their ghosts' lists last as long
};

/// A Context with every bead on each rank: one rank, or `replicate`; for the GPU one rank alone.
/// Throws what OpenMM throws if it refuses the forces.
std::unique_ptr<RankForces> make_whole_forces(RankPlan const&);
/// One with the rank's own beads and their ghosts: every bead that acts within reach + skin, and
/// the partners of own ones in bonded terms. Throws what OpenMM throws if it refuses the forces.
/// Precondition: every force can be split.
std::unique_ptr<RankForces> make_split_forces(RankPlan const&);
/// The same for the path on which positions and forces stay on the GPU.
std::unique_ptr<RankForces> make_halo_forces(RankPlan const&);
/// For that path, too: a Context with every bead on each rank, which computes a share of the pairs;
/// rank 0 all other forces. Preconditions: why_not_by_pairs() is empty, every rank has beads.
std::unique_ptr<RankForces> make_pair_forces(RankPlan const&);
/// Why a System's pairs cannot be shared out; empty where they can.
std::string why_not_by_pairs(OpenMM::System const&);

/// Layer by layer (systems/force_layers.hpp), each made by `make`; through the host. `plan`'s model
/// is what the layers were taken off.
using MakeRankForces = std::unique_ptr<RankForces> (*)(RankPlan const&);
std::unique_ptr<RankForces> make_layered_forces(RankPlan const&,
                                                std::vector<ForceLayer> const& layers,
                                                MakeRankForces make);

/// Throws ComputationError where one of `vectors` is not finite. `bead`: which each belongs to.
/// `what`: "the position".
void check_finite(std::span<Vec3 const> vectors, std::span<std::int64_t const> bead,
                  char const* what);

}  // namespace catena
