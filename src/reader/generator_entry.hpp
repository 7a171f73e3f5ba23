// `generator: {random: ...}` and its like: which one, its numbers, and the chain made from them.
#pragma once

#include "generate/generators.hpp"
#include "reader/chain_request.hpp"

namespace catena::scene {

class GeneratorEntry {
  public:
    /// Throws InputError for a generator that is unknown or incomplete.
    GeneratorEntry(ChainRequest const& request, Node const& node);

    std::int64_t size() const { return size_; }
    /// Point beads on links: smaller than bodies.
    bool is_beads() const { return beads_; }
    /// Whether the chains it makes have velocities of their own.
    bool gives_velocities() const { return velocities_; }
    /// Whether copies differ from each other.
    bool is_random() const { return !polygon_ && (!rods_ || rods_->is_random()); }
    /// Fills the chain.
    void make(ChainSpec& chain, std::int64_t copy) const;

  private:
    void read_random();
    void read_rods();
    void read_walk();
    void read_polygon();
    void read_elastic_rod();
    std::uint64_t seed(std::int64_t copy) const;

    ChainRequest const& request_;
    Node const& entry_;
    std::int64_t size_ = 0;
    std::optional<RandomChain> random_;  // one of five
    std::optional<Rods> rods_;
    std::optional<Walk> walk_;
    std::optional<Polygon> polygon_;
    std::optional<ElasticRod> elastic_;
    Winding winding_;
    double persistence_ = 0;  // of a worm-like walk
    bool beads_ = false, velocities_ = false, loads_ = true;
};

/// Whether the generator's chains stand on a fixed base unless the scene says otherwise.
bool stands_fixed(Node const& generator);

}  // namespace catena::scene
