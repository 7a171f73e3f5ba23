// The Space of a GPU (dca/host_space.hpp says what its members promise): a kernel a loop, all on one stream.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>

#include "cuda/device_model.hpp"
#include "dca/host_space.hpp"

namespace catena::cuda {

namespace kernels {

constexpr int threads = 128, most_in_one_block = 256;  // that many threads find registers for merges of every K

__device__ inline std::int64_t thread() { return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; }

template <class Action>
__global__ void for_each(std::int64_t count, Action action) {
    if (std::int64_t const i = thread(); i < count) action(i);
}
template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}
/// Levels that fit into one block each, one after the other: offset[l] to offset[l + 1], from level `first` on in steps of `step`.
template <class Item, class Action>
__global__ void small_levels(Item const* items, std::int64_t const* offset, int first, int count, int step, Action action) {
    for (int l = 0; l < count; ++l) {
        std::int64_t const begin = offset[first + l * step], end = offset[first + l * step + 1];
        if (begin + threadIdx.x < end) action(items[begin + threadIdx.x]);
        __syncthreads();
    }
}
template <class Predicate>
__global__ void first_that(std::int64_t count, unsigned long long* found, Predicate predicate) {
    if (std::int64_t const i = thread(); i < count && predicate(i)) atomicMin(found, static_cast<unsigned long long>(i));
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

class DeviceSpace {
  public:
    /// Copies share the stream and the place for answers: one thread at a time asks first() or largest().
    DeviceSpace() : stream_(std::make_shared<Stream>()), answer_(std::make_shared<Buffer<unsigned long long>>(1)) {}
    cudaStream_t stream() const { return stream_->get(); }

    template <class T>
    using Array = Buffer<T>;
    template <int D>
    using FieldOf = DeviceField<D>;
    using Directions = DeviceDirections;
    template <class T>
    using List = Buffer<T>;
    template <int D>
    using Fixed = FixedField<D>;
    using Model = DeviceModel;
    template <class T>
    class Levels {
      public:
        explicit Levels(std::vector<std::vector<T>> const& levels) : offset_{0} {
            std::vector<T> all;
            for (std::vector<T> const& level : levels) {
                all.insert(all.end(), level.begin(), level.end());
                offset_.push_back(std::ssize(all));
            }
            items_ = Buffer<T>(all);
            device_offset_ = Buffer<std::int64_t>(offset_);
        }
        int count() const { return static_cast<int>(offset_.size()) - 1; }
        std::int64_t size(int level) const { return offset_[level + 1] - offset_[level]; }
        T const* begin(int level) const { return items_.data() + offset_[level]; }
        T const* items() const { return items_.data(); }
        std::int64_t const* offset() const { return device_offset_.data(); }

      private:
        std::vector<std::int64_t> offset_;
        Buffer<T> items_;
        Buffer<std::int64_t> device_offset_;
    };

    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        if (count == 0) return;
        kernels::for_each<<<blocks(count), kernels::threads, 0, stream()>>>(count, action);
        started();
    }
    template <class T, class Action>
    void over(Buffer<T> const& items, Action const& action) const {
        over(items.data(), static_cast<std::int64_t>(items.size()), action);
    }
    template <class T, class Action>
    void climb(Levels<T> const& levels, Action const& action) const {
        for (int l = 0; l < levels.count();) l += some_levels(levels, l, 1, action);
    }
    template <class T, class Action>
    void descend(Levels<T> const& levels, Action const& action) const {
        for (int l = levels.count() - 1; l >= 0;) l -= some_levels(levels, l, -1, action);
    }
    template <class Predicate>
    std::int64_t first(std::int64_t count, Predicate const& predicate) const {
        if (count == 0) return 0;
        set_answer(0xff);  // above every index
        kernels::first_that<<<blocks(count), kernels::threads, 0, stream()>>>(count, answer_->data(), predicate);
        started();
        unsigned long long const found = get(answer_->data());
        return found < static_cast<unsigned long long>(count) ? static_cast<std::int64_t>(found) : count;
    }
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        if (count == 0) return 0;
        set_answer(0);
        kernels::largest<<<blocks(count), kernels::threads, 0, stream()>>>(count, answer_->data(), value);
        started();
        unsigned long long const bits = get(answer_->data());
        double found;
        std::memcpy(&found, &bits, sizeof(found));
        return found;
    }

    template <class T>
    T get(T const* place) const {
        T value;
        check(cudaMemcpyAsync(&value, place, sizeof(T), cudaMemcpyDeviceToHost, stream()), "give back a value");
        wait();
        return value;
    }
    template <class T>
    void put(T* place, T const& value) const {
        check(cudaMemcpyAsync(place, &value, sizeof(T), cudaMemcpyHostToDevice, stream()), "take a value");
        wait();  // the source may go
    }
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        Vector<double, D> value;
        copy_columns(value.data, 1, field.origin + k, field.pitch, 1, D, cudaMemcpyDeviceToHost, stream());
        wait();
        return value;
    }
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        copy_columns(field.origin + k, field.pitch, value.data, 1, 1, D, cudaMemcpyHostToDevice, stream());
        wait();
    }
    template <int D>
    Field<D> read(DeviceField<D> const& field) const {
        Field<D> host(field.size());
        field.download(host.view(), stream());
        wait();
        return host;
    }
    DirectionsField read(DeviceDirections const& directions) const {
        DirectionsField host(directions.size(), directions.directions());
        directions.download(host.view(), stream());
        wait();
        return host;
    }
    template <int D, class Edit>
    void edit(DeviceField<D>& field, Edit const& change) const {
        Field<D> host = read(field);
        change(host.view());
        field.upload(std::as_const(host).view(), stream());
        wait();
    }
    template <int D>
    using Mirror = Field<D>;
    template <int D>
    View<D> pull(DeviceField<D>& field, Field<D>& mirror) const {
        if (mirror.size() != field.size()) mirror = Field<D>(field.size());
        field.download(mirror.view(), stream());
        wait();
        return mirror.view();
    }
    template <int D>
    void push(DeviceField<D>& field, Field<D> const& mirror) const {
        field.upload(mirror.view(), stream());
        wait();
    }

    void wait() const { stream_->wait(); }
    int threads() const { return 1; }

  private:
    static unsigned blocks(std::int64_t count) { return static_cast<unsigned>((count + kernels::threads - 1) / kernels::threads); }
    void set_answer(int byte) const { check(cudaMemsetAsync(answer_->data(), byte, sizeof(unsigned long long), stream()), "be asked"); }
    static void started() { check(cudaGetLastError(), "start a kernel"); }
    template <class T, class Action>
    void over(T const* items, std::int64_t count, Action const& action) const {
        if (count == 0) return;
        kernels::over<<<blocks(count), kernels::threads, 0, stream()>>>(items, count, action);
        started();
    }
    /// Level `first`, or as many from there on (in steps of `step`) as fit into one block each. Returns how many.
    template <class T, class Action>
    int some_levels(Levels<T> const& levels, int first, int step, Action const& action) const {
        int count = 0;
        std::int64_t widest = 0;
        for (int l = first; l >= 0 && l < levels.count() && levels.size(l) <= kernels::most_in_one_block; l += step, ++count)
            widest = std::max(widest, levels.size(l));
        if (count > 0 && widest == 0) return count;  // a rank may have none of a level's items
        if (count < 2) {
            over(levels.begin(first), levels.size(first), action);
            return 1;
        }
        auto const width = static_cast<unsigned>((widest + 31) / 32 * 32);
        kernels::small_levels<<<1, width, 0, stream()>>>(levels.items(), levels.offset(), first, count, step, action);
        started();
        return count;
    }
    std::shared_ptr<Stream> stream_;
    std::shared_ptr<Buffer<unsigned long long>> answer_;  // of first() and largest()
};

}  // namespace catena::cuda
