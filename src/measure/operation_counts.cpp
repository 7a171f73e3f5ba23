// Operation counts of leaves, assembly and disassembly.
#include "measure/operation_counts.hpp"

#include "dca/leaf.hpp"

namespace catena {
namespace {

using namespace dca;
using Vector3 = Vector<Counted, 3>;
using Matrix3 = Matrix<Counted, 3, 3>;

/// Returns the operations of `action`.
template <class Action>
Operations count(Action const& action) {
    Counted::done() = {};
    action();
    return Counted::done();
}

/// Stores results here, so that the compiler does not remove their computation.
template <class T>
void keep(T const& value) {
    static thread_local T kept;
    kept = value;
}

/// Counts a merge of two segments with K directions.
template <int K>
void count_merges(HandleOperations& h) {
    h.directions = K;
    SegmentMatrix<Counted, K> a = SegmentMatrix<Counted, K>::zero();
    for (int i = 0; i < K; ++i) a.z11(i, i) = a.z22(i, i) = Counted(1);
    SegmentBias<Counted, K> const b = SegmentBias<Counted, K>::zero();
    JointMatrix<Counted, K> joint;
    Vector<Counted, K> offset;
    h.assembly_matrices = count([&] { keep(assemble(a, a, K, joint)); });
    h.assembly_biases = count([&] { keep(assemble(b, b, joint, offset)); });
    h.disassembly = count([&] { keep(disassemble(joint, offset, b.b1, b.b2)); });
}

/// Counts the operations of a rigid body, with the calls of BodyLeaf with JointFrameHandles
/// (dca/body_leaf.hpp).
template <int K, bool sliding>
HandleOperations count_bodies() {
    HandleOperations h;
    count_merges<K>(h);
    Counted const one(1);
    Quaternion<Counted> const rotation = Quaternion<Counted>::identity();
    Matrix3 const axes = Matrix3::identity();
    Vector3 const r{{one, one, one}}, w = r;
    Symmetric<Counted, 3> inertia = Symmetric<Counted, 3>::zero();
    Handle<Counted, K, sliding> h1, h2;
    auto const handles = [&] {
        Matrix3 const e1 = transposed_times(to_matrix(rotation), axes);
        h1 = make_handle<K, sliding>(r, e1, e1);
        h2 = make_handle<K, sliding>(r, axes, axes);
        if constexpr (sliding) {
            turn_to_screw(Screw<Counted>{one, one}, r, e1, e1, h1);
            turn_to_screw(Screw<Counted>{one, one}, r, axes, axes, h2);
        }
    };
    h.leaf_matrices = count([&] {
        handles();
        keep(leaf_matrix(one, inertia, h1, h2));
    });
    h.leaf_biases = count([&] {
        handles();
        Vector3 const a = one * r, alpha = inertia * r;
        keep(along(h1, alpha, a + cross(w, cross(w, r))));
        keep(along(h2, alpha, a + cross(w, cross(w, r))));
    });
    Vector<Counted, K> const force = Vector<Counted, K>::zero();
    h.leaf_accelerations = count([&] {
        handles();
        keep(inertia * (r + (moment(h1, force) - moment(h2, force))));
        keep(one * (r + (push(h1, force) - push(h2, force))));
    });
    return h;
}

/// Counts the operations of a bead, with the calls of BeadLeaf.
template <int K>
HandleOperations count_beads() {
    HandleOperations h;
    count_merges<K>(h);
    Counted const one(1);
    Vector3 const u{{one, Counted(0), Counted(0)}};
    Vector<Counted, K> const kind = Vector<Counted, K>::zero();
    h.leaf_matrices = count([&] { keep(bead_matrix(one, u, u, kind)); });
    h.leaf_biases = count([&] { keep(bead_bias(one, u, u, u, kind)); });
    h.leaf_accelerations = count([&] { keep(bead_acceleration(one, u, one, u, one, u)); });
    return h;
}

}  // namespace

std::vector<JointOperations> count_operations() {
    HandleOperations const full = count_bodies<6, false>(), sliding = count_bodies<6, true>();
    return {{"link", count_beads<1>(), count_beads<3>()},
            {"planar", count_bodies<2, false>(), full},
            {"spherical", count_bodies<3, false>(), full},
            {"universal", count_bodies<4, false>(), full},
            {"revolute", count_bodies<5, false>(), full},
            {"sliding", count_bodies<5, true>(), sliding},
            {"weld", full, full}};
}

}  // namespace catena
