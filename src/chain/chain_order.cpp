// Recursive bisection of space, which orders chains by rank.
#include "chain/chain_order.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace catena {
namespace {

/// Number of bodies of all chains.
std::int64_t bodies_of(std::span<PlacedChain const> chains) {
    std::int64_t bodies = 0;
    for (PlacedChain const& chain : chains) bodies += chain.bodies;
    return bodies;
}

/// Axis along which the midpoints of the chains extend farthest.
int longest_side(std::span<PlacedChain const> chains) {
    Vec3 least = chains[0].middle, most = least;
    for (PlacedChain const& chain : chains)
        for (int i = 0; i < 3; ++i) {
            least[i] = std::min(least[i], chain.middle[i]);
            most[i] = std::max(most[i], chain.middle[i]);
        }
    Vec3 const side = most - least;
    return static_cast<int>(std::max_element(side.data, side.data + 3) - side.data);
}

/// Recursive bisection with the cuts of dca::cut_by_shares(): a chain goes to the rank whose share
/// of all bodies contains the chain's middle.
class Halving {
  public:
    Halving(std::span<PlacedChain> chains, int ranks, dca::Shares const& shares)
        : begins_(dca::begins_of_shares(shares, ranks)), all_(bodies_of(chains)) {
        order(chains, 0, ranks, 0);
    }

  private:
    /// Sorts the chains of ranks [first, last). Chains of earlier ranks contain `before` bodies.
    void order(std::span<PlacedChain> chains, int first, int last, std::int64_t before) const {
        std::sort(chains.begin(), chains.end(),
                  [](PlacedChain const& a, PlacedChain const& b) { return a.chain < b.chain; });
        if (last - first == 1 || chains.size() < 2) return;
        int const axis = longest_side(chains), middle = first + (last - first) / 2;
        std::stable_sort(chains.begin(), chains.end(),
                         [axis](PlacedChain const& a, PlacedChain const& b) {
                             return a.middle[axis] < b.middle[axis];
                         });
        std::size_t cut = 0;
        std::int64_t begin = before;
        std::int64_t const part = begins_[static_cast<std::size_t>(middle)], parts = begins_.back();
        while (cut < chains.size() && (2 * begin + chains[cut].bodies) * parts < 2 * all_ * part)
            begin += chains[cut++].bodies;
        order(chains.first(cut), first, middle, before);
        order(chains.subspan(cut), middle, last, begin);
    }

    std::vector<std::int64_t> begins_;
    std::int64_t all_;
};

}  // namespace

std::vector<int> compact_order(std::vector<PlacedChain> chains, int ranks,
                               dca::Shares const& shares) {
    Halving const halving(chains, ranks, shares);  // sorts `chains`
    std::vector<int> in_order;
    for (PlacedChain const& chain : chains) in_order.push_back(chain.chain);
    return in_order;
}

std::vector<PlacedChain> placed_chains(Scene const& scene, std::vector<int> const& chains) {
    std::vector<PlacedChain> placed;
    for (int const chain : chains) {
        ChainSpec const& spec = scene.chains[static_cast<std::size_t>(chain)];
        std::vector<Vec3> const& points =
            spec.is_beads() ? spec.beads.position : spec.linked.position;
        PlacedChain p{chain, Vec3::zero(), static_cast<std::int64_t>(spec.size())};
        for (Vec3 const& x : points)
            p.middle = p.middle + (1.0 / static_cast<double>(points.size())) * x;
        if (scene.box)
            for (int i = 0; i < 3; ++i)
                p.middle[i] -= (*scene.box)[i] * std::floor(p.middle[i] / (*scene.box)[i]);
        placed.push_back(p);
    }
    return placed;
}

}  // namespace catena
