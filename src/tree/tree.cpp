// Construction of chain trees, of the partition into units, and of a rank's schedule.
#include "tree/tree.hpp"

#include <algorithm>

#include "tree/load_balance.hpp"

namespace catena::dca {

ChainTree::ChainTree(std::int64_t bodies_in, std::int64_t run_length_in)
    : bodies(bodies_in),
      run_length(run_length_in),
      runs((bodies_in + run_length_in - 1) / run_length_in) {
    while (nodes(cut_level) > max_units) ++cut_level;
    units = nodes(cut_level);
}

std::int64_t ChainTree::first_body(int level, std::int64_t node) const {
    return std::min(bodies, (node << level) * run_length);
}

int ChainTree::levels() const {
    int level = 0;
    while (nodes(level) > 1) ++level;
    return level;
}

Partition::Partition(std::vector<std::int64_t> const& lengths, bool pairwise, int ranks,
                     std::vector<TipTo> const& tips)
    : first_of_chain{0}, tip(tips) {
    tip.resize(lengths.size(), TipTo::nothing);
    for (std::int64_t const n : lengths) {
        trees.emplace_back(n, run_length_for(pairwise));
        first_of_chain.push_back(first_of_chain.back() + n);
    }
    cut_by_shares(*this, ranks, {});
}

int Partition::owner(std::int64_t body) const {
    return static_cast<int>(std::upper_bound(first_of_rank.begin(), first_of_rank.end(), body) -
                            first_of_rank.begin()) -
           1;
}

int Partition::chain_of(std::int64_t body) const {
    return static_cast<int>(std::upper_bound(first_of_chain.begin(), first_of_chain.end(), body) -
                            first_of_chain.begin()) -
           1;
}

std::vector<Piece> pieces_of(Partition const& partition, int rank) {
    std::vector<Piece> pieces;
    std::int64_t const begin = partition.first_of_rank[rank],
                       end = partition.first_of_rank[rank + 1];
    for (std::int64_t body = begin; body < end;) {
        int const chain = partition.chain_of(body);
        std::int64_t const chain_first = partition.first_of_chain[chain],
                           chain_end = partition.first_of_chain[chain + 1];
        ChainTree const& tree = partition.trees[chain];
        Piece piece;
        piece.chain = chain;
        piece.local = body - begin;
        piece.body = body - chain_first;
        piece.count = std::min(end, chain_end) - body;
        std::int64_t const unit_length = tree.run_length << tree.cut_level;
        piece.first_unit = piece.body / unit_length;
        piece.units = (piece.body + piece.count + unit_length - 1) / unit_length - piece.first_unit;
        piece.starts = body == chain_first;
        piece.ends = body + piece.count == chain_end;
        pieces.push_back(piece);
        body += piece.count;
    }
    return pieces;
}

namespace {

/// Node during construction: its slot, the storage index of its first body's inboard joint
/// (`first`), and that of the joint after its last body (`next`).
struct Node {
    std::int64_t slot, first, next;
};

/// Pairs the nodes of one level and appends the merges. An odd last node of the chain moves to the
/// next level unchanged. `slots` counts the segments allocated so far.
std::vector<Node> pair_up(std::vector<Node> const& nodes, std::vector<Merge>& merges,
                          std::int64_t& slots) {
    std::vector<Node> up;
    for (std::size_t i = 0; i < nodes.size(); i += 2) {
        if (i + 1 == nodes.size()) {
            up.push_back(nodes[i]);
            continue;
        }
        Node const& a = nodes[i];
        Node const& b = nodes[i + 1];
        merges.push_back({a.slot, b.slot, slots, a.first, b.first, b.next});
        up.push_back({slots++, a.first, b.next});
    }
    return up;
}

/// Returns the merges of `level`, after extending the list of levels if necessary.
std::vector<Merge>& level_of(std::vector<std::vector<Merge>>& levels, std::size_t level) {
    if (levels.size() <= level) levels.resize(level + 1);
    return levels[level];
}

/// Builds the schedule of one rank: runs, then merges up to the units, then shared chains.
class Builder {
  public:
    Builder(Partition const& partition, int rank)
        : partition_(partition), rank_(rank), pieces_(pieces_of(partition, rank)) {
        s_.bodies = partition.first_of_rank[rank + 1] - partition.first_of_rank[rank];
        s_.halo = s_.bodies;
        s_.none = s_.bodies + 1;
        for (Piece const& piece : pieces_)
            if (piece.ends && partition.has_jointed_tip(piece.chain))
                s_.tip_chain.push_back(piece.chain);
        s_.joints = s_.first_top_joint();
    }

    Schedule build() {
        for (Piece const& piece : pieces_) add_runs(piece);
        for (Piece const& piece : pieces_) add_units(piece);
        for (int chain = 0; chain < partition_.chains(); ++chain)
            if (partition_.is_split(chain)) add_shared(chain);
        return std::move(s_);
    }

  private:
    /// Appends the runs of one piece.
    void add_runs(Piece const& piece) {
        std::int64_t const length = partition_.trees[piece.chain].run_length;
        first_run_.push_back(static_cast<std::int64_t>(s_.runs.size()));
        for (std::int64_t body = 0; body < piece.count; body += length) {
            std::int64_t const count = std::min(length, piece.count - body);
            std::int64_t const end = piece.local + body + count;
            bool const last = body + count == piece.count;
            s_.runs.push_back({piece.local + body, count, s_.slots++,
                               !last        ? end
                               : piece.ends ? after(piece.chain)
                                            : s_.halo});
        }
    }

    /// Storage index of the joint after the last body of a chain that ends on this rank.
    std::int64_t after(int chain) const {
        auto const found = std::find(s_.tip_chain.begin(), s_.tip_chain.end(), chain);
        return found == s_.tip_chain.end() ? s_.none
                                           : s_.first_tip() + (found - s_.tip_chain.begin());
    }

    /// Appends the merges up to the units; a whole chain is merged up to its root.
    void add_units(Piece const& piece) {
        ChainTree const& tree = partition_.trees[piece.chain];
        std::int64_t const first_run =
            first_run_[static_cast<std::size_t>(&piece - pieces_.data())];
        std::int64_t const runs_a_unit = std::int64_t{1} << tree.cut_level;
        std::int64_t const runs = (piece.count + tree.run_length - 1) / tree.run_length;
        std::vector<Node> units;
        for (std::int64_t begin = 0; begin < runs; begin += runs_a_unit) {
            std::vector<Node> nodes;
            for (std::int64_t i = begin; i < std::min(runs, begin + runs_a_unit); ++i) {
                Run const& run = s_.runs[static_cast<std::size_t>(first_run + i)];
                nodes.push_back({run.slot, run.body, run.next});
            }
            for (int level = 0; level < tree.cut_level; ++level)
                nodes = pair_up(nodes, level_of(s_.levels, level), s_.slots);
            units.push_back(nodes.front());
        }
        if (!piece.whole()) {
            own_units_.insert(own_units_.end(), units.begin(), units.end());
            return;
        }
        for (std::size_t level = tree.cut_level; units.size() > 1; ++level)
            units = pair_up(units, level_of(s_.levels, level), s_.slots);
        s_.roots.push_back({units.front().slot, units.front().first, units.front().next,
                            piece.chain, partition_.tip[piece.chain]});
    }

    /// Appends the frontier units of a shared chain and, if this rank owns a part of it, the
    /// merges above them.
    void add_shared(int chain) {
        ChainTree const& tree = partition_.trees[chain];
        std::int64_t const chain_first = partition_.first_of_chain[chain];
        std::int64_t const begin = partition_.first_of_rank[rank_],
                           end = partition_.first_of_rank[rank_ + 1];
        bool const mine =
            begin < end && begin < partition_.first_of_chain[chain + 1] && end > chain_first;
        std::vector<Node> units;
        for (std::int64_t unit = 0; unit < tree.units; ++unit) {
            std::int64_t const body = chain_first + tree.first_body_of_unit(unit);
            int const owner = partition_.owner(body);
            bool const is_own = owner == rank_;
            s_.shared.push_back(
                {is_own ? own_units_[next_own_unit_++].slot : s_.slots++, owner, is_own});
            if (!mine) continue;
            std::int64_t const first = body >= begin && body < end ? body - begin
                                       : body == end               ? s_.halo
                                                     : top_joint(chain, body - chain_first);
            if (!units.empty()) units.back().next = first;
            units.push_back({s_.shared.back().slot, first, s_.none});
        }
        if (!mine) return;
        if (partition_.has_jointed_tip(chain))
            units.back().next = after(chain) != s_.none
                                    ? after(chain)
                                    : top_joint(chain, partition_.trees[chain].bodies);
        for (std::size_t level = 0; units.size() > 1; ++level)
            units = pair_up(units, level_of(s_.top_levels, level), s_.slots);
        s_.top_roots.push_back({units.front().slot, units.front().first, units.front().next, chain,
                                partition_.tip[chain]});
    }

    /// Allocates storage for a joint that only the top of a shared chain uses.
    std::int64_t top_joint(int chain, std::int64_t body) {
        s_.top_chain_of_joint.push_back(chain);
        s_.top_body_of_joint.push_back(body);
        return s_.joints++;
    }

    Partition const& partition_;
    int rank_;
    std::vector<Piece> pieces_;
    std::vector<std::int64_t> first_run_;
    std::vector<Node> own_units_;
    std::size_t next_own_unit_ = 0;
    Schedule s_;
};

}  // namespace

Schedule make_schedule(Partition const& partition, int rank) {
    return Builder(partition, rank).build();
}

}  // namespace catena::dca
