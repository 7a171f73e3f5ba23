// Where runs on hinges leave what their way back needs: among the nodes of the joints that they do not join.
#pragma once

#include "dca/inertia_run.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// What the way down needs of a run on hinges, where joining would keep the joints of its bodies. Precondition: what end(), hinge(),
/// body(), omega() and swing() are asked for was put; axes(), omega(), swing() and orientation(): of a run of three bodies or more.
template <class Sweeps>
class HingesInJoints {
    using Hinge = ReleasedHinge<double>;
    using Body = BodyInRun<double>;
    using End = RunsEnd<double>;
    // The last hinge's and the end's numbers lie together, what else is of the last body beside the body before: a run of two has none
    // between its ends.
    static constexpr int of_hinge = sizeof(Hinge) / sizeof(double), of_body = sizeof(Body) / sizeof(double), of_axes = 9, of_omega = 3;
    static constexpr int of_end = sizeof(End) / sizeof(double), most = sizeof(typename Sweeps::Node) / sizeof(double);
    static constexpr int at_axes = of_hinge + of_body, at_omega = at_axes + of_axes, at_last_omega = at_omega + of_omega,
                         at_orientation = at_last_omega + of_omega, at_swing = at_orientation + of_axes;
    using Swing = BodyAcceleration<double>;
    static_assert(of_hinge + of_end <= most && at_swing + sizeof(Swing) / sizeof(double) <= most);

  public:
    /// `all`: the way back asks for every body's swing.
    CATENA_HD HingesInJoints(Sweeps const& sweeps, Run const& run, bool all) : sweeps_(sweeps), run_(run), all_(all) {}
    CATENA_HD void put(int i, Hinge const& hinge) {
        store(i, 0, hinge);
        watch(i, hinge.inverse);
    }
    CATENA_HD void put(int i, Hinge const& hinge, Body const& body, Swing const& swing) {
        put(i, hinge);
        store(i, of_hinge, body);
        if (all_ || i == last() - 1) store(i, at_swing, swing);
    }
    CATENA_HD void put(End const& end) {
        store(last(), of_hinge, end);
        CATENA_UNROLL
        for (int i = 0; i < 6; ++i) watch(last(), end.factor(i, i));
    }
    CATENA_HD void put_axes(Mat3 const& axes) {
        if (last() > 1) store(last() - 1, at_axes, axes);
    }
    /// Of a body that is not the first, in its axes.
    CATENA_HD void put_omega(int i, Vec3 const& omega) {
        if (i < last())
            store(i, at_omega, omega);
        else if (last() > 1)
            store(last() - 1, at_last_omega, omega);
    }
    /// What turns from the ground's axes to the last body's.
    CATENA_HD void put_orientation(Mat3 const& from_ground) {
        if (last() > 1) store(last() - 1, at_orientation, from_ground);
    }
    CATENA_HD Hinge hinge(int i) const { return load<Hinge>(i, 0); }
    CATENA_HD Body body(int i) const { return load<Body>(i, of_hinge); }
    CATENA_HD Swing swing(int i) const { return load<Swing>(i, at_swing); }
    CATENA_HD End end() const { return load<End>(last(), of_hinge); }
    CATENA_HD Mat3 axes() const { return load<Mat3>(last() - 1, at_axes); }
    CATENA_HD Vec3 omega(int i) const { return i < last() ? load<Vec3>(i, at_omega) : load<Vec3>(last() - 1, at_last_omega); }
    CATENA_HD Mat3 orientation() const { return load<Mat3>(last() - 1, at_orientation); }
    CATENA_HD Lost const& lost() const { return lost_; }

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
    CATENA_HD double& number(int i, int n) const { return sweeps_.number_of_node(run_.body + i, n); }
    CATENA_HD void watch(int i, double inverse) {
        if (!is_good(inverse)) lost_.add(run_.body + i);
    }
    Sweeps const& sweeps_;
    Run const& run_;
    bool all_;
    Lost lost_;
};

}  // namespace catena::dca
