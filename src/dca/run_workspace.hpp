// Storage of the data that the outward pass of a run on revolute joints needs. It uses the nodes of
// the joints inside the run, which are not eliminated one by one.
#pragma once

#include <cstddef>

#include "dca/floating_run.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Data of a run on revolute joints for its outward pass, stored in the nodes of its inner joints.
/// Precondition: end(), revolute(), body(), omega() and velocity_bias() are called only for what
/// was put. axes(), omega(), velocity_bias() and orientation() need a run of three bodies or more.
template <class Sweeps>
class RunWorkspace {
    using Revolute = ReleasedRevolute<double>;
    using Body = BodyInRun<double>;
    using End = RunsEnd<double>;
    using Factor = Symmetric<double, 6>;
    using Column = Vector<double, 6>;
    // The last body's node holds its revolute joint and the end of the run, one after the other.
    // The rest of its data are in the node of the body before. A run of two bodies has no such node
    // and needs no such data.
    static constexpr int of_revolute = sizeof(Revolute) / sizeof(double),
                         of_body = sizeof(Body) / sizeof(double), of_axes = 9, of_omega = 3;
    static constexpr int of_end = sizeof(End) / sizeof(double),
                         most = sizeof(typename Sweeps::Node) / sizeof(double);
    // Velocity bias of a body, FloatingRun::velocity_bias.
    using VelocityBias = BodyAcceleration<double>;
    static constexpr int of_swing = sizeof(VelocityBias) / sizeof(double);
    static constexpr int at_axes = of_revolute + of_body, at_swing = at_axes + of_axes,
                         at_omega = at_swing + of_swing, at_last_omega = at_omega + of_omega,
                         at_orientation = at_last_omega + of_omega;
    static_assert(of_revolute + of_end <= most && at_orientation + of_axes <= most);
    static constexpr int at_first = of_revolute + Factor::size, at_bias = at_first + 6 * 5;
    static_assert(offsetof(End, first) == (at_first - of_revolute) * sizeof(double) &&
                  offsetof(End, bias) == (at_bias - of_revolute) * sizeof(double));

  public:
    /// Data with which the outward pass begins, in a run of three bodies or more: end(), axes() and
    /// velocity_bias(last - 1).
    struct Tail {
        End end;
        Mat3 axes;
        VelocityBias velocity_bias;
    };
    /// `all`: the outward pass needs the velocity bias of every body.
    CATENA_HD RunWorkspace(Sweeps const& sweeps, Run const& run, bool all)
        : sweeps_(sweeps), run_(run), all_(all) {}
    CATENA_HD void put(int i, Revolute const& revolute) {
        store(i, 0, revolute);
        watch(i, revolute.inverse);
    }
    CATENA_HD void put(int i, Revolute const& revolute, Body const& body,
                       VelocityBias const& velocity_bias) {
        put(i, revolute);
        put(i, body, velocity_bias);
    }
    CATENA_HD void put(int i, Body const& body, VelocityBias const& velocity_bias) {
        store(i, of_revolute, body);
        if (all_ || i == last() - 1) store(i, at_swing, velocity_bias);
    }
    CATENA_HD void put(End const& end) {
        put(end.factor);
        store(last(), at_first, end.first);
        store(last(), at_bias, end.bias);
    }
    // Parts of RunsEnd, for callers that compute it column by column.
    CATENA_HD void put(Factor const& factor) {
        store(last(), of_revolute, factor);
        CATENA_UNROLL
        for (int i = 0; i < 6; ++i) watch(last(), factor(i, i));
    }
    CATENA_HD void put_first(int j, Column const& column) const {
        CATENA_UNROLL
        for (int i = 0; i < 6; ++i) leave_number(&number(last(), at_first + i * 5 + j), column[i]);
    }
    CATENA_HD void put_bias(Column const& column) const { store(last(), at_bias, column); }
    CATENA_HD void put_axes(Mat3 const& axes) {
        if (last() > 1) store(last() - 1, at_axes, axes);
    }
    /// Stores the angular velocity of a body other than the first, in the body's axes.
    CATENA_HD void put_omega(int i, Vec3 const& omega) {
        if (i < last())
            store(i, at_omega, omega);
        else if (last() > 1)
            store(last() - 1, at_last_omega, omega);
    }
    /// Stores the rotation matrix from W to the last body's axes.
    CATENA_HD void put_orientation(Mat3 const& from_ground) {
        if (last() > 1) store(last() - 1, at_orientation, from_ground);
    }
    CATENA_HD Revolute revolute(int i) const { return load<Revolute>(i, 0); }
    CATENA_HD Body body(int i) const { return load<Body>(i, of_revolute); }
    CATENA_HD VelocityBias velocity_bias(int i) const { return load<VelocityBias>(i, at_swing); }
    CATENA_HD End end() const { return load<End>(last(), of_revolute); }
    CATENA_HD Mat3 axes() const { return load<Mat3>(last() - 1, at_axes); }
    CATENA_HD Vec3 omega(int i) const {
        return i < last() ? load<Vec3>(i, at_omega) : load<Vec3>(last() - 1, at_last_omega);
    }
    CATENA_HD Mat3 orientation() const { return load<Mat3>(last() - 1, at_orientation); }
    /// Returns number n of Tail.
    CATENA_HD double tail(int n) const {
        static_assert(at_swing == at_axes + of_axes &&
                      sizeof(Tail) == (of_end + of_axes + of_swing) * sizeof(double));
        return n < of_end ? number(last(), of_revolute + n)
                          : number(last() - 1, at_axes + n - of_end);
    }
    /// Returns the first joint of the run with a pivot failure.
    CATENA_HD PivotFailure const& lost() const { return lost_; }

  private:
    CATENA_HD int last() const { return static_cast<int>(run_.count) - 1; }
    template <class T>
    CATENA_HD void store(int i, int at, T const& value) const {
        constexpr int count = sizeof(T) / sizeof(double);
        auto const numbers = __builtin_bit_cast(Vector<double, count>, value);
        CATENA_UNROLL
        for (int n = 0; n < count; ++n) leave_number(&number(i, at + n), numbers[n]);
    }
    template <class T>
    CATENA_HD T load(int i, int at) const {
        constexpr int count = sizeof(T) / sizeof(double);
        Vector<double, count> numbers;
        CATENA_UNROLL
        for (int n = 0; n < count; ++n) numbers[n] = number(i, at + n);
        return __builtin_bit_cast(T, numbers);
    }
    CATENA_HD double& number(int i, int n) const {
        return sweeps_.number_of_node(run_.body + i, n);
    }
    CATENA_HD void watch(int i, double inverse) {
        if (!is_good(inverse)) lost_.add(run_.body + i);
    }
    Sweeps const& sweeps_;
    Run const& run_;
    bool all_;
    PivotFailure lost_;
};

}  // namespace catena::dca
