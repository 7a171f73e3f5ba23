// Members of complexes as chains of their own: another order of a trajectory's sites.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/output.hpp"

namespace catena {

/// A topology whose chains are the members of another one's chains.
struct MemberOrder {
    /// Masses, residues and chains. Sites follow each other along each member. A chain of one
    /// member keeps its name; members of others are named "CHAIN:IDENTIFIER".
    Topology topology;
    /// Index in the other topology of each site.
    std::vector<std::size_t> site;
};

/// Returns the members of all chains, in the order of the chains.
MemberOrder by_members(Topology const&);

/// True if the chain of the topology has several members.
bool is_complex(Topology const&, std::size_t chain);

/// Returns members from one entry per site: index of the member, place along it, residue number.
/// Returns nothing if the lists do not describe members of `topology`: lengths that do not fit,
/// unknown members, members in several chains, or places that are taken twice.
std::optional<Members> members_of_sites(Topology const& topology,
                                        std::vector<std::string> const& identifiers,
                                        std::vector<std::int64_t> const& member,
                                        std::vector<std::int64_t> const& place,
                                        std::vector<std::int64_t> const& number);

}  // namespace catena
