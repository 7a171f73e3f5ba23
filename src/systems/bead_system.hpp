// The beads of a scene in the form that OpenMM needs, and energies by term. This header does not
// need OpenMM.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// All beads of a scene, known to every rank, and their distribution over the ranks. The order is
/// that of the chains; carried beads take the places of their bodies.
struct BeadSystem {
    /// Rigid link between two beads.
    struct Link {
        std::int64_t inboard, outboard;
        /// Length, nm.
        double length;
    };
    /// Mass per bead, amu.
    std::vector<double> mass;
    /// Three-letter name of the residue per bead.
    std::vector<std::string> residue;
    std::vector<std::string> chain_name;  // one per chain
    /// First bead of each chain, then the number of beads.
    std::vector<std::int64_t> chain_offset;
    /// Links between beads; links to the ground are not among them.
    std::vector<Link> links;
    /// Last bead of a body and first bead of the next, across joints other than links.
    std::vector<std::pair<std::int64_t, std::int64_t>> neighbours;
    /// Range [first, last) of the beads of one rigid body, for bodies with several beads.
    std::vector<std::pair<std::int64_t, std::int64_t>> rigid;
    /// Range of beads per rank, ranks + 1 entries. Rank r owns by_rank[first_of_rank[r]] to
    /// by_rank[first_of_rank[r + 1] - 1].
    std::vector<std::int64_t> first_of_rank;
    /// Beads in the order in which ranks own them; empty if that is their own order.
    std::vector<std::int64_t> by_rank;
    /// Number of each bead in the scene, for messages; empty if it equals the index.
    std::vector<std::int64_t> number;
    /// Edges of the periodic box, nm.
    std::optional<Vec3> box;
    std::string scene_file;  // for messages
    int threads = 0;         // for the search for ghosts; 0: the rank's cores

    /// Number of replicas, which exert no forces on each other. Their beads follow one another, and
    /// all replicas have the same beads.
    std::int64_t replicas = 1;

    std::int64_t size() const { return static_cast<std::int64_t>(mass.size()); }
    /// Number of beads of one replica.
    std::int64_t beads_a_replica() const { return size() / replicas; }
    /// Beads that the rank owns, in the order of by_rank.
    std::vector<std::int64_t> beads_of(int rank) const;
    /// Number of a bead in the scene, for messages.
    std::int64_t name(std::int64_t bead) const {
        return number.empty() ? bead : number[static_cast<std::size_t>(bead)];
    }
};

/// Potential energy of one force.
struct EnergyTerm {
    /// Name of the term, as in the output.
    std::string name;
    double value;  // kJ/mol
};

}  // namespace catena
