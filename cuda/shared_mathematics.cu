// Every operation that host and device share, instantiated in kernels: what compiles here can be launched later.
#include <cstdint>

#include "chain/field.hpp"
#include "dca/leaf.hpp"
#include "dca/philox.hpp"
#include "dca/rotation.hpp"
#include "dca/segment.hpp"

namespace catena::shared_mathematics {

template <int K>
struct Work {
    std::int64_t count;
    FieldView<double, 3> vector;
    FieldView<double const, 4> orientation;
    Sym3 const* inverse_inertia;
    int const* restricted;
    dca::SegmentMatrix<double, K>* matrix;
    dca::SegmentBias<double, K>* bias;
    dca::JointMatrix<double, K>* joint;
    Vector<double, K>* offset;
    Vector<double, K>* force;
};

__device__ std::int64_t global_thread() { return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; }

template <int K>
__global__ void join(Work<K> w) {
    std::int64_t const i = global_thread();
    if (i >= w.count) return;
    w.matrix[i] = dca::assemble(w.matrix[2 * i], w.matrix[2 * i + 1], w.restricted[i], w.joint[i]);
    w.bias[i] = dca::assemble(w.bias[2 * i], w.bias[2 * i + 1], w.joint[i], w.offset[i]);
    w.force[i] = dca::disassemble(w.joint[i], w.offset[i], w.bias[i].b1, w.bias[i].b2);
}

template <int K>
__global__ void bodies(Work<K> w) {
    std::int64_t const i = global_thread();
    if (i >= w.count) return;
    Vector<double, 4> const q = w.orientation.load(i);
    Mat3 const axes = to_matrix(Quat{q[0], q[1], q[2], q[3]});
    Vec3 const r = w.vector.load(i);
    dca::Handle<double, K> inboard = dca::make_handle<K>(r, Mat3::identity(), axes);
    dca::Handle<double, K> const outboard = dca::make_handle<K>(-r, dca::triple(axes.column(0)), axes);
    if constexpr (K == 5) {  // sliding joints
        dca::turn_to_screw(dca::Screw<double>{0.6, 0.8}, r, Mat3::identity(), axes, inboard);
        w.matrix[i] = dca::leaf_matrix<true>(1.0, w.inverse_inertia[i], inboard, outboard);
    } else {
        w.matrix[i] = dca::leaf_matrix(1.0, w.inverse_inertia[i], inboard, outboard);
    }
    w.force[i] = dca::along(inboard, r, w.inverse_inertia[i] * r);
}

template <int K>
__global__ void beads(Work<K> w) {
    std::int64_t const i = global_thread();
    if (i >= w.count) return;
    w.matrix[i] = dca::bead_matrix(1.0, w.vector.load(i), w.vector.load(i + 1), w.force[i]);
    w.force[i] = dca::along_link(w.vector.load(i), w.vector.load(i + 1), w.force[i]);
}

template <int K>
__global__ void turn(Work<K> w, std::uint64_t seed) {
    std::int64_t const i = global_thread();
    if (i >= w.count) return;
    Vec3 const v = w.vector.load(i);
    Vec3 const noise = normal3(seed, 0, static_cast<std::uint64_t>(i), NoiseStage::thermostat);
    Quat const q = from_rotation_vector(noise) * normalized(conjugate(from_axis_angle(v, norm(noise))));
    Vec3 const twice = rotation_vector(to_quaternion(to_matrix(q) * transpose(to_matrix(q))));
    w.vector.store(i, plus_scaled(twice, dot(noise, v), cross(noise, v)));
}

// K: 1 links, 2 planar chains, 3 spherical joints and full handles of beads, 4 universal joints, 5 revolute joints, 6 full.
template __global__ void join(Work<1>);
template __global__ void join(Work<2>);
template __global__ void join(Work<3>);
template __global__ void join(Work<4>);
template __global__ void join(Work<5>);
template __global__ void join(Work<6>);
template __global__ void bodies(Work<1>);
template __global__ void bodies(Work<2>);
template __global__ void bodies(Work<3>);
template __global__ void bodies(Work<4>);
template __global__ void bodies(Work<5>);
template __global__ void bodies(Work<6>);
template __global__ void beads(Work<1>);
template __global__ void beads(Work<3>);
template __global__ void turn(Work<3>, std::uint64_t);

}  // namespace catena::shared_mathematics
