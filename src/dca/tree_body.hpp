// One body of a branched chain with everything outboard of it, held at the inboard side of its
// inboard joint, on the host.
#pragma once

#include "dca/leaf.hpp"

namespace catena::dca {

/// Free direction of a joint: its row of the inertia before its release, and the diagonal entry.
struct FreeDirection {
    Vector<double, 6> row;
    double own;
};
/// Releases direction i of an inertia: no force acts along it from here on.
inline FreeDirection released(int i, Symmetric<double, 6>& inertia) {
    FreeDirection r{{}, inertia(i, i)};
    for (int j = 0; j < 6; ++j) r.row[j] = inertia(i, j);
    for (int j = 0; j < 6; ++j) {
        double const share = r.row[j] / r.own;
        for (int k = j; k < 6; ++k)
            inertia(k, j) = j == i || k == i ? 0.0 : less_product(r.row[k], share, inertia(k, j));
    }
    return r;
}

/// A body with everything outboard of it, along the six directions of its inboard joint. f1 is the
/// joint's force on the body and a the acceleration of the joint's inboard side:
///   f1 = inertia a + force,
/// for the restricted directions; the acceleration along free ones follows from f1 = 0.
template <bool sliding>
struct TreeBody {
    using HandleOf = Handle<double, 6, sliding>;
    /// Angular acceleration, and linear acceleration of the centre of mass, per unit acceleration
    /// along each direction; B.
    Matrix<double, 3, 6> turning, shifting;
    /// Handle of the body, and of its inboard body, at the joint.
    HandleOf handle, seat;
    /// Acceleration of the seat per unit acceleration of the inboard body along its own directions.
    Matrix<double, 6, 6> carry;
    /// Inertia with the joint held, and with its free directions released.
    Symmetric<double, 6> held, inertia;
    FreeDirection direction[6];
    /// Velocity terms: those of joint and handle, and those of the seat.
    Vector<double, 6> closure, of_seat;
    Vector<double, 6> force;
    /// Force along each free direction while a is 0.
    Vector<double, 6> push;
    /// Acceleration of the body along the directions, without velocity terms.
    Vector<double, 6> acceleration;
};

}  // namespace catena::dca
