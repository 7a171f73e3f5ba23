// Kinds of chains: chains with the same sites are copies of each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/output.hpp"

namespace catena::analysis {

/// Equal chains. They agree in the number of sites, in every mass and residue name, in being a ring
/// or not, and in their branches.
struct Kind {
    std::string name;  // unique among the kinds of a trajectory
    std::int64_t sites = 0;
    bool ring = false;
    std::vector<std::size_t> chains;  // indices in the topology, ascending
    /// Site on which each site hangs, as in the topology; empty for unbranched chains.
    std::vector<std::int64_t> parent = {};

    bool is_branched() const { return !parent.empty(); }
    std::size_t copies() const { return chains.size(); }
};

/// Returns the kinds in the order of their first chains. Chains without sites belong to none. A
/// kind of several copies is named by what the names of its chains begin with. With `by_members`
/// chains of the name COMPLEX:MEMBER are members, which the kind's name tells apart.
std::vector<Kind> kinds_of(Topology const&, bool by_members = false);

}  // namespace catena::analysis
