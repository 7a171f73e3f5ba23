// Construction of ghost lists, and exchange of the ghosts' positions.
#include "neighbours/ghost_lists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clock.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"
#include "neighbours/ghosts.hpp"

namespace catena {

namespace {

/// Gathers a vector from every rank; ranks need not know each other's lengths. Collective.
template <class T>
std::vector<std::vector<T>> blocks_of_ranks(Communicator const& communicator,
                                            std::vector<T> const& own) {
    std::vector<std::vector<T>> blocks;
    all_gathered_blocks(communicator, own).each([&](std::span<T const> block) {
        blocks.emplace_back(block.begin(), block.end());
    });
    return blocks;
}

template <class T>
std::span<std::byte const> bytes_of(std::vector<T> const& values) {
    return std::as_bytes(std::span(values));
}
/// Resizes `values` to `count` elements and returns their bytes.
template <class T>
std::span<std::byte> room_for(std::size_t count, std::vector<T>& values) {
    values.resize(count);
    return std::as_writable_bytes(std::span(values));
}

}  // namespace

void throw_trouble(double bead, char const* trouble) {
    throw SharedError(
        fmt::format(fmt::runtime(std::string(trouble) +
                                 ": use a smaller dynamics.step, or a start without overlaps"),
                    bead + 1));
}

GhostLists::GhostLists(Communicator const& communicator, Plan plan)
    : communicator_(communicator),
      plan_(std::move(plan)),
      place_(static_cast<std::size_t>(plan_.first_of_rank.back())),
      executor_(openmp_is_built() ? openmp_executor(plan_.threads > 0 ? plan_.threads
                                                                      : cores_of_rank(communicator))
                                  : serial_executor()) {
    for (std::int64_t i = 0; i < std::ssize(place_); ++i)
        place_[plan_.by_rank.empty() ? i : plan_.by_rank[i]] = i;
    std::int64_t const own = plan_.first_of_rank[communicator_.rank() + 1] - first();
    for (std::int64_t k = 0; k < own; k += piece(own_bead(k))) first_of_piece_.push_back(k);
    first_of_piece_.push_back(own);
}

int GhostLists::owner(std::int64_t bead) const {
    auto const& first = plan_.first_of_rank;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), place_[bead]) -
                            first.begin()) -
           1;
}

void GhostLists::share_partners() {
    auto const partners = blocks_of_ranks(communicator_, plan_.partners);
    for (std::int64_t i = 0; i < std::ssize(plan_.partners); ++i)
        partners_[owner(plan_.partners[i])].receive.push_back(i);
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (std::int64_t const bead : partners[rank])
            if (owner(bead) == communicator_.rank())
                partners_[rank].send.push_back(place_[bead] - first());
}

// The result is the same on every rank, because it follows from the maximum of one number per rank.
bool GhostLists::are_used_up(Moves const& moves, char const* trouble) {
    double constexpr good = 0, used_up = 1,
                     in_trouble = 2;  // the bead's number is added to in_trouble
    bool const far = std::exchange(renew_, false) || (moves.far && !plan_.ranges.empty());
    double const state =
        communicator_.max(moves.bead >= 0 ? in_trouble + static_cast<double>(moves.bead)
                          : far           ? used_up
                                          : good);
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
    beads_ = plan_.partners;
    pieces_.clear();
    if (!plan_.ranges.empty()) add_near(own, lists);
    take(lists);
    ++traffic_.rebuilds;
    traffic_.ghosts = std::ssize(beads_);
    traffic_.most_ghosts = std::max(traffic_.most_ghosts, traffic_.ghosts);
    traffic_.seconds_of_lists += seconds_now() - begin;
}

/// Adds to the lists the beads that act on another rank's beads within reach + skin, in both
/// directions. If some rank finds no free cell for idle particles, all beads are searched over the
/// longest range. Every bead of another rank is then received here, and one that is no ghost is far
/// enough to mark a free position.
void GhostLists::add_near(std::span<Vec3 const> own, ListsOfRank& lists) {
    PairRange const longest{longest_reach(plan_.ranges), {}};
    Grid const grid(longest.reach + plan_.skin, plan_.box);
    std::vector<PointBlock> const blocks =
        blocks_of({own, first_of_piece_}, (longest.reach + plan_.skin) / 2);
    CellSet cells;
    for (PointBlock const& block : blocks)
        grid.within(block.least(), block.most(), [&](Cell const& cell) { cells.insert(cell); });
    bool const has_room = own.empty() || find_place_aside(grid, cells);
    std::vector<PairRange> const ranges =
        communicator_.max(has_room ? 0.0 : 1.0) > 0 ? std::vector{longest} : plan_.ranges;
    meet(own, blocks, grid, {cells.begin(), cells.end()});
    show();
    for (auto& [rank, meeting] : meetings_) {
        meeting.taken = near_ones(meeting, ranges);
        find_place_among(meeting.theirs, meeting.taken);
        for (std::size_t i = 0; i < meeting.taken.size(); ++i)
            if (std::binary_search(plan_.partners.begin(), plan_.partners.end(),
                                   meeting.theirs.piece[i]))
                meeting.taken[i] = 0;  // partners are received anyway
    }
    swap([](Meeting const& m) { return bytes_of(m.taken); },
         [](Meeting& m) { return room_for(m.mine.piece.size(), m.asked); });
    for (auto const& [rank, meeting] : meetings_) {
        Lists& l = lists[rank];
        for (std::size_t i = 0; i < meeting.asked.size(); ++i)
            for (std::int64_t k = 0; meeting.asked[i] != 0 && k < piece(meeting.mine.piece[i]); ++k)
                l.send.push_back(place_[meeting.mine.piece[i]] - first() + k);
        for (std::size_t i = 0; i < meeting.taken.size(); ++i) {
            std::int64_t const bead = meeting.theirs.piece[i];
            if (meeting.taken[i] == 0) continue;
            pieces_.push_back(bead);
            for (std::int64_t k = 0; k < piece(bead); ++k) {
                l.receive.push_back(std::ssize(beads_));
                beads_.push_back(bead + k);
            }
        }
    }
}

void GhostLists::Shown::clear() {
    piece.clear();
    position.clear();
    first.assign(1, 0);
}

void GhostLists::Shown::add(std::int64_t bead, std::span<Vec3 const> positions) {
    piece.push_back(bead);
    position.insert(position.end(), positions.begin(), positions.end());
    first.push_back(std::ssize(position));
}

/// Collects the own pieces for each rank whose beads lie in or around this rank's cells; the
/// relation is symmetric. `cells`: cells that `blocks` intersect.
void GhostLists::meet(std::span<Vec3 const> own, std::vector<PointBlock> const& blocks,
                      Grid const& grid, std::vector<Cell> const& cells) {
    std::vector<std::vector<Cell>> const of_ranks = blocks_of_ranks(communicator_, cells);
    PointGroups const pieces{own, first_of_piece_};
    for (auto& [rank, meeting] : meetings_) meeting.mine.clear();
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        if (rank == communicator_.rank()) continue;
        CellSet const around = grid.with_surroundings(of_ranks[rank]);
        for (PointBlock const& block : blocks) {
            bool is_shown = false;
            grid.within(block.least(), block.most(),
                        [&](Cell const& cell) { is_shown = is_shown || around.contains(cell); });
            for (std::int64_t i = block.begin; is_shown && i < block.end; ++i)
                meetings_[rank].mine.add(own_bead(first_of_piece_[i]), pieces.group(i));
        }
    }
    std::erase_if(meetings_, [](auto const& with) { return with.second.mine.piece.empty(); });
}

/// Exchanges the pieces and their positions.
void GhostLists::show() {
    for (auto& [rank, m] : meetings_) m.shown = std::ssize(m.mine.piece);
    swap([](Meeting const& m) { return std::as_bytes(std::span(&m.shown, 1)); },
         [](Meeting& m) { return std::as_writable_bytes(std::span(&m.expected, 1)); });
    swap([](Meeting const& m) { return bytes_of(m.mine.piece); },
         [](Meeting& m) { return room_for(static_cast<std::size_t>(m.expected), m.theirs.piece); });
    for (auto& [rank, m] : meetings_) {
        m.theirs.first.assign(1, 0);
        for (std::int64_t const bead : m.theirs.piece)
            m.theirs.first.push_back(m.theirs.first.back() + piece(bead));
    }
    swap([](Meeting const& m) { return bytes_of(m.mine.position); },
         [](Meeting& m) {
             return room_for(static_cast<std::size_t>(m.theirs.first.back()), m.theirs.position);
         });
}

/// Returns 1 for the pieces of another rank that have a bead near an own bead, else 0.
std::vector<char> GhostLists::near_ones(Meeting const& meeting,
                                        std::vector<PairRange> const& ranges) {
    std::vector<char> near(meeting.theirs.piece.size(), 0);
    std::vector<char> const none(meeting.mine.piece.size(), 0);
    for (PairRange const& range : ranges) {
        find_acting(meeting.mine, range, none, here_);
        find_acting(meeting.theirs, range, near, there_);
        auto const found =
            near_groups({there_.position, there_.first}, {here_.position, here_.first},
                        range.reach + plan_.skin, plan_.box, *executor_);
        for (std::size_t i = 0; i < near.size(); ++i) near[i] = std::max(near[i], found[i]);
    }
    return near;
}

/// Collects the beads of pieces that act over `range`; pieces with `left_out` set get no beads.
void GhostLists::find_acting(Shown const& shown, PairRange const& range,
                             std::vector<char> const& left_out, Acting& acting) const {
    acting.position.clear();
    acting.first.assign(1, 0);
    for (std::size_t i = 0; i < shown.piece.size(); ++i) {
        std::int64_t const begin = shown.first[i],
                           end = left_out[i] == 0 ? shown.first[i + 1] : begin;
        for (std::int64_t k = begin; k < end; ++k)
            if (range.is_for(shown.piece[i] + k - begin))
                acting.position.push_back(shown.position[k]);
        acting.first.push_back(std::ssize(acting.position));
    }
}

/// Uses the position of a bead that is no ghost as the idle position if there is no free cell. Own
/// beads may approach it by half the skin.
void GhostLists::find_place_among(Shown const& theirs, std::vector<char> const& near) {
    auto const far = std::find(near.begin(), near.end(), 0);
    if (!plan_.box || !free_.empty() || far == near.end()) return;
    free_ = {theirs.position[static_cast<std::size_t>(
        theirs.first[static_cast<std::size_t>(far - near.begin())])]};
    edge_ = Vec3{{plan_.skin / 4, plan_.skin / 4, plan_.skin / 4}};
}

/// Finds idle positions, from which nothing acts on own beads. In a periodic box these are in cells
/// that are neither own nor adjacent to own ones; unbounded space has room beyond all cells.
/// Returns false if every cell of the box is own or adjacent.
bool GhostLists::find_place_aside(Grid const& grid, CellSet const& own) {
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

/// Exchanges one message in each direction with every rank in `meetings_`.
template <class Out, class In>
void GhostLists::swap(Out const& out, In const& in) {
    std::vector<Outgoing> outgoing;
    std::vector<Incoming> incoming;
    for (auto& [rank, meeting] : meetings_) {
        outgoing.push_back({rank, out(std::as_const(meeting))});
        incoming.push_back({rank, in(meeting)});
    }
    exchange(outgoing, incoming);
}

// Idle particles are placed out of each other's reach if there is room. In unbounded space they
// form a cube: a row would be so long that OpenMM could not sort own beads among them. In a box
// they are scattered over up to 4096 free cells, because in one cell they would all interact.
// Groups of 32, which OpenMM processes at once, share a cell.
Vec3 GhostLists::aside(std::int64_t i, std::int64_t count) const {
    std::int64_t constexpr together = 32;
    auto const in_cube = [](std::int64_t k, std::int64_t of) {
        auto const side = static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(of))));
        return std::pair(Cell{k % side, k / side % side, k / (side * side)},
                         static_cast<double>(side));
    };
    Vec3 place;
    if (plan_.box) {
        std::int64_t const cells = std::ssize(free_), groups = (count + together - 1) / together,
                           group = i / together;
        // Every bead of the other ranks is a ghost here.
        if (cells == 0) throw ComputationError("no place in the box is out of the beads' reach");
        place = free_[static_cast<std::size_t>(group % cells)];
        auto const [at, side] = in_cube(group / cells * together + i % together,
                                        (groups + cells - 1) / cells * together);
        for (int c = 0; c < 3; ++c)
            place[c] += edge_[c] * ((static_cast<double>(at[c]) + 0.5) / side - 0.5);
    } else {
        place = aside_;
        Cell const at = in_cube(i, count).first;
        for (int c = 0; c < 3; ++c) place[c] += edge_[0] * static_cast<double>(at[c]);
    }
    return place;
}

void GhostLists::take(ListsOfRank const& lists) {
    neighbours_.clear();
    sent_.clear();
    received_.clear();
    for (auto const& [rank, l] : lists) {
        neighbours_.push_back({rank, l.send.size(), l.receive.size()});
        sent_.insert(sent_.end(), l.send.begin(), l.send.end());
        received_.insert(received_.end(), l.receive.begin(), l.receive.end());
    }
}

void GhostLists::carry(std::span<Vec3 const> sent, std::span<Vec3> received) {
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (Neighbour const& n : neighbours_) {
        if (n.sent > 0) out.push_back({n.rank, std::as_bytes(sent.first(n.sent))});
        if (n.received > 0)
            in.push_back({n.rank, std::as_writable_bytes(received.first(n.received))});
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
    std::vector<std::int64_t> counts;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        counts.push_back(plan_.first_of_rank[rank + 1] - plan_.first_of_rank[rank]);
    std::vector<Vec3> const by_rank = all_gathered(communicator_, own, counts);
    std::vector<Vec3> all(place_.size());
    for (std::size_t bead = 0; bead < all.size(); ++bead) all[bead] = by_rank[place_[bead]];
    return all;
}

void GhostLists::audit(std::span<Vec3 const> own, std::span<Vec3 const> ghosts) const {
    std::vector<Vec3> const all = all_positions(own);
    std::vector<char> is_known(all.size(), 0);
    for (std::int64_t const bead : beads_) is_known[static_cast<std::size_t>(bead)] = 1;
    double const no_bead = -1, count = static_cast<double>(all.size());
    // `worst` is a stale ghost's bead, or `count` + a missing one.
    double worst = no_bead;
    for (std::size_t i = 0; i < beads_.size(); ++i)
        if (!std::equal(ghosts[i].data, ghosts[i].data + 3, all[beads_[i]].data))
            worst = std::max(worst, static_cast<double>(beads_[i]));
    for (PairRange const& range : plan_.ranges) {
        // `acting` contains beads; `own_ones` contains positions in `acting`.
        std::vector<std::int64_t> acting, own_ones;
        std::vector<Vec3> there;
        for (std::int64_t bead = 0; bead < std::ssize(all); ++bead) {
            if (!range.is_for(bead)) continue;
            if (owner(bead) == communicator_.rank()) own_ones.push_back(std::ssize(acting));
            acting.push_back(bead);
            there.push_back(all[static_cast<std::size_t>(bead)]);
        }
        for (std::int64_t const i : ghosts_of(there, own_ones, range.reach, plan_.box))
            if (std::int64_t const bead = acting[static_cast<std::size_t>(i)];
                is_known[static_cast<std::size_t>(bead)] == 0)
                worst = std::max(worst, count + static_cast<double>(bead));
    }
    worst = communicator_.max(worst);
    if (worst >= count)
        throw SharedError(
            fmt::format("forces.openmm.audit: bead {} acts on a rank that has no ghost of it",
                        number(static_cast<std::int64_t>(worst - count)) + 1));
    if (worst > no_bead)
        throw SharedError(
            fmt::format("forces.openmm.audit: a ghost of bead {} is not at the bead's position",
                        number(static_cast<std::int64_t>(worst)) + 1));
}

}  // namespace catena
