// Implements a layer of forces on the GPU.
#include "cuda/openmm/gpu_layer.hpp"

#include <utility>

#include "cuda/openmm/gpu_path.hpp"

namespace catena::cuda {

GpuLayer::GpuLayer(DeviceLayer layer)
    : layer_(std::move(layer)),
      openmm_(on_device(*layer_.context)),
      list_(*openmm_, layer_.keeps_list && why_pairs_cannot_be_shared().empty()),
      from_(layer_.particle.size()) {
    openmm_->take_own_stream();
    arrays_ = openmm_->arrays();
    stream_ = static_cast<cudaStream_t>(arrays_.stream);
    *far_.data() = 0;
}

void GpuLayer::order(std::span<double const> of_particle, std::span<std::int32_t const> place) {
    check(cudaStreamSynchronize(stream_), "finish its work");
    std::vector<double> positions;
    positions.reserve(3 * layer_.particle.size());
    for (int const particle : layer_.particle)
        for (int c = 0; c < 3; ++c)
            positions.push_back(
                of_particle[3 * static_cast<std::size_t>(particle) + static_cast<std::size_t>(c)]);
    std::vector<int> const& particle_at = openmm_->order(positions);
    std::vector<std::int32_t> from;
    for (std::size_t i = 0; i < layer_.particle.size(); ++i)
        from.push_back(place[static_cast<std::size_t>(
            layer_.particle[static_cast<std::size_t>(particle_at[i])])]);
    check(cudaMemcpy(from_.data(), from.data(), from.size() * sizeof(from.front()),
                     cudaMemcpyHostToDevice),
          "receive OpenMM's order");
    check(cudaStreamSynchronize(nullptr), "receive OpenMM's order");
    arrays_ = openmm_->arrays();
    listed_positions_ = nullptr;
}

template <class Number>
void GpuLayer::put(Number const* all, void const* listed) {
    LayerPositions<Number> positions{from_.data(), all, static_cast<Number*>(arrays_.position)};
    positions.listed = static_cast<Number const*>(listed);
    positions.farthest_squared = farthest_squared_;
    positions.far = far_.data();
    copy(count(), positions, stream_);
}

void GpuLayer::put(DeviceParticles const& all, Event const& complete) {
    complete.hold(stream_);
    if (all.double_position)
        put<double>(all.double_position, listed_positions_);
    else
        put<float>(all.position, listed_positions_);
    placed_.record(stream_);
}

void GpuLayer::note_list(bool anew) {
    ++(anew ? pair_lists_.made : pair_lists_.kept);
    if (!anew) return;
    listed_.take(arrays_, stream_);
    listed_positions_ = listed_.data();
    auto const lasts = static_cast<float>(openmm_->list_lasts());
    farthest_squared_ = lasts * lasts;
}

void GpuLayer::choose_list_and_compute(bool new_order) {
    if (list_.is_kept()) {
        placed_.wait();
        bool const far = std::exchange(*far_.data(), 0) != 0;
        note_list(list_.choose(far || new_order));
    }
    compute();
    list_.note_evaluation();
}

void GpuLayer::compute() {
    openmm_->compute();
    computed_.record(stream_);
}

void GpuLayer::add_to(DeviceParticles const& all, cudaStream_t stream) const {
    computed_.hold(stream);
    add({{all.force, all.places, from_.data()},
         static_cast<std::int64_t const*>(arrays_.force),
         arrays_.places,
         count()},
        stream);
}

}  // namespace catena::cuda
