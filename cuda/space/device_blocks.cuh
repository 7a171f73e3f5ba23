// Teams of threads that carry whole chains through a step in registers, in one launch. A block of
// threads implements the Team of dca/team_tree.hpp on a GPU.
#pragma once

#include <algorithm>

#include "cuda/space/kernels.cuh"
#include "dca/team_tree.hpp"

namespace catena::cuda {

/// Assignment of chains to teams, in the GPU's memory.
struct DeviceTeams {
    /// Part of a run for every thread.
    dca::PartPlace const* place = nullptr;
    /// Number of merge levels of every block.
    std::int32_t const* levels = nullptr;
};

namespace kernels {

/// Largest block whose threads have enough registers for their beads.
constexpr int most_threads_of_team = 256;

/// Team of one block. Its shared memory holds a segment and a force per run, and two positions per
/// thread.
template <int K>
class DeviceTeam {
    using Largest = dca::SegmentMatrix<double, K>;
    static constexpr int ends = 6;

  public:
    /// Returns the bytes of shared memory of a block.
    static constexpr std::size_t shared_bytes(int of_threads) {
        auto const slots = static_cast<std::size_t>(of_threads / dca::parts_of_run);
        return sizeof(Largest) * slots +
               sizeof(double) * (K * slots + ends * static_cast<std::size_t>(of_threads));
    }
    __device__ explicit DeviceTeam(DeviceTeams const& teams)
        : teams_(teams), levels_(teams.levels[blockIdx.x]) {}
    /// Returns the part of a run that this thread works on.
    __device__ dca::PartPlace place() const { return teams_.place[thread()]; }
    /// Returns the number of that part within its run.
    __device__ int part() const { return static_cast<int>(threadIdx.x) % dca::parts_of_run; }
    /// Returns the place of the thread's run among the block's runs.
    __device__ int slot() const { return static_cast<int>(threadIdx.x) / dca::parts_of_run; }
    __device__ int levels() const { return levels_; }
    __device__ void sync() const { __syncthreads(); }

    /// Returns the value of the neighbouring thread of the same run, inboard.
    template <class T>
    __device__ T from_inboard(T const& value) const {
        return exchanged(
            value, [](double v) { return __shfl_up_sync(0xffffffffu, v, 1, dca::parts_of_run); });
    }
    /// Returns the value of the neighbouring thread of the same run, outboard.
    template <class T>
    __device__ T from_outboard(T const& value) const {
        return exchanged(
            value, [](double v) { return __shfl_down_sync(0xffffffffu, v, 1, dca::parts_of_run); });
    }
    /// Stores a run's segment in shared memory.
    template <class Segment>
    __device__ void put(int slot, Segment const& segment) const {
        store(shared_numbers, slots(), slot, segment);
    }
    template <class Segment>
    __device__ Segment get(int slot) const {
        return load<Segment>(shared_numbers, slots(), slot);
    }
    __device__ void put_force(int slot, Vector<double, K> const& force) const {
        store(forces(), slots(), slot, force);
    }
    template <int>
    __device__ Vector<double, K> force(int slot) const {
        return load<Vector<double, K>>(forces(), slots(), slot);
    }
    /// Returns the value of the previous thread of the block. All threads call it.
    __device__ Vec3 from_before(Vec3 const& value) const {
        return passed(last_places(), value, threadIdx.x == 0 ? 0 : -1);
    }
    /// Returns the value of the next thread of the block. All threads call it.
    __device__ Vec3 from_after(Vec3 const& value) const {
        return passed(first_places(), value, threadIdx.x + 1 == blockDim.x ? 0 : 1);
    }

  private:
    template <class T>
    using Numbers = Vector<double, static_cast<int>(sizeof(T) / sizeof(double))>;
    template <class T, class Exchange>
    __device__ static T exchanged(T const& value, Exchange const& exchange) {
        auto numbers = __builtin_bit_cast(Numbers<T>, value);
        CATENA_UNROLL
        for (double& v : numbers.data) v = exchange(v);
        return __builtin_bit_cast(T, numbers);
    }
    /// Stores number by number with a pitch, so that neighbouring threads access different banks.
    template <class T>
    __device__ static void store(double* origin, int pitch, int at, T const& value) {
        auto const numbers = __builtin_bit_cast(Numbers<T>, value);
        CATENA_UNROLL
        for (int n = 0; n < static_cast<int>(sizeof(T) / sizeof(double)); ++n)
            origin[n * pitch + at] = numbers[n];
    }
    template <class T>
    __device__ static T load(double const* origin, int pitch, int at) {
        Numbers<T> numbers;
        CATENA_UNROLL
        for (int n = 0; n < static_cast<int>(sizeof(T) / sizeof(double)); ++n)
            numbers[n] = origin[n * pitch + at];
        return __builtin_bit_cast(T, numbers);
    }
    /// Exchanges a vector with the thread at offset `from` through shared memory.
    __device__ Vec3 passed(double* places, Vec3 const& value, int from) const {
        auto const pitch = static_cast<int>(blockDim.x), own = static_cast<int>(threadIdx.x);
        store(places, pitch, own, value);
        __syncthreads();
        return load<Vec3>(places, pitch, own + from);
    }
    __device__ static int slots() { return static_cast<int>(blockDim.x) / dca::parts_of_run; }
    __device__ static double* forces() {
        return shared_numbers + sizeof(Largest) / sizeof(double) * slots();
    }
    __device__ static double* last_places() { return forces() + K * slots(); }
    __device__ static double* first_places() { return last_places() + 3 * blockDim.x; }
    DeviceTeams teams_;
    int levels_;
};

/// Calls action(team) in every block.
template <class Action>
__global__ void __launch_bounds__(most_threads_of_team)
    each_team(DeviceTeams teams, Action action) {
    action(DeviceTeam<Action::K>(teams));
}

}  // namespace kernels

/// Plan of the teams of a group, with its lists on the GPU.
class DeviceBlocks {
  public:
    static constexpr std::int64_t most_runs = kernels::most_threads_of_team / dca::parts_of_run;
    static constexpr std::int64_t longest_chain = most_runs * dca::longest_run;

    explicit DeviceBlocks(ChainGroup const& group) {
        dca::TeamPlan const plan = dca::plan_teams(group.pieces, runs_of_block(group));
        threads_ = plan.threads;
        count_ = static_cast<unsigned>(plan.teams());
        place_ = Buffer<dca::PartPlace>(plan.place);
        levels_ = Buffer<std::int32_t>(plan.levels);
    }
    unsigned count() const { return count_; }
    int threads() const { return threads_; }
    DeviceTeams teams() const { return {place_.data(), levels_.data()}; }

  private:
    /// Returns the number of runs per block: one wave of blocks if that suffices. The registers of
    /// a block allow only one block per multiprocessor.
    static std::int64_t runs_of_block(ChainGroup const& group) {
        int device = 0, multiprocessors = 0;
        check(cudaGetDevice(&device), "report its number");
        check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
              "report its size");
        std::int64_t longest = 1;
        for (dca::Piece const& piece : group.pieces)
            longest = std::max(longest, (piece.count + dca::longest_run - 1) / dca::longest_run);
        std::int64_t const chains =
            (std::ssize(group.schedule.runs) - 1) / (longest * multiprocessors) + 1;
        return std::min(chains * longest, most_runs);
    }
    int threads_ = 0;
    unsigned count_ = 0;
    Buffer<dca::PartPlace> place_;
    Buffer<std::int32_t> levels_;
};

}  // namespace catena::cuda
