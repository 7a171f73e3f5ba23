// Other ranks' beads around a rank's own: what the path on which positions and forces stay on the
// GPU asks of the ranks.
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

class Halo {
  public:
    /// Positions to and from a rank.
    struct Message {
        int rank;
        std::int64_t sent, received;
    };
    struct Lists {
        std::vector<Message>
            messages;  // whose positions follow each other in `sent` and `particle`
        std::vector<std::int64_t> sent;  // own beads whose positions are sent, in this order
        bool one_for_all = false;        // every message has all of `sent`
        std::vector<int> particle;       // of each position received, in the rank's Context
        std::vector<int>
            idle;  // particles that stand for no bead, and their places, which nothing feels
        std::vector<Vec3> aside;
        std::optional<double> farthest;  // how far own beads may move until lists are made anew;
                                         // any way where it is absent
        bool keeps_particles =
            false;  // the Context and its particles' parameters are those of the lists before
    };
    virtual ~Halo() = default;

    /// GhostLists::are_used_up's.
    static constexpr char const* in_trouble =
        "the position of bead {:.0f}, or OpenMM's force on it, is not finite";

    /// Whether the lists are to be made anew. `far`: an own bead is farther away than `farthest`;
    /// `bead`: number of one whose position or force is not finite, -1: there is none. Collective.
    /// Throws SharedError where some rank has one.
    virtual bool are_used_up(bool far, std::int64_t bead) = 0;
    /// Throws SharedError where some rank has a bead whose position or force is not finite.
    /// Collective.
    virtual void refuse_trouble(std::int64_t bead) const = 0;
    /// Finds the lists at own beads' positions, nm, W. Collective.
    virtual void make_lists(std::span<Vec3 const> own) = 0;
    virtual Lists const& lists() const = 0;
    /// That has a particle for each own bead and each ghost. Precondition: the rank has beads, and
    /// lists. Another one only after make_lists(), before which the caller lets go of the one
    /// before and makes the GPU context of all of them its thread's.
    virtual OpenMM::Context& context() = 0;
    /// Sends and receives positions. Collective.
    virtual void carry(std::span<Vec3 const> sent, std::span<Vec3> received) = 0;
    /// They went from GPU to GPU, not by carry().
    virtual void note_carried() = 0;
    virtual Communicator const& communicator() const = 0;
    virtual bool every_rank_has_beads() const = 0;
    /// Whether audit() is to be called at every evaluation, on every rank or none: compares the
    /// ghosts with a search among all beads. Collective; throws SharedError.
    virtual bool is_audited() const = 0;
    virtual void audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const = 0;
    /// Where every rank has every bead: bits for the groups of forces that this one computes, those
    /// between pairs in its share of these alone. What ranks find adds up to the forces. Absent: a
    /// rank computes whatever acts on its own beads.
    virtual std::optional<int> groups_of_share() const { return std::nullopt; }
    /// Where every rank has every bead: from now on positions of own beads are sent in this
    /// sequence, and so received elsewhere. Collective.
    virtual void send_in(std::span<std::int64_t const> /*sequence*/) {}
    /// Whether are_used_up() was told last that beads of some rank are far, or found lists used up:
    /// lists of pairs are to be made anew.
    virtual bool some_are_far() const { return false; }
};

}  // namespace catena
