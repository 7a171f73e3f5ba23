// What the lanes of a vector do with their runs: the operations of evaluation.hpp and tree_sweeps.hpp, in the same order, on vectors.
#pragma once

#include <new>
#include <type_traits>
#include <utility>

#include "dca/evaluation.hpp"
#include "dca/simd/records.hpp"
#include "dca/simd/runs.hpp"
#include "dca/simd/tile.hpp"

namespace catena::dca {

/// Bodies side by side as Evaluation takes them: their constants in the order of lanes, the rest in a tile.
template <class Real, class Leaf>
class BodiesInTile {
    static constexpr int K = Leaf::K;

  public:
    template <class Tile>
    BodiesInTile(Tile& tile, RunWork<Leaf> const& work) {
        loads_.force = tile.in(work.loads.force);
        if constexpr (Leaf::beads) {
            group_.inverse_mass = tile.in(work.group.inverse_mass);
            at_.position = tile.in(work.configuration.position, true);
            loads_.velocity = tile.in(work.loads.velocity, true);
        } else {
            using Frames = typename Leaf::Frames;
            at_.rotation = tile.in(work.configuration.rotation);
            at_.r2 = tile.in(work.configuration.r2);
            if constexpr (Frames::in_joints) at_.axes2 = tile.in(work.configuration.axes2);
            if constexpr (Frames::on_links) at_.direction = tile.in(work.configuration.direction, true);
            if constexpr (Frames::any_forces) group_.screw = tile.in(work.group.screw, true);
            loads_.torque = tile.in(work.loads.torque);
            loads_.omega = tile.in(work.loads.omega);
            loads_.hinge_rate = tile.in(work.loads.hinge_rate);
            if (!loads_.hinge_rate.origin) loads_.bias = tile.template in_directions<K>(work.loads.bias);
            loads_.gyroscopic = work.loads.gyroscopic;
        }
    }
    /// Those of a part.
    auto with(Constants<Real> constants) const {
        GroupView group = group_;
        each_constant<Leaf>(group, [&constants]<int D>(ConstView<D>& view) { view = constants.template next<D>(); });
        if constexpr (Leaf::beads) {
            return typename Leaf::Moving{group, nullptr, at_, loads_};
        } else {
            Leaf leaf(group);
            leaf.set(at_);
            return Resting<Leaf>{leaf, nullptr, loads_};
        }
    }

  private:
    GroupView group_{};
    ConfigurationView at_{};
    LoadsView loads_{};
};

/// The joints between segments, one a lane, as the way down needs them.
template <class Real, int K>
struct NodeInLanes {
    JointMatrix<Real, K> joint;
    Vector<Real, K> offset;

    void append(BiasedSegment<Real, K>& segment, BiasedSegment<Real, K> const& outboard) {
        dca::append(segment.matrix, outboard.matrix, K, joint);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
    Vector<Real, K> force(Vector<Real, K> const& first, Vector<Real, K> const& next) const {
        return disassemble(joint, offset, first, next);
    }
};
template <class Real, int K>
inline constexpr bool fits_nodes =
    sizeof(NodeInLanes<Real, K>) == node_numbers<K> * sizeof(Real) && sizeof(OneSided<Real, K>) == passed_numbers<K> * sizeof(Real);
/// Of joints number[j] + further, those whose bit j of `bad` is set.
template <class Real, class Leaf>
void note_lost(TreeSweeps<Leaf> const& sweeps, std::int64_t const* number, int further, unsigned bad) {
    for (int j = 0; bad != 0 && j < Real::lanes; ++j)
        if ((bad >> j & 1U) != 0) sweeps.note({static_cast<unsigned long long>(number[j] + further)});
}
template <class Leaf, class Real, int K>
void watch(TreeSweeps<Leaf> const& sweeps, std::int64_t const* number, int further, Symmetric<Real, K> const& factor) {
    unsigned bad = 0;
    for (int i = 0; i < K; ++i) bad |= factor(i, i).not_positive();
    note_lost<Real>(sweeps, number, further, bad);
}

/// Runs side by side, whose bodies are in a tile a part at a time, with what is done to them there.
template <class Real, class Leaf>
class RunsInTile {
    // Beads' neighbours are of the same run for the most part.
    static constexpr bool by_runs = Leaf::beads;
    static_assert(!by_runs || constants_of<Leaf> == 0);
    static constexpr int lanes = Real::lanes;
    static constexpr std::int64_t bodies_of_item = lanes * longest_run;

  protected:
    using Bodies = decltype(std::declval<BodiesInTile<Real, Leaf>>().with(Constants<Real>{}));

    explicit RunsInTile(RunWork<Leaf> const& work) : work_(work), in_tile_(tile_, work), bodies_(in_tile_.with({work.constants})) {
        if (View<2> const& of_hinges = work.out.hinge_acceleration; of_hinges.origin) {
            View<1> const first = tile_.out(View<1>{of_hinges.origin, of_hinges.pitch, of_hinges.size});
            out_.hinge_acceleration = {first.origin, first.pitch, first.size};  // the other component goes straight to its place
        } else {
            out_.acceleration = tile_.out(work.out.acceleration);
            out_.alpha = tile_.out(work.out.alpha);
        }
        out_.joint_force = tile_.template out_directions<Leaf::K>(work.out.joint_force);
    }
    /// The next item's bodies usually follow, or come before where the way is back.
    void fill(RunsInLanes const& runs, int p, int way) {
        begin_ = {by_runs ? p * part_length : 0};
        if (!by_runs)
            tile_.fill(columns(runs, p), way * bodies_of_item);
        else if (p == (way > 0 ? 0 : parts_of_run - 1))
            tile_.fill(runs.body, way * bodies_of_item);
        if constexpr (constants_of<Leaf> > 0) {
            constexpr int block = constants_of<Leaf> * part_length * lanes;
            double const* const here = work_.constants + ((&runs - work_.runs) * parts_of_run + p) * block;
            prefetch<Real>(here, 2 * way * block, block);
            bodies_ = in_tile_.with({here});
        }
    }
    void empty(RunsInLanes const& runs, int p) {
        if (!by_runs)
            tile_.empty(columns(runs, p), -bodies_of_item);
        else if (p == 0)
            tile_.empty(runs.body, -bodies_of_item);
    }

    RunWork<Leaf> const& work_;

  private:
    std::int64_t const* columns(RunsInLanes const& runs, int p) {
        for (int j = 0; j < lanes; ++j) first_[j] = runs.body[j] + p * part_length;
        return first_;
    }
    Tile<Real, by_runs ? longest_run : part_length> tile_;
    BodiesInTile<Real, Leaf> in_tile_;
    std::int64_t first_[lanes];

  protected:
    Bodies bodies_;
    Column<Real> begin_;  // of the part in the tile
    AccelerationsView out_{};
};

template <class Real, class Leaf>
class RunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes;
    using Base = RunsInTile<Real, Leaf>;
    using Base::work_, Base::begin_, Base::bodies_, Base::out_, Base::fill, Base::empty;
    using Bodies = typename Base::Bodies;
    using Body = typename Bodies::template Body<Column<Real>>;
    using Kept = decltype(std::declval<Bodies const&>().keep(std::declval<Body const&>()));
    using Segment = BiasedSegment<Real, K>;
    using Directions = Vector<Real, K>;
    using Node = NodeInLanes<Real, K>;
    using Passed = OneSided<Real, K>;
    static_assert(fits_nodes<Real, K>);
    static constexpr int numbers_of_node = node_numbers<K> * lanes, numbers_of_passed = passed_numbers<K> * lanes;

  public:
    explicit RunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Segment whole, part;
        CATENA_NO_UNROLL
        for (int p = 0; p < parts_of_run; ++p) {
            make_part(item, p, p == 0 ? whole : part);
            if (p == 0) continue;
            Node node;
            double* const kept = place_of_node(item, p);
            prefetch_to_write<Real>(kept, numbers_of_node, numbers_of_node);
            append(whole, part, node, runs, p * part_length);
            store_vectors<Real>(kept, node);
        }
        scatter<Real>(whole.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(whole.bias, work_.sweeps.biases, runs.slot);
    }
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Directions first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        CATENA_NO_UNROLL
        for (int p = parts_of_run - 1; p >= 0; --p) {
            Directions at_begin = first;
            if (p > 0) {
                Node node;
                double const* const kept = place_of_node(item, p);
                prefetch<Real>(kept, -numbers_of_node, numbers_of_node);
                load_vectors<Real>(kept, node);
                at_begin = node.force(first, next);
            }
            down(item, p, at_begin, next);
            next = at_begin;
        }
    }

  private:
    double* place_of(std::int64_t item) const { return work_.nodes + item * kept_of_run<K>(work_.keeps_all) * lanes; }
    /// Of the joint inboard of part p, which is not the first.
    double* place_of_node(std::int64_t item, int p) const { return place_of(item) + (p - 1) * numbers_of_node; }
    /// Of what the run's body i passes on. Precondition: all is kept.
    double* place_of_passed(std::int64_t item, int i) const {
        return place_of(item) + (parts_of_run - 1) * numbers_of_node + i * numbers_of_passed;
    }
    void make_part(std::int64_t item, int p, Segment& segment) {
        RunsInLanes const& runs = work_.runs[item];
        fill(runs, p, 1);
        auto bodies = bodies_.walk(begin_);
        Segment body;
        Node node;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
            ::new (i == 0 ? &segment : &body) Segment(bodies_.segment(bodies.body(i)));
            if (i == 0) return keep(item, p, 0, {{}, segment.matrix.z12, segment.bias});
            append(segment, body, node, runs, p * part_length + i);
            keep(item, p, i, {node.joint.factor, node.joint.outboard, body.bias});
        });
    }
    void keep(std::int64_t item, int p, int i, Passed const& passed) const {
        if constexpr (!Leaf::beads)
            if (work_.keeps_all) store_vectors<Real>(place_of_passed(item, p * part_length + i), passed);
    }
    void append(Segment& segment, Segment const& outboard, Node& node, RunsInLanes const& runs, int body) const {
        node.append(segment, outboard);
        watch(work_.sweeps, runs.body, body, node.joint.factor);
    }
    void down(std::int64_t item, int p, Directions const& first, Directions next) {
        RunsInLanes const& runs = work_.runs[item];
        fill(runs, p, -1);
        if (!Leaf::beads && work_.keeps_all)
            use_kept(item, p, first, next);
        else
            eliminate_again(first, next);
        empty(runs, p);
    }
    /// As Evaluation::down.
    void eliminate_again(Directions const& first, Directions next) {
        Elimination<Real, K> passed[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(begin_);
        Symmetric<Real, K> z22;
        Directions b2;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
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
    /// As Evaluation::forces.
    void use_kept(std::int64_t item, int p, Directions const& first, Directions next) {
        Elimination<Real, K> passed[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(begin_);
        Directions b2;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
            kept[i] = bodies_.keep(bodies.body(i));
            Passed joint;
            load_vectors<Real>(place_of_passed(item, p * part_length + i), joint);
            if (i == 0)
                b2 = joint.bias.b2 + transposed_times(joint.outboard, first);
            else
                passed[i] = pass(b2, joint);
        });
        back(kept, first, next, [&](int i) { return passed[i].gain * next + passed[i].offset; });
    }
    template <class Bodies>
    Segment take(Bodies& bodies, int i, Kept* kept) const {
        Body const body = bodies.body(i);
        kept[i] = bodies_.keep(body);
        return bodies_.segment(body, kept[i]);
    }
    /// From the last body, whose outboard joint's force is `next`; force(i) is that at body i's inboard joint.
    template <class Force>
    void back(Kept const* kept, Directions const& first, Directions& next, Force const& force) {
        each_body<unrolled<K>>(0, part_length, [&](int from_end) {
            int const i = part_length - 1 - from_end;
            Directions const at_i = i == 0 ? first : force(i);
            give(kept[i], i, at_i, next);
            next = at_i;
        });
    }
    void give(Kept const& kept, int i, Directions const& inboard, Directions const& outboard) {
        bodies_.accelerate(kept, inboard, outboard, out_);
        store_forces(GroupView{}, out_, begin_ + i, inboard, outboard);
    }
};

/// Runs on hinges, by their inertias: as Evaluation::climb and descend.
template <class Real, class Leaf>
class HingedRunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes, count = static_cast<int>(longest_run);
    static constexpr int numbers_of_hinge = hinge_numbers * lanes;
    using Base = RunsInTile<Real, Leaf>;
    using Base::work_, Base::bodies_, Base::out_, Base::fill, Base::empty;
    static_assert(sizeof(ReleasedHinge<Real>) == hinge_numbers * sizeof(Real) && sizeof(RunsEnd<Real>) == end_numbers * sizeof(Real));

  public:
    explicit HingedRunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept kept{*this, runs, place_of(item)};
        auto const segment = climb_hinges<Real>(
            count,
            [&](int i) {
                if (i % part_length == 0) fill(runs, i / part_length, 1);
                auto body = bodies_.leaf.hinged(bodies_.loads, Column<Real>{i % part_length});
                if (i == 0) take_first_biases(runs, body);
                return body;
            },
            kept);
        scatter<Real>(segment.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(segment.bias, work_.sweeps.biases, runs.slot);
    }
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Vector<Real, K> first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        Vector<Real, K> outboard = next;
        descend_hinges<Real, false>(
            count,
            [&](int i) {
                if (i % part_length == part_length - 1) fill(runs, i / part_length, -1);
                auto body = bodies_.leaf.hinged_frame(bodies_.loads, Column<Real>{i % part_length});
                if (i == 0) take_first_biases(runs, body);
                return body;
            },
            Kept{*this, runs, place_of(item)}, first, next,
            [&](int i, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
                Column<Real> const here{i % part_length};
                if (out_.acceleration.origin) {
                    write(out_.alpha, here, a.alpha);
                    write(out_.acceleration, here, a.a);
                }
                if (out_.hinge_acceleration.origin && i == count - 1) end_at(runs, frame, a);
                if (out_.joint_force) {
                    outboard = i == 0 ? first : inboard_force(bodies_.leaf.hinged(bodies_.loads, here), a, outboard);
                    write_directions<K>(out_.joint_force, here, outboard);
                }
                if (i == 0) begin_at(runs, frame, a);
            },
            [&](int i, Real const& of_hinge) { turn(runs, i, of_hinge); });
    }

  private:
    struct Kept {
        HingedRunsSideBySide const& all;
        RunsInLanes const& runs;
        double* place;

        void put(int i, ReleasedHinge<Real> const& hinge) {
            double* const kept = of_hinge(i);
            int const further = ahead * numbers_of_hinge + (i + ahead < count ? 0 : numbers_of_end);
            prefetch_to_write<Real>(kept, further, numbers_of_hinge);
            if (i == count / 2) prefetch_to_write<Real>(place, 0, numbers_of_end);
            store_vectors<Real>(kept, hinge);
            watch(i, hinge.inverse.not_positive());
        }
        void put(RunsEnd<Real> const& end) {
            store_vectors<Real>(place, end);
            for (int i = 0; i < 6; ++i) watch(count - 1, end.factor(i, i).not_positive());
        }
        ReleasedHinge<Real> hinge(int i) const {
            ReleasedHinge<Real> h;
            double const* const kept = of_hinge(i);
            prefetch<Real>(kept, -ahead * numbers_of_hinge - (i > ahead ? 0 : numbers_of_end), numbers_of_hinge);
            load_vectors<Real>(kept, h);
            return h;
        }
        RunsEnd<Real> end() const {
            RunsEnd<Real> e;
            prefetch<Real>(place, -kept_of_hinged_run * lanes, numbers_of_end);
            load_vectors<Real>(place, e);
            return e;
        }

      private:
        // What is asked for is so many hinges further, in the order of items: the next one's end lies between.
        static constexpr int ahead = 4, numbers_of_end = end_numbers * lanes;
        double* of_hinge(int i) const { return place + end_numbers * lanes + (i - 1) * numbers_of_hinge; }
        void watch(int i, unsigned bad) const { note_lost<Real>(all.work_.sweeps, runs.body, i, bad); }
    };
    double* place_of(std::int64_t item) const { return work_.nodes + item * kept_of_hinged_run * lanes; }
    GroupView const& group() const { return work_.group; }
    template <class Condition>
    static bool any(RunsInLanes const& runs, Condition const& of_first_body) {
        bool found = false;
        for (int j = 0; j < lanes; ++j) found = found || of_first_body(runs.body[j]);
        return found;
    }
    /// In lanes whose runs begin a chain.
    void take_first_biases(RunsInLanes const& runs, HingedFrame<Real>& body) const {
        if (!bodies_.loads.hinge_rate.origin) return;
        alignas(64) double bias[K * lanes];
        store_vectors<Real>(bias, body.bias);
        for (int j = 0; j < lanes; ++j)
            if (group().is_first[runs.body[j]])
                for (int n = 0; n < K; ++n) bias[n * lanes + j] = work_.loads.bias.origin[n * work_.loads.bias.pitch + runs.body[j]];
        load_vectors<Real>(bias, body.bias);
    }
    /// What is wanted of the runs' last and first bodies, as Evaluation::accelerate.
    void end_at(RunsInLanes const& runs, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) const {
        View<2> const& to = work_.out.hinge_acceleration;
        scatter(View<1>{to.origin + to.pitch, to.pitch, to.size}, runs.body, count, Vector<Real, 1>{{about_outboard_hinge(frame, a)}});
        if (any(runs, [&](std::int64_t body) { return body + count >= group().size || group().is_last[body + count]; }))
            scatter_accelerations(runs, count - 1, a);
    }
    void begin_at(RunsInLanes const& runs, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
        if (out_.hinge_acceleration.origin && any(runs, [&](std::int64_t body) { return group().is_first[body]; }))
            scatter_accelerations(runs, 0, a);
        turn(runs, 0, about_inboard_hinge(frame, a));
    }
    void scatter_accelerations(RunsInLanes const& runs, int i, BodyAcceleration<Real> const& a) const {
        scatter(work_.out.alpha, runs.body, i, a.alpha);
        scatter(work_.out.acceleration, runs.body, i, a.a);
    }
    /// The last that is known of body i of the runs.
    void turn(RunsInLanes const& runs, int i, Real const& of_hinge) {
        View<2> const& to = out_.hinge_acceleration;
        if (to.origin) write(View<1>{to.origin, to.pitch, to.size}, Column<Real>{i % part_length}, Vector<Real, 1>{{of_hinge}});
        if (i % part_length == 0) empty(runs, i / part_length);
    }
};

template <class Real, class Leaf>
using Runs = std::conditional_t<Leaf::by_inertia, HingedRunsSideBySide<Real, Leaf>, RunsSideBySide<Real, Leaf>>;

template <class Real, class Leaf>
[[gnu::flatten]] void climb_runs(RunWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    Runs<Real, Leaf> runs(work);
    for (std::int64_t item = begin; item < end; ++item) runs.climb(item);
}
template <class Real, class Leaf>
[[gnu::flatten]] void descend_runs(RunWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    Runs<Real, Leaf> runs(work);
    for (std::int64_t item = end; item-- > begin;) runs.descend(item);  // what was climbed last may still be near
}
template <class Real, class Leaf>
void prefetch_merge(MergeWork<Leaf> const& work, std::int64_t item) {
    constexpr int numbers_of_node = node_numbers<Leaf::K> * Real::lanes;
    auto const prefetch_segments = [&sweeps = work.sweeps](std::int64_t const* slots) {
        prefetch_records<Real>(sweeps.matrices, slots);
        prefetch_records<Real>(sweeps.biases, slots);
    };
    prefetch_segments(work.merges[item].inboard);
    prefetch_segments(work.merges[item].outboard);
    prefetch_to_write<Real>(work.nodes, item * numbers_of_node, numbers_of_node);
}
template <class Real, class Leaf>
[[gnu::flatten]] void climb_merges(MergeWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    constexpr int K = Leaf::K, numbers_of_node = node_numbers<K> * Real::lanes;
    auto const& [sweeps, merges, nodes] = work;
    for (std::int64_t item = begin; item < end; ++item) {
        MergesInLanes const& m = merges[item];
        if (item + 1 < end) prefetch_merge<Real>(work, item + 1);
        BiasedSegment<Real, K> segment, outboard;
        gather<Real>(sweeps.matrices, m.inboard, segment.matrix);
        gather<Real>(sweeps.biases, m.inboard, segment.bias);
        gather<Real>(sweeps.matrices, m.outboard, outboard.matrix);
        gather<Real>(sweeps.biases, m.outboard, outboard.bias);
        NodeInLanes<Real, K> node;
        node.append(segment, outboard);
        watch(sweeps, m.joint, 0, node.joint.factor);
        store_vectors<Real>(nodes + item * numbers_of_node, node);
        scatter<Real>(segment.matrix, sweeps.matrices, m.slot);
        scatter<Real>(segment.bias, sweeps.biases, m.slot);
    }
}
template <class Real, class Leaf>
[[gnu::flatten]] void descend_merges(MergeWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    constexpr int K = Leaf::K;
    auto const& [sweeps, merges, nodes] = work;
    for (std::int64_t item = begin; item < end; ++item) {
        MergesInLanes const& m = merges[item];
        NodeInLanes<Real, K> node;
        load_vectors<Real>(nodes + item * node_numbers<K> * Real::lanes, node);
        Vector<Real, K> first, next;
        gather<Real>(sweeps.forces, m.first, first);
        gather<Real>(sweeps.forces, m.next, next);
        scatter<Real>(node.force(first, next), sweeps.forces, m.joint);
    }
}
template <class Real, class Leaf>
RunKernels<Leaf> kernels() {
    return {climb_runs<Real, Leaf>, descend_runs<Real, Leaf>, climb_merges<Real, Leaf>, descend_merges<Real, Leaf>};
}

}  // namespace catena::dca
