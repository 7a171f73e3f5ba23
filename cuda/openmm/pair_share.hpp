// A rank's share of the pairs of beads that all ranks know (force/pair_decomposition.hpp), and its
// way to the whole forces on its own beads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/exchange/ghost_inboxes.hpp"
#include "cuda/openmm/gpu_path.hpp"
#include "neighbours/halo.hpp"
#include "neighbours/shared_particles.hpp"

namespace catena::cuda {

/// Each for so many beads.
void send(std::int64_t count, SentPositions const&, cudaStream_t);
void take(std::int64_t count, ArrivedPositions const&, cudaStream_t);
template <class Number>
void send(SentForces<Number> const&, cudaStream_t);
template <class Number>
void add(std::int64_t count, ReturnedForces<Number> const&, cudaStream_t);
/// Once the stream comes here it waits until every rank's has.
void meet(PeerBoxes const&, cudaStream_t);

class PairShare {
  public:
    /// Of a Halo that shares pairs, as everything that lives in OpenMM's CUDA context is made
    /// there.
    explicit PairShare(Halo& halo) : halo_(halo) {}
    /// Whenever lists of positions are made, before they are of use. `direct`: GPUs write to each
    /// other's memory. Whether they do so here. Collective.
    bool fit(bool direct);
    /// Before each evaluation: which pairs are this rank's. `new_order`: of OpenMM's particles.
    /// Whether their list is made anew; if not, the caller has kept the one before. Collective.
    bool choose(OpenMmOnDevice&, bool new_order);
    /// Whether some rank's OpenMM keeps a list of pairs, as far as is known.
    bool has_list() const { return has_list_; }
    /// Where beads stand in OpenMM's arrays from now on, own ones in the sequence in which they are
    /// sent, others in that in which they are received.
    void place(std::span<std::int32_t const> own, std::span<std::int32_t const> others);
    // Where GPUs write to each other's memory, each once the stream comes to it; `position`:
    // DeviceParticles's.
    /// Own beads' positions go to all other ranks' inboxes.
    void send_positions(float const* position, GhostInboxes const& inboxes, cudaStream_t) const;
    /// Every rank's stream has come here: what they were given before has arrived.
    void wait_for_positions(cudaStream_t) const;
    void take_positions(float* position, GhostInboxes const& inboxes, cudaStream_t) const;
    /// Once OpenMM has been given its work: forces on other ranks' beads go to these, and what
    /// comes from there is added. Forces of the evaluation before must have been used on every
    /// rank. Collective where GPUs do not write to each other's memory.
    void complete(DeviceParticles const&, cudaStream_t);

  private:
    std::int64_t own() const { return static_cast<std::int64_t>(halo_.lists().sent.size()); }
    std::int64_t sent() const {
        return static_cast<std::int64_t>(halo_.lists().particle.size());
    }  // forces, on beads of others
    std::int64_t received() const { return own() * static_cast<std::int64_t>(messages_.size()); }
    /// From GPU to GPU.
    template <class Number>
    void exchange(DeviceParticles const&, cudaStream_t) const;
    void exchange_by_host(DeviceParticles const&, cudaStream_t);
    template <class Number>
    void add_arrived(Number* arrived, DeviceParticles const&, cudaStream_t) const;
    void carry_by_host(cudaStream_t);

    Halo& halo_;
    std::vector<Halo::Message> messages_;  // with forces: those of positions, the other way
    std::vector<double> cuts_;             // of the row of blocks, between ranks
    std::int64_t evaluations_ = 0;
    bool has_list_ = false;
    std::unique_ptr<GhostInboxes> inboxes_;  // null: forces pass through the host
    std::shared_ptr<PeerMemory> memory_;
    PeerBoxes boxes_;
    Room<Buffer<std::int32_t>> place_of_own_, place_of_others_;
    Buffer<std::int64_t> sent_, arrived_;
    std::unique_ptr<PinnedBuffer<std::int64_t>> out_, in_;
};

}  // namespace catena::cuda
