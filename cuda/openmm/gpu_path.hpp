// Beads and OpenMM's particles on one GPU. What one rank and several do alike.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cuda/device/owners.hpp"
#include "cuda/openmm/openmm_on_device.hpp"
#include "neighbours/bead_tables.hpp"
#include "neighbours/device_path.hpp"

namespace catena::cuda {

/// Of a Context that outlives it.
std::unique_ptr<OpenMmOnDevice> on_device(OpenMM::Context&);

Vec3 mean(std::span<Vec3 const> x);

/// Memory that grows where more is needed.
template <class Owner>
class Room {
  public:
    Owner& of(std::size_t count) {
        if (!owner_ || capacity_ < count) {
            owner_.reset();
            capacity_ = count + count / 8;
            owner_ = std::make_unique<Owner>(capacity_);
        }
        return *owner_;
    }
    Owner& operator*() const { return *owner_; }

  private:
    std::unique_ptr<Owner> owner_;
    std::size_t capacity_ = 0;
};

/// Ghosts that arrived go where they belong.
void put(std::int64_t count, ArrivedBeads const&, cudaStream_t);

class GpuPath : public DevicePath {
  public:
    /// `home`: a Context that outlives this; what the chains and this keep on the GPU is kept in
    /// its CUcontext. `evaluations`: particles are brought into a new order after so many.
    GpuPath(OpenMM::Context& home, DevicePathPlan plan, int evaluations);
    ~GpuPath() override;

    bool make_current() noexcept override { return home_->make_current(); }
    void finish(std::span<DeviceBeads* const> beads) override;
    Clock clock() override;
    std::vector<Vec3> positions() override;
    PairLists pair_lists() const override { return pair_lists_; }

  protected:
    /// OpenMM's own integrators bring particles into a new order after 250, which would be a
    /// twentieth of a step of 100,000 beads. Chains move little meanwhile: of a condensate of 7,143
    /// OpenMM's forces take as long before an order that comes after 6,600 evaluations as after it
    /// (2.11 ms, H200). Where nobody asks how far beads are, they come into an order more often;
    /// where somebody does, also once that many lists of pairs have been made, since each bead has
    /// gone some 0.2 nm at most for each: coordinates far from their cell lose digits in single
    /// precision.
    static constexpr int evaluations_of_an_order = 1000, evaluations_of_a_listed_order = 8000,
                         lists_of_an_order = 400;

    struct Flags {
        std::int64_t trouble = -1, far = 0, of_ghosts = -1;
    };
    struct Events {
        Event begun{Event::For::clock}, chains_begin{Event::For::clock},
            chains_end{Event::For::clock}, openmm_begin{Event::For::clock},
            openmm_end{Event::For::clock};
        Event positions{Event::For::order}, forces{Event::For::order};
    };

    static cudaStream_t stream_of(DeviceBeads const& group) {
        return static_cast<cudaStream_t>(group.stream());
    }

    /// The Context that computes; null: none.
    void compute_with(std::unique_ptr<OpenMmOnDevice> openmm);
    /// Of an evaluation: the clock goes from here on.
    void start(std::span<DeviceBeads* const> beads, bool timed);
    /// Own bead that is in trouble, by its number; -1: none. Forgets it.
    std::int64_t take_trouble();
    struct Others {
        std::span<int const> particle;
        std::span<Vec3 const> position;
    };
    /// Gives OpenMM's particles a new order. `x`: of own beads, `others`: of the Context's other
    /// particles; `middle`: goes to the origin where all may be moved by one vector.
    void order(std::vector<Vec3> const& x, std::span<Others const> others, Vec3 const& middle);
    DeviceBead bead_of(int particle, Vec3 const& x) const {
        return bead_at(place_[static_cast<std::size_t>(particle)], x, plan_.box);
    }
    /// OpenMM waits for own beads' positions; it has read those before: the streams waited for its
    /// forces.
    void put_own(std::span<DeviceBeads* const> beads);
    void compute(std::span<DeviceBeads* const> beads);
    /// Of an evaluation that is timed.
    double at(Event const& event) const { return begun_ + event.seconds_since(events_->begun); }
    /// Before compute(): whether OpenMM's list of pairs is made anew. Where it is, particles that
    /// move far from here are noted from now on.
    void note_list(bool anew);
    /// Of compute(), once OpenMM has been given its work: what its forces lack yet.
    virtual void complete_forces() {}
    template <class T>
    void upload(Buffer<T> const& to, T const* from, std::size_t count) {
        if (count > 0)
            check(cudaMemcpyAsync(to.data(), from, count * sizeof(T), cudaMemcpyHostToDevice,
                                  stream_),
                  "take OpenMM's order");
    }

    DevicePathPlan plan_;
    std::unique_ptr<OpenMmOnDevice> home_, openmm_;
    cudaStream_t stream_ = nullptr;  // OpenMM's
    std::unique_ptr<PinnedBuffer<Flags>> flags_;
    std::unique_ptr<Events> events_;
    std::unique_ptr<Buffer<DeviceBead>> own_;
    Room<Buffer<double>> listed_;  // positions of the last list of pairs
    DeviceParticles particles_;
    std::vector<std::int32_t> place_;  // of each particle
    std::vector<DeviceBeads*> beads_;  // of the last evaluation
    int of_an_order_, of_this_order_ = 0,
                      lists_of_this_order_ = 0;  // evaluations, and lists of pairs made
    bool timed_ = false;
    double begun_ = 0;
    Interval exchange_;  // clock()'s
    PairLists pair_lists_;
};

/// Of several ranks.
std::unique_ptr<DevicePath> make_halo_path(OpenMM::Context& home, DevicePathPlan plan);

}  // namespace catena::cuda
