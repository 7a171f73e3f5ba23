#include "force/ghost_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

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

void sort_unique(std::vector<std::int64_t>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

GhostExchange::GhostExchange(Communicator const& communicator, Plan plan)
    : communicator_(communicator), plan_(std::move(plan)), place_(static_cast<std::size_t>(plan_.first_of_rank.back())) {
    for (std::int64_t i = 0; i < std::ssize(place_); ++i) place_[plan_.by_rank.empty() ? i : plan_.by_rank[i]] = i;
}

int GhostExchange::owner(std::int64_t bead) const {
    auto const& first = plan_.first_of_rank;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), place_[bead]) - first.begin()) - 1;
}

void GhostExchange::update(std::span<Vec3 const> own) {
    if (!std::exchange(has_partners_, true)) share_partners();
    if (must_rebuild(own)) rebuild(own);
    bring(own);
    ++traffic_.updates;
}

void GhostExchange::share_partners() {
    auto const partners = blocks_of_ranks(communicator_, plan_.partners);
    for (std::int64_t const bead : plan_.partners) partners_[owner(bead)].receive.push_back(bead);
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (std::int64_t const bead : partners[rank])
            if (owner(bead) == communicator_.rank()) partners_[rank].send.push_back(bead);
}

/// The same answer on every rank: the largest of a number each.
bool GhostExchange::must_rebuild(std::span<Vec3 const> own) {
    double constexpr good = 0, used_up = 1, not_finite = 2;  // and the bead's number
    bool const asked = std::exchange(renew_, false);
    bool const moves_matter = plan_.reach > 0 && !asked;
    double state = asked || (moves_matter && largest_displacement(listed_, own) >= plan_.skin / 2) ? used_up : good;
    for (std::int64_t k = 0; k < std::ssize(own); ++k)
        if (!std::all_of(own[k].data, own[k].data + 3, [](double x) { return std::isfinite(x); }))
            state = std::max(state, not_finite + static_cast<double>(own_bead(k)));
    state = communicator_.max(state);
    if (state >= not_finite)
        throw SharedError(fmt::format("the position of bead {:.0f} is not finite: take a smaller step, or a start without overlaps",
                                      state - not_finite + 1));
    return state == used_up;
}

void GhostExchange::rebuild(std::span<Vec3 const> own) {
    ListsOfRank lists = partners_;
    if (plan_.reach > 0) add_near(own, lists);
    take(std::move(lists));
    listed_.assign(own.begin(), own.end());
    ++traffic_.rebuilds;
    traffic_.ghosts = std::ssize(beads_);
    traffic_.most_ghosts = std::max(traffic_.most_ghosts, traffic_.ghosts);
}

std::vector<std::vector<Cell>> GhostExchange::cells_of_ranks(CellMap const& own) const {
    std::vector<Cell> cells;
    for (auto const& [cell, beads] : own) cells.push_back(cell);
    return blocks_of_ranks(communicator_, cells);
}

/// Adds what lies within reach + skin of another rank's beads to what it is sent, and the other way round.
void GhostExchange::add_near(std::span<Vec3 const> own, ListsOfRank& lists) {
    double const radius = plan_.reach + plan_.skin;
    Grid const grid(radius, plan_.box);
    CellMap beads_in;
    for (std::int64_t k = 0; k < std::ssize(own); ++k) beads_in[grid.cell(own[k])].push_back(k);
    std::vector<std::vector<Cell>> const cells = cells_of_ranks(beads_in);

    std::map<int, std::vector<Candidate>> candidates;
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        if (rank == communicator_.rank()) continue;
        CellSet const around = grid.with_surroundings(cells[rank]);
        for (auto const& [cell, beads] : beads_in)
            if (around.contains(cell))
                for (std::int64_t const k : beads) candidates[rank].push_back({own_bead(k), own[k]});
    }
    std::optional<Vec3> rejected;
    auto const of_others = swap_candidates(candidates);
    for (auto const& [rank, theirs] : of_others) {
        std::vector<Candidate> const& mine = candidates.at(rank);
        auto const positions = [](std::vector<Candidate> const& from) {
            std::vector<Vec3> x;
            for (Candidate const& c : from) x.push_back(c.position);
            return x;
        };
        std::vector<Vec3> const here = positions(mine), there = positions(theirs);
        for (std::int64_t const i : near_any(here, there, radius, plan_.box)) lists[rank].send.push_back(mine[i].bead);
        auto const near = near_any(there, here, radius, plan_.box);
        for (std::int64_t const i : near) lists[rank].receive.push_back(theirs[i].bead);
        for (std::int64_t i = 0; i < std::ssize(theirs) && !rejected; ++i)
            if (!std::binary_search(near.begin(), near.end(), i)) rejected = there[i];
    }
    find_place_aside(grid, grid.with_surroundings(cells[communicator_.rank()]), rejected);
}

/// Being in or around another's cells is mutual: who sends candidates gets some.
std::map<int, std::vector<GhostExchange::Candidate>> GhostExchange::swap_candidates(std::map<int, std::vector<Candidate>> const& own) {
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

/// `felt`: cells in and around those of own beads. A cell that is not among them is farther away than reach + skin. Where all are, every
/// bead of another rank was a candidate, and one that is no ghost is as far away.
void GhostExchange::find_place_aside(Grid const& grid, CellSet const& felt, std::optional<Vec3> const& rejected) {
    if (felt.empty()) return;
    if (!grid.ends()) {
        Cell farthest = *std::max_element(felt.begin(), felt.end());
        farthest[0] += 2;
        aside_ = grid.middle(farthest);
        aside_length_ = grid.edge()[0];
        return;
    }
    Cell const& count = grid.cells();
    for (std::int64_t i = 0; i < count[0] * count[1] * count[2]; ++i) {
        Cell const cell{i % count[0], i / count[0] % count[1], i / (count[0] * count[1])};
        if (felt.contains(cell)) continue;
        aside_ = grid.middle(cell);
        aside_length_ = grid.edge()[0] / 2;
        return;
    }
    if (!rejected) return;  // every bead is a ghost: nothing need stand aside
    aside_ = *rejected;
    aside_length_ = plan_.skin / 2;  // own beads may come nearer by the other half
}

/// Where there is room, out of each other's reach in a cube: a row would be so long that OpenMM could not sort own beads among them.
Vec3 GhostExchange::aside(std::int64_t i, std::int64_t count) const {
    if (plan_.box) return aside_ + Vec3{{aside_length_ * (static_cast<double>(i) / static_cast<double>(count) - 0.5), 0, 0}};
    auto const side = static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    Vec3 place = aside_;
    for (int c = 0; c < 3; ++c, i /= side) place[c] += aside_length_ * static_cast<double>(i % side);
    return place;
}

void GhostExchange::take(ListsOfRank lists) {
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
    for (auto const& [rank, l] : lists) {
        Neighbour n{rank, {}, {}, std::vector<Vec3>(l.send.size()), std::vector<Vec3>(l.receive.size())};
        for (std::int64_t const bead : l.send) n.send.push_back(place_[bead] - first());
        for (std::int64_t const bead : l.receive) n.receive.push_back(index(bead));
        neighbours_.push_back(std::move(n));
    }
    beads_ = plan_.partners;
    beads_.insert(beads_.end(), others.begin(), others.end());
    positions_.resize(beads_.size());
}

void GhostExchange::bring(std::span<Vec3 const> own) {
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (Neighbour& n : neighbours_) {
        for (std::size_t i = 0; i < n.send.size(); ++i) n.out[i] = own[n.send[i]];
        if (!n.out.empty()) out.push_back({n.rank, std::as_bytes(std::span(n.out))});
        if (!n.in.empty()) in.push_back({n.rank, std::as_writable_bytes(std::span(n.in))});
    }
    exchange(out, in);
    for (Neighbour const& n : neighbours_)
        for (std::size_t i = 0; i < n.receive.size(); ++i) positions_[n.receive[i]] = n.in[i];
}

void GhostExchange::exchange(std::vector<Outgoing> const& out, std::vector<Incoming> const& in) {
    communicator_.exchange_all(out, in);
    traffic_.messages += std::ssize(out);
    for (Outgoing const& m : out) traffic_.bytes += std::ssize(m.bytes);
}

std::vector<Vec3> GhostExchange::all_positions(std::span<Vec3 const> own) const {
    std::vector<std::int64_t> bytes;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        bytes.push_back((plan_.first_of_rank[rank + 1] - plan_.first_of_rank[rank]) * static_cast<std::int64_t>(sizeof(Vec3)));
    std::vector<Vec3> by_rank(place_.size()), all(place_.size());
    communicator_.all_gather(std::as_bytes(own), std::as_writable_bytes(std::span(by_rank)), bytes);
    for (std::size_t bead = 0; bead < all.size(); ++bead) all[bead] = by_rank[place_[bead]];
    return all;
}

void GhostExchange::audit(std::span<Vec3 const> own) const {
    std::vector<Vec3> const all = all_positions(own);
    std::vector<std::int64_t> own_beads;
    for (std::int64_t k = 0; k < own_count(); ++k) own_beads.push_back(own_bead(k));
    std::set<std::int64_t> const known(beads_.begin(), beads_.end());
    double const no_bead = -1, count = static_cast<double>(all.size());
    double worst = no_bead;  // a stale ghost's bead, or `count` + a missed one
    for (std::size_t i = 0; i < beads_.size(); ++i)
        if (!std::equal(positions_[i].data, positions_[i].data + 3, all[beads_[i]].data))
            worst = std::max(worst, static_cast<double>(beads_[i]));
    if (plan_.reach > 0)
        for (std::int64_t const bead : ghosts_of(all, own_beads, plan_.reach, plan_.box))
            if (!known.contains(bead)) worst = count + static_cast<double>(bead);
    worst = communicator_.max(worst);
    if (worst >= count)
        throw SharedError(fmt::format("forces.openmm.audit: bead {:.0f} is felt on a rank that has no ghost of it", worst - count + 1));
    if (worst > no_bead) throw SharedError(fmt::format("forces.openmm.audit: a ghost of bead {:.0f} is not where the bead is", worst + 1));
}

}  // namespace catena
