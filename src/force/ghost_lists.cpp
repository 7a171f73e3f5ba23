#include "force/ghost_lists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "clock.hpp"
#include "force/cells.hpp"
#include "force/ghosts.hpp"
#include "mpi/first_rank.hpp"

namespace catena {

namespace {

/// Blocks of every rank, which need not know each other's lengths. Collective.
template <class T>
std::vector<std::vector<T>> blocks_of_ranks(Communicator const& communicator, std::vector<T> const& own) {
    auto const ranks = static_cast<std::size_t>(communicator.size());
    std::int64_t const bytes = std::ssize(own) * static_cast<std::int64_t>(sizeof(T));
    std::vector<std::int64_t> bytes_of_rank(ranks);
    communicator.all_gather(std::as_bytes(std::span(&bytes, 1)), std::as_writable_bytes(std::span(bytes_of_rank)),
                            std::vector<std::int64_t>(ranks, sizeof(bytes)));
    std::int64_t total = 0;
    for (std::int64_t const b : bytes_of_rank) total += b;
    std::vector<T> all(static_cast<std::size_t>(total) / sizeof(T));
    communicator.all_gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)), bytes_of_rank);
    std::vector<std::vector<T>> blocks;
    auto begin = all.begin();
    for (std::int64_t const b : bytes_of_rank) {
        auto const end = begin + b / static_cast<std::int64_t>(sizeof(T));
        blocks.emplace_back(begin, end);
        begin = end;
    }
    return blocks;
}

[[noreturn]] void throw_trouble(double bead, char const* trouble) {
    throw SharedError(fmt::format(fmt::runtime(std::string(trouble) + ": take a smaller step, or a start without overlaps"), bead + 1));
}

void sort_unique(std::vector<std::int64_t>& values) {
    if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end()) return;  // as it is mostly
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

GhostLists::GhostLists(Communicator const& communicator, Plan plan)
    : communicator_(communicator),
      plan_(std::move(plan)),
      place_(static_cast<std::size_t>(plan_.first_of_rank.back())),
      executor_(openmp_is_built() ? openmp_executor(plan_.threads > 0 ? plan_.threads : cores_of_rank(communicator)) : serial_executor()) {
    for (std::int64_t i = 0; i < std::ssize(place_); ++i) place_[plan_.by_rank.empty() ? i : plan_.by_rank[i]] = i;
}

int GhostLists::owner(std::int64_t bead) const {
    auto const& first = plan_.first_of_rank;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), place_[bead]) - first.begin()) - 1;
}

void GhostLists::share_partners() {
    auto const partners = blocks_of_ranks(communicator_, plan_.partners);
    for (std::int64_t const bead : plan_.partners) partners_[owner(bead)].receive.push_back(bead);
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (std::int64_t const bead : partners[rank])
            if (owner(bead) == communicator_.rank()) partners_[rank].send.push_back(bead);
}

/// The same answer on every rank: the largest of a number each.
bool GhostLists::are_used_up(Moves const& moves, char const* trouble) {
    double constexpr good = 0, used_up = 1, in_trouble = 2;  // and the bead's number
    bool const far = std::exchange(renew_, false) || (moves.far && !plan_.ranges.empty());
    double const state = communicator_.max(moves.bead >= 0 ? in_trouble + static_cast<double>(moves.bead) : far ? used_up : good);
    if (state >= in_trouble) throw_trouble(state - in_trouble, trouble);
    return state == used_up;
}

void GhostLists::refuse_trouble(std::int64_t bead, char const* trouble) const {
    double const worst = communicator_.max(static_cast<double>(bead));
    if (worst >= 0) throw_trouble(worst, trouble);
}

void GhostLists::make(std::span<Vec3 const> own) {
    double const begin = seconds_now();
    if (!std::exchange(has_partners_, true)) share_partners();
    ListsOfRank lists = partners_;
    if (!plan_.ranges.empty()) add_near(own, lists);
    take(std::move(lists));
    ++traffic_.rebuilds;
    traffic_.ghosts = std::ssize(beads_);
    traffic_.most_ghosts = std::max(traffic_.most_ghosts, traffic_.ghosts);
    traffic_.seconds_of_lists += seconds_now() - begin;
}

/// Adds what acts on another rank's beads within reach + skin to what it is sent, and the other way round. Where some rank finds no place
/// aside all beads are looked for over the longest range: then every bead of another rank is a candidate there, and one that is no ghost
/// is as far away as a place aside must be.
void GhostLists::add_near(std::span<Vec3 const> own, ListsOfRank& lists) {
    PairRange const longest{longest_reach(plan_.ranges), {}};
    Grid const grid(longest.reach + plan_.skin, plan_.box);
    PointsInCells const in_cells(grid, own, *executor_);
    bool const has_room = own.empty() || find_place_aside(grid, in_cells.cells());
    std::vector<PairRange> const ranges = communicator_.max(has_room ? 0.0 : 1.0) > 0 ? std::vector{longest} : plan_.ranges;
    std::vector<std::vector<Cell>> const cells = blocks_of_ranks(communicator_, in_cells.cells());
    std::map<int, std::vector<Candidate>> candidates;
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        if (rank == communicator_.rank()) continue;
        CellSet const around = grid.with_surroundings(cells[rank]);
        for (std::size_t i = 0; i < in_cells.cells().size(); ++i)
            if (around.contains(in_cells.cells()[i]))
                for (std::int64_t const k : in_cells.points(i)) candidates[rank].push_back({own_bead(k), own[k]});
    }
    auto const of_others = swap_candidates(candidates);
    for (auto const& [rank, theirs] : of_others)
        for (PairRange const& range : ranges) add_near(candidates.at(rank), theirs, range, lists[rank]);
}

void GhostLists::add_near(std::vector<Candidate> const& mine, std::vector<Candidate> const& theirs, PairRange const& range, Lists& lists) {
    struct Acting {
        Acting(std::vector<Candidate> const& from, PairRange const& range) {
            for (Candidate const& c : from) {
                if (!range.is_for(c.bead)) continue;
                bead.push_back(c.bead);
                position.push_back(c.position);
            }
        }
        std::vector<std::int64_t> bead;
        std::vector<Vec3> position;
    };
    Acting const here(mine, range), there(theirs, range);
    auto const [shown, near] = near_each_other(here.position, there.position, range.reach + plan_.skin, plan_.box, *executor_);
    for (std::int64_t const i : shown) lists.send.push_back(here.bead[static_cast<std::size_t>(i)]);
    for (std::int64_t const i : near) lists.receive.push_back(there.bead[static_cast<std::size_t>(i)]);
    for (std::int64_t i = 0; i < std::ssize(there.bead) && plan_.box && free_.empty(); ++i) {
        if (std::binary_search(near.begin(), near.end(), i)) continue;
        free_ = {there.position[static_cast<std::size_t>(i)]};  // own beads may come nearer by half the skin
        edge_ = Vec3{{plan_.skin / 4, plan_.skin / 4, plan_.skin / 4}};
    }
}

/// In cells that are not in or around own beads', or far out where space has no end: nothing acts on own beads from there. False where
/// every cell of the box is.
bool GhostLists::find_place_aside(Grid const& grid, std::vector<Cell> const& own) {
    CellSet const felt = grid.with_surroundings(own);
    free_.clear();
    edge_ = grid.edge();
    if (!grid.ends()) {
        Cell farthest = *std::max_element(felt.begin(), felt.end());
        farthest[0] += 2;
        aside_ = grid.middle(farthest);
        return true;
    }
    Cell const& count = grid.cells();
    std::size_t constexpr enough = 4096;
    for (std::int64_t i = 0; i < count[0] * count[1] * count[2] && free_.size() < enough; ++i) {
        Cell const cell{i % count[0], i / count[0] % count[1], i / (count[0] * count[1])};
        if (!felt.contains(cell)) free_.push_back(grid.middle(cell));
    }
    return !free_.empty();
}

/// Being in or around another's cells is mutual: who sends candidates gets some.
std::map<int, std::vector<GhostLists::Candidate>> GhostLists::swap_candidates(std::map<int, std::vector<Candidate>> const& own) {
    std::map<int, std::int64_t> sent, expected;
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (auto const& [rank, candidates] : own) {
        sent[rank] = std::ssize(candidates);
        out.push_back({rank, std::as_bytes(std::span(&sent[rank], 1))});
        in.push_back({rank, std::as_writable_bytes(std::span(&expected[rank], 1))});
    }
    exchange(out, in);
    out.clear();
    in.clear();
    std::map<int, std::vector<Candidate>> others;
    for (auto const& [rank, candidates] : own) {
        others[rank].resize(static_cast<std::size_t>(expected[rank]));
        out.push_back({rank, std::as_bytes(std::span(candidates))});
        in.push_back({rank, std::as_writable_bytes(std::span(others[rank]))});
    }
    exchange(out, in);
    return others;
}

/// Out of each other's reach where there is room, in a cube: a row would be so long that OpenMM could not sort own beads among them. In a
/// box scattered over the cells that are free, thousands of them where there are so many: in one they would all feel each other.
Vec3 GhostLists::aside(std::int64_t i, std::int64_t count) const {
    auto const in_cube = [](std::int64_t k, std::int64_t of) {
        auto const side = static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(of))));
        return std::pair(Cell{k % side, k / side % side, k / (side * side)}, static_cast<double>(side));
    };
    Vec3 place;
    if (plan_.box) {
        std::int64_t const cells = std::ssize(free_);
        if (cells == 0) throw ComputationError("no place in the box is out of the beads' reach");  // every bead there is a ghost
        place = free_[static_cast<std::size_t>(i % cells)];
        auto const [at, side] = in_cube(i / cells, (count + cells - 1) / cells);
        for (int c = 0; c < 3; ++c) place[c] += edge_[c] * ((static_cast<double>(at[c]) + 0.5) / side - 0.5);
    } else {
        place = aside_;
        Cell const at = in_cube(i, count).first;
        for (int c = 0; c < 3; ++c) place[c] += edge_[0] * static_cast<double>(at[c]);
    }
    return place;
}

void GhostLists::take(ListsOfRank lists) {
    std::vector<std::int64_t> others;
    for (auto& [rank, l] : lists) {
        sort_unique(l.send);
        sort_unique(l.receive);
        std::set_difference(l.receive.begin(), l.receive.end(), plan_.partners.begin(), plan_.partners.end(), std::back_inserter(others));
    }
    std::sort(others.begin(), others.end());
    auto const partners = static_cast<std::int64_t>(plan_.partners.size());
    auto const index = [&](std::int64_t bead) {
        auto const partner = std::lower_bound(plan_.partners.begin(), plan_.partners.end(), bead);
        if (partner != plan_.partners.end() && *partner == bead) return partner - plan_.partners.begin();
        return partners + (std::lower_bound(others.begin(), others.end(), bead) - others.begin());
    };
    neighbours_.clear();
    sent_.clear();
    received_.clear();
    for (auto const& [rank, l] : lists) {
        neighbours_.push_back({rank, l.send.size(), l.receive.size()});
        for (std::int64_t const bead : l.send) sent_.push_back(place_[bead] - first());
        for (std::int64_t const bead : l.receive) received_.push_back(index(bead));
    }
    beads_ = plan_.partners;
    beads_.insert(beads_.end(), others.begin(), others.end());
}

void GhostLists::carry(std::span<Vec3 const> sent, std::span<Vec3> received) {
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (Neighbour const& n : neighbours_) {
        if (n.sent > 0) out.push_back({n.rank, std::as_bytes(sent.first(n.sent))});
        if (n.received > 0) in.push_back({n.rank, std::as_writable_bytes(received.first(n.received))});
        sent = sent.subspan(n.sent);
        received = received.subspan(n.received);
    }
    exchange(out, in);
    traffic_.direct = false;
    ++traffic_.updates;
}

void GhostLists::note_carried() {
    traffic_.direct = true;
    for (Neighbour const& n : neighbours_) {
        traffic_.messages += n.sent > 0 ? 1 : 0;
        traffic_.bytes += static_cast<std::int64_t>(n.sent * sizeof(Vec3));
    }
    ++traffic_.updates;
}

void GhostLists::exchange(std::vector<Outgoing> const& out, std::vector<Incoming> const& in) {
    communicator_.exchange_all(out, in);
    traffic_.messages += std::ssize(out);
    for (Outgoing const& m : out) traffic_.bytes += std::ssize(m.bytes);
}

std::vector<Vec3> GhostLists::all_positions(std::span<Vec3 const> own) const {
    std::vector<std::int64_t> bytes;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        bytes.push_back((plan_.first_of_rank[rank + 1] - plan_.first_of_rank[rank]) * static_cast<std::int64_t>(sizeof(Vec3)));
    std::vector<Vec3> by_rank(place_.size()), all(place_.size());
    communicator_.all_gather(std::as_bytes(own), std::as_writable_bytes(std::span(by_rank)), bytes);
    for (std::size_t bead = 0; bead < all.size(); ++bead) all[bead] = by_rank[place_[bead]];
    return all;
}

void GhostLists::audit(std::span<Vec3 const> own, std::span<Vec3 const> ghosts) const {
    std::vector<Vec3> const all = all_positions(own);
    std::set<std::int64_t> const known(beads_.begin(), beads_.end());
    double const no_bead = -1, count = static_cast<double>(all.size());
    double worst = no_bead;  // a stale ghost's bead, or `count` + a missed one
    for (std::size_t i = 0; i < beads_.size(); ++i)
        if (!std::equal(ghosts[i].data, ghosts[i].data + 3, all[beads_[i]].data)) worst = std::max(worst, static_cast<double>(beads_[i]));
    for (PairRange const& range : plan_.ranges) {
        std::vector<std::int64_t> acting, own_ones;  // beads; own ones by their places among these
        std::vector<Vec3> there;
        for (std::int64_t bead = 0; bead < std::ssize(all); ++bead) {
            if (!range.is_for(bead)) continue;
            if (owner(bead) == communicator_.rank()) own_ones.push_back(std::ssize(acting));
            acting.push_back(bead);
            there.push_back(all[static_cast<std::size_t>(bead)]);
        }
        for (std::int64_t const i : ghosts_of(there, own_ones, range.reach, plan_.box))
            if (std::int64_t const bead = acting[static_cast<std::size_t>(i)]; !known.contains(bead))
                worst = std::max(worst, count + static_cast<double>(bead));
    }
    worst = communicator_.max(worst);
    if (worst >= count)
        throw SharedError(fmt::format("forces.openmm.audit: bead {:.0f} is felt on a rank that has no ghost of it", worst - count + 1));
    if (worst > no_bead) throw SharedError(fmt::format("forces.openmm.audit: a ghost of bead {:.0f} is not where the bead is", worst + 1));
}

}  // namespace catena
