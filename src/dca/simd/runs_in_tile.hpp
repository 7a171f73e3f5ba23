// Runs side by side whose bodies are in a tile: the base of all kernels.
#pragma once

#include <utility>

#include "dca/fused_sweep.hpp"
#include "dca/simd/records.hpp"
#include "dca/simd/runs.hpp"
#include "dca/simd/tile.hpp"

namespace catena::dca {

/// Data of bodies side by side for the leaves: constants are stored in the order of lanes
/// (RunWork::constants), other data are in a tile.
template <class Real, class Leaf>
class BodiesInTile {
    static constexpr int K = Leaf::K;

  public:
    // Registers the views of `work` with the tile.
    template <class Tile>
    BodiesInTile(Tile& tile, RunWork<Leaf> const& work) {
        if constexpr (Leaf::beads) {
            loads_.force = tile.in(work.loads.force);
            group_.inverse_mass = tile.in(work.group.inverse_mass);
            at_.position = tile.in(work.configuration.position, true);
            loads_.velocity = tile.in(work.loads.velocity, true);
        } else {
            using Frames = typename Leaf::Frames;
            rotation = at_.rotation = tile.in(work.configuration.rotation);
            at_.r2 = tile.in(work.configuration.r2);
            if constexpr (Frames::in_joints) at_.axes2 = tile.in(work.configuration.axes2);
            if constexpr (Frames::on_links)
                at_.direction = tile.in(work.configuration.direction, true);
            if constexpr (Frames::any_forces) group_.screw = tile.in(work.group.screw, true);
            loads_.revolutes.given = work.loads.revolutes.given;
            loads_.gyroscopic = work.loads.gyroscopic || loads_.revolutes.given;
            loads_.revolute_rate = tile.in(work.loads.revolute_rate);
            if (!loads_.revolute_rate.origin)
                loads_.bias = tile.template in_directions<K>(work.loads.bias);
            if (!loads_.revolutes.given) {
                loads_.omega = tile.in(work.loads.omega);
                loads_.torque = tile.in(work.loads.torque);
                loads_.force = tile.in(work.loads.force);
                return;
            }
            on_way_back = tile.count();
            RevoluteLoads const& from = work.loads.revolutes;
            if (from.joint_torque.origin) {
                ConstView<3> const& all = from.joint_torque;
                revolute_torque = tile.in(ConstView<1>{
                    all.origin + RevoluteLoads::about_revolute * all.pitch, all.pitch, 0});
            }
            loads_.revolutes.torque = tile.in(from.torque);
            loads_.revolutes.force = tile.in(from.force);
        }
    }
    ConstView<4> rotation{};
    // Torques of revolute joints, if joint loads are given (RevoluteLoads).
    ConstView<1> revolute_torque{};
    // Number of doubles per body that the outward pass needs; they are the first ones of the tile.
    int on_way_back = 0;

    /// Returns the leaf of one part with its constants.
    auto with(Constants<Real> constants) const {
        GroupView group = group_;
        each_constant<Leaf>(group, [&constants]<int D>(ConstView<D>& view) {
            view = constants.template next<D>();
        });
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

/// Records pivot failures of the joints number[j] + further whose bit j of `bad` is set.
template <class Real, class Leaf>
void note_lost(TreeSweeps<Leaf> const& sweeps, std::int64_t const* number, int further,
               unsigned bad) {
    for (int j = 0; bad != 0 && j < Real::lanes; ++j)
        if ((bad >> j & 1U) != 0)
            sweeps.note({static_cast<unsigned long long>(number[j] + further)});
}

/// Base of the kernels: reads runs side by side into a tile part by part and writes the results
/// back.
template <class Real, class Leaf>
class RunsInTile {
    // Most neighbours of beads are in the same run, so that whole runs are read at once.
    static constexpr bool by_runs = Leaf::beads;
    static_assert(!by_runs || constants_of<Leaf> == 0);
    static constexpr int lanes = Real::lanes;
    static constexpr std::int64_t bodies_of_item = lanes * longest_run;

  protected:
    using Bodies = decltype(std::declval<BodiesInTile<Real, Leaf>>().with(Constants<Real>{}));

    explicit RunsInTile(RunWork<Leaf> const& work)
        : work_(work), in_tile_(tile_, work), bodies_(in_tile_.with({work.constants})) {
        if (View<2> const& of_revolutes = work.out.revolute_acceleration; of_revolutes.origin) {
            View<1> const first = tile_.out(component<Real>(of_revolutes, 0));
            // The other component is written directly to its field.
            out_.revolute_acceleration = {first.origin, first.pitch, first.size};
        } else {
            out_.acceleration = tile_.out(work.out.acceleration);
            out_.alpha = tile_.out(work.out.alpha);
        }
        out_.joint_force = tile_.template out_directions<Leaf::K>(work.out.joint_force);
    }
    /// Reads part p of the runs. `way`: 1 in the inward pass (from the first part to the last), -1
    /// in the outward pass.
    void fill(RunsInLanes const& runs, int p, int way) {
        begin_ = {by_runs ? p * part_length : 0};
        if (!by_runs)
            tile_.fill(PartInLanes<Real>(runs, p), count(way));
        else if (p == (way > 0 ? 0 : parts_of_run - 1))
            tile_.fill(runs.body);
        if constexpr (constants_of<Leaf> > 0) {
            double const* const here = constants(runs, p);
            bodies_ = in_tile_.with({here});
            if constexpr (frame_constants<Leaf> > 0)
                bodies_.loads.revolutes.frame =
                    Constants<Real>{
                        here + (constants_of<Leaf> - frame_constants<Leaf>)*part_length * lanes}
                        .template next<4>();
        }
    }
    /// Writes the results of part p.
    void empty(RunsInLanes const& runs, int p) {
        if (!by_runs)
            tile_.empty(PartInLanes<Real>(runs, p));
        else if (p == 0)
            tile_.empty(runs.body);
    }
    /// Prefetches with body i, which is called for every body in order. The bodies of the next item
    /// usually follow; in the outward pass they come before.
    [[gnu::always_inline]] void ask(RunsInLanes const& runs, int i, int way) const {
        if (!work_.prefetches) return;
        // A whole run is read at once when the next item begins, so that prefetches shortly before
        // would come too late.
        std::int64_t const ahead = (by_runs ? 2 : 1) * way * bodies_of_item;
        tile_.ask_to_read(runs.body, ahead, i, count(way));
        if (way < 0) tile_.ask_to_write(runs.body, ahead, i);
        if constexpr (constants_of<Leaf> > 0) {
            // The constants are prefetched two parts ahead. In the outward pass, a run on revolute
            // joints may need only those of its end parts.
            bool const of_ends = Leaf::by_inertia && way < 0 && !out_.by_all_bodies();
            if (of_ends && (i < part_length || i >= longest_run - part_length)) return;
            constexpr int of_body = constants_of<Leaf> * lanes,
                          two_parts = 2 * part_length * of_body;
            prefetch<Real>(constants(runs, 0) + i * of_body, way * two_parts, of_body);
        }
    }

    BodiesInTile<Real, Leaf> const& in_tile() const { return in_tile_; }

    RunWork<Leaf> const& work_;

  private:
    /// Returns the constants of part p of the runs.
    double const* constants(RunsInLanes const& runs, int p) const {
        return work_.constants + ((&runs - work_.runs) * parts_of_run + p) *
                                     (constants_of<Leaf> * part_length * lanes);
    }
    /// Returns the number of doubles per body that the pass in direction `way` reads.
    int count(int way) const {
        return way < 0 && in_tile_.on_way_back > 0 && !out_.joint_force ? in_tile_.on_way_back
                                                                        : tile_.count();
    }
    // Whole runs of beads, otherwise single parts.
    Tile<Real, by_runs ? longest_run : part_length> tile_;
    BodiesInTile<Real, Leaf> in_tile_;

  protected:
    Bodies bodies_;
    Column<Real> begin_;  // First column of the current part.
    AccelerationsView out_{};
};

}  // namespace catena::dca
