// The sweeps of articulated handles over the canonical tree (articulated.hpp), for open chains in
// joint coordinates. They have the interface described in tree_sweeps.hpp.
#pragma once

#include "dca/articulated.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Leaf of articulated handles: one body with its inboard joint. `sliding`: some joint translates.
template <bool sliding>
class ArticulatedLeaf {
  public:
    static constexpr int K = 6;
    static constexpr bool beads = false, in_joints = false, projected = false;
    using Matrix6 = ArticulatedMatrix<double, K>;
    using Bias6 = ArticulatedBias<double, K>;
    using Vec6 = Vector<double, K>;
    explicit ArticulatedLeaf(GroupView const& group) : group_(group), frames_(group) {}
    void set(ConfigurationView const& c) { frames_.set(c); }
    CATENA_HD GroupView const& group() const { return group_; }

    /// A body held at its inboard joint in every direction, with its handles.
    struct Held {
        typename JointFrameHandles<K, sliding>::template State<double> state;
        HandlePair<Handle<double, K, sliding>> handles;
        // Angular acceleration, and linear acceleration of the centre of mass, for a unit
        // acceleration along each direction of handle 1; B.
        Matrix<double, 3, K> turning, shifting;
        Matrix6 matrix;
    };
    /// Returns body k held at its inboard joint.
    CATENA_HD_APART Held held(std::int64_t k) const {
        Held b{frames_.state(k), {}, {}, {}, {}};
        b.handles = frames_.handles(b.state, k, to_matrix(as_quaternion(b.state.rotation)));
        Mat3 const e =
            transposed_times(to_matrix(as_quaternion(b.state.rotation)), axes_of(b.state.axes1));
        for (int i = 0; i < 3; ++i) {
            b.turning.set_column(i, Vec3::zero());
            b.shifting.set_column(i, e.column(i));
            b.turning.set_column(3 + i, e.column(i));
            b.shifting.set_column(3 + i, cross(b.state.r1, e.column(i)));
        }
        if constexpr (sliding) mix(as_screw(group_.screw.load(k)), b);
        double const mass = group_.mass.load(k)[0];
        Matrix<double, 3, K> const turned = full(as_symmetric(group_.inertia.load(k))) * b.turning;
        for (int j = 0; j < K; ++j)
            for (int i = j; i < K; ++i) {
                double const shifted = mass * dot(b.shifting.column(i), b.shifting.column(j));
                b.matrix.inertia(i, j) = shifted + dot(b.turning.column(i), turned.column(j));
            }
        b.matrix.tip = b.matrix.rest = Matrix<double, K, K>::zero();
        for (int j = 0; j < K; ++j)
            b.matrix.carry.set_column(
                j, along(b.handles.h2, b.turning.column(j), b.shifting.column(j)));
        return b;
    }
    /// Returns the matrices of body k with the free directions of its joint released. Adds a pivot
    /// failure to `found`.
    CATENA_HD_APART Matrix6 matrix(std::int64_t k, int restricted, PivotFailure& found) const {
        Matrix6 m = held(k).matrix;
        for (int i = K - 1; i >= restricted; --i) {
            double const own = release(i, m).own;
            if (!(own > 0 && own - own == 0)) found.add(k);
        }
        return m;
    }
    /// Returns the bias of body k with the free directions of its joint released.
    CATENA_HD Bias6 bias(LoadsView const& loads, std::int64_t k, int restricted) const {
        return released(loads, k, restricted).bias;
    }
    /// Writes the accelerations of body k from the states of its two joints, if they are requested.
    CATENA_HD void accelerate(LoadsView const& loads, std::int64_t k, int restricted,
                              HandleState<double, K> const& inboard, int restricted_outboard,
                              HandleState<double, K> const& outboard,
                              AccelerationsView const& out) const {
        if (!out.acceleration.origin) return;
        Released const r = released(loads, k, restricted);
        Vec6 const a = accelerations(r.body.matrix, r.bias, r.direction, inboard, restricted,
                                     outboard, restricted_outboard) -
                       r.closure;
        out.alpha.store(k, r.body.turning * a);
        out.acceleration.store(k, r.body.shifting * a);
    }

  private:
    // A body with the free directions of its joint released.
    struct Released {
        Held body;
        Vec6 closure;  // Velocity terms of the joint and of handle 1.
        Bias6 bias;
        ReleasedDirection<double> direction[K];
    };
    CATENA_HD_APART Released released(LoadsView const& loads, std::int64_t k,
                                      int restricted) const {
        Released r{held(k), Vec6::zero(), {}, {}};
        Vec3 const w = read_or_zero(loads.omega, k), force = read_or_zero(loads.force, k);
        Vec3 torque = read_or_zero(loads.torque, k);
        if (loads.gyroscopic) torque = torque - cross(w, as_symmetric(group_.inertia.load(k)) * w);
        r.closure = along(r.body.handles.h1, Vec3::zero(), cross(w, cross(w, r.body.state.r1)));
        if (loads.bias) r.closure = r.closure + loads.bias.load<K>(k);
        Matrix6& m = r.body.matrix;
        r.bias.p = -(m.inertia * r.closure) - transposed_times(r.body.turning, torque) -
                   transposed_times(r.body.shifting, force);
        r.bias.w = Vec6::zero();
        r.bias.e = along(r.body.handles.h2, Vec3::zero(), cross(w, cross(w, r.body.state.r2))) -
                   m.carry * r.closure;
        for (int i = K - 1; i >= restricted; --i) {
            r.direction[i] = release(i, m);
            release(i, r.direction[i], r.bias);
        }
        return r;
    }
    /// Combines directions 2 and 5 and orders all directions as turn_to_screw() does.
    CATENA_HD static void mix(Screw<double> const& screw, Held& b) {
        auto const each = [&](Matrix<double, 3, K>& m) {
            Vec3 const linear = m.column(2), angular = m.column(5);
            m.set_column(2, screw.c * linear - screw.s * angular);
            m.set_column(5, screw.s * linear + screw.c * angular);
            put_in_order(screw.order, m);
        };
        each(b.turning), each(b.shifting);
    }

    GroupView group_;
    JointFrameHandles<K, sliding> frames_;
};

/// The arrays of the articulated sweeps, with the members of TreeSweeps.
template <class Leaf>
struct ArticulatedSweeps {
    static constexpr int K = Leaf::K;
    using Matrices = ArticulatedMatrix<double, K>;
    using Biases = ArticulatedBias<double, K>;
    using Joint = ArticulatedJoint<double, K>;
    using Offset = ArticulatedOffset<double, K>;
    using State = HandleState<double, K>;
    static constexpr StageRecords in_stage{
        static_cast<int>((sizeof(Matrices) + sizeof(Biases)) / sizeof(double)),
        static_cast<int>(sizeof(State) / sizeof(double)), 128};
    // Data of a joint that the outward pass needs.
    struct Node {
        Joint joint;
        Offset offset;
    };

    Leaf leaf;
    // Number of restricted directions of every joint, as in TreeSweeps.
    std::uint8_t const* restricted = nullptr;
    RecordsView<Matrices, Order::plain> matrices;  // Indexed by slot.
    RecordsView<Biases, Order::plain> biases;
    RecordsView<Joint, Order::by_body> joints;  // Indexed by joint.
    RecordsView<Offset, Order::by_body> offsets;
    RecordsView<State, Order::by_body> forces;
    unsigned long long* lost = nullptr;

    /// Returns the size of the arrays for a schedule, in bytes.
    static std::int64_t bytes(Schedule const& schedule) {
        return schedule.slots * static_cast<std::int64_t>(sizeof(Matrices) + sizeof(Biases)) +
               schedule.joints *
                   static_cast<std::int64_t>(sizeof(Joint) + sizeof(Offset) + sizeof(State));
    }
    CATENA_HD JointAt at(std::int64_t k) const { return {k, restricted[k]}; }
    /// Reports a pivot failure to `lost`.
    CATENA_HD void note(PivotFailure const& found) const {
        if (found.joint != PivotFailure{}.joint) lower_to(lost, found.joint);
    }
    CATENA_HD_APART Node node(std::int64_t k) const { return {joints.load(k), offsets.load(k)}; }
};

/// The matrix sweep: matrices of every run and joint.
template <class Leaf>
struct ArticulatedMatrixSweep {
    static constexpr bool descends = false, keeps_nodes = false, supports_short_chains = false;
    using Sweeps = ArticulatedSweeps<Leaf>;
    using Segment = typename Sweeps::Matrices;
    using Part = NothingRead;
    Sweeps s;

    CATENA_HD Part read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    /// Returns the matrices of part p and stores the joints inside it.
    CATENA_HD Segment part(Run const& run, int p, Part) const {
        PivotFailure found;
        std::int64_t const begin = begin_of(run, p);
        Segment segment = s.leaf.matrix(begin, s.restricted[begin], found);
        for (std::int64_t k = begin + 1; k < end_of(run, p); ++k)
            segment = joined(segment, s.leaf.matrix(k, s.restricted[k], found), s.at(k), found);
        s.note(found);
        return segment;
    }
    /// Returns the merged matrices and stores their joint.
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard,
                             JointAt const& at) const {
        PivotFailure found;
        Segment const segment = joined(inboard, outboard, at, found);
        s.note(found);
        return segment;
    }
    CATENA_HD_APART Segment joined(Segment const& inboard, Segment const& outboard,
                                   JointAt const& at, PivotFailure& found) const {
        typename Sweeps::Joint joint;
        Segment const segment = join(inboard, outboard, at.restricted, joint);
        s.joints.store(at.k, joint);
        for (int i = 0; i < Leaf::K; ++i)
            if (double const pivot = joint.factor.lu(i, i); pivot == 0 || pivot - pivot != 0)
                found.add(at.k);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.matrices.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.matrices.store(slot, segment);
    }
    /// Does nothing: chains are open, and the first joint's state follows from the biases.
    CATENA_HD void close(Root const& /*root*/, Segment const& /*whole*/) const {}
};

/// The bias sweep: biases, then the joints' states and accelerations, with the matrices assembled
/// last. Bodies are computed again rather than stored.
template <class Leaf>
struct ArticulatedBiasSweep {
    static constexpr bool descends = true, keeps_nodes = false, supports_short_chains = false;
    using Sweeps = ArticulatedSweeps<Leaf>;
    using Segment = typename Sweeps::Biases;
    using ShownNumbers = RecordNumbers<Segment>;
    using State = typename Sweeps::State;
    using Node = typename Sweeps::Node;
    using Part = NothingRead;
    Sweeps s;
    LoadsView loads;
    AccelerationsView out;

    CATENA_HD Part read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    /// Returns the bias of part p and stores the offsets of the joints inside it.
    CATENA_HD Segment part(Run const& run, int p, Part) const {
        std::int64_t const begin = begin_of(run, p);
        Segment segment = s.leaf.bias(loads, begin, s.restricted[begin]);
        for (std::int64_t k = begin + 1; k < end_of(run, p); ++k)
            segment = joined(segment, s.leaf.bias(loads, k, s.restricted[k]), s.at(k));
        return segment;
    }
    /// Returns the merged bias and stores the joint's offset.
    CATENA_HD_APART Segment joined(Segment const& inboard, Segment const& outboard,
                                   JointAt const& at) const {
        typename Sweeps::Offset offset;
        Segment const segment = join(inboard, outboard, s.joints.load(at.k), offset);
        s.offsets.store(at.k, offset);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.biases.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.biases.store(slot, segment);
    }
    /// Computes the state of the first joint. The ground's acceleration is contained in the biases
    /// of the joints to it, and at a free tip there is no force.
    CATENA_HD void close(Root const& root, Segment const& whole) const {
        s.forces.store(root.first, {Vector<double, Leaf::K>::zero(), whole.p});
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    /// Returns the state of an eliminated joint from those at its run's two ends.
    CATENA_HD State force(Node const& node, State const& first, State const& next) const {
        return state_between(node.joint, node.offset, first, next);
    }
    /// Outward pass of part p from the states at its two ends: writes joint forces and
    /// accelerations.
    template <bool /*unroll*/>
    CATENA_HD void down(Run const& run, int p, Part, State const& first, State next) const {
        std::int64_t const begin = begin_of(run, p), end = end_of(run, p);
        int restricted_outboard = s.restricted[end == run.body + run.count ? run.next : end];
        for (std::int64_t k = end - 1; k >= begin; --k) {
            State const at_k = k == begin ? first : force(node(k), first, next);
            s.leaf.accelerate(loads, k, s.restricted[k], at_k, restricted_outboard, next, out);
            restricted_outboard = s.restricted[k];
            store_forces(s.leaf.group(), out, k, at_k.force, next.force);
            next = at_k;
        }
    }
};

template <bool sliding>
struct SweepsOf<ArticulatedLeaf<sliding>> {
    using Sweeps = ArticulatedSweeps<ArticulatedLeaf<sliding>>;
    using OfMatrices = ArticulatedMatrixSweep<ArticulatedLeaf<sliding>>;
    using OfBiases = ArticulatedBiasSweep<ArticulatedLeaf<sliding>>;
};
/// Returns the force in a joint's state.
template <int K>
CATENA_HD Vector<double, K> const& force_of(HandleState<double, K> const& joint) {
    return joint.force;
}

}  // namespace catena::dca
