// Construction of the paths of branched chains and of their work lists.
#include "tree/branches.hpp"

#include <bit>

namespace catena::dca {
namespace {

/// Children of every body, in ascending order, and the child with which its path goes on.
class Children {
  public:
    explicit Children(std::span<std::int64_t const> inboard)
        : first_(inboard.size() + 1, 0), child_(inboard.size()), heavy_(inboard.size(), -1) {
        auto const n = std::ssize(inboard);
        for (std::int64_t const p : inboard)
            if (p >= 0) ++first_[at(p) + 1];
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        std::vector<std::int64_t> next = first_, size(inboard.size(), 1);
        for (std::int64_t k = 0; k < n; ++k)
            if (inboard[at(k)] >= 0) child_[at(next[at(inboard[at(k)])]++)] = k;
        for (std::int64_t k = n - 1; k >= 0; --k) {
            for (std::int64_t const c : of(k))
                if (heavy_[at(k)] < 0 || size[at(c)] > size[at(heavy_[at(k)])]) heavy_[at(k)] = c;
            if (inboard[at(k)] >= 0) size[at(inboard[at(k)])] += size[at(k)];
        }
    }
    std::span<std::int64_t const> of(std::int64_t k) const {
        return std::span(child_).subspan(at(first_[at(k)]), at(first_[at(k) + 1] - first_[at(k)]));
    }
    /// Returns the next body of the path of body k; -1 if it ends there.
    std::int64_t heavy(std::int64_t k) const { return heavy_[at(k)]; }

  private:
    static std::size_t at(std::int64_t k) { return static_cast<std::size_t>(k); }
    std::vector<std::int64_t> first_, child_, heavy_;
};

/// Returns the chains' first bodies.
std::vector<std::int64_t> first_bodies(std::span<std::int64_t const> inboard) {
    std::vector<std::int64_t> first;
    for (std::int64_t k = 0; k < std::ssize(inboard); ++k)
        if (inboard[static_cast<std::size_t>(k)] < 0) first.push_back(k);
    return first;
}

/// Lays the paths that begin with `heads` at the next places and appends their forks. Returns the
/// heads of the next phase.
std::vector<std::int64_t> lay_phase(std::vector<std::int64_t> const& heads,
                                    Children const& children, Branches& b) {
    std::vector<std::int64_t> next_heads;
    // Side paths follow all paths of this phase.
    std::int64_t const first_side = b.first_of_phase.back() + std::ssize(heads);
    for (std::int64_t const head : heads) {
        for (std::int64_t k = head; k >= 0; k = children.heavy(k)) {
            std::int64_t const first = first_side + std::ssize(next_heads);
            for (std::int64_t const c : children.of(k))
                if (c != children.heavy(k)) next_heads.push_back(c);
            std::int64_t const end = first_side + std::ssize(next_heads);
            if (end > first) b.forks.push_back({std::ssize(b.body), first, end});
            b.body.push_back(k);
        }
        b.first_of_path.push_back(std::ssize(b.body));
    }
    b.first_of_phase.push_back(first_side);
    b.first_fork_of_phase.push_back(std::ssize(b.forks));
    return next_heads;
}

/// Deals the lists of all paths out to their phases. Paths are the chains of `all`.
std::vector<PhaseLists> deal_out(Schedule const& all, Branches const& b) {
    std::vector<PhaseLists> lists(b.first_of_phase.size() - 1);
    // The first place of each phase tells to which phase a joint belongs.
    std::vector<std::int64_t> begin;
    for (std::int64_t const path : b.first_of_phase)
        begin.push_back(b.first_of_path[static_cast<std::size_t>(path)]);
    auto const of = [&](std::int64_t joint) -> PhaseLists& {
        auto const after = std::upper_bound(begin.begin(), begin.end(), joint);
        return lists[static_cast<std::size_t>(after - begin.begin()) - 1];
    };
    for (Run const& run : all.runs) of(run.body).runs.push_back(run);
    for (std::size_t l = 0; l < all.levels.size(); ++l)
        for (Merge const& m : all.levels[l]) {
            PhaseLists& phase = of(m.joint);
            if (phase.levels.size() <= l) phase.levels.resize(l + 1);
            phase.levels[l].push_back(m);
        }
    for (Root const& root : all.roots) of(root.first).roots.push_back(root);
    return lists;
}

/// Levels of a sum over `terms` terms in pairs.
std::int64_t levels_of_sum(std::int64_t terms) {
    return std::bit_width(static_cast<std::uint64_t>(terms - 1)) + 1;
}

/// Returns Branches::depth(): the largest depth of each body, from the ends inwards.
std::int64_t depth_of(Branches const& b, std::vector<ChainTree> const& trees) {
    std::int64_t depth = 0;
    for (std::int64_t phase = std::ssize(b.first_of_phase) - 2; phase >= 0; --phase) {
        std::int64_t sums = 0, of_trees = 0;
        for (std::int64_t f = b.first_fork_of_phase[static_cast<std::size_t>(phase)];
             f < b.first_fork_of_phase[static_cast<std::size_t>(phase) + 1]; ++f)
            sums = std::max(sums, levels_of_sum(b.forks[static_cast<std::size_t>(f)].paths()));
        for (std::int64_t path = b.first_of_phase[static_cast<std::size_t>(phase)];
             path < b.first_of_phase[static_cast<std::size_t>(phase) + 1]; ++path) {
            ChainTree const& tree = trees[static_cast<std::size_t>(path)];
            of_trees =
                std::max(of_trees, std::min(tree.bodies, tree.run_length) - 1 + tree.levels());
        }
        depth += sums + of_trees;
    }
    return depth;
}

}  // namespace

Branches::Branches(std::span<std::int64_t const> inboard, bool pairwise) : first_of_path{0} {
    Children const children(inboard);
    body.reserve(inboard.size());
    for (std::vector<std::int64_t> heads = first_bodies(inboard); !heads.empty();)
        heads = lay_phase(heads, children, *this);
    std::vector<std::int64_t> lengths;
    for (std::size_t path = 0; path + 1 < first_of_path.size(); ++path)
        lengths.push_back(first_of_path[path + 1] - first_of_path[path]);
    Partition const partition(lengths, pairwise, 1);
    Schedule const schedule = make_schedule(partition, 0);
    slots = schedule.slots;
    joints = schedule.joints;
    lists = deal_out(schedule, *this);
    depth_ = depth_of(*this, partition.trees);
}

BranchCounts Branches::counts() const {
    BranchCounts counts{paths(), 0, phases(), 0, depth()};
    for (PhaseLists const& phase : lists) {
        counts.runs += std::ssize(phase.runs);
        counts.levels = std::max(counts.levels, std::ssize(phase.levels));
    }
    return counts;
}

}  // namespace catena::dca
