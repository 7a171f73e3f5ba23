// Directions of a joint's handles, in the order in which handles carry them. Those that the joint
// restricts come first.
//
// Usually directions 0-2 are forces along the joint's axes and 3-5 torques about them. The axis of
// a joint with one axis is the last one, so that a revolute joint leaves direction 5 free. A screw
// combines the force and the torque along that axis. Joints that leave other directions free have
// an order of their own (JointDefaults::order).
#pragma once

#include <type_traits>

#include "joints/joint_models.hpp"
#include "math/linear.hpp"

namespace catena::dca {

/// A joint that translates and rotates along its axis a: the free motion is (angular c a, linear s
/// a) with c^2 + s^2 = 1. In the usual order, direction 2 is the restricted one, (angular -s a,
/// linear c a), and direction 5 the free one.
/// Revolute: c = 1, s = 0. Prismatic: c = 0, s = 1. Helical with pitch h: (1, h) / sqrt(1 + h^2).
/// Other joints have c = 1, s = 0; `order` is JointDefaults::order.
template <class Real>
struct Screw {
    Real c, s;
    Real order = Real(usual_order);
};
/// Returns the screw of LocalJoints::screw.
template <class Real>
CATENA_HD Screw<Real> as_screw(Vector<Real, 4> const& numbers) {
    return {numbers[0], numbers[1], numbers[3]};
}

/// Linear and angular part of a motion or a wrench along a joint's axes.
template <class Real>
struct AlongAxes {
    Vector<Real, 3> linear, angular;
};

/// True if some joint has an order of its own.
template <class Real>
CATENA_HD bool any_ordered(Real const& order) {
    if constexpr (std::is_floating_point_v<Real>)
        return order > 0;
    else
        return any_above(order, 0.0);
}
/// Returns `yes` where the order is `code`, and `no` elsewhere.
template <class Real>
CATENA_HD Real where_ordered(Real const& order, int code, Real const& yes, Real const& no) {
    if constexpr (std::is_floating_point_v<Real>)
        return order == code ? yes : no;
    else
        return where_less(order, Real(code + 0.5), where_less(Real(code - 0.5), order, yes, no),
                          no);
}

/// Calls move(code, place, direction) for every place of every order that has another direction
/// there than usual.
template <int places, class Move>
CATENA_HD void for_each_moved(Move const& move) {
    joints::for_each_ordered(
        [&move](auto model) {
            constexpr int code = decltype(model)::order;
            CATENA_UNROLL
            for (int place = 0; place < places; ++place)
                if (direction_at(code, place) != place)
                    move(code, place, direction_at(code, place));
        },
        JointModels{});
}
/// Puts columns 0 .. K-1 of a matrix, which have the usual order, into the joint's order.
template <class Real, int R, int K>
CATENA_HD void put_in_order(Real const& order, Matrix<Real, R, K>& columns) {
    if (!any_ordered(order)) return;
    Matrix<Real, R, K> const usual = columns;
    for_each_moved<K>([&](int code, int place, int direction) {
        for (int i = 0; i < R; ++i)
            columns(i, place) = where_ordered(order, code, usual(i, direction), columns(i, place));
    });
}

/// Returns the components along a joint's directions.
template <class Real>
CATENA_HD Vector<Real, 6> along_directions(Screw<Real> const& s, AlongAxes<Real> const& pair) {
    auto const &linear = pair.linear, &angular = pair.angular;
    Vector<Real, 6> d{{linear[0], linear[1], s.c * linear[2] - s.s * angular[2], angular[0],
                       angular[1], s.s * linear[2] + s.c * angular[2]}};
    if (!any_ordered(s.order)) return d;
    Vector<Real, 6> const usual = d;
    for_each_moved<6>([&](int code, int place, int direction) {
        d[place] = where_ordered(s.order, code, usual[direction], d[place]);
    });
    return d;
}
/// Returns the pair along a joint's axes from its components along the joint's directions; the
/// inverse of along_directions().
template <class Real>
CATENA_HD AlongAxes<Real> along_axes(Screw<Real> const& s, Vector<Real, 6> const& components) {
    Vector<Real, 6> d = components;
    if (any_ordered(s.order))
        for_each_moved<6>([&](int code, int place, int direction) {
            d[direction] = where_ordered(s.order, code, components[place], d[direction]);
        });
    return {{{d[0], d[1], s.c * d[2] + s.s * d[5]}}, {{d[3], d[4], s.c * d[5] - s.s * d[2]}}};
}

}  // namespace catena::dca
