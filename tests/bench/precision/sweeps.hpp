// The sweeps themselves: operators of dca/segment.hpp on bodies of bodies.hpp, in any precision and
// number of lanes.
#pragma once

#include "tests/bench/precision/bodies.hpp"
#include "tests/bench/precision/kernels.hpp"

/// Vectors in every build: what is left over the linker could give to others.
#if !defined(CATENA_WHOLE_SWEEPS)
#define CATENA_WHOLE_SWEEPS [[gnu::flatten]]
#endif

namespace catena::precision {

/// `Kind` in Real: Beads or Bodies; `Wide`: double, with as many lanes.
template <class Real, class Wide, class Kind>
class Sweeps {
    static constexpr int K = Kind::K, lanes = lanes_of<Real>();
    static_assert(lanes == lanes_of<Wide>());
    using WideKind = typename Kind::template In<Wide>;
    using State = typename Kind::State;
    using Loads = typename Kind::Loads;
    using Defect = typename Kind::Defect;
    using Matrices = dca::SegmentMatrix<Real, K>;
    using Biases = dca::SegmentBias<Real, K>;
    using Joint = dca::JointMatrix<Real, K>;
    using Directions = Vector<Real, K>;
    using Solution = typename WideKind::Solution;
    using WideDirections = Vector<Wide, K>;

  public:
    explicit Sweeps(Work const& work)
        : rows_(work.rows),
          runs_(work.rows / bodies_of_run),
          restricted_(work.restricted_at_base),
          states_(of<State>(work, state)),
          loads_(of<Loads>(work, loads)),
          joints_(of<Joint>(work, joint)),
          offsets_(of<Directions>(work, offset)),
          forces_(of<Directions>(work, force)),
          matrices_(of<Matrices>(work, matrix)),
          biases_(of<Biases>(work, bias)),
          top_(of<Joint>(work, top)),
          top_offsets_(of<Directions>(work, top_offset)),
          bodies_(of<typename WideKind::Body>(work, body)),
          given_(of<typename WideKind::Loads>(work, given)),
          solution_(of<Solution>(work, solution)),
          defects_(of<Defect>(work, defect)) {}

    bool assemble() {
        unsigned bad = 0;
        for (std::int64_t run = 0; run < runs_; ++run) {
            std::int64_t const begin = run * bodies_of_run;
            Matrices segment = Kind::matrix(states_ + begin);
            for (std::int64_t k = begin + 1; k < begin + bodies_of_run; ++k) {
                Joint eliminated;
                append(segment, Kind::matrix(states_ + k), K, eliminated);
                joints_[k] = eliminated;
                bad |= trouble(eliminated.factor, K);
            }
            matrices_[run] = segment;
        }
        Matrices* below = matrices_;
        each_level([&](std::int64_t nodes, std::int64_t span) {
            for (std::int64_t i = 0; i < nodes; ++i) {
                Joint eliminated;
                below[2 * nodes + i] = assemble_pair(below + 2 * i, eliminated);
                joints_[(2 * i + 1) * span * bodies_of_run] = eliminated;
                bad |= trouble(eliminated.factor, K);
            }
            below += 2 * nodes;
        });
        Matrices stretch = *below;
        int level = 0;
        for (int by = 1; by < lanes; by *= 2, ++level) {
            Matrices const next = turned<Real>(stretch, by);
            append(stretch, next, K, top_[level]);
            bad |= trouble(top_[level].factor, K) & every(2 * by);
        }
        top_[level].factor = dca::factorize(stretch.z11, restricted_);
        return (bad | (trouble(top_[level].factor, restricted_) & 1U)) == 0;
    }
    void solve() {
        sweep(loads_, [](Solution& x, auto const& found) { WideKind::set(x, found); });
    }
    void correct() {
        sweep(defects_, [](Solution& x, auto const& found) { WideKind::add(x, found); });
    }
    void find_defect() {
        WideDirections before = WideDirections::zero();
        for (std::int64_t k = 0; k < rows_; ++k) {
            WideDirections const outboard =
                k + 1 < rows_ ? solution_[k + 1].force : beyond(solution_[0].force);
            defects_[k] = WideKind::defect(bodies_ + k, given_[k], solution_[k], outboard, before)
                              .template in<Real>();
        }
        if constexpr (lanes > 1) {
            // What row 0 lacks of the stretch before, at rest with the ground in lane 0.
            WideDirections const last = with_lane(turned<Wide>(before, lanes - 1), 0, 0.0);
            WideDirections none = last;
            defects_[0] =
                WideKind::defect(bodies_, given_[0], solution_[0],
                                 rows_ > 1 ? solution_[1].force : beyond(solution_[0].force), none)
                    .template in<Real>();
        }
    }

  private:
    template <class T>
    static T* of(Work const& work, Array which) {
        return static_cast<T*>(work.of[which]);
    }
    static unsigned trouble(Symmetric<Real, K> const& factor, int restricted) {
        unsigned bad = 0;
        for (int i = 0; i < restricted; ++i) bad |= not_positive(factor(i, i));
        return bad;
    }
    /// Lanes 0, by, 2 by, ...
    static unsigned every(int by) {
        unsigned bits = 0;
        for (int j = 0; j < lanes; j += by) bits |= 1U << j;
        return bits;
    }
    /// action(nodes, runs of each half of one) from the lowest level of pairs on.
    template <class Action>
    void each_level(Action const& action) const {
        for (std::int64_t span = 1; 2 * span <= runs_; span *= 2) action(runs_ / (2 * span), span);
    }
    static Matrices assemble_pair(Matrices const* pair, Joint& eliminated) {
        return dca::assemble(pair[0], pair[1], K, eliminated);
    }
    /// At the stretches' outboard ends, from their inboard ends.
    static WideDirections beyond(WideDirections const& inboard) {
        return with_lane(turned<Wide>(inboard, lanes > 1 ? 1 : 0), lanes - 1, 0.0);
    }

    template <class Given, class Take>
    void sweep(Given const* given, Take const& take) {
        for (std::int64_t run = 0; run < runs_; ++run) {
            std::int64_t const begin = run * bodies_of_run;
            Biases segment = Kind::bias(states_ + begin, given[begin]);
            for (std::int64_t k = begin + 1; k < begin + bodies_of_run; ++k)
                append(segment, Kind::bias(states_ + k, given[k]), joints_[k], offsets_[k]);
            biases_[run] = segment;
        }
        Biases* below = biases_;
        each_level([&](std::int64_t nodes, std::int64_t span) {
            for (std::int64_t i = 0; i < nodes; ++i) {
                std::int64_t const k = (2 * i + 1) * span * bodies_of_run;
                below[2 * nodes + i] =
                    dca::assemble(below[2 * i], below[2 * i + 1], joints_[k], offsets_[k]);
            }
            below += 2 * nodes;
        });
        close(*below);
        for (std::int64_t span = runs_ / 2; span > 0; span /= 2)
            for (std::int64_t i = 0; i < runs_; i += 2 * span) {
                std::int64_t const k = (i + span) * bodies_of_run;
                forces_[i + span] =
                    disassemble(joints_[k], offsets_[k], forces_[i], forces_[i + 2 * span]);
            }
        for (std::int64_t run = 0; run < runs_; ++run) {
            std::int64_t const begin = run * bodies_of_run;
            Directions const first = forces_[run];
            Directions next = forces_[run + 1];
            for (std::int64_t k = begin + bodies_of_run; k-- > begin;) {
                Directions const at_k =
                    k == begin ? first : disassemble(joints_[k], offsets_[k], first, next);
                take(solution_[k], Kind::solution(states_ + k, given[k], at_k, next));
                next = at_k;
            }
        }
    }
    /// Forces at the ends of all stretches.
    void close(Biases stretch) {
        int level = 0;
        for (int by = 1; by < lanes; by *= 2, ++level) {
            Biases const next = turned<Real>(stretch, by);
            append(stretch, next, top_[level], top_offsets_[level]);
        }
        Symmetric<Real, K> const& ground = top_[level].factor;
        Directions first = dca::solve_upper(ground, dca::solve_lower(ground, -stretch.b1)),
                   next = Directions::zero();
        for (int by = lanes / 2; by > 0; by /= 2) {
            --level;
            spread(first, next, disassemble(top_[level], top_offsets_[level], first, next), by);
        }
        forces_[0] = first;
        forces_[runs_] = next;
    }
    /// From nodes of 2 by stretches, whose forces are in their first lane, to their halves.
    static void spread(Directions& first, Directions& next, Directions const& between, int by) {
        typename NumberOf<Real>::type at_first[lanes], at_next[lanes], middle[lanes];
        for (int i = 0; i < K; ++i) {
            store(first[i], at_first);
            store(next[i], at_next);
            store(between[i], middle);
            for (int j = lanes - 1; j >= 0; --j) {
                bool const outer = (j & by) != 0;
                at_first[j] = outer ? middle[j - by] : at_first[j];
                at_next[j] = outer ? at_next[j - by] : middle[j];
            }
            first[i] = load<Real>(at_first);
            next[i] = load<Real>(at_next);
        }
    }

    std::int64_t rows_, runs_;
    int restricted_;
    State const* states_;
    Loads const* loads_;
    Joint* joints_;
    Directions *offsets_, *forces_;
    Matrices* matrices_;
    Biases* biases_;
    Joint* top_;
    Directions* top_offsets_;
    typename WideKind::Body const* bodies_;
    typename WideKind::Loads const* given_;
    Solution* solution_;
    Defect* defects_;
};

template <class Real, class Wide, class Kind>
CATENA_WHOLE_SWEEPS bool assemble(Work const& work) {
    return Sweeps<Real, Wide, Kind>(work).assemble();
}
template <class Real, class Wide, class Kind>
CATENA_WHOLE_SWEEPS void solve(Work const& work) {
    Sweeps<Real, Wide, Kind>(work).solve();
}
template <class Real, class Wide, class Kind>
CATENA_WHOLE_SWEEPS void correct(Work const& work) {
    Sweeps<Real, Wide, Kind>(work).correct();
}
template <class Real, class Wide, class Kind>
CATENA_WHOLE_SWEEPS void find_defect(Work const& work) {
    Sweeps<Real, Wide, Kind>(work).find_defect();
}

template <class Real, class Wide, class Kind>
Kernels kernels() {
    using WideKind = typename Kind::template In<Wide>;
    constexpr int K = Kind::K;
    Kernels k;
    k.lanes = lanes_of<Real>();
    k.real_bytes = static_cast<int>(sizeof(Real)) / k.lanes;
    k.record_bytes[state] = sizeof(typename Kind::State);
    k.record_bytes[loads] = sizeof(typename Kind::Loads);
    k.record_bytes[joint] = k.record_bytes[top] = sizeof(dca::JointMatrix<Real, K>);
    k.record_bytes[offset] = k.record_bytes[force] = k.record_bytes[top_offset] =
        sizeof(Vector<Real, K>);
    k.record_bytes[matrix] = sizeof(dca::SegmentMatrix<Real, K>);
    k.record_bytes[bias] = sizeof(dca::SegmentBias<Real, K>);
    k.record_bytes[body] = sizeof(typename WideKind::Body);
    k.record_bytes[given] = sizeof(typename WideKind::Loads);
    k.record_bytes[solution] = sizeof(typename WideKind::Solution);
    k.record_bytes[defect] = sizeof(typename Kind::Defect);
    k.assemble = assemble<Real, Wide, Kind>;
    k.solve = solve<Real, Wide, Kind>;
    k.correct = correct<Real, Wide, Kind>;
    k.find_defect = find_defect<Real, Wide, Kind>;
    return k;
}
/// `WideSingle`: doubles in as many lanes as Single has.
template <class Double, class Single, class WideSingle>
KernelTable kernel_table() {
    return {{kernels<Double, Double, Beads<Double>>(), kernels<Double, Double, Bodies<Double, 3>>(),
             kernels<Double, Double, Bodies<Double, 5>>()},
            {kernels<Single, WideSingle, Beads<Single>>(),
             kernels<Single, WideSingle, Bodies<Single, 3>>(),
             kernels<Single, WideSingle, Bodies<Single, 5>>()}};
}

}  // namespace catena::precision
