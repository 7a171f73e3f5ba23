// Start positions that a file gives are made to fit the chain's links: whole across the periodic
// box, each link as long as it is to be.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bodies/domains.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Largest change of a link's length that is taken, relative to the length: six times the thermal
/// spread of the softest bond that becomes a rigid link without a note (5 % of its length). A
/// residue that is missing between two CA atoms changes it by more.
inline constexpr double thermal_spreads = 6, largest_link_change = 0.3;
/// The same, whatever the spread, where softer bonds become links.
inline constexpr double largest_soft_change = 0.9;
/// The same with `relax: true`, where a System's bonds say who is joined: centres of mass of
/// neighbouring residues are up to 0.9 nm apart.
inline constexpr double largest_relaxed_change = 1.5;
/// Of links that stand for springs with this thermal spread, relative to their length.
inline double largest_change_of(double spread) {
    return std::max(largest_link_change, std::min(largest_soft_change, thermal_spreads * spread));
}
/// Of the longest link that no side of the box can have cut: the image of a cut link is not longer.
inline constexpr double most_usual = 1.5;
/// From here on a change of a link is noted; a bead's displacement from the longest link on.
inline constexpr double noted_link_change = 0.03;

class StartFit {
  public:
    /// `from` gives the positions; `remedy`: for links whose lengths would change too much. The
    /// scene's box and `relax` count. `most`: the largest change of a link; `relaxed`: that of a
    /// link that is too long where the scene has `relax: true` (0: the same).
    StartFit(Scene& scene, Node const& from, std::string remedy, double most = largest_link_change,
             double relaxed = 0)
        : scene_(scene),
          from_(from),
          remedy_(std::move(remedy)),
          most_(most),
          relaxed_(std::max(most, relaxed)) {}

    struct Chain {
        std::string name;
        BeadArrays& beads;
        Base base = Base::free;
        std::vector<Domain> rigid = {};  // ascending; they keep their shape and are not turned
        TipJoint const* tip =
            nullptr;  // a link that closes the chain, on its first bead or the ground
    };
    /// Where the scene has a periodic box: moves beads by whole edges until no link is cut by its
    /// sides; bead 1 stays (fixed base: the anchor). A link is cut where its nearest image is
    /// nearer to `beads.length`. `as_given`, where no lengths are known: where its nearest image is
    /// shorter, and not longer than 1.5 of the longest link within half of every edge.
    void make_whole(Chain const& chain, bool as_given);

    /// Gives the links `beads.length` by the least change of positions: the least sum of squared
    /// displacements, to second order in them. The scene's `start` learns of the largest change.
    /// InputError, which names beads and overlaps, where a link would change by more than `most` of
    /// its length (with `relax: true` links that are too short may) or turn round. Precondition: no
    /// two neighbours coincide.
    void fit(Chain const& chain);

    /// Gives the link of the chain's tip its length, the others keep theirs; as fit(). `distance`:
    /// of its ends.
    void close(Chain const& chain, double distance);

    /// What was done to all these chains, as notes of the scene.
    void note() const;

  private:
    struct Change {
        double part = 0;  // of the link's length
        double from = 0, to = 0;
        std::size_t link = 0;
    };
    Change largest_change(Chain const& chain, std::vector<double> const& before) const;
    void refuse(Chain const& chain, Change const& worst, std::vector<double> const& before) const;
    std::string nearest_text(Chain const& chain) const;
    void project(Chain const& chain, Change const& worst);
    void record(Chain const& chain, Change const& worst, std::vector<Vec3> const& given);
    /// By how much of its wanted length a link may be longer.
    double most_shortened() const { return scene_.relax ? relaxed_ : most_; }
    char const* unit() const { return scene_.si ? "m" : "nm"; }

    Scene& scene_;
    Node const& from_;
    std::string remedy_;
    double most_, relaxed_;
    std::int64_t cut_links_ = 0, cut_chains_ = 0;
    std::string first_cut_;
    double largest_ = 0, most_moved_ = 0;  // change of a link, relative, and displacement of a bead
    bool moved_far_ = false;
    std::string link_, moved_;
};

}  // namespace catena::scene
