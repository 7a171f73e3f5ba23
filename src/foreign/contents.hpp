// Files of a folder by what they hold.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace catena::foreign {

/// Files of a folder, each list in alphabetical order.
struct Contents {
    std::vector<std::string> all, systems, states, integrators, topologies;
    /// Files whose name promises a System, State or Integrator, and that hold none.
    std::vector<std::string> no_systems, no_states, no_integrators;
};

/// Reads the names of a folder and the root elements of its XML files. Throws InputError for a
/// folder that cannot be read.
Contents contents_of(std::filesystem::path const& folder);

/// True for the endings of PDB and mmCIF files, compressed or not.
bool is_topology(std::filesystem::path const& file);

/// Name of the root element of an XML file; empty if its first 64 kB hold none.
std::string root_of(std::filesystem::path const& file);

/// File names without folders and joined by commas, for messages.
std::string bare_names(std::vector<std::string> const& files);

}  // namespace catena::foreign
