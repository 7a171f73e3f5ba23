// A rank's share of the pairs of beads that all ranks know (force/openmm_pairs.hpp), and its way to the whole forces on its own beads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/openmm_on_device.hpp"
#include "cuda/owners.hpp"
#include "cuda/peer_inboxes.hpp"
#include "force/device_beads.hpp"
#include "force/halo.hpp"

namespace catena::cuda {

/// Once the stream comes here it waits until every rank's has.
void meet(PeerBoxes const&, cudaStream_t);

class PairShare {
  public:
    /// Of a Halo that shares pairs, as everything that lives in OpenMM's CUDA context is made there.
    explicit PairShare(Halo& halo) : halo_(halo) {}
    /// Whenever lists of positions are made, before they are of use. `direct`: GPUs write to each other's memory. Whether they do so here.
    /// Collective.
    bool fit(bool direct);
    /// Before each evaluation: which pairs are this rank's. `new_order`: of OpenMM's particles. Whether their list is made anew.
    /// Collective.
    bool choose(OpenMmOnDevice&, bool new_order);
    /// Whether some rank's OpenMM keeps a list of pairs, as far as is known.
    bool has_list() const { return has_list_; }
    /// Once the stream comes here every rank's has: what they were given before, positions, has arrived. Where GPUs write to each other's
    /// memory.
    void wait_for_positions(cudaStream_t) const;
    /// Once OpenMM has been given its work: forces on other ranks' beads go to these, and what comes from there is added. Forces of the
    /// evaluation before must have been used on every rank. `own`: of this rank's beads, `others`: in the order of received positions.
    /// Collective where GPUs do not write to each other's memory.
    void complete(DeviceParticles const& own, DeviceParticles const& others, cudaStream_t);

  private:
    std::int64_t own() const { return static_cast<std::int64_t>(halo_.lists().sent.size()); }
    std::int64_t sent() const { return static_cast<std::int64_t>(halo_.lists().particle.size()); }  // forces, on beads of others
    std::int64_t received() const { return own() * static_cast<std::int64_t>(messages_.size()); }
    void clear_inbox(cudaStream_t) const;
    void carry_by_host(cudaStream_t);

    Halo& halo_;
    std::vector<Halo::Message> messages_;  // with forces: those of positions, the other way
    std::vector<double> cuts_;             // of the row of blocks, between ranks
    std::int64_t evaluations_ = 0;
    bool has_list_ = false;
    std::unique_ptr<PeerInboxes> inboxes_;  // null: forces pass through the host
    std::shared_ptr<PeerMemory> memory_;
    PeerBoxes boxes_;
    Buffer<std::int64_t> sent_, arrived_;
    std::unique_ptr<PinnedBuffer<std::int64_t>> out_, in_;
};

}  // namespace catena::cuda
