// Fit of start positions from a file to the chain's links: whole across the periodic box, with each
// link at its length.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bodies/domains.hpp"
#include "scene/branches.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Largest accepted change of a link's length, relative to the length. It is six times the thermal
/// spread of the softest bond (5 % of its length) that becomes a rigid link without a note. A
/// residue that is missing between two CA atoms changes the length by more.
inline constexpr double thermal_spreads = 6, largest_link_change = 0.3;
/// Largest accepted relative change for softer bonds that become links, for any thermal spread.
inline constexpr double largest_soft_change = 0.9;
/// Largest accepted relative change with `relax: true`, if a System's bonds define the neighbours.
/// Centres of mass of neighbouring residues are up to 0.9 nm apart.
inline constexpr double largest_relaxed_change = 1.5;
/// Largest accepted relative change of links that stand for springs with the thermal spread
/// `spread`, relative to their length.
inline double largest_change_of(double spread) {
    return std::max(largest_link_change, std::min(largest_soft_change, thermal_spreads * spread));
}
/// Largest length of the image of a cut link, relative to the longest link that no side of the box
/// can have cut.
inline constexpr double most_usual = 1.5;
/// Relative change of a link from which on it is noted. A displacement of a bead is noted from the
/// longest link on.
inline constexpr double noted_link_change = 0.03;

/// Removes what fits have recorded and noted so far, because other positions replace theirs.
void forget_fits(Scene& scene);

/// Fits the chains of one file and collects notes on the changes.
class StartFit {
  public:
    /// `from` is the key of the positions in messages. `remedy` is the advice for links whose
    /// lengths would change too much. The scene's box and `relax` apply. `most` is the largest
    /// relative change of a link. `relaxed` replaces it for links that are too long if the scene
    /// has `relax: true`; 0 means `most`.
    StartFit(Scene& scene, Node const& from, std::string remedy, double most = largest_link_change,
             double relaxed = 0)
        : scene_(scene),
          from_(from),
          remedy_(std::move(remedy)),
          most_(most),
          relaxed_(std::max(most, relaxed)) {}

    /// A chain to fit.
    struct Chain {
        std::string name;
        BeadArrays& beads;
        Base base = Base::free;
        /// Rigid domains, ascending; they keep their shape and orientation.
        std::vector<Domain> rigid = {};
        /// Link that closes the chain at its first bead or at the ground, or nullptr.
        TipJoint const* tip = nullptr;
        /// Beads on which the beads hang; empty for an unbranched chain.
        Parents parents = {};
    };
    /// Moves beads by whole edges of the periodic box until no link is cut by its sides; without a
    /// box nothing moves. Bead 1 stays (fixed base: the anchor). A link is cut if its nearest image
    /// fits `beads.length` better. With `as_given`, if lengths are unknown, a link is cut if its
    /// nearest image is shorter. That image must not exceed 1.5 times the longest link within half
    /// of every edge.
    void make_whole(Chain const& chain, bool as_given) { make_whole(chain, as_given, scene_.box); }
    /// As above, for positions that may be wrapped into another box than the scene's.
    void make_whole(Chain const& chain, bool as_given, std::optional<Vec3> const& box);

    /// Gives the links `beads.length` by the least change of positions: the least sum of squared
    /// displacements, to second order in them. Records the largest change in the scene's `start`.
    /// Throws InputError, which names beads and overlaps, if a link would change by more than
    /// `most` of its length or reverse its direction. Links that are too short may change more with
    /// `relax: true`. Precondition: no two neighbours coincide.
    void fit(Chain const& chain);

    /// Gives the link of the chain's tip its length; the other links keep theirs. Throws like
    /// fit(). `distance` is that between its ends.
    void close(Chain const& chain, double distance);

    /// Adds the changes of all these chains to the scene's notes.
    void note() const;

  private:
    /// Change of one link.
    struct Change {
        double part = 0;  // relative to the link's length
        /// Distance before and length after.
        double from = 0, to = 0;
        /// Index of the link: that of its outboard bead, from 0.
        std::size_t link = 0;
    };
    Change largest_change(Chain const& chain, std::vector<double> const& before) const;
    /// Throws InputError for positions that are in another unit: most links are ten times too long
    /// or too short, which `relax: true` does not mend.
    void refuse_unit(Chain const& chain, std::vector<double> const& before) const;
    void refuse(Chain const& chain, Change const& worst, std::vector<double> const& before) const;
    std::string nearest_text(Chain const& chain) const;
    void project(Chain const& chain, Change const& worst);
    void record(Chain const& chain, Change const& worst, std::vector<Vec3> const& given);
    /// Largest relative change of a link that is too long.
    double most_shortened() const { return scene_.relax ? relaxed_ : most_; }
    char const* unit() const { return scene_.si ? "m" : "nm"; }

    Scene& scene_;
    Node const& from_;
    std::string remedy_;
    double most_, relaxed_;
    std::int64_t cut_links_ = 0, cut_chains_ = 0;
    std::string first_cut_;
    /// Largest relative change of a link and largest displacement of a bead.
    double largest_ = 0, most_moved_ = 0;
    bool moved_far_ = false;
    std::string link_, moved_;
};

}  // namespace catena::scene
