// CUDA's words for a host compiler, so that kernels run where there is no GPU. A block is a thread
// of the host and its threads are fibers of that: from barrier to barrier they go one after the
// other, each time in another order, and what passes between them without a barrier comes too late
// for some. Blocks of a cluster, or that wait for each other, go side by side. The thread sanitizer
// takes every fiber for a thread.
#pragma once

#include <gtest/gtest.h>
#include <setjmp.h>
#include <ucontext.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <barrier>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <span>
#include <thread>
#include <type_traits>
#include <vector>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CATENA_FIBERS_ARE_WATCHED
#endif
#if __has_feature(address_sanitizer)
#define CATENA_STACKS_ARE_WATCHED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define CATENA_STACKS_ARE_WATCHED
#endif
#if defined(__SANITIZE_THREAD__)
#define CATENA_FIBERS_ARE_WATCHED
#endif
#if defined(CATENA_FIBERS_ARE_WATCHED)
#include <sanitizer/tsan_interface.h>
#endif

#define __global__
#define __device__
#define __host__
#define __shared__ thread_local
#define __launch_bounds__(...)
#define __forceinline__ inline

/// _longjmp() without the check that it leads down the same stack, which some compilers put before
/// it.
extern "C" [[noreturn]] void catena_jump_to_another_stack(jmp_buf, int) __asm__("_longjmp");

namespace catena::cuda_on_host {

struct Index {
    unsigned x = 0;
};

/// What the thread sanitizer is told: a switch from fiber to fiber orders nothing, a barrier does.
namespace watch {
#if defined(CATENA_FIBERS_ARE_WATCHED)
inline void* self() { return __tsan_get_current_fiber(); }
inline void* create() { return __tsan_create_fiber(0); }
inline void destroy(void* fiber) { __tsan_destroy_fiber(fiber); }
inline void before_switch(void* to) { __tsan_switch_to_fiber(to, __tsan_switch_to_fiber_no_sync); }
inline void arrive(void* at) { __tsan_release(at); }
inline void leave(void* from) { __tsan_acquire(from); }
#else
inline void* self() { return nullptr; }
inline void* create() { return nullptr; }
inline void destroy(void*) {}
inline void before_switch(void*) {}
inline void arrive(void*) {}
inline void leave(void*) {}
#endif
}  // namespace watch

/// Where a fiber, or what resumes it, has stopped. swapcontext() asks the system for the signals'
/// mask at every switch, which takes longer than all that fibers do between two of them; sanitizers
/// know no other way.
class Stop {
  public:
    void begin_at(stack_t const& stack, void (*entry)()) {
        getcontext(&context_);
        context_.uc_stack = stack;
        makecontext(&context_, entry, 0);
    }
#if defined(CATENA_FIBERS_ARE_WATCHED) || defined(CATENA_STACKS_ARE_WATCHED)
    void switch_to(Stop& other) { swapcontext(&context_, &other.context_); }
#else
    void switch_to(Stop& other) {
        if (_setjmp(jump_) != 0) return;
        has_jump_ = true;
        if (other.has_jump_) catena_jump_to_another_stack(other.jump_, 1);
        setcontext(&other.context_);
    }
#endif

  private:
    ucontext_t context_{};
    jmp_buf jump_{};
    bool has_jump_ = false;
};

/// An H100's or H200's, of a block.
constexpr std::size_t most_shared_bytes = 232448;
constexpr std::size_t numbers_to_see_overruns = 64;

}  // namespace catena::cuda_on_host

inline constinit thread_local catena::cuda_on_host::Index threadIdx{}, blockIdx{}, blockDim{},
    gridDim{};

namespace catena::cuda::kernels {
alignas(16) inline constinit thread_local double shared_numbers
    [cuda_on_host::most_shared_bytes / sizeof(double) + cuda_on_host::numbers_to_see_overruns]{};
}  // namespace catena::cuda::kernels

namespace catena::cuda_on_host {

/// Of a block's fibers, one block after the other. Launches leave theirs to later ones, which need
/// no new pages then.
class Stacks {
  public:
    explicit Stacks(std::size_t count) {
        {
            std::scoped_lock const lock(mutex_);
            if (!left_.empty()) {
                own_ = std::move(left_.back());
                left_.pop_back();
            }
        }
        while (own_.size() < count) own_.push_back(std::make_unique_for_overwrite<Stack>());
    }
    ~Stacks() {
        std::scoped_lock const lock(mutex_);
        left_.push_back(std::move(own_));
    }
    Stacks(Stacks const&) = delete;
    Stacks& operator=(Stacks const&) = delete;
    stack_t of(std::size_t fiber) const { return {own_[fiber].get(), 0, sizeof(Stack)}; }

  private:
    using Stack = std::array<std::byte, 256 << 10>;
    using Group = std::vector<std::unique_ptr<Stack>>;
    static inline std::mutex mutex_;
    static inline std::vector<Group> left_;
    Group own_;
};

/// One that runs.
class Block {
  public:
    /// `cluster`: where its cluster's blocks meet; null for a block alone.
    Block(unsigned threads, Stacks const& stacks, std::barrier<>* cluster,
          std::function<void()> const& kernel)
        : kernel_(kernel), cluster_(cluster), fibers_(threads) {
        here_ = this;
        for (std::size_t t = 0; t < threads; ++t) {
            Fiber& fiber = fibers_[t];
            fiber.watched = watch::create();
            fiber.stop.begin_at(stacks.of(t), &Block::enter);
        }
    }
    ~Block() {
        for (Fiber const& fiber : fibers_) watch::destroy(fiber.watched);
    }
    Block(Block const&) = delete;
    Block& operator=(Block const&) = delete;

    void run() {
        std::vector<Warp> warps((fibers_.size() + lanes - 1) / lanes);
        std::vector<std::size_t> order(warps.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::minstd_rand random(blockIdx.x + 1);
        for (bool over = false; !over;) {
            std::shuffle(order.begin(), order.end(), random);
            watch::arrive(&left_);
            for (std::size_t const w : order)
                if (warps[w].waits_for == Whole::warp) resume(w, warps[w], random);
            auto const waits = [&](Whole whole) {
                return [whole](Warp const& warp) { return warp.waits_for == whole; };
            };
            over = std::all_of(warps.begin(), warps.end(), waits(Whole::nobody));
            if (over || std::any_of(warps.begin(), warps.end(), waits(Whole::warp))) continue;
            for (Warp const& warp : warps)
                if (warp.line != warps[0].line || warp.waits_for != warps[0].waits_for)
                    fail(warp.line, warps[0].line);
            if (warps[0].waits_for == Whole::cluster) cluster_->arrive_and_wait();
            for (Warp& warp : warps) warp.waits_for = Whole::warp;
        }
        if (cluster_) cluster_->arrive_and_drop();
    }
    enum class Whole { nobody, warp, block, cluster };
    /// Where the running fiber waits for the others. Alone, it waits for no cluster: a GPU without
    /// clusters knows nothing of them.
    static void wait(int line, Whole whole) {
        if (whole != Whole::cluster || here_->cluster_) here_->leave_fiber(line, whole);
    }
    /// What another lane of the warp had when all came here.
    static double of_lane(double value, int lane, int line) {
        std::vector<Fiber>& fibers = here_->fibers_;
        std::size_t const own = threadIdx.x;
        fibers[own].given = value;
        wait(line, Whole::warp);
        double const found =
            fibers[own / lanes * lanes + static_cast<std::size_t>(lane) % lanes].given;
        wait(line, Whole::warp);
        return found;
    }

    /// Copies to shared memory that a thread has started: they come when it waits for them, but
    /// what was there is lost at once.
    static void start_copy(double* to, double const* from) {
        *to = std::numeric_limits<double>::quiet_NaN();
        here_->fibers_[threadIdx.x].copies.push_back({to, from});
    }
    static void close_copies() {
        Fiber& fiber = here_->fibers_[threadIdx.x];
        fiber.together.push_back(fiber.copies.size());
    }
    static void wait_for_copies(std::size_t left) {
        Fiber& fiber = here_->fibers_[threadIdx.x];
        if (fiber.together.size() <= left) return;
        std::size_t const end = fiber.together[fiber.together.size() - 1 - left];
        for (; fiber.come < end; ++fiber.come)
            *fiber.copies[fiber.come].to = *fiber.copies[fiber.come].from;
        if (fiber.come < fiber.copies.size()) return;
        fiber.copies.clear();
        fiber.together.clear();
        fiber.come = 0;
    }
    static void note_wait_for_launch() { here_->fibers_[threadIdx.x].waited_for_launch = true; }

  private:
    struct Fiber {
        Stop stop;
        void* watched = nullptr;
        bool waited_for_launch = false;
        int line = 0;
        Whole waits_for = Whole::nobody;
        double given = 0;
        struct Copy {
            double* to;
            double const* from;
        };
        std::vector<Copy> copies;
        std::vector<std::size_t> together;  // where those end that go together
        std::size_t come = 0;
    };
    /// What all of its lanes wait for.
    struct Warp {
        int line = 0;
        Whole waits_for = Whole::warp;
    };
    static constexpr std::size_t lanes = 32;
    static void fail(int line, int other) {
        ADD_FAILURE() << "threads of a block wait in lines " << line << " and " << other
                      << " (0: nowhere)";
        std::abort();  // nothing says how to go on
    }
    /// Up to where its lanes wait.
    void resume(std::size_t w, Warp& warp, std::minstd_rand& random) {
        std::size_t const first = w * lanes;
        std::vector<std::size_t> order(std::min(lanes, fibers_.size() - first));
        std::iota(order.begin(), order.end(), first);
        std::shuffle(order.begin(), order.end(), random);
        for (std::size_t const t : order) resume(static_cast<unsigned>(t));
        watch::leave(&arrived_);
        Fiber const& lane = fibers_[first];
        for (std::size_t const t : order)
            if (fibers_[t].line != lane.line || fibers_[t].waits_for != lane.waits_for)
                fail(fibers_[t].line, lane.line);
        warp = {lane.line, lane.waits_for};
    }
    static void enter() {
        watch::leave(&here_->left_);
        here_->kernel_();
        if (!here_->fibers_[threadIdx.x].waited_for_launch) {
            ADD_FAILURE()
                << "a thread has not waited for the launch before";  // as cuda/device/launch.cuh
                                                                     // asks of every kernel
            std::abort();
        }
        if (!here_->fibers_[threadIdx.x].copies.empty())
            ADD_FAILURE() << "a thread has not waited for its copies";
        here_->leave_fiber(0, Whole::nobody);
    }
    /// No race with the fibers that read it.
    __attribute__((noinline, no_sanitize("thread"))) static void number_thread(unsigned t) {
        threadIdx.x = t;
    }
    void resume(unsigned t) {
        number_thread(t);
        watch::before_switch(fibers_[t].watched);
        outside_.switch_to(fibers_[t].stop);
    }
    void leave_fiber(int line, Whole whole) {
        Fiber& fiber = fibers_[threadIdx.x];
        fiber.line = line;
        fiber.waits_for = whole;
        void* const outside = watched_;  // read before the others may go on
        watch::arrive(&arrived_);
        watch::before_switch(outside);
        fiber.stop.switch_to(outside_);
        watch::leave(&left_);
    }

    static inline thread_local Block* here_ = nullptr;
    std::function<void()> const& kernel_;
    std::barrier<>* cluster_;
    std::vector<Fiber> fibers_;
    Stop outside_;
    void* watched_ = watch::self();
    char arrived_ = 0, left_ = 0;  // what the sanitizer knows them by
};

/// What the blocks of a launch know of each other.
struct Letters {
    struct Inbox {
        double* memory = nullptr;
        std::atomic<int> bytes = 0;
    };
    std::vector<Inbox> of_block;
    explicit Letters(unsigned blocks) : of_block(blocks) {}
};
inline constinit thread_local Letters* letters = nullptr;

struct Launch {
    unsigned blocks = 0, threads = 0;
    std::size_t numbers = 0;   // of shared memory
    unsigned cluster = 1;      // blocks that meet
    bool all_at_once = false;  // blocks wait for each other
};

/// Block `b`. Its shared memory is full of NaN at first.
inline void run_block(unsigned b, Launch const& grid, Stacks const& stacks, std::barrier<>* cluster,
                      std::function<void()> const& kernel) {
    constexpr double unset = std::numeric_limits<double>::quiet_NaN();
    std::span const own(cuda::kernels::shared_numbers, grid.numbers + numbers_to_see_overruns);
    std::fill(own.begin(), own.end(), unset);
    letters->of_block[b].memory = own.data();
    blockIdx.x = b;
    gridDim.x = grid.blocks;
    blockDim.x = grid.threads;
    Block(grid.threads, stacks, cluster, kernel).run();
    for (double const beyond : own.last(numbers_to_see_overruns))
        if (std::bit_cast<std::uint64_t>(beyond) != std::bit_cast<std::uint64_t>(unset))
            ADD_FAILURE() << "wrote beyond shared memory";
}

template <class... Parameters>
void launch(Launch const& grid, void (*kernel)(Parameters...),
            std::type_identity_t<Parameters> const&... parameters) {
    ASSERT_LE(grid.numbers * sizeof(double), most_shared_bytes);
    ASSERT_TRUE(grid.cluster == 1 || grid.cluster == grid.blocks);
    std::function<void()> const of_thread = [&] { kernel(parameters...); };
    unsigned const workers = grid.all_at_once   ? grid.blocks
                             : grid.cluster > 1 ? grid.cluster
                                                : std::min(grid.blocks, 2U);
    std::barrier<> cluster(workers);
    Letters here(grid.blocks);
    std::vector<std::jthread> threads;
    for (unsigned w = 0; w < workers; ++w)
        threads.emplace_back([&, w] {
            letters = &here;
            Stacks const stacks(grid.threads);
            for (unsigned b = w; b < grid.blocks; b += workers)
                run_block(b, grid, stacks, grid.cluster > 1 ? &cluster : nullptr, of_thread);
        });
}

}  // namespace catena::cuda_on_host

/// `line`: that of the call.
inline void __syncthreads(int line = __builtin_LINE()) {
    catena::cuda_on_host::Block::wait(line, catena::cuda_on_host::Block::Whole::block);
}
inline void __syncwarp(int line = __builtin_LINE()) {
    catena::cuda_on_host::Block::wait(line, catena::cuda_on_host::Block::Whole::warp);
}
template <class T>
T __shfl_sync(unsigned, T value, int lane, int line = __builtin_LINE()) {
    return static_cast<T>(
        catena::cuda_on_host::Block::of_lane(static_cast<double>(value), lane, line));
}
inline int __all_sync(unsigned, int says, int line = __builtin_LINE()) {
    for (int apart = 16; apart > 0; apart /= 2)
        says &= __shfl_sync(0xffffffffu, says, static_cast<int>(threadIdx.x) ^ apart, line);
    return says;
}
inline unsigned __ballot_sync(unsigned, int says, int line = __builtin_LINE()) {
    unsigned ballot = (says ? 1U : 0U) << threadIdx.x % 32;
    for (int apart = 1; apart < 32; apart *= 2)
        ballot |= __shfl_sync(0xffffffffu, ballot, static_cast<int>(threadIdx.x) ^ apart, line);
    return ballot;
}
inline double __longlong_as_double(long long bits) { return std::bit_cast<double>(bits); }
inline long long __double_as_longlong(double value) { return std::bit_cast<long long>(value); }
namespace catena::cuda::kernels {

inline void start_copy(double* to_shared, double const* from) {
    cuda_on_host::Block::start_copy(to_shared, from);
}
inline void close_copies() { cuda_on_host::Block::close_copies(); }
template <int left>
void wait_for_copies() {
    cuda_on_host::Block::wait_for_copies(left);
}

class Inbox {
  public:
    explicit Inbox(std::uint64_t*) {}
    static void open(int bytes) { expected_ = bytes; }
    static void send(int block, double* at, double value) {
        cuda_on_host::Letters::Inbox& to =
            cuda_on_host::letters->of_block[static_cast<std::size_t>(block)];
        to.memory[at - shared_numbers] = value;
        to.bytes.fetch_add(sizeof(value), std::memory_order_release);
    }
    static void wait(int line = __builtin_LINE()) {
        std::atomic<int> const& bytes = cuda_on_host::letters->of_block[blockIdx.x].bytes;
        bool all = false;
        while (!all) {  // lanes see it come one after the other, and go on together
            all = cuda_on_host::Block::of_lane(
                      bytes.load(std::memory_order_acquire) == expected_ ? 1 : 0, 0, line) > 0;
        }
    }

  private:
    static inline thread_local int expected_ = 0;
};
struct LetterBox {
    struct Halves {
        unsigned long long lower = 0, upper = 0;
    };
    std::atomic<unsigned long long> memory[2];

    void put(Halves const& halves) {
        memory[0].store(halves.lower, std::memory_order_relaxed);
        memory[1].store(halves.upper, std::memory_order_relaxed);
    }
    Halves get() const {
        std::this_thread::yield();  // other blocks are on their way
        return {memory[0].load(std::memory_order_relaxed),
                memory[1].load(std::memory_order_relaxed)};
    }
};
inline void arrive_at_cluster() {}
inline void wait_for_cluster(int line = __builtin_LINE()) {
    cuda_on_host::Block::wait(line, cuda_on_host::Block::Whole::block);
    cuda_on_host::Block::wait(line, cuda_on_host::Block::Whole::cluster);
}
inline void let_next_launch_start() {}
inline void wait_for_launch() { cuda_on_host::Block::note_wait_for_launch(); }

}  // namespace catena::cuda::kernels
