// What the lanes of a vector do with their runs: the operations of evaluation.hpp and tree_sweeps.hpp, in the same order, on vectors.
#pragma once

#include <utility>

#include "dca/evaluation.hpp"
#include "dca/simd/runs.hpp"
#include "dca/simd/tile.hpp"

namespace catena::dca {

/// Bodies side by side as Evaluation takes them, their arrays in a tile.
template <class Real, class Leaf>
struct BodiesInTile {
    static constexpr int K = Leaf::K;
    static auto make(Tile<Real>& tile, RunWork<Leaf> const& work) {
        GroupView group{};
        group.inverse_mass = tile.in(work.group.inverse_mass);
        ConfigurationView at{};
        LoadsView loads{};
        loads.force = tile.in(work.loads.force);
        if constexpr (Leaf::beads) {
            at.position = tile.in(work.configuration.position, true);
            loads.velocity = tile.in(work.loads.velocity, true);
            return typename Leaf::Moving{group, nullptr, at, loads};
        } else {
            using Frames = typename Leaf::Frames;
            group.inverse_inertia = tile.in(work.group.inverse_inertia);
            group.r1 = tile.in(work.group.r1);
            group.r2 = tile.in(work.configuration.r2.origin ? work.configuration.r2 : work.group.r2);
            at.rotation = tile.in(work.configuration.rotation);
            if constexpr (Frames::in_joints) {
                group.axes1 = tile.in(work.group.axes1);
                group.axes2 = tile.in(work.configuration.axes2.origin ? work.configuration.axes2 : work.group.axes2);
            }
            if constexpr (Frames::on_links) at.direction = tile.in(work.configuration.direction, true);
            if constexpr (Frames::any_forces) group.screw = tile.in(work.group.screw, true);
            loads.torque = tile.in(work.loads.torque);
            loads.omega = tile.in(work.loads.omega);
            loads.bias = tile.template in_directions<K>(work.loads.bias);
            loads.gyroscopic = work.loads.gyroscopic;
            Leaf leaf(group);
            leaf.set(at);
            return Resting<Leaf>{leaf, nullptr, loads};
        }
    }
    using type = decltype(make(std::declval<Tile<Real>&>(), std::declval<RunWork<Leaf> const&>()));
};

template <class Real, class Leaf>
class RunsSideBySide {
    static constexpr int K = Leaf::K, lanes = Real::lanes;
    using Bodies = typename BodiesInTile<Real, Leaf>::type;
    using Body = typename Bodies::template Body<Column<Real>>;
    using Kept = decltype(Bodies::keep(std::declval<Body const&>()));
    using Segment = BiasedSegment<Real, K>;
    using Directions = Vector<Real, K>;
    struct Node {
        JointMatrix<Real, K> joint;
        Directions offset;
    };
    static constexpr int numbers = static_cast<int>(sizeof(Node) / sizeof(Real));
    static_assert(numbers * (parts_of_run - 1) == node_numbers<K>);

  public:
    explicit RunsSideBySide(RunWork<Leaf> const& work) : work_(work), bodies_(BodiesInTile<Real, Leaf>::make(tile_, work)) {
        out_.acceleration = tile_.out(work.out.acceleration);
        out_.alpha = tile_.out(work.out.alpha);
        out_.joint_force = tile_.template out_directions<K>(work.out.joint_force);
    }

    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Segment whole;
        CATENA_NO_UNROLL
        for (int p = 0; p < parts_of_run; ++p) {
            Node const node = add(whole, part(runs, p), runs, p, p * part_length);
            if (p > 0) store(place(item, p), node);
        }
        scatter(whole.matrix, work_.sweeps.matrices, runs.slot);
        scatter(whole.bias, work_.sweeps.biases, runs.slot);
    }
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Directions const first = gather(work_.sweeps.forces, runs.body);
        Directions next = gather(work_.sweeps.forces, runs.next);
        CATENA_NO_UNROLL
        for (int p = parts_of_run - 1; p >= 0; --p) {
            Directions const at_begin = p == 0 ? first : force(load(place(item, p)), first, next);
            down(runs, p, at_begin, next);
            next = at_begin;
        }
    }

  private:
    double* place(std::int64_t item, int p) const { return work_.nodes + (item * node_numbers<K> + (p - 1) * numbers) * lanes; }
    /// The next item's bodies usually follow, or come before where the way is back.
    void fill(RunsInLanes const& runs, int p, int ahead) { tile_.fill(columns(runs, p), ahead * lanes * longest_run); }
    std::int64_t const* columns(RunsInLanes const& runs, int p) {
        for (int j = 0; j < lanes; ++j) first_[j] = runs.body[j] + p * part_length;
        return first_;
    }
    Segment part(RunsInLanes const& runs, int p) {
        fill(runs, p, 1);
        auto bodies = bodies_.walk(Column<Real>{0});
        Segment segment;
        each_body<K>(0, part_length, [&](int i) { add(segment, bodies_.segment(bodies.body(i)), runs, i, p * part_length + i); });
        return segment;
    }
    /// Number i of those that a segment is joined of, in a loop: what makes them is long, and should stand there once.
    Node add(Segment& segment, Segment const& outboard, RunsInLanes const& runs, int i, int body) const {
        Node node;
        if (i == 0) {
            segment = outboard;
        } else {
            segment = joined(segment, outboard, node);
            watch(runs, body, node.joint.factor);
        }
        return node;
    }
    Segment joined(Segment const& inboard, Segment const& outboard, Node& node) const {
        Segment segment;
        segment.matrix = assemble(inboard.matrix, outboard.matrix, K, node.joint);
        segment.bias = assemble(inboard.bias, outboard.bias, node.joint, node.offset);
        return segment;
    }
    Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    void down(RunsInLanes const& runs, int p, Directions const& first, Directions next) {
        fill(runs, p, -1);
        if constexpr (Leaf::at_once)
            eliminate_again(first, next);
        else
            assemble_again(first, next);
        tile_.empty(columns(runs, p));
    }
    /// As Evaluation::down.
    void eliminate_again(Directions const& first, Directions next) {
        Elimination<Real, K> passed[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(Column<Real>{0});
        Symmetric<Real, K> z22;
        Directions b2;
        each_body<K>(0, part_length, [&](int i) {
            Segment const segment = take(bodies, i, kept);
            if (i == 0) {
                z22 = segment.matrix.z22;
                b2 = segment.bias.b2 + transposed_times(segment.matrix.z12, first);
            } else {
                passed[i] = eliminate(z22, b2, segment.matrix, segment.bias, K);
            }
        });
        back(kept, first, next, [&](int i) { return passed[i].gain * next + passed[i].offset; });
    }
    /// As BiasSweep::down, the joints found once more.
    void assemble_again(Directions const& first, Directions next) {
        Node node[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(Column<Real>{0});
        Segment segment;
        each_body<K>(0, part_length, [&](int i) {
            Segment const outboard = take(bodies, i, kept);
            segment = i == 0 ? outboard : joined(segment, outboard, node[i]);
        });
        back(kept, first, next, [&](int i) { return force(node[i], first, next); });
    }
    template <class Bodies>
    Segment take(Bodies& bodies, int i, Kept* kept) const {
        Body const body = bodies.body(i);
        kept[i] = bodies_.keep(body);
        return bodies_.segment(body);
    }
    /// From the last body, whose outboard joint's force is `next`; force(i) is that at body i's inboard joint.
    template <class Force>
    void back(Kept const* kept, Directions const& first, Directions& next, Force const& force) {
        each_body<K>(0, part_length, [&](int from_end) {
            int const i = part_length - 1 - from_end;
            Directions const at_i = i == 0 ? first : force(i);
            give(kept[i], i, at_i, next);
            next = at_i;
        });
    }
    void give(Kept const& kept, int i, Directions const& inboard, Directions const& outboard) {
        bodies_.accelerate(kept, inboard, outboard, out_);
        store_forces(GroupView{}, out_, Column<Real>{i}, inboard, outboard);
    }
    void watch(RunsInLanes const& runs, int body, Symmetric<Real, K> const& factor) const {
        unsigned bad = 0;
        for (int i = 0; i < K; ++i) bad |= factor(i, i).not_positive();
        for (int j = 0; bad != 0 && j < lanes; ++j)
            if ((bad >> j & 1U) != 0) work_.sweeps.note({static_cast<unsigned long long>(runs.body[j] + body)});
    }

    template <class Record>
    static void store(double* to, Record const& record) {
        auto const* const values = reinterpret_cast<Real const*>(&record);
        for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n) values[n].store(to + n * lanes);
    }
    static Node load(double const* from) {
        Node node;
        auto* const values = reinterpret_cast<Real*>(&node);
        for (int n = 0; n < numbers; ++n) values[n] = Real::load(from + n * lanes);
        return node;
    }
    template <class Record, class OfOne>
    static void scatter(Record const& record, RecordsView<OfOne, Order::plain> to, std::int64_t const* index) {
        constexpr int count = static_cast<int>(sizeof(OfOne) / sizeof(double));
        alignas(64) double values[count * lanes];
        store(values, record);
        for (int j = 0; j < lanes; ++j)
            for (int n = 0; n < count; ++n) to.origin[index[j] * count + n] = values[n * lanes + j];
    }
    static Directions gather(RecordsView<Vector<double, K>, Order::by_body> from, std::int64_t const* index) {
        std::int64_t at[lanes];
        for (int j = 0; j < lanes; ++j) at[j] = index[j] * K;
        Directions v;
        for (int n = 0; n < K; ++n) v[n] = Real::pick(from.origin + n, at);
        return v;
    }

    RunWork<Leaf> const& work_;
    Tile<Real> tile_;
    Bodies bodies_;
    AccelerationsView out_{};
    std::int64_t first_[lanes];
};

template <class Real, class Leaf>
[[gnu::flatten]] void climb_runs(RunWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    RunsSideBySide<Real, Leaf> runs(work);
    for (std::int64_t item = begin; item < end; ++item) runs.climb(item);
}
template <class Real, class Leaf>
[[gnu::flatten]] void descend_runs(RunWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    RunsSideBySide<Real, Leaf> runs(work);
    for (std::int64_t item = end; item-- > begin;) runs.descend(item);  // what was climbed last may still be near
}
template <class Real, class Leaf>
RunKernels<Leaf> kernels() {
    return {climb_runs<Real, Leaf>, descend_runs<Real, Leaf>};
}

}  // namespace catena::dca
