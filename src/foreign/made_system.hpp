// What the files beside a CALVADOS configuration hold, read once for all comparisons.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "foreign/system_text.hpp"
#include "systems/import.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

/// The System of a folder with its topology.
struct MadeSystem {
    SystemText text;
    /// Nothing if no charges are recognised.
    std::optional<ScreenedChains> charges;
    /// Chains of the topology; empty without one.
    std::vector<PdbChain> chains;
    std::string topology;  // its name without the folder, for messages

    std::string name() const { return text.name(); }
};

/// Reads the files. Throws InputError if one cannot be read.
MadeSystem read_made_system(Files const&);

}  // namespace catena::foreign
