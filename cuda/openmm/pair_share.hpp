// Force decomposition: a rank's share of the pairs of beads that all ranks know
// (force/pair_decomposition.hpp). Exchanges then sum the forces on its own beads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/exchange/ghost_inboxes.hpp"
#include "cuda/openmm/gpu_path.hpp"
#include "neighbours/halo.hpp"
#include "neighbours/shared_particles.hpp"

namespace catena::cuda {

/// Enqueues the sending of positions of `count` own beads to the other ranks' inboxes.
void send(std::int64_t count, SentPositions const&, cudaStream_t);
/// Enqueues the copy of `count` arrived positions to OpenMM's arrays.
void take(std::int64_t count, ArrivedPositions const&, cudaStream_t);
/// Enqueues the sending of forces on other ranks' beads.
template <class Number>
void send(SentForces<Number> const&, cudaStream_t);
/// Enqueues the addition of forces that other ranks computed on `count` own beads.
template <class Number>
void add(std::int64_t count, ReturnedForces<Number> const&, cudaStream_t);
/// Enqueues a barrier between the streams of all ranks.
void meet(PeerBoxes const&, cudaStream_t);

/// Shares the pairs among ranks and exchanges positions and forces.
class PairShare {
  public:
    /// `halo`: a Halo that shares pairs. OpenMM's CUDA context must be current when the object is
    /// made.
    explicit PairShare(Halo& halo) : halo_(halo) {}
    /// Prepares the buffers; to be called whenever lists of positions are made, before their use.
    /// `direct`: GPUs write to each other's memory. Returns true if they do so here too.
    /// Collective.
    bool fit(bool direct);
    /// Chooses this rank's pairs in each of the Contexts: that of all particles and those of the
    /// layers, the same at every call. To be called before each evaluation. `new_order`: OpenMM's
    /// particles were reordered. Returns true if all pair lists are rebuilt; otherwise the caller
    /// has kept the previous ones. Collective.
    bool choose(std::span<OpenMmOnDevice* const> contexts, bool new_order);
    /// True if OpenMM keeps a pair list on some rank, as far as is known: in Context i, in any.
    bool has_list(std::size_t i) const { return i < has_list_.size() && has_list_[i]; }
    bool has_list() const {
        return std::find(has_list_.begin(), has_list_.end(), true) != has_list_.end();
    }
    /// Keeps the lists of the Contexts that have one; see PairList.
    void keep_lists(std::span<OpenMmOnDevice* const> contexts) const;
    /// Returns the distance, nm, that particles may move before a list must be rebuilt. All lists
    /// are then rebuilt at once, by all ranks.
    double lists_last(std::span<OpenMmOnDevice* const> contexts) const;
    /// Sets the places of beads in OpenMM's arrays. Own beads are listed in the order in which they
    /// are sent, others in the order in which they are received.
    void place(std::span<std::int32_t const> own, std::span<std::int32_t const> others);
    // The next three enqueue work for ranks whose GPUs write to each other's memory; `position` is
    // DeviceParticles::position.

    /// Sends own beads' positions to all other ranks' inboxes.
    void send_positions(float const* position, GhostInboxes const& inboxes, cudaStream_t) const;
    /// Barrier between the ranks' streams, after which all positions sent before it have arrived.
    void wait_for_positions(cudaStream_t) const;
    /// Copies arrived positions of other ranks' beads to OpenMM's arrays.
    void take_positions(float* position, GhostInboxes const& inboxes, cudaStream_t) const;
    /// Sends forces on other ranks' beads to these ranks and adds those that arrive from there. It
    /// is called after OpenMM's work was enqueued. Every rank must have used the forces of the
    /// previous evaluation. Collective unless GPUs write to each other's memory.
    void complete(DeviceParticles const&, cudaStream_t);

  private:
    /// Number of own beads.
    std::int64_t own() const { return static_cast<std::int64_t>(halo_.lists().sent.size()); }
    /// Number of forces sent, which act on other ranks' beads.
    std::int64_t sent() const { return static_cast<std::int64_t>(halo_.lists().particle.size()); }
    /// Number of forces received: one per own bead and other rank.
    std::int64_t received() const { return own() * static_cast<std::int64_t>(messages_.size()); }
    /// Evens the shares in each Context by the sizes of the ranks' lists. Collective.
    void even_out(std::span<OpenMmOnDevice* const> contexts);
    /// Exchanges forces from GPU to GPU.
    template <class Number>
    void exchange(DeviceParticles const&, cudaStream_t) const;
    /// Exchanges forces through the hosts' memory.
    void exchange_by_host(DeviceParticles const&, cudaStream_t);
    /// Adds the arrived forces to those on own beads.
    template <class Number>
    void add_arrived(Number* arrived, DeviceParticles const&, cudaStream_t) const;
    /// Carries forces through pinned memory and messages between hosts. Collective.
    void carry_by_host(cudaStream_t);

    Halo& halo_;
    std::vector<Halo::Message> messages_;  // messages of forces: those of positions, reversed
    /// Boundaries of the ranks' shares in each Context's row of blocks, fractions.
    std::vector<std::vector<double>> cuts_;
    std::int64_t evaluations_ = 0;
    std::vector<bool> has_list_;             // for each Context
    std::unique_ptr<GhostInboxes> inboxes_;  // null: forces pass through the host
    std::shared_ptr<PeerMemory> memory_;
    PeerBoxes boxes_;
    Room<Buffer<std::int32_t>> place_of_own_, place_of_others_;
    Buffer<std::int64_t> sent_, arrived_;
    std::unique_ptr<PinnedBuffer<std::int64_t>> out_, in_;
};

}  // namespace catena::cuda
