// Owners of what lives on a device. Memory moves with its owner, a stream stays where it is; a failed call throws ComputationError with
// CUDA's own words.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "chain/field.hpp"
#include "dca/solver.hpp"
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

/// D numbers for each of `size` bodies and one halo body on either side, as BasicField on the host.
template <int D>
class DeviceField {
  public:
    DeviceField() = default;
    explicit DeviceField(std::int64_t size)
        : size_(size), pitch_((size + 2 * halo + 7) / 8 * 8), data_(static_cast<std::size_t>(size > 0 ? D * pitch_ : 0)) {}
    View<D> view() const { return data_.data() ? View<D>{data_.data() + halo, pitch_, size_} : View<D>{}; }
    std::int64_t size() const { return size_; }

    /// With its halo; a view without origin leaves what is there.
    void upload(ConstView<D> host, cudaStream_t stream) const {
        if (host.origin) copy_columns(before(), pitch_, host.origin - 1, host.pitch, size_ + 2, D, cudaMemcpyHostToDevice, stream);
    }
    void download(View<D> host, cudaStream_t stream) const {
        if (host.origin) copy_columns(host.origin - 1, host.pitch, before(), pitch_, size_ + 2, D, cudaMemcpyDeviceToHost, stream);
    }

  private:
    static constexpr std::int64_t halo = 8;
    double* before() const { return data_.data() ? data_.data() + halo - 1 : nullptr; }
    std::int64_t size_ = 0, pitch_ = 0;
    Buffer<double> data_;
};

/// As DirectionsField on the host.
class DeviceDirections {
  public:
    DeviceDirections() = default;
    DeviceDirections(std::int64_t size, int directions)
        : size_(size), directions_(directions), pitch_((size + 7) / 8 * 8), data_(static_cast<std::size_t>(pitch_ * directions)) {}
    DirectionsView view() const { return {data_.data(), pitch_}; }
    std::int64_t size() const { return size_; }
    int directions() const { return directions_; }
    void upload(ConstDirectionsView host, cudaStream_t stream) const {
        copy_columns(data_.data(), pitch_, host.origin, host.pitch, size_, directions_, cudaMemcpyHostToDevice, stream);
    }
    void download(DirectionsView host, cudaStream_t stream) const {
        copy_columns(host.origin, host.pitch, data_.data(), pitch_, size_, directions_, cudaMemcpyDeviceToHost, stream);
    }

  private:
    std::int64_t size_ = 0;
    int directions_ = 0;
    std::int64_t pitch_ = 0;
    Buffer<double> data_;
};

}  // namespace catena::cuda
