// Local copy of the data of a few runs' bodies, transposed so that those of several runs lie side
// by side. It holds a part, or the whole, of as many runs as a vector has lanes. Views of a tile
// are read at a Column, a place that stands for one body of every run.
#pragma once

#include "dca/lane_access.hpp"
#include "dca/simd/prefetch.hpp"
#include "dca/simd/runs.hpp"

namespace catena::dca {

/// Body `at` of those in the tile. Columns -1 and `length` are the neighbours.
template <class Real_>
struct Column {
    using Real = Real_;
    int at = 0;
    friend CATENA_HD Column operator+(Column c, int by) { return {c.at + by}; }
    friend CATENA_HD Column operator-(Column c, int by) { return {c.at - by}; }
};

/// Reads one body of every run, one vector per number.
template <class Real, int D>
CATENA_HD Vector<Real, D> read(ConstView<D> const& view, Column<Real> const& c) {
    Vector<Real, D> v;
    CATENA_UNROLL
    for (int i = 0; i < D; ++i)
        v[i] = Real::load(view.origin + i * view.pitch + c.at * Real::lanes);
    return v;
}
/// Writes one body of every run, one vector per number.
template <class Real, int D>
CATENA_HD void write(View<D> const& view, Column<Real> const& c, Vector<Real, D> const& value) {
    CATENA_UNROLL
    for (int i = 0; i < D; ++i) value[i].store(view.origin + i * view.pitch + c.at * Real::lanes);
}
/// Returns the view of number i alone.
template <class Real, int D>
View<1> component(View<D> const& view, int i) {
    return {view.origin + i * view.pitch, view.pitch, view.size};
}
/// Writes to bodies body[j] + further of a field directly, without a tile.
template <class Real, int D>
void scatter(View<D> const& view, std::int64_t const* body, int further,
             Vector<Real, D> const& value) {
    alignas(64) double of_lane[Real::lanes];
    for (int i = 0; i < D; ++i) {
        value[i].store(of_lane);
        for (int j = 0; j < Real::lanes; ++j)
            view.origin[i * view.pitch + body[j] + further] = of_lane[j];
    }
}
/// Reads bodies body[j] of a field directly, without a tile.
template <class Real, int D>
Vector<Real, D> pick(ConstView<D> const& view, std::int64_t const* body) {
    Vector<Real, D> v;
    for (int i = 0; i < D; ++i) v[i] = Real::pick(view.origin + i * view.pitch, body);
    return v;
}
template <int K, class Real>
CATENA_HD Vector<Real, K> read_directions(ConstDirectionsView const& view, Column<Real> const& c) {
    return read(ConstView<K>{view.origin, view.pitch, 0}, c);
}
template <int K, class Real>
CATENA_HD void write_directions(DirectionsView const& view, Column<Real> const& c,
                                Vector<Real, K> const& value) {
    write(View<K>{view.origin, view.pitch, 0}, c, value);
}
/// Overloads for columns: bodies in a tile neither begin nor end a chain, except first bodies in
/// RevoluteRunsSideBySide, which handles them itself.
template <class Real>
CATENA_HD bool begins_chain(GroupView const&, Column<Real> const&) {
    return false;
}
template <class Real>
CATENA_HD bool ends_chain(GroupView const&, Column<Real> const&) {
    return false;
}
template <class Real>
CATENA_HD bool has_jointed_tip(GroupView const&, Column<Real> const&) {
    return false;
}
template <class Real>
CATENA_HD Vector<Real, 4> outboard_screw(GroupView const& group, Column<Real> const& c) {
    return read(group.screw, c + 1);
}

/// Constants of a part in the order of RunWork::constants; next() returns the views one after the
/// other.
template <class Real>
struct Constants {
    double const* place;
    template <int D>
    ConstView<D> next() {
        constexpr std::int64_t pitch = part_length * Real::lanes;
        ConstView<D> const here{place, pitch, part_length};
        place += D * pitch;
        return here;
    }
};

/// Copy of `length` bodies of each run.
template <class Real, int length>
class Tile {
    static constexpr int lanes = Real::lanes, columns = length + 2, most = 64;

  public:
    /// Registers a view to be read and returns the corresponding view of the tile. A view without
    /// origin gives one without origin. `neighbours`: columns -1 and `length` are read too.
    template <int D>
    ConstView<D> in(ConstView<D> view, bool neighbours = false) {
        if (!view.origin) return {};
        ConstView<D> const here{place(count_), pitch, length};
        if (count_ + D + written_ > most) __builtin_trap();
        for (int i = 0; i < D; ++i) source_[count_++] = {view.origin + i * view.pitch, neighbours};
        return here;
    }
    /// Registers a view to be written and returns the corresponding view of the tile.
    template <int D>
    View<D> out(View<D> view) {
        if (!view.origin) return {};
        View<D> const here{place(most - written_ - D), pitch, length};
        if (count_ + written_ + D > most) __builtin_trap();
        for (int i = 0; i < D; ++i) target_[written_ + D - 1 - i] = view.origin + i * view.pitch;
        written_ += D;
        return here;
    }
    /// Registers a view of K directions to be read.
    template <int K>
    ConstDirectionsView in_directions(ConstDirectionsView view) {
        ConstView<K> const here = in(ConstView<K>{view.origin, view.pitch, 0});
        return {here.origin, here.pitch};
    }
    /// Registers a view of K directions to be written.
    template <int K>
    DirectionsView out_directions(DirectionsView view) {
        View<K> const here = out(View<K>{view.origin, view.pitch, 0});
        return {here.origin, here.pitch};
    }
    /// Returns the number of doubles per body that the tile reads.
    int count() const { return count_; }
    /// Reads the bodies into the tile. `first` are the bodies in column 0. `count` limits the read
    /// to the first numbers in the order of registration.
    void fill(std::int64_t const* first, int count) {
        for (int n = 0; n < count; ++n) {
            double const* const from = source_[n].origin;
            double* const to = place(n);
            for (int i = 0; i < length; i += 4) Real::read_four(from + i, first, to + i * lanes);
            if (!source_[n].neighbours) continue;
            Real::pick(from - 1, first).store(to - lanes);
            Real::pick(from + length, first).store(to + length * lanes);
        }
    }
    void fill(std::int64_t const* first) { fill(first, count_); }
    /// Reads part of the runs. In skipped columns of shorter runs, the first body is repeated.
    void fill(PartInLanes<Real> const& part, int count) {
        fill(part.first, count);
        if (!part.short_ones) return;
        for (int j = 0; j < lanes; ++j)
            for (int n = 0; n < count && part.skipped[j] > 0; ++n)
                for (int i = 0; i < length; ++i)
                    place(n)[i * lanes + j] =
                        source_[n].origin[part.first[j] +
                                          (i < part.skipped[j] ? 0 : i - part.skipped[j])];
    }
    void fill(PartInLanes<Real> const& part) { fill(part, count_); }
    /// Writes the results in the tile to their fields. `first` are the bodies in column 0.
    void empty(std::int64_t const* first) {
        for (int n = 0; n < written_; ++n)
            for (int i = 0; i < length; i += 4)
                Real::write_four(place(most - 1 - n) + i * lanes, target_[n] + i, first);
    }
    /// Writes the results of a part to their fields, except for skipped columns.
    void empty(PartInLanes<Real> const& part) {
        if (!part.short_ones) return empty(part.first);
        for (int n = 0; n < written_; ++n)
            for (int j = 0; j < lanes; ++j)
                for (int i = part.skipped[j]; i < length; ++i)
                    target_[n][part.first[j] + i - part.skipped[j]] =
                        place(most - 1 - n)[i * lanes + j];
    }
    /// Prefetches a share of what fill() will read and empty() will write for runs that are `ahead`
    /// bodies further. It is called once for each body i. The shares are small, because many
    /// prefetches at once would delay each other and the computation.
    [[gnu::always_inline]] void ask(std::int64_t const* first, std::int64_t ahead, int i) const {
        ask_to_read(first, ahead, i);
        ask_to_write(first, ahead, i);
    }
    /// Prefetches a share of what fill() will read.
    [[gnu::always_inline]] void ask_to_read(std::int64_t const* first, std::int64_t ahead, int i,
                                            int count) const {
        for (int n = i % numbers_of_line; n < count; n += numbers_of_line)
            for (int j = 0; j < lanes; ++j)
                prefetch<Real>(source_[n].origin, line_of(i) + first[j] + ahead);
    }
    [[gnu::always_inline]] void ask_to_read(std::int64_t const* first, std::int64_t ahead,
                                            int i) const {
        ask_to_read(first, ahead, i, count_);
    }
    /// Prefetches a share of what empty() will write.
    [[gnu::always_inline]] void ask_to_write(std::int64_t const* first, std::int64_t ahead,
                                             int i) const {
        for (int n = i % numbers_of_line; n < written_; n += numbers_of_line)
            for (int j = 0; j < lanes; ++j)
                prefetch_to_write<Real>(target_[n], line_of(i) + first[j] + ahead);
    }

  private:
    // Storage: the numbers to be read are at the beginning, those to be written at the end.
    static constexpr std::int64_t pitch = columns * lanes;
    static constexpr int line_of(int i) { return i / numbers_of_line * numbers_of_line; }
    double* place(int n) { return numbers_ + n * pitch + lanes; }
    // A number to be read from its field.
    struct Source {
        double const* origin;
        bool neighbours;
    };
    int count_ = 0, written_ = 0;
    Source source_[most];
    double* target_[most];
    alignas(64) double numbers_[most * pitch];
};

}  // namespace catena::dca
