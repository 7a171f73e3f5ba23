// What `rigid` makes of a file: bodies of one chain that serial chains are assembled from.
#pragma once

#include <string>
#include <string_view>

#include "domains/rigid_entry.hpp"
#include "tests/fuzz/target.hpp"

namespace catena::fuzz {

/// Residues of the chain that the domains belong to.
constexpr std::size_t chain_residues = 200;

/// Reads `rigid` with the file and requires bodies that share no residue and lie in the chain.
inline void read_rigid(std::string const& key, std::string_view bytes,
                       scene::RigidSource const& source, std::string const& more) {
    MemoryFile const file(bytes);
    auto const entry =
        scene::parse_document("rigid: {" + key + ": " + file.path() + more + "}", "scene.yaml");
    scene::RigidBodies const made = read_rigid_bodies(entry->items.at(0), source);
    std::vector<bool> taken(source.numbers.residues);
    for (scene::RigidSet const& set : made.sets) {
        std::size_t residues = 0;
        for (scene::Domain const& range : set.ranges)
            for (std::size_t k = range.first; k <= range.last; ++k, ++residues) {
                require(k < taken.size() && !taken[k]);
                taken[k] = true;
            }
        require(residues >= 3);
    }
    std::size_t placed = 0;
    for (scene::Assembly const& chain : assemble(made.sets, source.numbers))
        placed += chain.residues.size();
    require(placed == source.numbers.residues);
}

}  // namespace catena::fuzz
