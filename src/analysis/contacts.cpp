// Implements contact maps.
#include "analysis/contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "math/executor.hpp"
#include "neighbours/cells.hpp"

namespace catena::analysis {
namespace {

constexpr std::int64_t most_rows = 1000;  // rows of all kinds together
constexpr std::size_t most_paired_kinds = Contacts::most_paired_kinds;
constexpr std::int64_t map_blocks = 16;  // blocks of frames that give the errors

/// Counts of one map, and the scatter of its blocks of frames.
class MapCounts {
  public:
    MapCounts(std::size_t rows, std::size_t columns)
        : columns_(columns),
          block_(rows * columns, 0.0),
          sum_(block_),
          of_blocks_(block_),
          squares_(block_) {}

    void add(std::size_t row, std::size_t column) { block_[row * columns_ + column] += 1; }
    /// Ends a block of `frames` frames. Only a whole block counts for the error.
    void end_block(double frames, bool whole) {
        blocks_ += whole ? 1 : 0;
        for (std::size_t k = 0; k < block_.size(); ++k) {
            sum_[k] += block_[k];
            double const a_frame = whole ? block_[k] / frames : 0;
            of_blocks_[k] += a_frame;
            squares_[k] += a_frame * a_frame;
            block_[k] = 0;
        }
    }
    std::size_t size() const { return block_.size(); }
    double sum(std::size_t k) const { return sum_[k]; }
    /// Returns the standard error of a count per frame; NaN for fewer than two blocks.
    double error(std::size_t k) const {
        double const mean = of_blocks_[k] / blocks_;
        return blocks_ < 2
                   ? NAN
                   : std::sqrt(std::max(0.0, squares_[k] / blocks_ - mean * mean) / (blocks_ - 1));
    }

  private:
    std::size_t columns_;
    double blocks_ = 0;          // number of whole blocks
    std::vector<double> block_,  // counts of the current block
        sum_,                    // counts of all ended blocks
        of_blocks_, squares_;    // sums over whole blocks of counts per frame, and of their squares
};

/// Place of a site among the kinds.
struct Owner {
    std::size_t kind, copy, chain, row;
    std::int64_t place;  // along its chain
};

/// True if two sites of a chain are `least_separation` links or more apart.
bool are_apart(Kind const& kind, std::int64_t a, std::int64_t b) {
    if (!kind.is_branched()) return std::abs(a - b) >= Contacts::least_separation;
    auto const inboard = [&](std::int64_t k) { return kind.parent[static_cast<std::size_t>(k)]; };
    static_assert(Contacts::least_separation == 3, "pairs one and two links apart are told below");
    std::int64_t const later = std::max(a, b), on = inboard(later), earlier = std::min(a, b);
    bool const one = on == earlier;
    return !one && inboard(on) != earlier && on != inboard(earlier);
}

}  // namespace

struct Contacts::State {
    State(Topology const& topology, std::vector<Kind> const& of, double at_most,
          std::int64_t of_frames)
        : kinds(of), cutoff(at_most), frames(of_frames) {
        std::int64_t sites = 0;
        for (Kind const& kind : kinds) sites += kind.sites;
        sites_a_row = std::max<std::int64_t>(1, (sites + most_rows - 1) / most_rows);
        owner.resize(topology.mass.size());
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            for (std::size_t c = 0; c < kinds[k].copies(); ++c) {
                std::size_t const chain = kinds[k].chains[c];
                auto const first = static_cast<std::size_t>(topology.chains[chain].first);
                for (std::int64_t i = 0; i < kinds[k].sites; ++i)
                    owner[first + static_cast<std::size_t>(i)] = {
                        k, c, chain, static_cast<std::size_t>(i / sites_a_row), i};
            }
            within.emplace_back(rows_of(k), rows_of(k));
            numbers.push_back({CopyValues(kinds[k].copies()), CopyValues(kinds[k].copies())});
            first_copy.push_back(copies);
            copies += kinds[k].copies();
        }
        for (std::size_t a = 0; a < kinds.size(); ++a)
            for (std::size_t b = a; b < kinds.size(); ++b)
                between.emplace_back(has_pairs(a, b) ? rows_of(a) : 0, rows_of(b));
    }

    std::size_t rows_of(std::size_t kind) const {
        return static_cast<std::size_t>((kinds[kind].sites + sites_a_row - 1) / sites_a_row);
    }
    /// True if there is a map for chains of two kinds, a <= b.
    bool has_pairs(std::size_t a, std::size_t b) const {
        return a == b ? kinds[a].copies() > 1 : kinds.size() <= most_paired_kinds;
    }
    /// Index in `between` of two kinds, a <= b.
    std::size_t pair(std::size_t a, std::size_t b) const {
        return a * kinds.size() - a * (a + 1) / 2 + b;
    }
    /// Number of sites in a row of a kind's maps.
    double sites_in(std::size_t kind, std::size_t row) const {
        std::int64_t const first = static_cast<std::int64_t>(row) * sites_a_row;
        return static_cast<double>(std::min(sites_a_row, kinds[kind].sites - first));
    }

    void count_within(Owner const& a, Owner const& b) {
        within[a.kind].add(a.row, b.row);
        if (a.row != b.row) within[a.kind].add(b.row, a.row);
        if (are_apart(kinds[a.kind], a.place, b.place)) ++own_contacts[of_copy(a)];
    }
    void count_between(Owner const& a, Owner const& b) {
        if (a.kind > b.kind) return count_between(b, a);
        if (has_pairs(a.kind, b.kind)) {
            MapCounts& map = between[pair(a.kind, b.kind)];
            map.add(a.row, b.row);
            if (a.kind == b.kind) map.add(b.row, a.row);
        }
        ++other_contacts[of_copy(a)];
        ++other_contacts[of_copy(b)];
    }
    std::size_t of_copy(Owner const& one) const { return first_copy[one.kind] + one.copy; }

    /// Counts a pair of sites in neighbouring cells if it is a contact.
    void look_at(Snapshot const& s, Grid const& grid, std::size_t p, std::size_t q) {
        double const most = cutoff * cutoff;
        Vec3 const apart = s.position[p] - s.position[q];
        bool const near_image = grid.squared_distance(s.position[p], s.position[q]) <= most;
        if (owner[p].chain != owner[q].chain) {
            if (near_image) count_between(owner[p], owner[q]);
        } else if (dot(apart, apart) <= most) {
            count_within(owner[p], owner[q]);
        } else if (near_image) {
            ++own_images;
        }
    }

    void look_at_all(Snapshot const& s) {
        Grid const grid(cutoff, s.box);
        PointsInCells const cells(grid, s.position, this_thread());
        std::vector<Cell> const& all = cells.cells();
        std::vector<std::size_t> near;
        for (std::size_t i = 0; i < all.size(); ++i) {
            near.clear();
            grid.around(all[i], [&](Cell const& cell) {
                auto const found = std::lower_bound(all.begin(), all.end(), cell);
                if (found == all.end() || !is_same(*found, cell)) return;
                if (auto const j = static_cast<std::size_t>(found - all.begin()); j > i)
                    near.push_back(j);
            });
            std::sort(near.begin(), near.end());
            near.erase(std::unique(near.begin(), near.end()), near.end());
            auto const own = cells.points(i);
            for (std::size_t a = 0; a < own.size(); ++a) {
                auto const p = static_cast<std::size_t>(own[a]);
                for (std::size_t b = a + 1; b < own.size(); ++b)
                    look_at(s, grid, p, static_cast<std::size_t>(own[b]));
                for (std::size_t const j : near)
                    for (std::int64_t const q : cells.points(j))
                        look_at(s, grid, p, static_cast<std::size_t>(q));
            }
        }
    }

    /// Ends the current block of frames if it is full, or if there are no more frames.
    void end_block_if_due() {
        std::int64_t const length = std::max<std::int64_t>(1, frames / map_blocks);
        std::int64_t const in_block = (seen - 1) % length + 1;
        bool const whole = in_block == length;
        if (!whole && seen != frames) return;
        for (auto* maps : {&within, &between})
            for (MapCounts& map : *maps) map.end_block(static_cast<double>(in_block), whole);
    }

    /// Returns a map of probabilities from counts. `chains`: number of chains, or of pairs of
    /// chains.
    ContactMap map_of(MapCounts const& counts, ContactMap::Parts const& parts,
                      double chains) const {
        ContactMap map;
        map.parts = parts;
        auto const [within_chain, first, second] = parts;
        map.rows = rows_of(first);
        map.columns = rows_of(second);
        map.mean.resize(counts.size());
        map.error.resize(counts.size());
        for (std::size_t k = 0; k < counts.size(); ++k) {
            std::size_t const row = k / map.columns, column = k % map.columns;
            double sites = sites_in(first, row) * sites_in(second, column);
            if (within_chain && row == column)
                sites = sites_in(first, row) * (sites_in(first, row) - 1) / 2;
            double const scale = sites > 0 ? 1 / (sites * chains) : 0;
            map.mean[k] = scale * counts.sum(k) / static_cast<double>(seen);
            map.error[k] = scale * counts.error(k);
        }
        return map;
    }

    std::vector<Kind> const& kinds;
    double cutoff;
    std::int64_t frames, seen = 0, sites_a_row = 1, own_images = 0;
    std::size_t copies = 0;
    std::vector<Owner> owner;                                // per site
    std::vector<std::size_t> first_copy;                     // per kind, among all copies
    std::vector<MapCounts> within, between;                  // per kind; per pair of kinds
    std::vector<std::int64_t> own_contacts, other_contacts;  // per copy, in the current frame
    std::vector<ContactNumbers> numbers;
};

Contacts::Contacts(Topology const& topology, std::vector<Kind> const& kinds, double cutoff,
                   std::int64_t frames)
    : state_(std::make_unique<State>(topology, kinds, cutoff, frames)) {}
Contacts::~Contacts() = default;

void Contacts::add(Snapshot const& snapshot) {
    State& s = *state_;
    if (snapshot.box)
        for (int i = 0; i < 3; ++i)
            if (2 * s.cutoff > (*snapshot.box)[i])
                throw InputError(
                    fmt::format("a cutoff of {:g} exceeds half of the box's edge of {:g}", s.cutoff,
                                (*snapshot.box)[i]),
                    "--cutoff", "give a shorter one, or 0 for no contacts");
    s.own_contacts.assign(s.copies, 0);
    s.other_contacts.assign(s.copies, 0);
    s.look_at_all(snapshot);
    ++s.seen;
    for (std::size_t k = 0; k < s.kinds.size(); ++k)
        for (std::size_t c = 0; c < s.kinds[k].copies(); ++c) {
            s.numbers[k].within.add(static_cast<double>(s.own_contacts[s.first_copy[k] + c]));
            s.numbers[k].between.add(static_cast<double>(s.other_contacts[s.first_copy[k] + c]));
        }
    s.end_block_if_due();
}

std::int64_t Contacts::sites_a_row() const { return state_->sites_a_row; }
std::int64_t Contacts::own_images() const { return state_->own_images; }
std::vector<ContactNumbers> const& Contacts::numbers() const { return state_->numbers; }

std::vector<ContactMap> Contacts::maps() const {
    State const& s = *state_;
    std::vector<ContactMap> maps;
    auto const copies = [&](std::size_t kind) {
        return static_cast<double>(s.kinds[kind].copies());
    };
    for (std::size_t k = 0; k < s.kinds.size(); ++k)
        maps.push_back(s.map_of(s.within[k], {true, k, k}, copies(k)));
    for (std::size_t a = 0; a < s.kinds.size(); ++a)
        for (std::size_t b = a; b < s.kinds.size(); ++b)
            if (s.has_pairs(a, b))
                maps.push_back(s.map_of(s.between[s.pair(a, b)], {false, a, b},
                                        copies(a) * (a == b ? copies(a) - 1 : copies(b))));
    return maps;
}

}  // namespace catena::analysis
