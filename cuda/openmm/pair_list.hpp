// OpenMM's list of the pairs of one Context, which is kept until particles have moved too far.
#pragma once

#include <utility>

#include "cuda/device/owners.hpp"
#include "cuda/openmm/openmm_on_device.hpp"
#include "cuda/openmm/room.hpp"

namespace catena::cuda {

/// For thousands of particles OpenMM keeps a pair list. Before it checks if any particle has moved
/// far, it sorts blocks of particles, at every evaluation. Here the check is made while positions
/// are written, and the list is kept without a check by OpenMM.
class PairList {
  public:
    /// `may_be_kept`: all pair forces of the Context use the list. `openmm` must outlive this
    /// object.
    PairList(OpenMmOnDevice& openmm, bool may_be_kept)
        : openmm_(openmm), may_be_kept_(may_be_kept) {
        if (may_be_kept_) openmm_.share(-1, 0, 1);
    }
    /// True if the list is kept, so that choose() must be called before each evaluation. It is so
    /// after the first one if OpenMM has a list.
    bool is_kept() const { return is_kept_; }
    /// Chooses if the next evaluation rebuilds the list, which it `must`, or keeps it. Returns true
    /// if it is rebuilt.
    bool choose(bool must) {
        bool const anew = must || !std::exchange(is_made_, true);
        if (anew) openmm_.make_list(0, 1);
        return anew;
    }
    /// Must be called after each evaluation was enqueued. The list is kept until it is rebuilt,
    /// also for energies that are requested meanwhile.
    void note_evaluation() {
        if (is_kept_) openmm_.keep_list();
        if (!std::exchange(has_computed_, true)) is_kept_ = may_be_kept_ && openmm_.tiles() > 0;
    }

  private:
    OpenMmOnDevice& openmm_;
    bool may_be_kept_, is_kept_ = false, is_made_ = false, has_computed_ = false;
};

/// The positions at which OpenMM built its list, to tell how far particles have moved since.
class ListedPositions {
  public:
    /// Enqueues a copy of the present positions.
    void take(OpenMmArrays const& arrays, cudaStream_t stream) {
        auto const numbers = static_cast<std::size_t>(4 * arrays.places);
        bool const twice = arrays.double_precision;
        void* const listed = listed_.of(twice ? numbers : numbers / 2).data();
        check(cudaMemcpyAsync(listed, arrays.position,
                              numbers * (twice ? sizeof(double) : sizeof(float)),
                              cudaMemcpyDeviceToDevice, stream),
              "receive lists");
    }
    /// Returns the copy, in the layout of OpenMmArrays::position.
    void const* data() const { return (*listed_).data(); }

  private:
    Room<Buffer<double>> listed_;
};

}  // namespace catena::cuda
