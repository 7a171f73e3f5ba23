// What the files beside a CALVADOS configuration hold, read once for all comparisons.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "foreign/system_text.hpp"
#include "math/linear.hpp"
#include "systems/import.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

/// Rounding of distances between positions of a PDB file, whose last digit is 1e-4 nm.
inline constexpr double most_pdb_difference = 2e-4;  // nm

/// The System of a folder with its topology.
struct MadeSystem {
    SystemText text;
    /// Empty if no charges are recognised.
    std::optional<ScreenedChains> charges;
    /// Chains of the topology; empty without one.
    std::vector<PdbChain> chains;
    std::string topology;  // its name without the folder, for messages
    /// Positions in top.pdb, which the package writes with the System, nm; empty without them.
    std::vector<Vec3> first_start;

    std::string name() const { return text.name(); }
    /// Returns the distance of the nearest images of two particles in top.pdb, nm; nothing for
    /// particles that it does not have.
    std::optional<double> distance(std::int64_t a, std::int64_t b) const;
};

/// Reads the files. Throws InputError if one cannot be read.
MadeSystem read_made_system(Files const&);

}  // namespace catena::foreign
