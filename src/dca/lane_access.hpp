// How leaves read and write arrays of bodies. A place is a body's index, or what stands for several
// bodies side by side (simd/tile.hpp); its scalar type follows from it, and the same source serves
// one body and several.
#pragma once

#include <type_traits>

#include "dca/solver.hpp"
#include "math/rotation.hpp"

namespace catena::dca {

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
/// Whether it stands for one body.
template <class Place>
inline constexpr bool is_one_body = std::is_same_v<Place, std::int64_t>;
template <class Place>
concept SeveralBodies = requires { typename Place::Real; };

template <class T, int D>
CATENA_HD Vector<double, D> read(FieldView<T, D> const& view, std::int64_t k) {
    return view.load(k);
}
template <class T, int D>
CATENA_HD double read(FieldView<T, D> const& view, std::int64_t k, int component) {
    return view.at(k, component);
}
/// What leaves read a body's numbers by: each field in turn, of which some may be nowhere, and some
/// are wanted once: accelerations do without them where the turning is known (body_leaf.hpp).
/// Another reader may have them elsewhere.
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
/// Of a body whose turning is kept, and which is read once more, for its accelerations.
struct ReadFirst : ReadHere {
    template <class T, int D>
    CATENA_HD Vector<double, D> once_if_any(FieldView<T, D> const& view, std::int64_t k) const {
        return view.origin ? view.load_last(k) : Vector<double, D>::zero();
    }
};
/// Then; and of one that is not read again.
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

// Bodies side by side whose neighbours are read have both.
CATENA_HD bool ends_chain(GroupView const& group, std::int64_t k) { return group.is_last[k]; }
CATENA_HD bool begins_chain(GroupView const& group, std::int64_t k) { return group.is_first[k]; }
/// Whether a run's last body comes before one that makes a run by itself, or may: the body after it
/// is another rank's, or the next chain.
CATENA_HD bool comes_before_one(GroupView const& group, std::int64_t k) {
    return k + 1 >= group.size || group.is_last[k + 1];
}
CATENA_HD bool has_jointed_tip(GroupView const& group, std::int64_t k) {
    return group.has_jointed_tip(k);
}
CATENA_HD Vec3 outboard_screw(GroupView const& group, std::int64_t k) {
    return group.outboard_screw(k);
}

}  // namespace catena::dca
