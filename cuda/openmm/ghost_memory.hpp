// Memory of the positions that ranks exchange: own beads that are ghosts of other ranks, and the
// ghosts that arrive.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cuda/exchange/ghost_inboxes.hpp"
#include "cuda/openmm/gpu_path.hpp"
#include "neighbours/halo.hpp"

namespace catena::cuda {

/// Own beads that are ghosts of other ranks: where each is written in the messages, and memory for
/// the messages on the GPU and in pinned memory of the host.
class ShownMessages {
  public:
    /// `far`, `trouble`: addresses of the flags that kernels set; see ShownBeads.
    ShownMessages(Halo const& halo, std::int64_t* far, std::int64_t* trouble)
        : halo_(halo), far_(far), trouble_(trouble) {}
    /// Provides room for the messages on the host.
    void fit() { out_.of(lists().sent.size()); }
    /// Uploads, for each own bead at `x` (nm), the places in messages to which it is written.
    /// Waits.
    void list(std::vector<Vec3> const& x, cudaStream_t stream);
    /// Enqueues the gathering of all messages in GPU memory. `written` orders the streams: that of
    /// the last group waits for all others.
    void gather(std::span<DeviceBeads* const> beads, Event& written) const;
    /// Returns the gathered messages, x, y, z of each position, nm.
    double const* messages() const { return shown_.shown; }
    /// Returns the messages on the host.
    std::span<Vec3> out() const { return {(*out_).data(), lists().sent.size()}; }
    /// Enqueues the copy of the messages to the host.
    void to_host(cudaStream_t stream) const;

  private:
    Halo::Lists const& lists() const { return halo_.lists(); }

    Halo const& halo_;
    std::int64_t *far_, *trouble_;
    ShownBeads shown_;
    Room<Buffer<std::int32_t>> first_, place_;
    Room<Buffer<double>> from_, show_;
    Room<PinnedBuffer<Vec3>> out_;
};

/// Ghosts of a rank: their places in OpenMM's arrays, and memory for their positions on the GPU and
/// in pinned memory of the host.
class ArrivedGhosts {
  public:
    /// `trouble`: address of the flag for a ghost whose position is not finite.
    ArrivedGhosts(Halo const& halo, std::int64_t* trouble) : halo_(halo), trouble_(trouble) {}
    /// Provides room for the ghosts on the host.
    void fit() { in_.of(lists().particle.size()); }
    /// Returns the positions on the host.
    std::span<Vec3> in() const { return {(*in_).data(), lists().particle.size()}; }
    /// Copies the inbox to the host. Waits.
    void look_into(GhostInboxes const& inboxes, cudaStream_t stream);
    /// Sets the places in OpenMM's arrays: `beads` are those of ghosts, then those of particles
    /// that stand for no bead, which are put aside. Waits.
    void place(std::vector<DeviceBead> const& beads, DeviceParticles const& particles,
               cudaStream_t stream);
    /// Enqueues the copy of the ghosts' positions to OpenMM's arrays: from the inbox, or from the
    /// host if `inboxes` is null.
    void put(GhostInboxes const* inboxes, DeviceParticles const& particles,
             cudaStream_t stream) const;

  private:
    Halo::Lists const& lists() const { return halo_.lists(); }
    /// Returns the description of ghosts from number `first` on, for cuda::put().
    ArrivedBeads from(std::size_t first, DeviceParticles const& particles) const;

    Halo const& halo_;
    std::int64_t* trouble_;
    Room<Buffer<double>> arrived_;
    Room<Buffer<DeviceBead>> bead_;
    Room<PinnedBuffer<Vec3>> in_;
};

}  // namespace catena::cuda
