// Communication between lanes of a warp, blocks of a cluster (compute capability 9.0) and blocks of
// one or several launches.
#pragma once

#include <cstdint>

#include "math/linear.hpp"

namespace catena::cuda::kernels {

/// Number of blocks per cluster that every GPU with clusters supports.
constexpr int most_in_cluster = 8;

/// Size of T in doubles.
template <class T>
inline constexpr int numbers_of = static_cast<int>(sizeof(T) / sizeof(double));
template <class T>
/// T as a vector of doubles, used to copy it number by number.
using NumbersOf = Vector<double, numbers_of<T>>;

/// Returns the value of lane `from` of the warp. All lanes must call it.
template <class T>
__device__ T from_lane(T const& value, int from) {
    auto numbers = __builtin_bit_cast(NumbersOf<T>, value);
    CATENA_UNROLL
    for (double& v : numbers.data) v = __shfl_sync(0xffffffffu, v, from);
    return __builtin_bit_cast(T, numbers);
}

#if defined(__CUDACC__)

/// Location in a block's shared memory to which other blocks of its cluster write numbers. A memory
/// barrier (mbarrier) counts the bytes and tells when all have arrived.
class Inbox {
  public:
    __device__ explicit Inbox(std::uint64_t* arrived) : arrived_(address(arrived)) {}
    /// Announces the number of bytes to come. One thread calls it before any block sends.
    __device__ void open(int bytes) const {
#if __CUDA_ARCH__ >= 900
        asm volatile(
            "mbarrier.init.shared::cta.b64 [%0], 1;\n\tfence.mbarrier_init.release.cluster;" ::"r"(
                arrived_)
            : "memory");
        asm volatile("mbarrier.arrive.expect_tx.shared::cta.b64 _, [%0], %1;" ::"r"(arrived_),
                     "r"(bytes)
                     : "memory");
#endif
    }
    /// Writes `value` to the address that corresponds to `at` in the shared memory of block
    /// `block`.
    __device__ void send(int block, double* at, double value) const {
#if __CUDA_ARCH__ >= 900
        asm volatile(
            "{\n\t.reg .b32 to, arrived;\n\tmapa.shared::cluster.u32 to, %0, "
            "%2;\n\tmapa.shared::cluster.u32 arrived, %1, %2;\n\t"
            "st.async.shared::cluster.mbarrier::complete_tx::bytes.b64 [to], %3, [arrived];\n\t}" ::
                "r"(address(at)),
            "r"(arrived_), "r"(block), "l"(__double_as_longlong(value))
            : "memory");
#endif
    }
    /// Waits until all announced bytes have arrived.
    __device__ void wait() const {
#if __CUDA_ARCH__ >= 900
        asm volatile(
            "{\n\t.reg .pred "
            "all;\n\tWAIT:\n\tmbarrier.try_wait.parity.acquire.cluster.shared::cta.b64 all, [%0], "
            "0;\n\t@!all bra WAIT;\n\t}" ::"r"(arrived_)
            : "memory");
#endif
    }

  private:
    __device__ static std::uint32_t address(void const* shared) {
        return static_cast<std::uint32_t>(__cvta_generic_to_shared(shared));
    }
    std::uint32_t arrived_;
};

/// Memory cell for a letter (below). Each half is written and read atomically, the two halves
/// independently of each other.
struct alignas(16) LetterBox {
    /// The two 8-byte halves; one 16-byte instruction writes or reads both.
    struct Halves {
        unsigned long long lower = 0, upper = 0;
    };
    unsigned long long memory[2];

    __device__ void put(Halves const& halves) {
        asm volatile("st.relaxed.gpu.global.v2.b64 [%0], {%1, %2};" ::"l"(this), "l"(halves.lower),
                     "l"(halves.upper)
                     : "memory");
    }
    __device__ Halves get() const {
        Halves halves;
        asm volatile("ld.relaxed.gpu.global.v2.b64 {%0, %1}, [%2];"
                     : "=l"(halves.lower), "=l"(halves.upper)
                     : "l"(this)
                     : "memory");
        return halves;
    }
};

/// Memory cell that blocks on other GPUs read and write too (system scope instead of GPU scope).
struct PeerLetterBox : LetterBox {
    __device__ void put(Halves const& halves) {
        asm volatile("st.relaxed.sys.global.v2.b64 [%0], {%1, %2};" ::"l"(this), "l"(halves.lower),
                     "l"(halves.upper)
                     : "memory");
    }
    __device__ Halves get() const {
        Halves halves;
        asm volatile("ld.relaxed.sys.global.v2.b64 {%0, %1}, [%2];"
                     : "=l"(halves.lower), "=l"(halves.upper)
                     : "l"(this)
                     : "memory");
        return halves;
    }
};

/// Cluster barrier in two halves, so that a block can work between arrival and wait.
__device__ inline void arrive_at_cluster() {
#if __CUDA_ARCH__ >= 900
    asm volatile("barrier.cluster.arrive.release.aligned;" ::: "memory");
#endif
}
__device__ inline void wait_for_cluster() {
#if __CUDA_ARCH__ >= 900
    asm volatile("barrier.cluster.wait.acquire.aligned;" ::: "memory");
#endif
}
/// Allows the next launch of the stream to start before this one has ended. That launch must call
/// wait_for_launch() before it uses what this one writes.
__device__ inline void let_next_launch_start() {
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}
/// Waits until the previous launch of the stream has ended and its writes are visible.
__device__ inline void wait_for_launch() {
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

#endif

/// Number that travels between blocks which all run at once, of one launch or of launches on
/// several GPUs. Each half of the number carries the launch's number in its upper bits. The reader
/// therefore knows whether the number has arrived, and no barrier is needed.
struct Letter : LetterBox::Halves {
    __device__ static Letter of(double value, unsigned launch) {
        auto const bits = static_cast<unsigned long long>(__double_as_longlong(value)),
                   beside = static_cast<unsigned long long>(launch) << 32;
        return {{(bits & lower_half) | beside, bits >> 32 | beside}};
    }
    __device__ bool is_of(unsigned launch) const {
        return lower >> 32 == launch && upper >> 32 == launch;
    }
    __device__ double value() const {
        return __longlong_as_double(static_cast<long long>((lower & lower_half) | upper << 32));
    }

  private:
    static constexpr unsigned long long lower_half = 0xffffffff;
};
/// Records that such blocks exchange, in memory as boxes[n * records + i] for number n of record i.
template <class Box>
struct LettersIn {
    Box* boxes = nullptr;
    int records = 0;
    /// Number of the launch, never 0: unwritten letters belong to launch 0.
    unsigned launch = 0;

    __device__ void put(int i, int n, double value) const {
        boxes[n * records + i].put(Letter::of(value, launch));
    }
    /// Polls until number n of record i has arrived and returns it.
    __device__ double wait_for(int i, int n) const {
        Letter letter;
        while (!letter.is_of(launch)) letter = {boxes[n * records + i].get()};
        return letter.value();
    }
    /// Calls put(n, number n of record i) for n = begin, begin + step, ... below end. It polls
    /// `at_once` letters concurrently to hide the memory latency.
    template <int at_once, class Put>
    __device__ void take_some(int i, int begin, int end, int step, Put const& put) const {
        for (int first = begin; first < end; first += at_once * step) {
            Letter letter[at_once];
            bool are_here = false;
            while (!are_here) {
                CATENA_UNROLL
                for (int j = 0; j < at_once; ++j)
                    if (int const n = first + j * step; n < end && !letter[j].is_of(launch))
                        letter[j] = {boxes[n * records + i].get()};
                are_here = true;
                CATENA_UNROLL
                for (int j = 0; j < at_once; ++j)
                    are_here = are_here && (first + j * step >= end || letter[j].is_of(launch));
            }
            CATENA_UNROLL
            for (int j = 0; j < at_once; ++j)
                if (int const n = first + j * step; n < end) put(n, letter[j].value());
        }
    }
};
using Letters = LettersIn<LetterBox>;
/// Letters of a launch that performs both passes: segments to the block above, forces from the
/// block above.
struct TopLaunchLetters {
    Letters up, down;
    unsigned* launches = nullptr;  // number of launches so far, one counter per block

    /// Numbers this launch. Every thread that uses the letters calls it.
    __device__ void open() {
        unsigned const last = launches[blockIdx.x], most = 0xffffffff;
        up.launch = down.launch = last < most ? last + 1 : 1;
    }
    /// Stores the launch's number. One thread calls it when its block reads no more letters.
    __device__ void close() const { launches[blockIdx.x] = up.launch; }
};

/// Reads one word of each 64-byte line of a kernel parameter. Parameters are in no cache at the
/// start of a kernel, so the first use would wait for them.
template <class T>
__device__ void touch([[maybe_unused]] T const& parameter) {
#if defined(__CUDA_ARCH__)
    constexpr int line = 64;
    CATENA_UNROLL
    for (std::size_t i = 0; i < sizeof(T); i += line)
        asm volatile(
            "" ::"r"(*reinterpret_cast<int const*>(reinterpret_cast<char const*>(&parameter) + i)));
#endif
}

}  // namespace catena::cuda::kernels
