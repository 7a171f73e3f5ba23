// Kernels of DeviceSpace: loops, queries and the stages of sweeps. A kernel indexes, loads, calls
// and stores; the mathematics is in dca/.
#pragma once

#include "cuda/space/device_field.cuh"
#include "cuda/sweeps/stage_kernels.cuh"

namespace catena::cuda {

namespace kernels {

/// Calls action(k) for bodies k of [0, count), in gpu_order: neighbouring threads access
/// neighbouring addresses.
template <class Action>
__global__ void for_each(std::int64_t count, Action action) {
    wait_for_launch();
    if (std::int64_t const k = gpu_order::body(thread()); k < count) action(k);
}
/// Calls action(item) for each of `count` items.
template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    wait_for_launch();
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}

/// Copies number i of a body, for item i, from a field to memory that the host can read.
struct TakeBody {
    double const* from;
    double* to;
    __device__ void operator()(std::int64_t i) const { to[i] = from[i * gpu_order::lanes]; }
};
/// Writes number i of a body, for item i, from a value given by the host to a field.
template <int D>
struct PutBody {
    double* to;
    Vector<double, D> value;
    __device__ void operator()(std::int64_t i) const {
        to[i * gpu_order::lanes] = value[static_cast<int>(i)];
    }
};

/// Finds the largest |value(i)|, i < count, as the bits of a double. Non-negative doubles are
/// ordered like their bits, and a NaN compares above all of them.
template <class Value>
__global__ void largest(std::int64_t count, unsigned long long* found, Value value) {
    wait_for_launch();
    unsigned long long mine = 0;
    if (std::int64_t const i = thread(); i < count)
        mine = static_cast<unsigned long long>(__double_as_longlong(fabs(value(i))));
    for (int lane = 16; lane > 0; lane /= 2) {
        unsigned long long const other = __shfl_down_sync(0xffffffffu, mine, lane);
        mine = other > mine ? other : mine;
    }
    if (threadIdx.x % 32 == 0 && mine > 0) atomicMax(found, mine);
}

}  // namespace kernels

}  // namespace catena::cuda
