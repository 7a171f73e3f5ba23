// Reader of the generators of branched chains: star, brush, dendrimer, random_tree.
#pragma once

#include <optional>

#include "generate/branched.hpp"
#include "reader/chain_request.hpp"

namespace catena::scene {

/// Parameters of one of these generators.
class BranchedEntry {
  public:
    /// Reads the map of the generator's parameters, whose key is its name, and the residue of the
    /// chain's `model`. Throws InputError.
    BranchedEntry(ChainRequest& request, Node const& entry);

    std::int64_t size() const { return walk_.beads; }
    /// Makes the chain of a seed, grown or at the request's `positions`. Adds a note if beads
    /// overlap.
    void make(ChainSpec& chain, std::uint64_t seed) const;

  private:
    /// Reads `residue`, `mass`, `length` and `excluded`, with defaults of the chain's model.
    void read_beads(Fields const& fields, ChainRequest& request);
    /// Throws InputError for a given `excluded` beyond what the two longest links reach.
    void refuse_beyond_reach(std::vector<double> const& length, double excluded) const;
    /// Adds a note on overlaps that a start has.
    void note(Overlaps const& left, double excluded) const;

    ChainRequest const& request_;
    BranchedShape shape_;
    Walk walk_;
    std::string residue_ = "UNK";
    /// Distance that beads keep; without a value the mean length of the links.
    std::optional<double> excluded_;
    Node const* given_excluded_ = nullptr;
};

/// True for the name of one of these generators.
bool makes_branches(std::string_view generator);

}  // namespace catena::scene
