// How the tree solver reads one body from the arrays: its matrices, its bias, and its acceleration once the joint forces are known.
#pragma once

#include "dca/leaf.hpp"
#include "dca/solver.hpp"

namespace catena::dca {

template <int D>
CATENA_HD Vector<double, D> load_or_zero(ConstView<D> const& view, std::int64_t k) {
    return view.origin ? view.load(k) : Vector<double, D>::zero();
}

/// Point beads; K = 1 projected, 3 full.
template <int K_>
class BeadLeaf {
  public:
    static constexpr int K = K_;
    explicit BeadLeaf(ChainGroup const& group) : group_(&group) {}
    void set(ConfigurationView const& c) { direction_ = c.direction; }

    SegmentMatrix<double, K> matrix(std::int64_t k) const {
        return bead_matrix(group_->inverse_mass.view().at(k, 0), direction_.load(k), outboard(k), Vector<double, K>{});
    }
    SegmentBias<double, K> bias(LoadsView const& loads, std::int64_t k) const {
        SegmentBias<double, K> b{Vector<double, K>::zero(), Vector<double, K>::zero()};
        if (loads.force.origin) {
            Vec3 const a = group_->inverse_mass.view().at(k, 0) * loads.force.load(k);
            b = {along_link(direction_.load(k), a, Vector<double, K>{}), along_link(outboard(k), a, Vector<double, K>{})};
        }
        if (loads.bias) b.b1 = b.b1 + loads.bias.load<K>(k);
        return b;
    }
    void accelerate(LoadsView const& loads, std::int64_t k, Vector<double, K> const& inboard_force, Vector<double, K> const& outboard_force,
                    AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        Vec3 const f =
            plus_scaled(plus_scaled(load_or_zero(loads.force, k), inboard_force[0], direction_.load(k)), -outboard_force[0], outboard(k));
        out.acceleration.store(k, group_->inverse_mass.view().at(k, 0) * f);
    }

  private:
    Vec3 outboard(std::int64_t k) const { return group_->is_last[static_cast<std::size_t>(k)] ? Vec3::zero() : direction_.load(k + 1); }
    ChainGroup const* group_;
    ConstView<3> direction_;
};

/// Rigid bodies; K = 3 spherical, 5 revolute and mixed, 6 full.
template <int K_, Axes axes>
class BodyLeaf {
  public:
    static constexpr int K = K_;
    explicit BodyLeaf(ChainGroup const& group)
        : inverse_mass_(group.inverse_mass.view()),
          inverse_inertia_(group.inverse_inertia.view()),
          r1_(group.r1.view()),
          r2_(group.r2.view()),
          axes1_(group.axes1.view()),
          axes2_(group.axes2.view()) {}
    void set(ConfigurationView const& c) { rotation_ = c.rotation; }

    SegmentMatrix<double, K> matrix(std::int64_t k) const {
        Handles const h = handles(k);
        return leaf_matrix(inverse_mass_.at(k, 0), inverse_inertia(k), h.h1, h.h2);
    }
    SegmentBias<double, K> bias(LoadsView const& loads, std::int64_t k) const {
        Handles const h = handles(k);
        Vec3 a1 = inverse_mass_.at(k, 0) * load_or_zero(loads.force, k), a2 = a1;
        Vec3 const alpha = loads.torque.origin ? inverse_inertia(k) * loads.torque.load(k) : Vec3::zero();
        if (loads.omega.origin) {
            Vec3 const w = loads.omega.load(k);
            a1 = a1 + h.to_force_axes * cross(w, cross(w, r1_.load(k)));
            a2 = a2 + h.to_force_axes * cross(w, cross(w, r2_.load(k)));
        }
        SegmentBias<double, K> b{along(h.h1, alpha, a1), along(h.h2, alpha, a2)};
        if (loads.bias) b.b1 = b.b1 + loads.bias.load<K>(k);
        return b;
    }
    void accelerate(LoadsView const& loads, std::int64_t k, Vector<double, K> const& inboard_force, Vector<double, K> const& outboard_force,
                    AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        Handles const h = handles(k);
        Vec3 const torque = load_or_zero(loads.torque, k) + (h.h1.torque * inboard_force - h.h2.torque * outboard_force);
        Vec3 const force = load_or_zero(loads.force, k) + (h.h1.force * inboard_force - h.h2.force * outboard_force);
        out.alpha.store(k, inverse_inertia(k) * torque);
        out.acceleration.store(k, inverse_mass_.at(k, 0) * force);
    }

  private:
    struct Handles {
        Handle<double, K> h1, h2;
        Mat3 to_force_axes;  // from B to the axes of forces
    };
    Symmetric<double, 3> inverse_inertia(std::int64_t k) const {
        Vector<double, 6> const v = inverse_inertia_.load(k);
        return {{v[0], v[1], v[2], v[3], v[4], v[5]}};
    }
    static Mat3 matrix_of(Vector<double, 9> const& v) { return {{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]}}; }
    Handles handles(std::int64_t k) const {
        Vector<double, 4> const q = rotation_.load(k);
        Mat3 const turn = to_matrix(Quat{q[0], q[1], q[2], q[3]});
        Vec3 const r1 = r1_.load(k), r2 = r2_.load(k);
        if constexpr (axes == Axes::world) {
            Mat3 const to_body = transpose(turn), unit = Mat3::identity();
            return {make_handle<K>(r1, to_body, unit), make_handle<K>(r2, to_body, unit), turn};
        } else {
            Mat3 const e1 = transposed_times(turn, matrix_of(axes1_.load(k))), e2 = matrix_of(axes2_.load(k));
            return {make_handle<K>(r1, e1, e1), make_handle<K>(r2, e2, e2), Mat3::identity()};
        }
    }

    ConstView<1> inverse_mass_;
    ConstView<6> inverse_inertia_;
    ConstView<3> r1_, r2_;
    ConstView<9> axes1_, axes2_;
    ConstView<4> rotation_;
};

}  // namespace catena::dca
