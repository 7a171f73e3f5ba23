// Implements grow(): self-avoiding growth of many chains in one periodic box.
#include <algorithm>
#include <limits>

#include "generate/crowd.hpp"
#include "generate/occupied.hpp"
#include "generate/random.hpp"

namespace catena::scene {

namespace {

/// Grows all chains of a crowd, one bead per chain in turns.
class Growth {
  public:
    Growth(Crowd& crowd, std::uint64_t seed)
        : crowd_(crowd),
          seed_(seed),
          occupied_(crowd.box, crowd.excluded, crowd.at.size()),
          tips_(crowd.chains()) {
        for (std::size_t i = crowd.movable(); i < crowd.at.size(); ++i)
            occupied_.put(i, crowd.at[i]);
        for (std::size_t c = 0; c < tips_.size(); ++c)
            tips_[c].allowance = crowd.first[c + 1] - crowd.first[c];
    }

    void run() {
        std::size_t longest = 0;
        for (std::size_t c = 0; c < tips_.size(); ++c) longest = std::max(longest, size_of(c));
        for (std::size_t size = 1; size <= longest; ++size)
            for (std::size_t c = 0; c < tips_.size(); ++c)
                if (size <= size_of(c)) grow_to(c, size);
    }

  private:
    /// State of a growing chain.
    struct Tip {
        /// Number of beads placed so far.
        std::size_t grown = 0;
        /// Number of beads that the chain may still remove; at 0 it accepts overlaps.
        std::size_t allowance = 0;
        /// Number of random streams used so far.
        std::uint64_t draws = 0;
    };

    std::size_t size_of(std::size_t chain) const {
        return crowd_.first[chain + 1] - crowd_.first[chain];
    }

    /// Grows the chain to `size` beads. The retreat doubles with each failure, so that the chain
    /// leaves any dead end.
    void grow_to(std::size_t chain, std::size_t size) {
        Tip& tip = tips_[chain];
        std::size_t retreat = 1;
        while (tip.grown < size) {
            if (extend(chain)) continue;
            std::size_t const back =
                std::min({retreat, tip.grown > 0 ? tip.grown - 1 : 0, tip.allowance});
            for (std::size_t i = 0; i < back; ++i)
                occupied_.take(crowd_.first[chain] + --tip.grown);
            tip.allowance = back > 0 ? tip.allowance - back : 0;
            retreat *= 2;
        }
    }

    /// Adds a bead at the first free place among 64 trials and returns true. Without free place it
    /// returns false or, if the chain has no allowance left, accepts the least overlap. Places
    /// beyond the chain's walls are worse than any overlap.
    bool extend(std::size_t chain) {
        Tip& tip = tips_[chain];
        std::size_t const i = crowd_.first[chain] + tip.grown;
        std::int32_t const neighbour =
            tip.grown > 0 ? static_cast<std::int32_t>(crowd_.inboard(i)) : Occupied::none;
        double const enough = crowd_.excluded * crowd_.excluded;
        bool const choosy = tip.allowance > 0;
        double best = -std::numeric_limits<double>::infinity();
        for (int trial = 0; trial < 64 && best < enough; ++trial) {
            Vec3 const place = candidate(chain);
            double const outside = crowd_.outside(chain, place);
            double const clear =
                outside > 0 ? -outside
                            : occupied_.clearance(place, neighbour,
                                                  choosy ? 0.999999 * enough : best, enough);
            if (clear > best) best = clear, crowd_.at[i] = place;
        }
        if (choosy && best < enough) return false;
        occupied_.put(i, crowd_.at[i]);
        ++tip.grown;
        return true;
    }

    /// Draws a trial position: at the link's length from the bead on which it hangs, or anywhere
    /// for the first bead.
    Vec3 candidate(std::size_t chain) {
        Tip& tip = tips_[chain];
        std::size_t const i = crowd_.first[chain] + tip.grown;
        Draws draws(seed_of_stream(seed_, chain), static_cast<std::int64_t>(tip.grown),
                    tip.draws++);
        if (tip.grown > 0)
            return plus_scaled(crowd_.at[crowd_.inboard(i)], crowd_.length[i], draws.on_sphere());
        Vec3 start;
        for (int axis = 0; axis < 3; ++axis) {
            Range const range = crowd_.range(chain, axis);
            start[axis] = range.is_bounded() ? draws.between(range.low, range.high)
                                             : draws.between(0, crowd_.box[axis]);
        }
        return start;
    }

    Crowd& crowd_;
    std::uint64_t seed_;
    Occupied occupied_;
    std::vector<Tip> tips_;
};

}  // namespace

void grow(Crowd& crowd, std::uint64_t seed) { Growth(crowd, seed).run(); }

}  // namespace catena::scene
