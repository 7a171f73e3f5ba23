// `generator: {random: ...}` and its like: which one, its numbers, and the chain made from them.
#pragma once

#include "scene/chain_request.hpp"

namespace catena::scene {

class GeneratorEntry {
  public:
    /// Throws InputError for a generator that is unknown, incomplete or not in this version.
    GeneratorEntry(ChainRequest const& request, Node const& node);

    std::int64_t size() const { return size_; }
    bool is_beads() const { return beads_; }
    /// Whether the chains it makes have velocities of their own.
    bool gives_velocities() const { return velocities_; }
    /// Fills `beads` or `bodies` of the chain.
    void make(ChainSpec& chain, std::int64_t copy) const;

  private:
    std::uint64_t seed(std::int64_t copy) const;

    ChainRequest const& request_;
    Node const& entry_;
    std::int64_t size_ = 0;
    JointType joint_ = JointType::link;
    double mass_ = 1, length_ = 1, radius_ = 0.05;
    bool beads_ = false, velocities_ = false, loads_ = true;
};

}  // namespace catena::scene
