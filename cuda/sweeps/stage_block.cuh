// A block's part of a sweep's stage (tree/stages.hpp) on a GPU. tests/support/cuda_on_host.hpp,
// included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/stage_places.cuh"

namespace catena::cuda::kernels {

/// A block's part of a stage in its shared memory: its words, read once, and the segments and
/// forces at its places. A sweep that keeps nodes, or whose merges go by teams, stores nodes there
/// too. Each takes the place of the outboard segment of its merge.
template <class Sweep>
class BlockOfStage {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Sweeps::Node;
    using Records = RecordsOfStage<Sweep>;
    using Segments = typename Records::Segments;
    using Nodes = typename Records::Nodes;
    using Forces = typename Records::Forces;
    static constexpr bool by_teams = merges_by_teams<Sweep>;

  public:
    /// `block`: number of the block in the stage; `memory`: its shared memory.
    __device__ BlockOfStage(DeviceStage const& stage, unsigned block, Sweep const& sweep,
                            double* memory)
        : sweep_(sweep), at_(stage, block, memory) {}
    /// Reads the block's words. It is called first; a barrier must follow.
    __device__ void take_words() const { at_.take_words(); }

    /// Reads the items' segments, or eliminates the runs. `part`: the thread's bodies, if items are
    /// runs. `and_down`: the same launch performs the outward pass.
    template <bool and_down>
    __device__ void take_items(typename Sweep::Part& part) const {
        dca::BlockHead const& head = at_.words.head();
        if constexpr (by_teams)
            take_segments();
        else if (!at_.stage.runs)
            each_of(head.items, [&](int i) {
                at_.segments.store(i, sweep_.load(at_.words.item(i).own_slot()));
            });
        else
            climb_some_runs<and_down>(
                at_.stage.runs, head.first_item, head.first_item + head.items, sweep_, at_.parts,
                part, [&](std::int64_t i, Segment const& segment) {
                    at_.segments.store(static_cast<int>(i - head.first_item), segment);
                });
    }
    /// Receives segments of blocks below by letters and reads the other items from memory.
    __device__ void take_items(Letters const& letters) const {
        int const items = at_.words.head().items;
        each_of(items, [&](int i) {
            dca::BlockItem const& item = at_.words.item(i);
            if (item.comes_by_letter()) return;
            if constexpr (by_teams)
                for (int n = 0; n < Segments::numbers; ++n)
                    at_.segments.number(i, n) = sweep_.s.number_of_segment(item.own_slot(), n);
            else
                at_.segments.store(i, sweep_.load(item.own_slot()));
        });
        // Neighbouring threads take neighbouring items; the remaining threads share the numbers of
        // an item.
        // Independent requests hide the latency of memory.
        constexpr int at_once = Segments::numbers > 16 ? 16 : 8;
        auto const all = static_cast<int>(blockDim.x), own = static_cast<int>(threadIdx.x);
        int side_by_side = 32;
        while (side_by_side < items && side_by_side < all) side_by_side *= 2;
        for (int i = own % side_by_side; i < items; i += side_by_side)
            if (at_.words.item(i).comes_by_letter())
                letters.take_some<at_once>(
                    i, own / side_by_side, Segments::numbers, all / side_by_side,
                    [&](int n, double number) { at_.segments.number(i, n) = number; });
    }
    /// Merges segments, level by level.
    __device__ void climb() const {
        CATENA_NO_UNROLL
        for (int l = 0; l < at_.stage.layout.levels; ++l) {
            __syncthreads();
            if constexpr (by_teams)
                at_.each_merge_of_team(l, [&](auto const& team, dca::BlockMerge const& m,
                                              bool works) {
                    double *const inboard = at_.segments.record(m.inboard), *const outboard =
                                                                                at_.segments.record(
                                                                                    m.outboard);
                    team.join(sweep_, {m.joint, m.restricted}, works,
                              {inboard, outboard, inboard, outboard});
                });
            else
                at_.each_merge(l, [&](dca::BlockMerge const& m) { join(m); });
        }
        __syncthreads();
    }
    /// Stores segments that other stages or ranks need.
    __device__ void send_segments() const {
        int const ups = at_.words.head().ups;
        if constexpr (by_teams)
            for (int i = 0; i < ups; ++i) give(at_.words.up(i));
        else
            each_of(ups, [&](int i) {
                sweep_.store(at_.words.up(i).at, at_.segments.load(at_.words.up(i).place));
            });
    }
    /// Sends segments to the block of the stage above.
    __device__ void send_segments(Letters const& letters) const {
        each_of(at_.words.head().ups * Segments::numbers, [&](int i) {
            dca::BlockHanded const& up = at_.words.up(i / Segments::numbers);
            int const n = i % Segments::numbers;
            letters.put(up.above, n, at_.segments.number(up.place, n));
        });
    }
    /// Computes the forces at the ends of chains whose tree is complete in this block.
    __device__ void close() const {
        dca::BlockHead const& head = at_.words.head();
        each_of(head.roots,
                [&](int i) { close(i == 0 ? head.root : at_.stage.roots[head.first_root + i]); });
    }
    /// Stores the nodes for an outward pass in another launch.
    __device__ void put_nodes() const {
        if constexpr (by_teams)
            at_.copy(at_.segments.origin, at_.kept());
        else if constexpr (Sweep::keeps_nodes)
            at_.each_merge([&](dca::BlockMerge const& m) {
                sweep_.keep(m.joint, at_.nodes.load(m.outboard));
            });
    }
    /// Reads the nodes back.
    __device__ void take_nodes() const {
        if constexpr (by_teams)
            at_.copy(at_.kept(), at_.segments.origin);
        else if constexpr (Sweep::keeps_nodes)
            at_.each_merge([&](dca::BlockMerge const& m) {
                at_.nodes.store(m.outboard, sweep_.node(m.joint));
            });
    }
    /// Reads the forces that come from stages above.
    __device__ void take_forces() const {
        each_of(at_.words.head().downs, [&](int i) { take_force(at_.words.down(i)); });
    }
    /// Receives forces from the block of the stage above and reads the others from memory.
    __device__ void take_forces(Letters const& letters) const {
        int const downs = at_.words.head().downs;
        each_of(downs, [&](int i) {
            if (dca::BlockHanded const& down = at_.words.down(i); down.above < 0) take_force(down);
        });
        each_of(downs * Forces::numbers, [&](int i) {
            dca::BlockHanded const& down = at_.words.down(i / Forces::numbers);
            int const n = i % Forces::numbers;
            if (down.above >= 0) at_.forces.number(down.place, n) = letters.wait_for(down.above, n);
        });
    }
    /// Sends forces to the blocks of the stage below.
    __device__ void give_forces(Letters const& letters) const {
        each_of(at_.stage.forces, [&](int place) {
            CATENA_UNROLL
            for (int n = 0; n < Forces::numbers; ++n)
                letters.put(place, n, at_.forces.number(place, n));
        });
    }
    /// Computes joint forces, from the highest level to the lowest.
    __device__ void descend() const {
        CATENA_NO_UNROLL
        for (int l = at_.stage.layout.levels - 1; l >= 0; --l) {
            __syncthreads();
            if constexpr (by_teams)
                at_.each_merge_of_team(l,
                                       [&](auto const& team, dca::BlockMerge const& m, bool works) {
                                           team.go_down(m, works, at_.nodes, at_.forces);
                                       });
            else
                at_.each_merge(l, [&](dca::BlockMerge const& m) { go_down(m); });
        }
        __syncthreads();
    }
    /// Stores the items' forces, or performs the runs' outward pass. `part`: as left by
    /// take_items() in the same launch, or null if `alone`. Loops are unrolled if `alone`, because
    /// many blocks then use the instructions.
    template <bool alone>
    __device__ void give_items(typename Sweep::Part const* part) const {
        if (!by_teams && at_.stage.runs)
            descend_runs<alone>(part);
        else
            each_of(at_.words.head().items, [&](int i) {
                if (dca::BlockItem const& item = at_.words.item(i); !item.is_given())
                    sweep_.s.forces.store(item.joint, at_.forces.load(i));
            });
    }

  private:
    // Sweeps with merges by teams never process stages with runs here; StageWalk splits these
    // sweeps.
    template <bool alone>
    __device__ void descend_runs(typename Sweep::Part const* part) const {
        if constexpr (!by_teams) {
            dca::BlockHead const& head = at_.words.head();
            auto const place = [&](std::int64_t i) {
                return static_cast<int>(i - head.first_item);
            };
            descend_some_runs<alone, !alone, false>(
                at_.stage.runs, head.first_item, head.first_item + head.items, sweep_, at_.parts,
                part, [&](dca::Run const&, std::int64_t i) { return at_.forces.load(place(i)); },
                [&](dca::Run const&, std::int64_t i) {
                    return at_.forces.load(at_.words.next_of_run(place(i)));
                });
        }
    }
    /// Computes the forces at the ends of one chain.
    __device__ void close(dca::StageRoot const& closed) const {
        Segment const whole = at_.segments.load(closed.place);
        if constexpr (takes_factors<Sweep>)
            if (closed.root.tip == dca::TipTo::nothing)
                return sweep_.close_free({closed.root.first, closed.restricted}, whole,
                                         BranchlessFactorizer<false>{});
        sweep_.close(closed.root, whole);
    }
    __device__ void take_force(dca::BlockHanded const& down) const {
        at_.forces.store(down.place, sweep_.s.forces.load(down.at));
    }
    /// Merges two segments; the merged one takes the place of the inboard one.
    __device__ void join(dca::BlockMerge const& m) const {
        Segment const inboard = at_.segments.load(m.inboard),
                      outboard = at_.segments.load(m.outboard);
        dca::JointAt const at{m.joint, m.restricted};
        if constexpr (Sweep::keeps_nodes) {
            Node node;
            at_.segments.store(m.inboard, joined_quickly(sweep_, inboard, outboard, at, node));
            at_.nodes.store(m.outboard, node);
        } else {
            at_.segments.store(m.inboard, sweep_.joined(inboard, outboard, at));
        }
    }
    /// Computes the force at a merge's joint.
    __device__ void go_down(dca::BlockMerge const& m) const {
        Node node;
        if constexpr (Sweep::keeps_nodes)
            node = at_.nodes.load(m.outboard);
        else
            node = sweep_.node(m.joint);
        at_.forces.store(m.outboard,
                         sweep_.force(node, at_.forces.load(m.inboard), at_.forces.load(m.next)));
    }
    /// Reads the items' segments: one number per warp, one item per lane.
    __device__ void take_segments() const {
        constexpr int at_once = 9;  // independent requests hide the latency of memory
        int const warp = static_cast<int>(threadIdx.x) / 32,
                  warps = static_cast<int>(blockDim.x) / 32;
        for (int place = static_cast<int>(threadIdx.x) % 32; place < at_.words.head().items;
             place += 32) {
            std::int64_t const slot = at_.words.item(place).own_slot();
            move_some<at_once>(
                warp, Segments::numbers, warps,
                [&](int n) { return sweep_.s.number_of_segment(slot, n); },
                [&](int n, double number) { at_.segments.number(place, n) = number; });
        }
    }
    /// Stores a segment by all threads of the block.
    __device__ void give(dca::BlockHanded const& up) const {
        each_of(Segments::numbers, [&](int n) {
            sweep_.s.number_of_segment(up.at, n) = at_.segments.number(up.place, n);
        });
    }
    Sweep const& sweep_;
    PlacesOfBlock<Sweep> at_;
};

}  // namespace catena::cuda::kernels
