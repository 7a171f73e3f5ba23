// Owners of what lives on a device. Move-only; a failed call throws ComputationError with CUDA's own words.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "chain/field.hpp"
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
    Stream(Stream&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
    Stream& operator=(Stream&&) = delete;
    cudaStream_t get() const { return stream_; }
    void wait() const { check(cudaStreamSynchronize(stream_), "finish its work"); }

  private:
    cudaStream_t stream_ = nullptr;
};

/// Zero-initialised memory of a device.
template <class T>
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t count) : count_(count) {
        if (count == 0) return;
        check(cudaMalloc(&data_, count * sizeof(T)), "find memory");
        check(cudaMemset(data_, 0, count * sizeof(T)), "clear memory");
    }
    explicit Buffer(std::vector<T> const& host) : Buffer(host.size()) {
        if (count_ > 0) check(cudaMemcpy(data_, host.data(), count_ * sizeof(T), cudaMemcpyHostToDevice), "copy to its memory");
    }
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

/// D numbers for each of `size` bodies and one halo body on either side, as BasicField on the host.
template <int D>
class DeviceField {
  public:
    DeviceField() = default;
    explicit DeviceField(std::int64_t size)
        : size_(size), pitch_((size + 2 * halo + 7) / 8 * 8), data_(static_cast<std::size_t>(D * pitch_)) {}
    View<D> view() const { return data_.data() ? View<D>{data_.data() + halo, pitch_, size_} : View<D>{}; }

    /// With its halo; a view without origin leaves zeros.
    void upload(ConstView<D> host, cudaStream_t stream) const {
        copy(data_.data() + halo - 1, pitch_, host.origin ? host.origin - 1 : nullptr, host.pitch, cudaMemcpyHostToDevice, stream);
    }
    void download(View<D> host, cudaStream_t stream) const {
        copy(host.origin ? host.origin - 1 : nullptr, host.pitch, data_.data() + halo - 1, pitch_, cudaMemcpyDeviceToHost, stream);
    }

  private:
    static constexpr std::int64_t halo = 8;
    void copy(double* to, std::int64_t to_pitch, double const* from, std::int64_t from_pitch, cudaMemcpyKind kind,
              cudaStream_t stream) const {
        if (!to || !from || size_ == 0) return;
        check(cudaMemcpy2DAsync(to, static_cast<std::size_t>(to_pitch) * sizeof(double), from,
                                static_cast<std::size_t>(from_pitch) * sizeof(double), static_cast<std::size_t>(size_ + 2) * sizeof(double),
                                D, kind, stream),
              "move a field");
    }
    std::int64_t size_ = 0, pitch_ = 0;
    Buffer<double> data_;
};

}  // namespace catena::cuda
