// What runs on a GPU for DeviceSpace: loops, answers, and a sweep's stages. A launcher indexes, loads, calls and stores; the mathematics
// is in dca/.
#pragma once

#include "cuda/device_field.cuh"
#include "cuda/stage_kernels.cuh"

namespace catena::cuda {

namespace kernels {

/// Neighbouring threads at neighbouring places.
template <class Action>
__global__ void for_each(std::int64_t count, Action action) {
    if (std::int64_t const k = gpu_order::body(thread()); k < count) action(k);
}
template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}

/// Item i: number i of a body, between a field and memory that the host reaches or gave.
struct TakeBody {
    double const* from;
    std::int64_t pitch;
    double* to;
    __device__ void operator()(std::int64_t i) const { to[i] = from[i * pitch]; }
};
template <int D>
struct PutBody {
    double* to;
    std::int64_t pitch;
    Vector<double, D> value;
    __device__ void operator()(std::int64_t i) const { to[i * pitch] = value[static_cast<int>(i)]; }
};

constexpr int most_in_one_block = 256;
/// Levels that fit into one block each, one after the other: offset[l] to offset[l + 1], from level `first` on in steps of `step`.
template <class Item, class Action>
__global__ void small_levels(Item const* items, std::int64_t const* offset, int first, int count, int step, Action action) {
    for (int l = 0; l < count; ++l) {
        std::int64_t const begin = offset[first + l * step], end = offset[first + l * step + 1];
        if (begin + threadIdx.x < end) action(items[begin + threadIdx.x]);
        __syncthreads();
    }
}

/// By one block: of every item, of every level upwards and of every level downwards.
template <class Item, class Node, class First, class Up, class Down>
__global__ void up_and_down(Item const* items, int count, Node const* nodes, std::int64_t const* offset, int levels, First first, Up up,
                            Down down) {
    if (threadIdx.x < static_cast<unsigned>(count)) first(items[threadIdx.x]);
    for (int turn = 0; turn < 2 * levels; ++turn) {
        int const l = turn < levels ? turn : 2 * levels - 1 - turn;
        std::int64_t const i = offset[l] + threadIdx.x;
        __syncthreads();
        if (i >= offset[l + 1]) continue;
        if (turn < levels)
            up(nodes[i]);
        else
            down(nodes[i]);
    }
}

/// Doubles from 0 on have the order of their bits, and a NaN is above them all.
template <class Value>
__global__ void largest(std::int64_t count, unsigned long long* found, Value value) {
    unsigned long long mine = 0;
    if (std::int64_t const i = thread(); i < count) mine = static_cast<unsigned long long>(__double_as_longlong(fabs(value(i))));
    for (int lane = 16; lane > 0; lane /= 2) {
        unsigned long long const other = __shfl_down_sync(0xffffffffu, mine, lane);
        mine = other > mine ? other : mine;
    }
    if (threadIdx.x % 32 == 0 && mine > 0) atomicMax(found, mine);
}

}  // namespace kernels

}  // namespace catena::cuda
