// Fields on a GPU: counterparts of the host's BasicField and DirectionsField, in the order
// gpu_order. Kernels on the device convert between the host's order and this one.
#pragma once

#include "cuda/device/owners.hpp"
#include "dca/solver.hpp"

namespace catena::cuda {

namespace kernels {

/// Copies the columns of bodies `begin` to `end` - 1 from the host's order to gpu_order, one grid
/// row per column. `host` and `device` are the addresses of body 0 in the first column; pitches are
/// in numbers.
static __global__ void to_gpu_order(double const* host, std::int64_t host_pitch, double* device,
                                    std::int64_t pitch, std::int64_t begin, std::int64_t end) {
    std::int64_t const k = begin + static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (k < end)
        device[gpu_order::first_number(k, pitch) + blockIdx.y * gpu_order::lanes] =
            host[blockIdx.y * host_pitch + k];
}
/// Copies columns in the opposite direction.
static __global__ void to_host_order(double const* device, std::int64_t pitch, double* host,
                                     std::int64_t host_pitch, std::int64_t begin,
                                     std::int64_t end) {
    std::int64_t const k = begin + static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (k < end)
        host[blockIdx.y * host_pitch + k] =
            device[gpu_order::first_number(k, pitch) + blockIdx.y * gpu_order::lanes];
}

}  // namespace kernels

/// Temporary memory allocated and freed in the order of a stream; `numbers` doubles.
class Scratch {
  public:
    Scratch(std::int64_t numbers, cudaStream_t stream) : stream_(stream) {
        void* memory = nullptr;
        check(cudaMallocAsync(&memory, static_cast<std::size_t>(numbers) * sizeof(double), stream),
              "allocate memory");
        data_ = static_cast<double*>(memory);
    }
    ~Scratch() { cudaFreeAsync(data_, stream_); }
    Scratch(Scratch const&) = delete;
    Scratch& operator=(Scratch const&) = delete;
    double* data() const { return data_; }

  private:
    double* data_ = nullptr;
    cudaStream_t stream_;
};

/// Columns of doubles for bodies `first_body` to `first_body + count - 1`, in gpu_order.
class DeviceColumns {
  public:
    DeviceColumns() = default;
    DeviceColumns(std::int64_t first_body, std::int64_t count, int columns)
        : first_(first_body),
          count_(count),
          columns_(columns),
          data_(static_cast<std::size_t>(
              count > 0 ? pitch() + gpu_order::padded(first_body + count) * columns : 0)) {}
    /// Address of body 0 in the first column; null without memory. The row of the halo precedes it.
    double* origin() const { return data_.data() ? data_.data() + pitch() : nullptr; }
    std::int64_t pitch() const { return gpu_order::pitch(columns_); }
    int columns() const { return columns_; }

    /// Enqueues the copy from the host. `host` is the address of body 0 in the first column.
    void upload(double const* host, std::int64_t host_pitch, cudaStream_t stream) const {
        if (!host || !origin()) return;
        Scratch const plain(count_ * columns_, stream);
        copy_columns(plain.data(), count_, host + first_, host_pitch, count_, columns_,
                     cudaMemcpyHostToDevice, stream);
        kernels::to_gpu_order<<<grid(), threads, 0, stream>>>(
            plain.data() - first_, count_, origin(), pitch(), first_, first_ + count_);
        check(cudaGetLastError(), "start a kernel");
    }
    /// Enqueues the copy to the host.
    void download(double* host, std::int64_t host_pitch, cudaStream_t stream) const {
        if (!host || !origin()) return;
        Scratch const plain(count_ * columns_, stream);
        kernels::to_host_order<<<grid(), threads, 0, stream>>>(
            origin(), pitch(), plain.data() - first_, count_, first_, first_ + count_);
        check(cudaGetLastError(), "start a kernel");
        copy_columns(host + first_, host_pitch, plain.data(), count_, count_, columns_,
                     cudaMemcpyDeviceToHost, stream);
    }

  private:
    static constexpr int threads = 256;
    dim3 grid() const {
        return {static_cast<unsigned>((count_ + threads - 1) / threads),
                static_cast<unsigned>(columns_)};
    }
    std::int64_t first_ = 0, count_ = 0;
    int columns_ = 0;
    Buffer<double> data_;
};

/// Field of D numbers for each of `size` bodies and for one halo body on either side.
template <int D>
class DeviceField {
  public:
    DeviceField() = default;
    explicit DeviceField(std::int64_t size)
        : size_(size), columns_(-1, size > 0 ? size + 2 : 0, D) {}
    View<D> view() const {
        return columns_.origin() ? View<D>{columns_.origin(), columns_.pitch(), size_} : View<D>{};
    }
    std::int64_t size() const { return size_; }
    /// Copies a host's view with its halo. A view without origin leaves the field unchanged.
    void upload(ConstView<D> host, cudaStream_t stream) const {
        columns_.upload(host.origin, host.pitch, stream);
    }
    void download(View<D> host, cudaStream_t stream) const {
        columns_.download(host.origin, host.pitch, stream);
    }

  private:
    std::int64_t size_ = 0;
    DeviceColumns columns_;
};

/// Field of `directions` numbers per body, known at run time; without a halo.
class DeviceDirections {
  public:
    DeviceDirections() = default;
    DeviceDirections(std::int64_t size, int directions)
        : size_(size), columns_(0, size, directions) {}
    DirectionsView view() const { return {columns_.origin(), columns_.pitch()}; }
    std::int64_t size() const { return size_; }
    int directions() const { return columns_.columns(); }
    void upload(ConstDirectionsView host, cudaStream_t stream) const {
        columns_.upload(host.origin, host.pitch, stream);
    }
    void download(DirectionsView host, cudaStream_t stream) const {
        columns_.download(host.origin, host.pitch, stream);
    }

  private:
    std::int64_t size_ = 0;
    DeviceColumns columns_;
};

}  // namespace catena::cuda
