// Interface of the GPU path to ghosts: exchange of bead positions between ranks when positions and
// forces stay in GPU memory.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/linear.hpp"
#include "mpi/communicator.hpp"

namespace OpenMM {
class Context;
}

namespace catena {

/// Ghosts of one rank, and the OpenMM Context of its own beads and ghosts.
class Halo {
  public:
    /// Numbers of positions sent to and received from a rank.
    struct Message {
        int rank;
        std::int64_t sent, received;
    };
    /// Lists that stay valid until the next rebuild.
    struct Lists {
        /// Messages; their positions are consecutive in `sent` and `particle`.
        std::vector<Message> messages;
        std::vector<std::int64_t> sent;  // own beads whose positions are sent, in this order
        bool one_for_all = false;        // true if every message contains all of `sent`
        std::vector<int> particle;       // particle in the rank's Context of each position received
        /// Particles that represent no bead, and their positions (`aside`), at which nothing acts
        /// on them.
        std::vector<int> idle;
        std::vector<Vec3> aside;
        /// Limit of own beads' displacement until the next rebuild, nm; absent: no limit.
        std::optional<double> farthest;
        /// True if the Context and its particles' parameters are those of the previous lists.
        bool keeps_particles = false;
    };
    virtual ~Halo() = default;

    /// Error text for GhostLists::are_used_up().
    static constexpr char const* in_trouble =
        "the position of bead {:.0f}, or OpenMM's force on it, is not finite";

    /// True if the lists must be rebuilt. `far`: an own bead has moved farther than `farthest`.
    /// `bead`: number of a bead whose position or force is not finite; -1: none. Collective. Throws
    /// SharedError if a rank has such a bead.
    virtual bool are_used_up(bool far, std::int64_t bead) = 0;
    /// Throws SharedError if some rank has a bead whose position or force is not finite.
    /// Collective.
    virtual void refuse_trouble(std::int64_t bead) const = 0;
    /// Builds the lists at the own beads' positions, nm, W. Collective.
    virtual void make_lists(std::span<Vec3 const> own) = 0;
    virtual Lists const& lists() const = 0;
    /// Context with one particle for each own bead and each ghost. Preconditions: the rank has
    /// beads, and lists exist. The Context changes only after make_lists(). Before that call the
    /// caller must release the previous one and make the common GPU context current.
    virtual OpenMM::Context& context() = 0;
    /// Exchanges positions through host memory. Collective.
    virtual void carry(std::span<Vec3 const> sent, std::span<Vec3> received) = 0;
    /// Records that positions were exchanged from GPU to GPU instead.
    virtual void note_carried() = 0;
    virtual Communicator const& communicator() const = 0;
    virtual bool every_rank_has_beads() const = 0;
    /// True if audit() must be called at every evaluation, which is the same on all ranks. audit()
    /// compares the ghosts with a search among all beads. It is collective and throws SharedError.
    virtual bool is_audited() const = 0;
    virtual void audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const = 0;
    /// Force decomposition, in which every rank has every bead: bits of the force groups that this
    /// rank computes. Pair forces among them cover this rank's share of pairs only; the sum over
    /// ranks is the total force. Absent: a rank computes all forces on its own beads.
    virtual std::optional<int> groups_of_share() const { return std::nullopt; }
    /// Force decomposition: sets the sequence in which own beads' positions are sent, and so
    /// received elsewhere. Collective.
    virtual void send_in(std::span<std::int64_t const> /*sequence*/) {}
    /// True if the last are_used_up() found beads of some rank far, or the lists invalid. Neighbour
    /// lists must then be rebuilt.
    virtual bool some_are_far() const { return false; }
};

}  // namespace catena
