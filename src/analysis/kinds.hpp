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
    /// Number of replicas that have chains of this kind. Chains of different replicas do not
    /// interact.
    std::size_t replicas = 1;
    /// Site on which each site hangs, as in the topology; empty for unbranched chains.
    std::vector<std::int64_t> parent = {};

    bool is_branched() const { return !parent.empty(); }
    std::size_t copies() const { return chains.size(); }
    std::size_t copies_a_replica() const { return chains.size() / replicas; }
    /// Number of consecutive copies that are not independent of each other: those of a replica. 1
    /// without replicas, where no copies are known to be independent.
    std::size_t together() const { return replicas > 1 ? copies_a_replica() : 1; }
};

/// Returns the kinds in the order of their first chains. Chains without sites belong to none. A
/// kind of several copies is named by what the names of its chains begin with. With `by_members`
/// chains of the name COMPLEX:MEMBER are members, which the kind's name tells apart.
std::vector<Kind> kinds_of(Topology const&, bool by_members = false);

}  // namespace catena::analysis
