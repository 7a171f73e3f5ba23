// What runs on a GPU for DeviceSpace: loops, answers, and a sweep's stages. A launcher indexes,
// loads, calls and stores; the mathematics is in dca/.
#pragma once

#include "cuda/space/device_field.cuh"
#include "cuda/sweeps/stage_kernels.cuh"

namespace catena::cuda {

namespace kernels {

/// Neighbouring threads at neighbouring places.
template <class Action>
__global__ void for_each(std::int64_t count, Action action) {
    wait_for_launch();
    if (std::int64_t const k = gpu_order::body(thread()); k < count) action(k);
}
template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    wait_for_launch();
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}

/// Item i: number i of a body, between a field and memory that the host reaches or gave.
struct TakeBody {
    double const* from;
    double* to;
    __device__ void operator()(std::int64_t i) const { to[i] = from[i * gpu_order::lanes]; }
};
template <int D>
struct PutBody {
    double* to;
    Vector<double, D> value;
    __device__ void operator()(std::int64_t i) const {
        to[i * gpu_order::lanes] = value[static_cast<int>(i)];
    }
};

/// Doubles from 0 on have the order of their bits, and a NaN is above them all.
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
