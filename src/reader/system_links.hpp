// Chains that the scene writes down beside a System of OpenMM's: their links, and what is doubtful
// about them.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "reader/chains.hpp"
#include "systems/import.hpp"

namespace catena::scene {

class WrittenSystem {
  public:
    /// Reads the System that the scene names, and adds to the scene's notes what of it is left out.
    /// Throws InputError.
    explicit WrittenSystem(Scene&);
    /// First particle of a chain in the System; `next`: one past the last of the chain before,
    /// which counts where the map has no such chain.
    std::int64_t first_particle(std::string const& chain, std::int64_t next) const;
    /// nm, of the link that bonds and constraints make between a particle and the one before; NaN
    /// where none does.
    double length(std::int64_t particle) const;
    /// Largest thermal spread of the springs between neighbours in a chain of so many beads that
    /// begins with particle `first`, relative to their length.
    double largest_spread(std::int64_t first, std::int64_t beads) const;
    /// Whether links in chains of so many beads that begin with particles a and b are of the same
    /// lengths.
    bool alike(std::int64_t a, std::int64_t b, std::int64_t beads) const;
    /// Notes springs of the System that links of these chains replace although they are soft, and
    /// refuses the softest.
    void judge(std::vector<Draft> const& drafts, Scene&) const;

  private:
    SystemLinks links_;
    double temperature_;
    std::unordered_map<std::string, std::int64_t> first_;  // of the map, by the chain's name
};

}  // namespace catena::scene
