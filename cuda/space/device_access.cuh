// Loops on a stream of a GPU, and the host's access to what lies in the GPU's memory.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "cuda/device/launch.cuh"
#include "cuda/exchange/peer_memory.hpp"
#include "cuda/space/device_field.cuh"
#include "cuda/space/kernels.cuh"

namespace catena::cuda {

/// Returns the address of body k's first number in the GPU's memory.
template <class Real, int D>
Real* number_of(FieldView<Real, D> const& field, std::int64_t k) {
    return field.origin + gpu_order::first_number(k, field.pitch);
}

/// A stream of the current GPU with loops over bodies and copies of values, bodies and fields. Its
/// members behave as those of HostSpace. Copies share the stream and the memory for answers, so
/// that only one thread at a time may call largest() or get().
class DeviceAccess {
  public:
    DeviceAccess()
        : stream_(std::make_shared<Stream>()),
          answer_(std::make_shared<Buffer<unsigned long long>>(1)),
          letter_(std::make_shared<PinnedBuffer<double>>(most_of_a_body)) {}
    cudaStream_t stream() const { return stream_->get(); }
    /// Waits until all work of the stream is complete.
    void wait() const { stream_->wait(); }

    /// Calls action(k) for k < count.
    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        if (count == 0) return;
        launch({blocks(gpu_order::padded(count)), kernels::threads}, stream(),
               kernels::for_each<Action>, count, action);
    }
    /// Calls action(item) for each item.
    template <class T, class Action>
    void over(Buffer<T> const& items, Action const& action) const {
        if (items.size() == 0) return;
        auto const count = static_cast<std::int64_t>(items.size());
        launch({blocks(count), kernels::threads}, stream(), kernels::over<T, Action>, items.data(),
               count, action);
    }
    /// Returns the largest |value(i)|, i < count, or NaN if a value is NaN. Waits.
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        if (count == 0) return 0;
        set_answer(0);
        launch({blocks(count), kernels::threads}, stream(), kernels::largest<Value>, count,
               answer_->data(), value);
        unsigned long long const bits = get(answer_->data());
        double found;
        std::memcpy(&found, &bits, sizeof(found));
        return found;
    }

    /// Returns the value at `place` in the GPU's memory. Waits.
    template <class T>
    T get(T const* place) const {
        T value;
        check(cudaMemcpyAsync(&value, place, sizeof(T), cudaMemcpyDeviceToHost, stream()),
              "return a value");
        wait();
        return value;
    }
    /// Writes a value to `place` in the GPU's memory. Waits.
    template <class T>
    void put(T* place, T const& value) const {
        check(cudaMemcpyAsync(place, &value, sizeof(T), cudaMemcpyHostToDevice, stream()),
              "receive a value");
        wait();  // `value` may go out of scope
    }
    /// Returns the numbers of body k. Waits.
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        static_assert(D <= most_of_a_body);
        for_each(D, kernels::TakeBody{number_of(field, k), letter_->data()});
        wait();
        Vector<double, D> value;
        std::copy_n(letter_->data(), D, value.data);
        return value;
    }
    /// Writes the numbers of body k.
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        for_each(D, kernels::PutBody<D>{number_of(field, k), value});
    }
    /// Returns a copy of the field on the host. Waits.
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
    /// Overwrites the field with the host's values. Waits.
    void write(DeviceDirections& directions, DirectionsField const& host) const {
        directions.upload(host.view(), stream());
        wait();
    }
    /// Calls change(view) on a host copy of the field and writes it back. Waits.
    template <int D, class Edit>
    void edit(DeviceField<D>& field, Edit const& change) const {
        give_back(field, read(field), change);
    }
    /// Calls all(view) on a field of zeros on the host and writes it to the GPU. Waits.
    template <int D, class Set>
    void set(DeviceField<D>& field, Set const& all) const {
        give_back(field, Field<D>(field.size()), all);
    }
    /// Host copy of a field, in pinned memory if it is large.
    template <int D>
    struct Mirror {
        Field<D> field;
        PinnedPages pages = {};  // pins the field's memory
    };
    /// Copies the field to its mirror and returns the mirror's view. Waits.
    template <int D>
    View<D> pull(DeviceField<D>& field, Mirror<D>& mirror) const {
        if (mirror.field.size() != field.size()) {
            mirror.pages = PinnedPages();
            mirror.field = Field<D>(field.size());
            mirror.pages = PinnedPages(mirror.field.storage());
        }
        field.download(mirror.field.view(), stream());
        wait();
        return mirror.field.view();
    }
    /// Enqueues the copy of the mirror to the field.
    template <int D>
    void push(DeviceField<D>& field, Mirror<D> const& mirror) const {
        field.upload(mirror.field.view(), stream());
    }

  protected:
    std::shared_ptr<Stream> const& shared_stream() const { return stream_; }

  private:
    /// Returns the number of blocks for `count` threads.
    static unsigned blocks(std::int64_t count) {
        return static_cast<unsigned>((count + kernels::threads - 1) / kernels::threads);
    }
    /// Sets all bytes of the answer to `byte`.
    void set_answer(int byte) const {
        check(cudaMemsetAsync(answer_->data(), byte, sizeof(unsigned long long), stream()),
              "be queried");
    }
    /// Applies `change` to a host field and uploads it.
    template <int D, class Change>
    void give_back(DeviceField<D>& field, Field<D> host, Change const& change) const {
        change(host.view());
        field.upload(std::as_const(host).view(), stream());
        wait();
    }

    std::shared_ptr<Stream> stream_;
    std::shared_ptr<Buffer<unsigned long long>> answer_;  // memory for the answer of largest()
    std::shared_ptr<PinnedBuffer<double>> letter_;        // memory for the answer of get()
};

}  // namespace catena::cuda
