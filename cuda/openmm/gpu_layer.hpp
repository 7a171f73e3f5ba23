// A layer of forces on the GPU: some of the particles in a Context of their own, which computes
// beside the Context of all particles (neighbours/layer_particles.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/openmm/pair_list.hpp"
#include "neighbours/device_path.hpp"
#include "neighbours/layer_particles.hpp"

namespace catena::cuda {

/// Enqueues the copy of positions to the `count` particles of a layer.
template <class Number>
void copy(std::int64_t count, LayerPositions<Number> const&, cudaStream_t);
/// Enqueues the addition of a layer's forces.
void add(LayerForces const&, cudaStream_t);

/// One layer. Its work runs in a stream of its own.
class GpuLayer {
  public:
    /// OpenMM's CUDA context must be current.
    explicit GpuLayer(DeviceLayer layer);

    OpenMmOnDevice& openmm() { return *openmm_; }
    /// Brings the layer's particles into a new order, by position. `of_particle`: x, y, z of all
    /// particles, nm; `place`: their places in OpenMM's arrays.
    void order(std::span<double const> of_particle, std::span<std::int32_t const> place);
    /// Enqueues the copy of positions from `all` particles, which are complete at `complete`.
    void put(DeviceParticles const& all, Event const& complete);
    /// Enqueues OpenMM's computation of forces with a list that is kept or rebuilt. It is rebuilt
    /// if particles have a new order, or one of them has moved too far. The call then waits for
    /// the positions.
    void choose_list_and_compute(bool new_order);
    /// Enqueues OpenMM's computation of forces with the list that the caller has chosen.
    void compute();
    /// Makes `stream` wait for the layer's forces and add them to those on `all` particles.
    void add_to(DeviceParticles const& all, cudaStream_t stream) const;
    DevicePath::PairLists pair_lists() const { return pair_lists_; }

  private:
    std::int64_t count() const { return std::ssize(layer_.particle); }
    /// Copies positions, and checks how far particles have moved since `listed` (may be null).
    template <class Number>
    void put(Number const* all, void const* listed);
    /// Records if the list is rebuilt. If so, particles that move far from their present positions
    /// are detected from now on.
    void note_list(bool anew);

    DeviceLayer layer_;
    std::unique_ptr<OpenMmOnDevice> openmm_;
    PairList list_;
    OpenMmArrays arrays_;
    cudaStream_t stream_ = nullptr;
    Buffer<std::int32_t> from_;  // LayerPositions::from
    PinnedBuffer<std::int64_t> far_{1};
    ListedPositions listed_;
    /// Positions in `listed_` in the present order; null if it has none.
    void const* listed_positions_ = nullptr;
    float farthest_squared_ = 0;
    Event placed_{Event::For::order}, computed_{Event::For::order};
    DevicePath::PairLists pair_lists_;
};

}  // namespace catena::cuda
