// Domain files of the CALVADOS package: `domains.yaml`, domains by the names of proteins.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/node.hpp"

namespace catena::scene {

/// Segments [first, last] of one domain. Residues count along the chain from 1, both included.
using DomainSegments = std::vector<std::array<std::int64_t, 2>>;

/// Domains of one protein in a file.
struct FileDomains {
    std::string protein;
    std::vector<DomainSegments> domains;
};

/// Reads a YAML file that maps names of proteins to lists of domains: [first, last], or a list of
/// such pairs for a domain of several segments. The protein is that of the name `wanted`; if that
/// is empty, the one of the name `chain`, else the only one. `at` names the file in messages.
/// Throws InputError for other contents and for an unknown protein.
FileDomains read_domain_file(std::string const& path, Node const& at, std::string const& wanted,
                             std::string const& chain);

}  // namespace catena::scene
