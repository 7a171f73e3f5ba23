// The beads of a scene as OpenMM knows them, and energies by term. No OpenMM here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// All beads of a scene (those of chains that have some, one chain after the other; bodies' carried
/// beads in their place), known to every rank, and which of them a rank owns.
struct BeadSystem {
    struct Link {
        std::int64_t inboard, outboard;
        double length;
    };
    std::vector<double> mass;
    std::vector<std::string> residue;
    std::vector<std::string> chain_name;     // one a chain
    std::vector<std::int64_t> chain_offset;  // first bead of each chain, then the number of beads
    std::vector<Link> links;                 // between beads (a link to ground is not among them)
    std::vector<std::pair<std::int64_t, std::int64_t>>
        neighbours;  // last bead of a body and first of the next, on joints but links
    std::vector<std::pair<std::int64_t, std::int64_t>>
        rigid;  // beads [first, last) of one rigid body, where there are several
    std::vector<std::int64_t>
        first_of_rank;  // size ranks + 1: rank r owns beads by_rank[first_of_rank[r]] ..
                        // by_rank[first_of_rank[r + 1] - 1]
    std::vector<std::int64_t>
        by_rank;  // beads in the order in which ranks own them; empty: as they are
    std::vector<std::int64_t>
        number;  // of each bead in the scene, for messages; empty: as they are
    std::optional<Vec3> box;
    std::string scene_file;  // for messages
    int threads = 0;         // that look for ghosts; 0: the rank's cores

    std::int64_t size() const { return static_cast<std::int64_t>(mass.size()); }
    std::vector<std::int64_t> beads_of(int rank) const;
    std::int64_t name(std::int64_t bead) const {
        return number.empty() ? bead : number[static_cast<std::size_t>(bead)];
    }
};

struct EnergyTerm {
    std::string name;
    double value;  // kJ/mol
};

}  // namespace catena
