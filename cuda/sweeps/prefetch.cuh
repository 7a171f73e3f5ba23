// Prefetch of bodies to a thread's place in shared memory while the thread processes the body
// before. With larger handles there are no registers to hold the numbers under way.
// tests/support/cuda_on_host.hpp, included first, makes this file compile on the host.
#pragma once

#include "cuda/device/copies.cuh"
#include "dca/tree_sweeps.hpp"

namespace catena::cuda::kernels {

/// Bodies [begin, end) of a thread, each read once and in order. `Bodies`: dca::Resting. A thread
/// has two places with an odd number of doubles in total, so that threads access different banks.
template <class Bodies>
class BodiesInTurn {
    using Read = typename decltype(Bodies::leaf)::template Body<std::int64_t>;
    using Body = typename Bodies::template Body<std::int64_t>;
    // The index of the body is not stored.
    static constexpr int numbers = static_cast<int>(sizeof(Read) / sizeof(double)) - 1;
    static constexpr int of_thread = 2 * numbers | 1;

    /// Reader of leaves (dca/lane_access.hpp) that starts asynchronous copies and returns zeros.
    struct Start {
        double* to;
        int n = 0;
        template <class T, int D>
        __device__ Vector<double, D> operator()(FieldView<T, D> const& view, std::int64_t k) {
            CATENA_UNROLL
            for (int i = 0; i < D; ++i) start_copy(to + n + i, &view.at(k, i));
            n += D;
            return {};
        }
        template <class T, int D>
        __device__ Vector<double, D> if_any(FieldView<T, D> const& view, std::int64_t k) {
            if (view.origin) Start{to, n}(view, k);
            n += D;
            return {};
        }
        template <class T, int D>
        __device__ Vector<double, D> once_if_any(FieldView<T, D> const& view, std::int64_t k) {
            return if_any(view, k);
        }
    };
    /// Reader that returns the copied numbers in the order in which Start copied them.
    struct Take {
        double const* from;
        int n = 0;
        template <class T, int D>
        __device__ Vector<double, D> operator()(FieldView<T, D> const&, std::int64_t) {
            Vector<double, D> v;
            CATENA_UNROLL
            for (int i = 0; i < D; ++i) v[i] = from[n + i];
            n += D;
            return v;
        }
        template <class T, int D>
        __device__ Vector<double, D> if_any(FieldView<T, D> const& view, std::int64_t k) {
            int const first = n;
            n += D;
            return view.origin ? Take{from, first}(view, k) : Vector<double, D>::zero();
        }
        template <class T, int D>
        __device__ Vector<double, D> once_if_any(FieldView<T, D> const& view, std::int64_t k) {
            return if_any(view, k);
        }
    };

  public:
    /// Size of a block's shared memory in doubles.
    static __host__ __device__ constexpr std::size_t size(int threads) {
        return static_cast<std::size_t>(of_thread) * static_cast<std::size_t>(threads);
    }
    __device__ BodiesInTurn(Bodies const& bodies, std::int64_t begin, std::int64_t end,
                            double* memory)
        : bodies_(bodies), own_(memory + threadIdx.x * of_thread), next_(begin), end_(end) {
        start();
    }
    /// Access to a part's bodies in the form that a sweep expects; the index is ignored.
    struct Part {
        BodiesInTurn& all;
        __device__ Body body(int) const { return all.next(); }
    };

  private:
    /// Place of body k.
    __device__ double* place_of(std::int64_t k) const { return own_ + (k & 1) * numbers; }
    /// Starts the copy of the next body.
    __device__ void start() {
        bodies_.leaf.body(bodies_.loads, next_, Start{place_of(next_)});
        restricted_ = bodies_.restricted[next_];
        close_copies();
    }
    /// Returns the next body. The following copy starts before this body's numbers are read. The
    /// compiler keeps this order, so that code with few registers reads the numbers late.
    __device__ Body next() {
        wait_for_copies<0>();
        std::int64_t const k = next_;
        int const restricted = restricted_;
        if (++next_ < end_) start();
        return {bodies_.leaf.body(bodies_.loads, k, Take{place_of(k)}), restricted};
    }
    Bodies const& bodies_;
    double* own_;
    std::int64_t next_, end_;
    int restricted_ = 0;
};

}  // namespace catena::cuda::kernels
