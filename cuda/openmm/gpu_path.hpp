// Coupling of beads with OpenMM's particles on one GPU: the part that is common to one rank and
// several ranks.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cuda/device/owners.hpp"
#include "cuda/openmm/gpu_layer.hpp"
#include "cuda/openmm/openmm_on_device.hpp"
#include "cuda/openmm/order_age.hpp"
#include "cuda/openmm/pair_list.hpp"
#include "cuda/openmm/room.hpp"
#include "neighbours/bead_tables.hpp"
#include "neighbours/device_path.hpp"
#include "neighbours/replica_places.hpp"

namespace catena::cuda {

/// Opens OpenMM's arrays of a Context, which must outlive the result.
std::unique_ptr<OpenMmOnDevice> on_device(OpenMM::Context&);

/// Returns the mean of the positions `x`.
Vec3 mean(std::span<Vec3 const> x);

/// Enqueues the copy of `count` arrived ghosts to their places in OpenMM's arrays.
void put(std::int64_t count, ArrivedBeads const&, cudaStream_t);

/// Returns the stream of a group of beads.
inline cudaStream_t stream_of(DeviceBeads const& group) {
    return static_cast<cudaStream_t>(group.stream());
}

/// Enqueues a copy of `count` elements from the host to `to`.
template <class T>
void upload(Buffer<T> const& to, T const* from, std::size_t count, cudaStream_t stream) {
    if (count > 0)
        check(cudaMemcpyAsync(to.data(), from, count * sizeof(T), cudaMemcpyHostToDevice, stream),
              "receive OpenMM's order");
}

/// Base class of the coupling: order of particles, positions to OpenMM, forces from OpenMM, timing.
class GpuPath : public DevicePath {
  public:
    /// `home`: a Context that outlives this object; the chains' and this object's GPU memory is
    /// allocated in its CUcontext. `evaluations`: number of evaluations after which particles are
    /// reordered (OrderAge).
    GpuPath(OpenMM::Context& home, DevicePathPlan plan, int evaluations);
    ~GpuPath() override;

    bool make_current() noexcept override { return home_->make_current(); }
    void finish(std::span<DeviceBeads* const> beads) override;
    Clock clock() override;
    std::vector<Vec3> positions() override;
    PairLists pair_lists() const override { return pair_lists_; }
    std::vector<PairLists> pair_lists_of_layers() const override;

  protected:
    /// Flags that kernels set in pinned memory. The flag `trouble` is the index of an own bead
    /// whose position or force is not finite, `of_ghosts` that of a ghost; -1: none. The
    /// flag `far` is 1 if a bead has moved too far for the current lists, `strayed` if one is too
    /// far from the centre of its replica.
    struct Flags {
        std::int64_t trouble = -1, far = 0, of_ghosts = -1, strayed = 0;
    };
    /// Events that time an evaluation and that order the streams of chains and OpenMM.
    struct Events {
        Event begun{Event::For::clock}, chains_begin{Event::For::clock},
            chains_end{Event::For::clock}, openmm_begin{Event::For::clock},
            openmm_end{Event::For::clock};
        Event positions{Event::For::order}, all_positions{Event::For::order},
            forces{Event::For::order};
    };

    /// Sets the Context that computes forces; null: none.
    void compute_with(std::unique_ptr<OpenMmOnDevice> openmm);
    /// Starts an evaluation, and its clock if `timed`.
    void start(std::span<DeviceBeads* const> beads, bool timed);
    /// Returns the number of an own bead whose position or force is not finite, or -1, and resets
    /// the flag.
    std::int64_t take_trouble();
    /// Sets the flag `trouble` if a position `x` of an own bead is not finite.
    void look_for_trouble(std::span<Vec3 const> x);
    /// True if a bead of the last evaluation was too far from the centre of its replica; resets the
    /// flag.
    bool take_strayed() { return std::exchange(flags_->data()->strayed, 0) != 0; }
    /// Returns the Context of all particles, then those of the layers.
    std::vector<OpenMmOnDevice*> contexts() const;
    /// Particles of the Context that are not own beads, with their positions in nm.
    struct Others {
        std::span<int const> particle;
        std::span<Vec3 const> position;
    };
    /// Brings OpenMM's particles into a new order, by position. `x`: positions of own beads, nm;
    /// `others`: the Context's other particles. `middle` becomes the origin if all particles may be
    /// moved by one vector.
    void order(std::vector<Vec3> const& x, std::span<Others const> others, Vec3 const& middle);
    /// Finds the places of replicas for the own beads at `x`, nm.
    void place_replicas(std::vector<Vec3> const& x);
    /// Returns the place of own bead i in OpenMM's arrays, and the place of its replica.
    DeviceBead bead_of_replica(std::size_t i) const;
    /// Returns the place in OpenMM's arrays and the periodic cell of a particle at `x`.
    DeviceBead bead_of(int particle, Vec3 const& x) const {
        return bead_at(place_[static_cast<std::size_t>(particle)], x, plan_.box);
    }
    /// Writes own beads' positions to OpenMM's arrays and makes OpenMM's stream wait for them.
    /// OpenMM has read the previous positions by then, because the chains' streams waited for its
    /// forces.
    void put_own(std::span<DeviceBeads* const> beads);
    /// Enqueues the copy of all particles' positions to the layers, after OpenMM's stream has them.
    void put_layers();
    /// Enqueues OpenMM's computation of forces, those of the layers included, and counts the
    /// evaluation.
    void compute(std::span<DeviceBeads* const> beads);
    /// Returns the time of an event of a timed evaluation, seconds of std::chrono::steady_clock.
    double at(Event const& event) const { return begun_ + event.seconds_since(events_->begun); }
    /// Enqueues OpenMM's computation of forces in the Context of all particles and in those of the
    /// layers.
    virtual void compute_contexts() = 0;
    /// Records before compute() if OpenMM's pair list is rebuilt (`anew`). If so, particles that
    /// move farther than `lasts` (nm) from their present positions are detected from now on.
    void note_list(bool anew, double lasts);
    /// Completes the forces within compute(), after OpenMM's work was enqueued; by default they are
    /// complete.
    virtual void complete_forces() {}
    DevicePathPlan plan_;
    std::unique_ptr<OpenMmOnDevice> home_, openmm_;
    cudaStream_t stream_ = nullptr;  // OpenMM's stream
    std::unique_ptr<PinnedBuffer<Flags>> flags_;
    std::unique_ptr<Events> events_;
    std::unique_ptr<Buffer<DeviceBead>> own_;
    ReplicaPlaces replicas_;                   // of own beads; empty without replicas
    std::unique_ptr<Buffer<double>> centres_;  // of the replica of each own bead, x, y, z, nm
    ListedPositions listed_;
    DeviceParticles particles_;
    std::vector<std::int32_t> place_;  // place of each particle in OpenMM's arrays
    std::vector<DeviceBeads*> beads_;  // groups of beads of the last evaluation
    OrderAge age_;
    bool timed_ = false;
    double begun_ = 0;   // time at which the evaluation began, s
    Interval exchange_;  // interval of the exchange, for clock()
    PairLists pair_lists_;
    std::vector<std::unique_ptr<GpuLayer>> layers_;
};

/// Makes the coupling of one rank among several.
std::unique_ptr<DevicePath> make_halo_path(OpenMM::Context& home, DevicePathPlan plan);

}  // namespace catena::cuda
