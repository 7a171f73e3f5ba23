// Construction of the paths of branched chains and of their work lists.
#include "tree/branches.hpp"

#include <algorithm>
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
/// heads of their side paths.
std::vector<std::int64_t> lay_paths(std::vector<std::int64_t> const& heads,
                                    Children const& children, Branches& b) {
    std::vector<std::int64_t> next_heads;
    // Side paths follow all paths of these heads.
    std::int64_t const first_side = b.first_of_generation.back() + std::ssize(heads);
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
    b.first_of_generation.push_back(first_side);
    return next_heads;
}

/// Returns the phase of the body at each place.
std::vector<std::int64_t> phases_of(Branches const& b) {
    std::vector<std::int64_t> phase(b.body.size(), 0),
        of_path(static_cast<std::size_t>(b.paths()), 0);
    auto fork = b.forks.rbegin();
    for (std::size_t path = of_path.size(); path-- > 0;)
        for (std::int64_t place = b.first_of_path[path + 1]; place-- > b.first_of_path[path];) {
            std::int64_t& of_body = phase[static_cast<std::size_t>(place)];
            if (fork != b.forks.rend() && fork->place == place) {
                auto const first = of_path.begin() + fork->first_path;
                of_body = 1 + *std::max_element(first, first + fork->paths());
                ++fork;
            }
            of_path[path] = std::max(of_path[path], of_body);
        }
    return phase;
}

/// Builds the trees of paths and deals their work out to the phases.
class PathTrees {
  public:
    PathTrees(Branches& branches, std::vector<std::int64_t> const& phase, bool pairwise)
        : b_(branches), phase_(phase), run_length_(run_length_for(pairwise)) {
        b_.joints = std::ssize(b_.body) + 2;  // as in Schedule: the halo, and a joint that is 0
        for (std::size_t path = 0; path + 1 < b_.first_of_path.size(); ++path) add(path);
    }

  private:
    /// A segment; `levels` counts its merges of its own phase, one above the other.
    struct Node {
        std::int64_t slot = 0, first = 0, next = 0, phase = 0;
        std::size_t levels = 0;
    };

    void add(std::size_t path) {
        std::vector<Node> leaves;
        std::int64_t const end = b_.first_of_path[path + 1];
        for (std::int64_t place = b_.first_of_path[path]; place < end;)
            place = leaves.emplace_back(leaf(place, end)).next;
        leaves.back().next = b_.joints - 1;
        lists(leaves.back().phase).runs.back().next = b_.joints - 1;
        Node const root = joined(leaves);
        lists(root.phase)
            .roots.push_back(
                {root.slot, root.first, root.next, static_cast<int>(path), TipTo::nothing});
    }
    /// Appends the run that begins at a place of a path, which ends at `end`.
    Node leaf(std::int64_t place, std::int64_t end) {
        std::int64_t next = place, phase = 0;
        do {
            phase = std::max(phase, phase_[static_cast<std::size_t>(next++)]);
        } while (next < std::min(end, place + run_length_) && phase <= last_phase_of_runs &&
                 phase_[static_cast<std::size_t>(next)] <= last_phase_of_runs);
        lists(phase).runs.push_back({place, next - place, b_.slots, next});
        return {b_.slots++, place, next, phase, 0};
    }
    /// Merges neighbouring segments into one.
    Node joined(std::span<Node const> nodes) {
        if (nodes.size() == 1) return nodes.front();
        std::size_t const cut = cut_of(nodes);
        Node const inboard = joined(nodes.first(cut)), outboard = joined(nodes.subspan(cut));
        std::int64_t const phase = std::max(inboard.phase, outboard.phase);
        std::size_t const level = std::max(inboard.phase == phase ? inboard.levels : 0,
                                           outboard.phase == phase ? outboard.levels : 0);
        auto& levels = lists(phase).levels;
        if (levels.size() <= level) levels.resize(level + 1);
        levels[level].push_back(
            {inboard.slot, outboard.slot, b_.slots, inboard.first, outboard.first, outboard.next});
        return {b_.slots++, inboard.first, outboard.next, phase, level + 1};
    }
    /// Returns the number of segments inboard of the joint that is eliminated last.
    static std::size_t cut_of(std::span<Node const> nodes) {
        auto const [least, most] =
            std::minmax_element(nodes.begin(), nodes.end(),
                                [](Node const& a, Node const& b) { return a.phase < b.phase; });
        // As in ChainTree.
        if (least->phase == most->phase) return std::bit_floor(nodes.size() - 1);
        std::uint64_t sum = 0, before = 0;
        for (Node const& node : nodes) sum += weight(most->phase - node.phase);
        for (std::size_t cut = 1; cut < nodes.size(); ++cut) {
            std::uint64_t const last = before;
            before += weight(most->phase - nodes[cut - 1].phase);
            if (2 * before < sum && cut + 1 < nodes.size()) continue;
            bool const nearer = cut > 1 && sum - 2 * last <= (2 * before > sum ? 2 * before - sum
                                                                               : sum - 2 * before);
            return nearer ? cut - 1 : cut;
        }
        return nodes.size() - 1;
    }
    /// Weight of a segment so many phases before the last: a quarter for each.
    static std::uint64_t weight(std::int64_t phases) {
        constexpr std::int64_t most = 18;
        return phases > most ? 0 : std::uint64_t{1} << 2 * (most - phases);
    }
    PhaseLists& lists(std::int64_t phase) {
        if (std::ssize(b_.lists) <= phase) b_.lists.resize(static_cast<std::size_t>(phase) + 1);
        return b_.lists[static_cast<std::size_t>(phase)];
    }

    /// Last phase whose bodies share runs. At most a quarter of all bodies are of later phases.
    static constexpr std::int64_t last_phase_of_runs = 1;
    Branches& b_;
    std::vector<std::int64_t> const& phase_;
    std::int64_t run_length_;
};

/// Sorts forks by their phases, and by places within a phase.
void sort_by_phase(std::vector<std::int64_t> const& phase, Branches& b) {
    auto const of = [&](Fork const& fork) { return phase[static_cast<std::size_t>(fork.place)]; };
    std::stable_sort(b.forks.begin(), b.forks.end(),
                     [&](Fork const& x, Fork const& y) { return of(x) < of(y); });
    b.first_fork_of_phase.assign(1, 0);
    for (std::int64_t p = 0; p < b.phases(); ++p) {
        auto const end = std::upper_bound(
            b.forks.begin(), b.forks.end(), p,
            [&](std::int64_t value, Fork const& fork) { return value < of(fork); });
        b.first_fork_of_phase.push_back(end - b.forks.begin());
    }
}

/// Levels of a sum over `terms` terms in pairs.
std::int64_t levels_of_sum(std::int64_t terms) {
    return std::bit_width(static_cast<std::uint64_t>(terms - 1)) + 1;
}

/// Returns the depth of a phase: its longest sum over side paths, longest run and levels.
std::int64_t depth_of(Branches const& b, std::size_t phase) {
    PhaseLists const& lists = b.lists[phase];
    std::int64_t sums = 0, of_runs = 0;
    for (std::int64_t f = b.first_fork_of_phase[phase]; f < b.first_fork_of_phase[phase + 1]; ++f)
        sums = std::max(sums, levels_of_sum(b.forks[static_cast<std::size_t>(f)].paths()));
    for (Run const& run : lists.runs) of_runs = std::max(of_runs, run.count - 1);
    return sums + of_runs + std::ssize(lists.levels);
}

}  // namespace

Branches::Branches(std::span<std::int64_t const> inboard, bool pairwise) : first_of_path{0} {
    Children const children(inboard);
    body.reserve(inboard.size());
    for (std::vector<std::int64_t> heads = first_bodies(inboard); !heads.empty();)
        heads = lay_paths(heads, children, *this);
    std::vector<std::int64_t> const phase = phases_of(*this);
    PathTrees(*this, phase, pairwise);
    sort_by_phase(phase, *this);
    for (std::size_t p = 0; p < lists.size(); ++p) depth_ += depth_of(*this, p);
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
