// Runs on revolute joints side by side, one per lane, computed by articulated-body inertias
// (floating_run.hpp).
#pragma once

#include "dca/simd/revolute_loads.hpp"

namespace catena::dca {

/// Kernel for runs on revolute joints; computes what RevoluteRun does for one run.
template <class Real, class Leaf>
class RevoluteRunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes, count = static_cast<int>(longest_run);
    using Base = RunsInTile<Real, Leaf>;
    using Base::work_, Base::bodies_, Base::out_, Base::fill, Base::empty, Base::ask, Base::in_tile;
    using Vector3 = Vector<Real, 3>;
    using Kept = KeptRevolutes<Real, Leaf>;
    using Loads = LoadsInLanes<Real, Leaf>;

  public:
    explicit RevoluteRunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    /// Inward pass of the runs in the lanes of one item.
    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        auto const fetch = [this, &runs](int i) {
            if (i % part_length == 0) fill(runs, i / part_length, 1);
            ask(runs, i, 1);
        };
        if (bodies_.loads.revolutes.given) {
            climb(item, FollowedInLanes(loads(), runs, kept(item), out_.by_all_bodies(), fetch));
        } else {
            auto const body = [this, &runs, &fetch](int i) {
                fetch(i);
                Column<Real> const here{i % part_length};
                auto b = bodies_.leaf.revolute_at_rest(bodies_.loads, here);
                Vector3 const omega = loads().omega_at(here);
                loads().set_moving(runs, i, omega, b);
                bodies_.leaf.add_gyroscopic(bodies_.loads, omega, b);
                return b;
            };
            climb(item, BodiesOfRun<Real, decltype(body)>(body));
        }
    }
    /// Outward pass of the runs in the lanes of one item.
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept const kept = this->kept(item);
        Vector<Real, K> first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        Vector3 omega;
        typename Loads::PassedOn passed{next, {}, {}, Real(0)};
        // Accelerations of the first bodies of shorter runs, kept until column 0 is reached.
        BodyAcceleration<Real> of_late;
        int part = parts_of_run;
        ask(runs, 0, -1);
        descend_revolutes<Real>(
            count, out_.by_all_bodies(),
            [&](int i) {
                if (i / part_length != part) fill(runs, part = i / part_length, -1);
                Column<Real> const here{i % part_length};
                omega = !bodies_.loads.revolutes.given ? loads().omega_at(here)
                        : i == 0                       ? pick<Real>(work_.loads.omega, runs.body)
                                                       : kept.omega(i);
                auto frame = bodies_.leaf.frame_at_rest(here);
                loads().set_moving(runs, i, omega, frame);
                return frame;
            },
            kept, first, next,
            [&](int i, RevoluteFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
                Column<Real> const here{i % part_length};
                if (out_.acceleration.origin) {
                    write(out_.alpha, here, a.alpha);
                    write(out_.acceleration, here, a.a);
                }
                if (out_.joint_force) {
                    Vector<Real, K> force =
                        i == 0 ? first : loads().pass_on(runs, i, kept, omega, frame, a, passed);
                    if (runs.begins[i] != 0) choose<Real>(runs.begins[i], first, force);
                    write_directions<K>(out_.joint_force, here, force);
                }
                if (!out_.revolute_acceleration.origin) {
                    if (i > 0) return;
                    empty(runs, 0);
                    scatter_accelerations(runs.body, 0, a,
                                          [&](int j) { return (runs.late >> j & 1) != 0; });
                } else if (i == 0) {
                    begin_at(runs, frame, a);
                } else if (i == count - 1) {
                    end_at(runs, frame, a);
                }
            },
            [&](int i, BodyAcceleration<Real>& a) {
                if (runs.late == 0 || runs.begins[i] == 0) return;
                i > 0 ? choose<Real>(runs.begins[i], a, of_late)
                      : choose<Real>(runs.late, of_late, a);
            },
            [&](int i, Real const& of_revolute) {
                ask(runs, i, -1);
                joint_acceleration(runs, i, of_revolute);
            });
    }

  private:
    /// Inward pass for any supplier of bodies. In the lanes of shorter runs, it restarts where
    /// their first bodies begin.
    template <class Bodies>
    void climb(std::int64_t item, Bodies&& bodies) {
        RunsInLanes const& runs = work_.runs[item];
        FloatingRun<Real> begun;
        typename std::remove_reference_t<Bodies>::State first;
        auto const segment = climb_revolutes<Real>(
            count, bodies, [&](int i) { return loads().torque_about(i); }, kept(item),
            [&](int i, FloatingRun<Real>& run, auto& all) {
                if (runs.late == 0 || runs.begins[i] == 0) return;
                if (i == 0) {
                    begun = run;
                    first = all.state;
                } else {
                    choose<Real>(runs.begins[i], begun, run);
                    choose<Real>(runs.begins[i], first, all.state);
                }
            });
        scatter<Real>(segment.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(segment.bias, work_.sweeps.biases, runs.slot);
    }
    /// Returns the storage of an item's runs.
    Kept kept(std::int64_t item) const {
        return {work_, out_, work_.runs[item], work_.nodes + item * kept_of_revolute_run * lanes};
    }
    /// Returns the loads on the bodies in the tile.
    Loads loads() const { return {work_, bodies_, in_tile()}; }
    /// Writes the wanted results of the runs' last bodies, and begin_at() those of the first ones,
    /// in the lanes where RevoluteRun::accelerate() would write them.
    void end_at(RunsInLanes const& runs, RevoluteFrame<Real> const& frame,
                BodyAcceleration<Real> const& a) const {
        scatter(component<Real>(work_.out.revolute_acceleration, 1), runs.column, count,
                Vector<Real, 1>{{about_outboard_revolute(frame, a)}});
        scatter_accelerations(runs.column, count - 1, a, [&](int j) {
            std::int64_t const next = runs.column[j] + count;
            return next >= work_.group.size || work_.group.is_last[next];
        });
    }
    void begin_at(RunsInLanes const& runs, RevoluteFrame<Real> const& frame,
                  BodyAcceleration<Real> const& a) {
        scatter_accelerations(runs.body, 0, a,
                              [&](int j) { return work_.group.is_first[runs.body[j]] != 0; });
        Real const about = about_inboard_revolute(frame, a);
        joint_acceleration(runs, 0, about);
        if (runs.late != 0)
            scatter(component<Real>(work_.out.revolute_acceleration, 0), runs.body, 0,
                    Vector<Real, 1>{{about}});
    }
    /// Writes the accelerations of bodies body[j] + i in the lanes with wanted(j).
    template <class Wanted>
    void scatter_accelerations(std::int64_t const* body, int i, BodyAcceleration<Real> const& a,
                               Wanted const& wanted) const {
        bool stored = false;
        alignas(64) double numbers[6 * lanes];
        for (int j = 0; j < lanes; ++j) {
            if (!wanted(j)) continue;
            if (!stored) store_vectors<Real>(numbers, a);
            stored = true;
            for (int n = 0; n < 3; ++n) {
                work_.out.alpha.origin[n * work_.out.alpha.pitch + body[j] + i] =
                    numbers[n * lanes + j];
                work_.out.acceleration.origin[n * work_.out.acceleration.pitch + body[j] + i] =
                    numbers[(3 + n) * lanes + j];
            }
        }
    }
    /// Writes the joint acceleration of body i of the runs, the last result for this body. At the
    /// first body of a part, the part's results leave the tile.
    void joint_acceleration(RunsInLanes const& runs, int i, Real const& of_revolute) {
        View<2> const& to = out_.revolute_acceleration;
        if (to.origin)
            write(component<Real>(to, 0), Column<Real>{i % part_length},
                  Vector<Real, 1>{{of_revolute}});
        if (i % part_length == 0) empty(runs, i / part_length);
    }
};

}  // namespace catena::dca
