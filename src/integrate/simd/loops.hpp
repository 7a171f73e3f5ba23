// Loops of JointLoops over vectors of `Real`.
#pragma once

#include "dca/simd/abreast.hpp"
#include "dca/simd/records.hpp"
#include "dca/simd/tile.hpp"
#include "integrate/joint_lanes.hpp"

namespace catena {

/// JointScan::follow of runs side by side, one a lane: the same operations on each in the same order.
template <class Real, bool positions>
class FollowRuns {
    static constexpr int lanes = Real::lanes, part = dca::part_length;
    using Motions = MotionOf<Real>;
    using Column = dca::Column<Real>;

  public:
    explicit FollowRuns(JointScan const& s)
        : joints_(s.joints),
          whole_(s.whole),
          rotation_(tile_.in(ConstView<4>(s.rotation))),
          omega_(tile_.in(ConstView<3>(s.omega))),
          to_rotation_(tile_.out(s.rotation)),
          to_omega_(tile_.out(s.omega)) {
        if constexpr (positions) {
            translation_ = tile_.in(ConstView<3>(s.translation));
            velocity_ = tile_.in(ConstView<3>(s.velocity));
            to_translation_ = tile_.out(s.translation);
            to_velocity_ = tile_.out(s.velocity);
        }
        if (joints_.planar) normal_ = tile_.in(ConstView<3>{s.joints.axes1.origin + 3 * s.joints.axes1.pitch, s.joints.axes1.pitch, 0});
    }
    FollowRuns(FollowRuns const&) = delete;  // its views are of its own tile
    FollowRuns& operator=(FollowRuns const&) = delete;

    void follow(dca::RunsInLanes const& runs) {
        constexpr std::int64_t bodies_of_item = lanes * dca::longest_run;
        Motions m{};
        std::int64_t first[lanes];
        for (int p = 0; p < dca::parts_of_run; ++p) {
            for (int j = 0; j < lanes; ++j) first[j] = runs.body[j] + p * part;
            tile_.fill(first, bodies_of_item);
            for (Column k{0}; k.at < part; ++k.at) {
                bool const begins = p == 0 && k.at == 0;
                m = begins ? load(k) : compose<positions>(m, load(k));
                if (!begins && joints_.planar) m.omega = joints_.kept_in_plane(read(normal_, k), m.omega);
                store(k, m);
            }
            tile_.empty(first, bodies_of_item);
        }
        m.rotation = normalized(m.rotation);
        dca::scatter<Real>(m, whole_, runs.slot);
    }

  private:
    Motions load(Column k) const {
        using Vector3 = Vector<Real, 3>;
        Motions m{as_quaternion(read(rotation_, k)), read(omega_, k), Vector3::zero(), Vector3::zero()};
        if constexpr (positions) {
            m.translation = read(translation_, k);
            m.velocity = read(velocity_, k);
        }
        return m;
    }
    void store(Column k, Motions const& m) const {
        write(to_rotation_, k, as_vector(m.rotation));
        write(to_omega_, k, m.omega);
        if constexpr (positions) {
            write(to_translation_, k, m.translation);
            write(to_velocity_, k, m.velocity);
        }
    }
    JointsView joints_;
    MotionRecords whole_;
    dca::Tile<Real, part> tile_;
    ConstView<4> rotation_;
    ConstView<3> omega_, translation_, velocity_, normal_;
    View<4> to_rotation_;
    View<3> to_omega_, to_translation_, to_velocity_;
};

template <class Real, bool positions>
struct LoopsOf {
    using Bodies = dca::Abreast<Real>;
    [[gnu::flatten]] static void set_relative(JointChains const& chains, std::int64_t const* first, std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.template set_relative<positions>(Bodies{first[i]});
    }
    [[gnu::flatten]] static void follow(JointScan const& scan, dca::RunsInLanes const* runs, std::int64_t begin, std::int64_t end) {
        FollowRuns<Real, positions> lanes(scan);
        for (std::int64_t i = begin; i < end; ++i) lanes.follow(runs[i]);
    }
    [[gnu::flatten]] static void set_motion(JointChains const& chains, std::int64_t const* first, std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.template set_motion<positions>(Bodies{first[i]}, false);
    }
    [[gnu::flatten]] static void set_rates(JointChains const& chains, RatesView const& out, std::int64_t const* first, std::int64_t begin,
                                           std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) chains.set_rates(Bodies{first[i]}, out);
    }
    [[gnu::flatten]] static void runge_kutta(JointSteps const& steps, RungeKuttaStage const& stage, std::int64_t const* first,
                                             std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) steps.template runge_kutta<positions>(Bodies{first[i]}, stage);
    }
    [[gnu::flatten]] static void embedded_stage(EmbeddedSteps const& steps, EmbeddedStage const& stage, std::int64_t const* first,
                                                std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) steps.template advance<positions>(Bodies{first[i]}, stage);
    }
    static constexpr JointLoops loops() { return {set_relative, follow, set_motion, set_rates, runge_kutta, embedded_stage}; }
};

template <class Real>
JointLoops joint_loops(bool positions) {
    return positions ? LoopsOf<Real, true>::loops() : LoopsOf<Real, false>::loops();
}

}  // namespace catena
