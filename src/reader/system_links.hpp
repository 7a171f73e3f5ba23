// Links of chains that are written together with an OpenMM System, and notes on doubtful ones. The
// System's bonds and constraints decide the lengths of links; the scene decides which beads exist.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "reader/chains.hpp"
#include "scene/branches.hpp"
#include "systems/import.hpp"

namespace catena::scene {

/// The scene's System as seen by written chains.
class WrittenSystem {
  public:
    /// Reads the System that the scene names. Adds a note to the scene for each part that is left
    /// out. Throws InputError.
    explicit WrittenSystem(Scene&);
    /// First particle of a chain in the System. `next` is one past the last particle of the
    /// preceding chain; it is returned if the map has no such chain.
    std::int64_t first_particle(std::string const& chain, std::int64_t next) const;
    /// Length in nm of the link that bonds and constraints form between a particle and the
    /// preceding one. Returns NaN if they form none.
    double length(std::int64_t particle) const { return length(particle - 1, particle); }
    /// The same for any two particles.
    double length(std::int64_t a, std::int64_t b) const { return between(a, b).length; }
    /// Largest thermal spread, relative to the length, of the springs between neighbours in a
    /// chain. The chain has `beads` beads from particle `first` on.
    double largest_spread(std::int64_t first, std::int64_t beads, Parents parents = {}) const;
    /// True if chains of `beads` beads that begin with particles a and b have the same link
    /// lengths.
    bool alike(std::int64_t a, std::int64_t b, std::int64_t beads, Parents parents = {}) const;
    /// Notes soft springs of the System that links of these chains replace; throws InputError for
    /// the softest. Notes links where the System has no bond, or one of another length, and bonded
    /// forces between chains that do not use a periodic System's box.
    void judge(std::vector<Draft> const& drafts, Scene&) const;
    /// True if a force of the System is periodic.
    bool is_periodic() const { return links_.periodic; }

  private:
    /// What joins two particles; it holds nothing if they are not joined.
    Joining between(std::int64_t a, std::int64_t b) const;
    /// True if any bond, of custom forces too, or constraint joins two particles.
    bool bonded(std::int64_t a, std::int64_t b) const;
    /// Pairs of particles from `first` to `last` that bonds or constraints join, the lower one
    /// first.
    std::set<std::pair<std::int64_t, std::int64_t>> bonds_within(std::int64_t first,
                                                                 std::int64_t last) const;
    /// Notes the links of all drafts that are not those of the System.
    void compare(std::vector<Draft> const& drafts, Scene&) const;

    /// Links between consecutive particles of the System.
    SystemLinks links_;
    /// Temperature of the thermal spread, K.
    double temperature_;
    /// First particle of each chain in the map, by the chain's name.
    std::unordered_map<std::string, std::int64_t> first_;
};

}  // namespace catena::scene
