// One body, or one of every stretch, as BeadLeaf and BodyLeaf (dca/body_leaf.hpp) have it: the same
// operators of dca/leaf.hpp on records.
#pragma once

#include "dca/leaf.hpp"
#include "tests/bench/precision/numbers.hpp"

namespace catena::precision {

template <class Real, int K>
struct BodySolution {
    Vector<Real, 3> alpha, acceleration;
    Vector<Real, K> force;  // of the inboard joint
};

/// Rigid bodies in joint coordinates (JointFrameHandles): K = 3 spherical, 5 revolute.
template <class Real, int K_>
struct Bodies {
    static constexpr int K = K_;
    template <class Other>
    using In = Bodies<Other, K>;
    using Three = Vector<Real, 3>;
    using Directions = Vector<Real, K>;
    using Handle = dca::Handle<Real, K>;
    struct Place {
        Three r1, r2;
        Vector<Real, 4> rotation;
        Matrix<Real, 3, 3> axes1, axes2;
    };
    struct State {
        Real inverse_mass;
        Symmetric<Real, 3> inverse_inertia;
        Place place;
    };
    struct Body {
        Real mass;
        Symmetric<Real, 3> inertia;
        Place place;
    };
    struct Defect {
        Three torque, force;
        Directions bias;
        template <class To>
        auto in() const {
            return typename Bodies<To, K>::Defect{converted<To>(torque), converted<To>(force),
                                                  converted<To>(bias)};
        }
    };
    struct Loads : Defect {
        Three omega;
    };
    using Solution = BodySolution<Real, K>;
    struct Handles {
        Handle h1, h2;
    };

    static Handles handles(Place const& p) {
        Matrix<Real, 3, 3> const e1 =
            transposed_times(to_matrix(as_quaternion(p.rotation)), p.axes1);
        return {dca::make_handle<K>(p.r1, e1, e1), dca::make_handle<K>(p.r2, p.axes2, p.axes2)};
    }
    static dca::SegmentMatrix<Real, K> matrix(State const* at) {
        Handles const h = handles(at->place);
        return dca::leaf_matrix(at->inverse_mass, at->inverse_inertia, h.h1, h.h2);
    }
    static dca::SegmentBias<Real, K> bias(State const* at, Loads const& loads) {
        Three const a = at->inverse_mass * loads.force, alpha = at->inverse_inertia * loads.torque;
        return biases(handles(at->place), alpha, a + centripetal(loads, at->place.r1),
                      a + centripetal(loads, at->place.r2), loads.bias);
    }
    static dca::SegmentBias<Real, K> bias(State const* at, Defect const& loads) {
        Three const a = at->inverse_mass * loads.force;
        return biases(handles(at->place), at->inverse_inertia * loads.torque, a, a, loads.bias);
    }
    static Solution solution(State const* at, Defect const& loads, Directions const& inboard,
                             Directions const& outboard) {
        Handles const h = handles(at->place);
        Three const torque = loads.torque + (moment(h.h1, inboard) - moment(h.h2, outboard));
        Three const force = loads.force + (push(h.h1, inboard) - push(h.h2, outboard));
        return {at->inverse_inertia * torque, at->inverse_mass * force, inboard};
    }
    /// What the equations of motion and, in `bias`, the closing of the inboard joint lack
    /// (JointSolution::defect). `before`: acceleration of handle 2 of the body before; becomes that
    /// of this one.
    static Defect defect(Body const* at, Loads const& loads, Solution const& x,
                         Directions const& outboard, Directions& before) {
        Handles const h = handles(at->place);
        Defect d;
        d.torque =
            loads.torque + (moment(h.h1, x.force) - moment(h.h2, outboard)) - at->inertia * x.alpha;
        d.force =
            loads.force + (push(h.h1, x.force) - push(h.h2, outboard)) - at->mass * x.acceleration;
        d.bias = along(h.h1, x.alpha, x.acceleration + centripetal(loads, at->place.r1)) - before +
                 loads.bias;
        before = along(h.h2, x.alpha, x.acceleration + centripetal(loads, at->place.r2));
        return d;
    }
    template <class From>
    static void add(Solution& x, BodySolution<From, K> const& more) {
        x.alpha = x.alpha + converted<Real>(more.alpha);
        x.acceleration = x.acceleration + converted<Real>(more.acceleration);
        x.force = x.force + converted<Real>(more.force);
    }
    template <class From>
    static void set(Solution& x, BodySolution<From, K> const& found) {
        x = {converted<Real>(found.alpha), converted<Real>(found.acceleration),
             converted<Real>(found.force)};
    }

  private:
    static Three centripetal(Loads const& loads, Three const& r) {
        return cross(loads.omega, cross(loads.omega, r));
    }
    static dca::SegmentBias<Real, K> biases(Handles const& h, Three const& alpha, Three const& a1,
                                            Three const& a2, Directions const& more) {
        return {along(h.h1, alpha, a1) + more, along(h.h2, alpha, a2)};
    }
};

template <class Real>
struct BeadSolution {
    Vector<Real, 3> acceleration;
    Vector<Real, 1> force;
};

/// Point beads on links.
template <class Real>
struct Beads {
    static constexpr int K = 1;
    template <class Other>
    using In = Beads<Other>;
    using Three = Vector<Real, 3>;
    using Directions = Vector<Real, 1>;
    struct State {
        Three direction;  // of the inboard link; the outboard one's is in the next row
        Real inverse_mass;
    };
    struct Body {
        Three direction;
        Real mass;
    };
    struct Defect {
        Three force;
        Directions bias;
        template <class To>
        auto in() const {
            return typename Beads<To>::Defect{converted<To>(force), converted<To>(bias)};
        }
    };
    struct Loads : Defect {};
    using Solution = BeadSolution<Real>;

    static dca::SegmentMatrix<Real, 1> matrix(State const* at) {
        return dca::bead_matrix(at->inverse_mass, at->direction, at[1].direction, Directions{});
    }
    static dca::SegmentBias<Real, 1> bias(State const* at, Defect const& loads) {
        auto b = dca::bead_bias(at->inverse_mass, loads.force, at->direction, at[1].direction,
                                Directions{});
        b.b1 = b.b1 + loads.bias;
        return b;
    }
    static Solution solution(State const* at, Defect const& loads, Directions const& inboard,
                             Directions const& outboard) {
        return {dca::bead_acceleration(at->inverse_mass, loads.force, inboard[0], at->direction,
                                       outboard[0], at[1].direction),
                inboard};
    }
    static Defect defect(Body const* at, Loads const& loads, Solution const& x,
                         Directions const& outboard, Directions& before) {
        Three const pulled = plus_scaled(plus_scaled(loads.force, x.force[0], at->direction),
                                         -outboard[0], at[1].direction);
        Defect d;
        d.force = plus_scaled(pulled, -at->mass, x.acceleration);
        d.bias[0] = dot(at->direction, x.acceleration) - before[0] + loads.bias[0];
        before[0] = dot(at[1].direction, x.acceleration);
        return d;
    }
    template <class From>
    static void add(Solution& x, BeadSolution<From> const& more) {
        x.acceleration = x.acceleration + converted<Real>(more.acceleration);
        x.force = x.force + converted<Real>(more.force);
    }
    template <class From>
    static void set(Solution& x, BeadSolution<From> const& found) {
        x = {converted<Real>(found.acceleration), converted<Real>(found.force)};
    }
};

}  // namespace catena::precision
