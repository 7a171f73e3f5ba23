// Reader of `generator: {random: ...}` and the other generators: their kind, parameters and chains.
#pragma once

#include "generate/generators.hpp"
#include "reader/branched_entry.hpp"
#include "reader/chain_request.hpp"

namespace catena::scene {

/// One `generator` entry of a chain. Parameters are read once; each copy of the chain differs by
/// its seed only.
class GeneratorEntry {
  public:
    /// Reads the entry. Throws InputError for a generator that is unknown or incomplete.
    GeneratorEntry(ChainRequest& request, Node const& node);

    /// Number of bodies or beads per chain.
    std::int64_t size() const { return size_; }
    /// True for point beads on links, which take less memory than bodies.
    bool is_beads() const { return beads_; }
    /// True if the generator gives its chains velocities.
    bool gives_velocities() const { return velocities_; }
    /// True if copies differ from each other.
    bool is_random() const { return !polygon_ && (!rods_ || rods_->is_random()); }
    /// Makes copy `copy` (from 0) in `chain`.
    void make(ChainSpec& chain, std::int64_t copy) const;

  private:
    /// Readers of the kinds of generators, each with its own keys.
    void read_random();
    void read_rods();
    void read_walk();
    void read_branches();
    void read_polygon();
    void read_elastic_rod();
    /// Seed of a copy: that of the entry's own `seed`, or of the scene.
    std::uint64_t seed(std::int64_t copy) const;

    ChainRequest& request_;
    /// Map of the generator's parameters.
    Node const& entry_;
    std::int64_t size_ = 0;
    std::optional<RandomChain> random_;  // exactly one of the six is set
    std::optional<Rods> rods_;
    std::optional<Walk> walk_;
    std::optional<Polygon> polygon_;
    std::optional<ElasticRod> elastic_;
    std::optional<BranchedEntry> branched_;
    /// Shape of a coil or dill.
    Winding winding_;
    double persistence_ = 0;  // persistence length of a worm-like walk
    /// Kind of the chains, whether they have velocities, and whether they keep the random loads.
    bool beads_ = false, velocities_ = false, loads_ = true;
};

/// True if the generator's chains have a fixed base by default.
bool stands_fixed(Node const& generator);

}  // namespace catena::scene
