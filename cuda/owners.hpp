// Owners of what lives on a device. Memory moves with its owner, a stream stays where it is; a failed call throws ComputationError with
// CUDA's own words.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "error.hpp"

namespace catena::cuda {

inline void check(cudaError_t status, char const* doing) {
    if (status != cudaSuccess) throw ComputationError(std::string("the GPU failed to ") + doing + ": " + cudaGetErrorString(status));
}

class Stream {
  public:
    Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "make a stream"); }
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

/// A moment in a stream's work.
class Moment {
  public:
    explicit Moment(cudaStream_t stream) {
        check(cudaEventCreate(&event_), "make an event");
        check(cudaEventRecord(event_, stream), "note a moment");
    }
    ~Moment() { cudaEventDestroy(event_); }
    Moment(Moment const&) = delete;
    Moment& operator=(Moment const&) = delete;
    /// Waits for this one.
    double seconds_since(Moment const& start) const {
        float milliseconds = 0;
        check(cudaEventSynchronize(event_), "finish its work");
        check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "tell the time");
        return 1e-3 * static_cast<double>(milliseconds);
    }

  private:
    cudaEvent_t event_ = nullptr;
};

/// What an action asks of a stream, recorded to be done again. The action must not wait for it.
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
        check(status, "take its work as a graph");
    }
    ~Graph() { cudaGraphExecDestroy(graph_); }
    Graph(Graph const&) = delete;
    Graph& operator=(Graph const&) = delete;
    void launch(cudaStream_t stream) const { check(cudaGraphLaunch(graph_, stream), "launch a graph"); }

  private:
    cudaGraphExec_t graph_ = nullptr;
};

/// Memory of a device, ready for any stream when the constructor returns: zeros or the host's values.
template <class T>
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t count) : count_(count) {
        if (count == 0) return;
        void* memory = nullptr;
        check(cudaMalloc(&memory, count * sizeof(T)), "find memory");
        data_ = static_cast<T*>(memory);
        check(cudaMemset(data_, 0, count * sizeof(T)), "clear memory");
        check(cudaStreamSynchronize(nullptr), "clear memory");
    }
    explicit Buffer(std::span<T const> host) : Buffer(host.size()) {
        if (count_ == 0) return;
        check(cudaMemcpy(data_, host.data(), count_ * sizeof(T), cudaMemcpyHostToDevice), "copy to its memory");
        check(cudaStreamSynchronize(nullptr), "copy to its memory");
    }
    explicit Buffer(std::vector<T> const& host) : Buffer(std::span<T const>(host)) {}
    ~Buffer() { cudaFree(data_); }
    Buffer(Buffer&& other) noexcept : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
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

/// Columns of `length` numbers between two pitched arrays.
inline void copy_columns(double* to, std::int64_t to_pitch, double const* from, std::int64_t from_pitch, std::int64_t length, int columns,
                         cudaMemcpyKind kind, cudaStream_t stream) {
    if (!to || !from || length == 0 || columns == 0) return;
    auto const bytes = [](std::int64_t numbers) { return static_cast<std::size_t>(numbers) * sizeof(double); };
    check(cudaMemcpy2DAsync(to, bytes(to_pitch), from, bytes(from_pitch), bytes(length), static_cast<std::size_t>(columns), kind, stream),
          "move a field");
}

}  // namespace catena::cuda
