// Implementation of KinematicLoops for vectors of type `Real`, compiled for one instruction set by
// each source that includes it.
#pragma once

#include "dca/simd/abreast.hpp"
#include "dca/simd/records.hpp"
#include "dca/simd/tile.hpp"
#include "dynamics/joint/joint_lanes.hpp"

namespace catena {

/// JointScan::follow for runs side by side, one per lane. Each lane performs the same operations in
/// the same order as the scalar code.
template <class Real, bool positions>
class FollowRuns {
    static constexpr int lanes = Real::lanes, part = dca::part_length;
    using Motions = MotionOf<Real>;
    using Column = dca::Column<Real>;

  public:
    FollowRuns(JointScan const& s, bool prefetches)
        : joints_(s.joints),
          whole_(s.whole),
          asks_ahead_(prefetches),
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
        if (joints_.planar)
            normal_ = tile_.in(ConstView<3>{s.joints.axes1.origin + 3 * s.joints.axes1.pitch,
                                            s.joints.axes1.pitch, 0});
    }
    /// Copies are deleted because the views refer to the object's own tile.
    FollowRuns(FollowRuns const&) = delete;
    FollowRuns& operator=(FollowRuns const&) = delete;

    /// Composes the motions along one group of runs and stores the motion across each.
    void follow(dca::RunsInLanes const& runs) {
        Motions m{};
        for (int p = 0; p < dca::parts_of_run; ++p) {
            dca::PartInLanes<Real> const bodies(runs, p);
            tile_.fill(bodies);
            for (Column k{0}; k.at < part; ++k.at) {
                // Prefetched for reading; the lines are written later.
                if (asks_ahead_)
                    tile_.ask_to_read(runs.body, lanes * dca::longest_run, p * part + k.at);
                unsigned const begin = runs.begins[p * part + k.at];
                Motions const own = load(k);
                if (p == 0 && k.at == 0) {
                    m = own;
                } else {
                    m = compose<positions>(m, own);
                    if (joints_.planar) m.omega = joints_.kept_in_plane(read(normal_, k), m.omega);
                    if (begin != 0) dca::choose<Real>(begin, own, m);
                }
                store(k, m);
            }
            tile_.empty(bodies);
        }
        m.rotation = normalized(m.rotation);
        dca::scatter<Real>(m, whole_, runs.slot);
    }

  private:
    /// Relative motions of one column of bodies.
    Motions load(Column k) const {
        using Vector3 = Vector<Real, 3>;
        Motions m{as_quaternion(read(rotation_, k)), read(omega_, k), Vector3::zero(),
                  Vector3::zero()};
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
    bool asks_ahead_;
    dca::Tile<Real, part> tile_;
    ConstView<4> rotation_;
    ConstView<3> omega_, translation_, velocity_, normal_;
    View<4> to_rotation_;
    View<3> to_omega_, to_translation_, to_velocity_;
};

/// Counterpart of FollowRuns for runs on revolute joints, without positions. It computes the
/// joints' motions from their coordinates, and their rotations and torques.
template <class Real>
class FollowRevolutes {
    static constexpr int lanes = Real::lanes, part = dca::part_length;
    using Motions = MotionOf<Real>;
    using Column = dca::Column<Real>;
    using Vector3 = Vector<Real, 3>;

  public:
    FollowRevolutes(JointLoads const& loads, double const* constants, bool prefetches)
        : scan_(loads.moved.scan),
          constants_(constants),
          asks_ahead_(prefetches),
          q_(coordinate(scan_.state.q)),
          qd_(coordinate(scan_.state.qd)),
          turn_(tile_.out(scan_.motion.joint_turn)) {
        BodyLoadsView const& given = loads.given;
        if (!given.joint_loads) return;
        load_ = {loads.joint_load.origin + RevoluteLoads::about_revolute * loads.joint_load.pitch,
                 loads.joint_load.pitch, 0};
        torque_ = coordinate(given.torque);
        if (given.springs) stiffness_ = coordinate(given.stiffness), rest_ = coordinate(given.rest);
        if (given.dampers) damping_ = coordinate(given.damping);
        to_load_ = tile_.out(load_);
    }
    FollowRevolutes(FollowRevolutes const&) = delete;
    FollowRevolutes& operator=(FollowRevolutes const&) = delete;

    /// Processes group `item` of runs.
    void follow(dca::RunsInLanes const* items, std::int64_t item) {
        constexpr int of_body = revolute_constants * lanes, block = part * of_body;
        dca::RunsInLanes const& runs = items[item];
        Motions m{};
        for (int p = 0; p < dca::parts_of_run; ++p) {
            dca::PartInLanes<Real> const bodies(runs, p);
            tile_.fill(bodies);
            double const* const here = constants_ + (item * dca::parts_of_run + p) * block;
            dca::Constants<Real> constants{here};
            auto const axis = constants.template next<3>();
            auto const frame = constants.template next<4>();
            for (Column k{0}; k.at < part; ++k.at) {
                if (asks_ahead_) {
                    tile_.ask(runs.body, lanes * dca::longest_run, p * part + k.at);
                    dca::prefetch<Real>(here + k.at * of_body, 2 * block, of_body);
                }
                Vector3 const along = read(axis, k);
                Vector<Real, 1> const q = read(q_, k), qd = read(qd_, k);
                Of of{from_axis_angle(along, q[0]),
                      {},
                      to_load_.origin ? torque(k, q, qd) : Vector<Real, 1>{{Real(0)}}};
                of.motion = {as_quaternion(read(frame, k)) * of.rotation, qd[0] * along,
                             Vector3::zero(), Vector3::zero()};
                unsigned const begin = runs.begins[p * part + k.at];
                if (begin != 0) take_known(runs, begin, of);
                if (p == 0 && k.at == 0) {
                    m = of.motion;
                    dca::scatter(scan_.rotation, runs.body, 0, as_vector(m.rotation));
                    dca::scatter(scan_.omega, runs.body, 0, m.omega);
                } else {
                    m = compose<false>(m, of.motion);
                    if (begin != 0) dca::choose<Real>(begin, of.motion, m);
                }
                write(turn_, k, as_vector(of.rotation));
                if (to_load_.origin) write(to_load_, k, of.torque);
            }
            tile_.empty(bodies);
        }
        m.rotation = normalized(m.rotation);
        dca::scatter<Real>(m, scan_.whole, runs.slot);
    }

  private:
    /// Rotation, motion and torque of the joints of one column.
    struct Of {
        Quaternion<Real> rotation;
        Motions motion;
        Vector<Real, 1> torque;
    };
    /// View of component 0 of a field, in the tile.
    template <class T, int D>
    ConstView<1> coordinate(FieldView<T, D> const& view) {
        return tile_.in(ConstView<1>{view.origin, view.pitch, 0});
    }
    /// Torque about the axes, as JointLoads::set_joint_load computes it.
    Vector<Real, 1> torque(Column k, Vector<Real, 1> const& q, Vector<Real, 1> const& qd) const {
        Real along = read(torque_, k)[0];
        if (stiffness_.origin)
            along =
                terms::JointSpring::plus(along, read(stiffness_, k)[0], q[0], read(rest_, k)[0]);
        if (damping_.origin) along = terms::JointDamper::plus(along, read(damping_, k)[0], qd[0]);
        return {{along}};
    }
    /// Replaces the values in lanes `begin` whose run begins a chain by the stored ones, since a
    /// chain's first body may have any joint.
    void take_known(dca::RunsInLanes const& runs, unsigned begin, Of& of) {
        constexpr int numbers = static_cast<int>(sizeof(Of) / sizeof(Real)), of_turn = 4;
        alignas(64) double all[numbers * lanes];
        bool known = false;
        for (int j = 0; j < lanes; ++j) {
            std::int64_t const k = runs.body[j];
            if ((begin >> j & 1U) == 0 || !scan_.joints.is_first[k]) continue;
            if (!known) dca::store_vectors<Real>(all, of);
            known = true;
            auto const take = [&all, j, k](int at, auto const& view, int count) {
                for (int i = 0; i < count; ++i)
                    all[(at + i) * lanes + j] = view.origin[i * view.pitch + k];
            };
            take(0, scan_.motion.joint_turn, of_turn);
            take(of_turn, scan_.rotation, first_of_omega);
            take(of_turn + first_of_omega, scan_.omega, 3);
            if (to_load_.origin) take(numbers - 1, load_, 1);
        }
        if (known) dca::load_vectors<Real>(all, of);
    }
    JointScan const& scan_;
    double const* constants_;
    bool asks_ahead_;
    dca::Tile<Real, part> tile_;
    ConstView<1> q_, qd_, torque_, stiffness_, rest_, damping_;
    View<4> turn_;
    View<1> load_, to_load_;
};
/// JointScan::set_motion for the first bodies of runs.
template <class Real>
void begin_runs(JointScan const& s, dca::RunsInLanes const& runs) {
    std::int64_t at[Real::lanes];
    for (int j = 0; j < Real::lanes; ++j) at[j] = runs.slot[j] * MotionRecords::numbers;
    MotionOf<Real> first{};
    first.rotation = as_quaternion(dca::pick<Real>(ConstView<4>(s.rotation), runs.body));
    first.omega = dca::pick<Real>(ConstView<3>(s.omega), runs.body);
    auto const omega_before =
        dca::pick<Real>(ConstView<3>{s.before.origin + first_of_omega, 1, 0}, at);
    dca::scatter(s.motion.omega, runs.body, 0, compose(omega_before, first));
    /// Orientations are requested for chains' first bodies only, which other code sets.
    if (s.motion.orients_first_alone) return;
    auto const before = as_quaternion(dca::pick<Real>(ConstView<4>{s.before.origin, 1, 0}, at));
    dca::scatter(s.motion.orientation, runs.body, 0,
                 as_vector(normalized(before * first.rotation)));
}

/// KinematicLoops::follow_revolutes for one vector type.
template <class Real>
[[gnu::flatten]] void follow_revolutes(JointLoads const& loads, RunsAbreast const& runs,
                                       double const* constants, std::int64_t begin,
                                       std::int64_t end) {
    FollowRevolutes<Real> lanes(loads, constants, runs.prefetches);
    for (std::int64_t i = begin; i < end; ++i) lanes.follow(runs.items, i);
}
/// KinematicLoops::begin_runs for one vector type.
template <class Real>
[[gnu::flatten]] void begin_all_runs(JointScan const& scan, RunsAbreast const& runs,
                                     std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) begin_runs<Real>(scan, runs.items[i]);
}

/// The other loops for one vector type, with or without positions.
template <class Real, bool positions>
struct KinematicLoopsOf {
    using Bodies = dca::Abreast<Real>;
    [[gnu::flatten]] static void set_relative(JointChains const& chains, BodyLanes const& bodies,
                                              std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i)
            chains.template set_relative<positions>(Bodies{bodies.first[i], bodies.prefetches});
    }
    [[gnu::flatten]] static void follow(JointScan const& scan, RunsAbreast const& runs,
                                        std::int64_t begin, std::int64_t end) {
        FollowRuns<Real, positions> lanes(scan, runs.prefetches);
        for (std::int64_t i = begin; i < end; ++i) lanes.follow(runs.items[i]);
    }
    [[gnu::flatten]] static void set_motion(JointChains const& chains, BodyLanes const& bodies,
                                            std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i)
            chains.template set_motion<positions>(Bodies{bodies.first[i], bodies.prefetches},
                                                  false);
    }
    static constexpr KinematicLoops table() {
        return {set_relative, follow, follow_revolutes<Real>, begin_all_runs<Real>, set_motion};
    }
};

/// Table of loops with or without positions.
template <class Real>
KinematicLoops kinematic_loops(bool positions) {
    return positions ? KinematicLoopsOf<Real, true>::table()
                     : KinematicLoopsOf<Real, false>::table();
}

}  // namespace catena
