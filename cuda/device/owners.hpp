// RAII owners of CUDA resources: streams, events, graphs and memory. Buffer and PinnedPages can be
// moved, the others cannot. A failed call throws ComputationError with CUDA's own message.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "error.hpp"

namespace catena::cuda {

/// Throws ComputationError "the GPU failed to `doing`: ..." unless `status` is cudaSuccess.
inline void check(cudaError_t status, char const* doing) {
    if (status != cudaSuccess)
        throw ComputationError(std::string("the GPU failed to ") + doing + ": " +
                               cudaGetErrorString(status));
}

/// Non-blocking CUDA stream, independent of the default stream.
class Stream {
  public:
    Stream() {
        check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "create a stream");
    }
    ~Stream() {
        if (stream_) cudaStreamDestroy(stream_);
    }
    Stream(Stream const&) = delete;
    Stream& operator=(Stream const&) = delete;
    cudaStream_t get() const { return stream_; }
    void wait() const { check(cudaStreamSynchronize(stream_), "finish its work"); }

  private:
    cudaStream_t stream_ = nullptr;
};

/// Point in a stream, used to time its work or to order streams. Ordering is faster without timing.
class Event {
  public:
    enum class For { clock, order };
    explicit Event(For use) {
        check(cudaEventCreateWithFlags(
                  &event_, use == For::clock ? cudaEventDefault : cudaEventDisableTiming),
              "create an event");
    }
    ~Event() {
        if (event_) cudaEventDestroy(event_);
    }
    Event(Event const&) = delete;
    Event& operator=(Event const&) = delete;
    void record(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "record an event"); }
    /// Makes `stream` wait until the point recorded last is reached.
    void hold(cudaStream_t stream) const {
        check(cudaStreamWaitEvent(stream, event_, 0), "order its work");
    }
    void wait() const { check(cudaEventSynchronize(event_), "finish its work"); }
    /// Returns the seconds from `other` to this event. Precondition: both events are complete and
    /// were created For::clock.
    double seconds_since(Event const& other) const {
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, other.event_, event_), "measure a time");
        return 1e-3 * static_cast<double>(milliseconds);
    }

  private:
    cudaEvent_t event_ = nullptr;
};

/// Work that an action enqueues in a stream, captured once as a CUDA graph and launched many times.
/// The action must not wait for the stream.
class Graph {
  public:
    template <class Action>
    Graph(cudaStream_t stream, Action const& action) {
        cudaGraph_t graph = nullptr;
        check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "record its work");
        action();
        check(cudaStreamEndCapture(stream, &graph), "record its work");
        cudaError_t const status = cudaGraphInstantiate(&graph_, graph, 0);
        cudaGraphDestroy(graph);
        check(status, "record its work as a graph");
    }
    ~Graph() { cudaGraphExecDestroy(graph_); }
    Graph(Graph const&) = delete;
    Graph& operator=(Graph const&) = delete;
    void launch(cudaStream_t stream) const {
        check(cudaGraphLaunch(graph_, stream), "launch a graph");
    }

  private:
    cudaGraphExec_t graph_ = nullptr;
};

/// Pinned host memory that the device can address too; not initialised.
template <class T>
class PinnedBuffer {
  public:
    explicit PinnedBuffer(std::size_t count) {
        if (count == 0) return;
        void* memory = nullptr;
        check(
            cudaHostAlloc(&memory, count * sizeof(T), cudaHostAllocMapped | cudaHostAllocPortable),
            "allocate memory of the host");
        data_ = static_cast<T*>(memory);
    }
    ~PinnedBuffer() { cudaFreeHost(data_); }
    PinnedBuffer(PinnedBuffer const&) = delete;
    PinnedBuffer& operator=(PinnedBuffer const&) = delete;
    T* data() const { return data_; }

  private:
    T* data_ = nullptr;
};

/// Registers existing host memory as pinned, so that copies to and from the device run
/// asynchronously. Memory below 1 MiB is left unregistered, because it shares pages with other
/// data.
class PinnedPages {
  public:
    PinnedPages() = default;
    explicit PinnedPages(std::span<double> memory) {
        constexpr std::size_t worth_it = 1 << 20;
        if (memory.size_bytes() < worth_it) return;
        if (cudaHostRegister(memory.data(), memory.size_bytes(), cudaHostRegisterDefault) ==
            cudaSuccess)
            memory_ = memory.data();
        else
            cudaGetLastError();  // the copies only take longer
    }
    ~PinnedPages() {
        if (memory_) cudaHostUnregister(memory_);
    }
    PinnedPages(PinnedPages&& other) noexcept : memory_(std::exchange(other.memory_, nullptr)) {}
    PinnedPages& operator=(PinnedPages&& other) noexcept {
        std::swap(memory_, other.memory_);
        return *this;
    }

  private:
    double* memory_ = nullptr;
};

/// Device memory, filled with zeros or with the host's values. Any stream may use it when the
/// constructor returns.
template <class T>
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t count) : count_(count) {
        if (count == 0) return;
        void* memory = nullptr;
        check(cudaMalloc(&memory, count * sizeof(T)), "allocate memory");
        data_ = static_cast<T*>(memory);
        check(cudaMemset(data_, 0, count * sizeof(T)), "clear memory");
        check(cudaStreamSynchronize(nullptr), "clear memory");
    }
    explicit Buffer(std::span<T const> host) : Buffer(host.size()) {
        if (count_ == 0) return;
        check(cudaMemcpy(data_, host.data(), count_ * sizeof(T), cudaMemcpyHostToDevice),
              "copy to its memory");
        check(cudaStreamSynchronize(nullptr), "copy to its memory");
    }
    explicit Buffer(std::vector<T> const& host) : Buffer(std::span<T const>(host)) {}
    ~Buffer() { cudaFree(data_); }
    Buffer(Buffer&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
    Buffer& operator=(Buffer&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(count_, other.count_);
        return *this;
    }
    T* data() const { return data_; }
    std::size_t size() const { return count_; }

  private:
    T* data_ = nullptr;
    std::size_t count_ = 0;
};

/// Enqueues a copy of `columns` columns of `length` numbers between two pitched arrays; pitches in
/// numbers.
inline void copy_columns(double* to, std::int64_t to_pitch, double const* from,
                         std::int64_t from_pitch, std::int64_t length, int columns,
                         cudaMemcpyKind kind, cudaStream_t stream) {
    if (!to || !from || length == 0 || columns == 0) return;
    auto const bytes = [](std::int64_t numbers) {
        return static_cast<std::size_t>(numbers) * sizeof(double);
    };
    check(cudaMemcpy2DAsync(to, bytes(to_pitch), from, bytes(from_pitch), bytes(length),
                            static_cast<std::size_t>(columns), kind, stream),
          "move a field");
}

}  // namespace catena::cuda
