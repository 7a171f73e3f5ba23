// Access of leaves to arrays of bodies. A place is either a body's index or stands for several
// bodies side by side (simd/tile.hpp). Its scalar type follows from it, so that one source serves
// single bodies and several at once.
#pragma once

#include <type_traits>

#include "dca/solver.hpp"
#include "math/rotation.hpp"

namespace catena::dca {

/// Scalar type of the values at a place: double for one body, a vector for several.
template <class Place>
struct RealOf {
    using type = typename Place::Real;
};
template <>
struct RealOf<std::int64_t> {
    using type = double;
};
template <class Place>
using RealAt = typename RealOf<Place>::type;
template <class Place>
using Vec3At = Vector<RealAt<Place>, 3>;
template <class Place>
using Mat3At = Matrix<RealAt<Place>, 3, 3>;
template <class Place>
using QuatAt = Quaternion<RealAt<Place>>;
/// True if the place is the index of one body.
template <class Place>
inline constexpr bool is_one_body = std::is_same_v<Place, std::int64_t>;
/// A place that stands for several bodies side by side.
template <class Place>
concept SeveralBodies = requires { typename Place::Real; };

/// Returns body k's numbers of a field.
template <class T, int D>
CATENA_HD Vector<double, D> read(FieldView<T, D> const& view, std::int64_t k) {
    return view.load(k);
}
template <class T, int D>
CATENA_HD double read(FieldView<T, D> const& view, std::int64_t k, int component) {
    return view.at(k, component);
}
/// Default reader of a leaf's data: reads each field from its array. Other readers may have the
/// data elsewhere.
///
/// if_any() returns zero for a field without array. once_if_any() is for fields that the
/// accelerations do not need where the body's `Turning` is stored (body_leaf.hpp).
struct ReadHere {
    template <class T, int D, class Place>
    CATENA_HD Vector<RealAt<Place>, D> operator()(FieldView<T, D> const& view, Place k) const {
        return read(view, k);
    }
    template <class T, int D, class Place>
    CATENA_HD Vector<RealAt<Place>, D> if_any(FieldView<T, D> const& view, Place k) const {
        return view.origin ? read(view, k) : Vector<RealAt<Place>, D>::zero();
    }
    template <class T, int D, class Place>
    CATENA_HD Vector<RealAt<Place>, D> once_if_any(FieldView<T, D> const& view, Place k) const {
        return if_any(view, k);
    }
};
/// Reader for a body whose `Turning` is stored and which is read a second time, for its
/// accelerations.
struct ReadFirst : ReadHere {
    template <class T, int D>
    CATENA_HD Vector<double, D> once_if_any(FieldView<T, D> const& view, std::int64_t k) const {
        return view.origin ? view.load_last(k) : Vector<double, D>::zero();
    }
};
/// Reader for that second time, and for a body that is not read again.
struct ReadLast {
    template <class T, int D>
    CATENA_HD Vector<double, D> operator()(FieldView<T, D> const& view, std::int64_t k) const {
        return view.load_last(k);
    }
    template <class T, int D>
    CATENA_HD Vector<double, D> if_any(FieldView<T, D> const& view, std::int64_t k) const {
        return view.origin ? view.load_last(k) : Vector<double, D>::zero();
    }
    template <class T, int D>
    CATENA_HD Vector<double, D> once_if_any(FieldView<T, D> const&, std::int64_t) const {
        return Vector<double, D>::zero();
    }
};
/// Writes body k's numbers of a field.
template <int D>
CATENA_HD void write(View<D> const& view, std::int64_t k, Vector<double, D> const& value) {
    view.store(k, value);
}
template <int K>
CATENA_HD Vector<double, K> read_directions(ConstDirectionsView const& view, std::int64_t k) {
    return view.load<K>(k);
}
template <int K>
CATENA_HD void write_directions(DirectionsView const& view, std::int64_t k,
                                Vector<double, K> const& value) {
    view.store<K>(k, value);
}

// Position of a body in its chain. The overloads for bodies side by side (simd/tile.hpp) assume
// that every body has both neighbours.
CATENA_HD bool ends_chain(GroupView const& group, std::int64_t k) { return group.is_last[k]; }
CATENA_HD bool begins_chain(GroupView const& group, std::int64_t k) { return group.is_first[k]; }
/// True if a body that forms a run of its own, or may do so, follows a run's last body k: one of
/// another rank, or a chain's last body.
CATENA_HD bool comes_before_one(GroupView const& group, std::int64_t k) {
    return k + 1 >= group.size || group.is_last[k + 1];
}
CATENA_HD bool has_jointed_tip(GroupView const& group, std::int64_t k) {
    return group.has_jointed_tip(k);
}
CATENA_HD Vector<double, 4> outboard_screw(GroupView const& group, std::int64_t k) {
    return group.outboard_screw(k);
}

}  // namespace catena::dca
