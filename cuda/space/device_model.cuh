// Constant properties of a group's bodies and joints on a device.
#pragma once

#include <memory>
#include <utility>

#include "chain/chain_group.hpp"
#include "cuda/space/device_field.cuh"
#include "cuda/space/memory.hpp"
#include "cuda/space/shared_models.hpp"

namespace catena::cuda {

/// Copy of a constant field of the host.
template <int D>
class FixedField {
  public:
    explicit FixedField(Field<D> const& host) : field_(host.size()) {
        field_.upload(host.view(), nullptr);
        check(cudaStreamSynchronize(nullptr), "receive the model");
    }
    /// Returns the view of all bodies, with the halo.
    ConstView<D> view() const { return field_.view(); }

  private:
    DeviceField<D> field_;
};

/// Copy of a constant field that stores a single tile, with pitch 0, if all bodies are alike. Every
/// row of bodies then maps to the first row of the tile. The halo equals any body in that case,
/// unlike on the host.
template <int D>
class AlikeField {
  public:
    explicit AlikeField(Field<D> const& host)
        : size_(host.size()),
          one_tile_(one_tile_serves(host)),
          field_(one_tile_ ? gpu_order::tile : size_) {
        field_.upload(host.view(), nullptr);
        check(cudaStreamSynchronize(nullptr), "receive the model");
    }
    ConstView<D> view() const {
        ConstView<D> const all = field_.view();
        return one_tile_ ? ConstView<D>{all.origin, 0, size_} : all;
    }

  private:
    std::int64_t size_;
    bool one_tile_;
    DeviceField<D> field_;
};

/// Copy of a group's model: masses, inertias, handles, axes and joint types.
/// ChainGroup describes each field; units are those of the scene (nm, ps, amu unless `units: si`).
class ModelArrays {
  public:
    /// `with_inertias`: includes masses and inertias of bodies in joint coordinates, even if no
    /// sweep reads them.
    ModelArrays(ChainGroup const& group, bool with_inertias)
        : size_(group.size),
          sweeps_read_inertias_(group.mass_of_sweeps().size() > 0),
          is_first_(group.ends.is_first),
          is_last_(group.ends.is_last),
          restricted_(group.joints.restricted),
          jointed_tip_(group.ends.jointed_tip),
          tip_screw_(group.ends.tip_screw),
          inverse_mass_(group.bodies.inverse_mass),
          inverse_inertia_(group.bodies.inverse_inertia),
          r1_(group.bodies.r1),
          r2_(group.bodies.r2),
          axes1_(group.bodies.axes1),
          axes2_(group.bodies.axes2),
          screw_(group.joints.screw),
          mass_(with_inertias ? group.bodies.mass : group.mass_of_sweeps()),
          inertia_(with_inertias ? group.bodies.inertia : group.inertia_of_sweeps()) {}

    /// Returns the addresses of the model in the form that leaves read.
    GroupView view() const {
        return {size_,
                is_first_.data(),
                is_last_.data(),
                jointed_tip_.data(),
                tip_screw_.data(),
                inverse_mass_.view(),
                inverse_inertia_.view(),
                r1_.view(),
                r2_.view(),
                axes1_.view(),
                axes2_.view(),
                screw_.view(),
                sweeps_read_inertias_ ? mass() : ConstView<1>{},
                sweeps_read_inertias_ ? inertia() : ConstView<6>{}};
    }
    ConstView<1> mass() const { return mass_.view(); }
    ConstView<6> inertia() const { return inertia_.view(); }
    /// Returns the number of restricted directions of every joint.
    std::uint8_t const* restricted() const { return restricted_.data(); }

  private:
    std::int64_t size_;
    bool sweeps_read_inertias_;
    /// Flags of chains' first and last bodies, and restricted directions of joints.
    Buffer<std::uint8_t> is_first_, is_last_, restricted_;
    /// Index of the jointed tip of a last body, and screw of each jointed tip.
    Buffer<std::int32_t> jointed_tip_;
    Buffer<Vector<double, 4>> tip_screw_;
    /// Inverse masses, and inverse inertias about the centre of mass in body axes (lower
    /// triangles).
    AlikeField<1> inverse_mass_;
    AlikeField<6> inverse_inertia_;
    /// Vectors from the centre of mass to handles 1 and 2 in body axes.
    AlikeField<3> r1_, r2_;
    /// Axes of the inboard joint in its meeting frame, and of the outboard joint in body axes.
    AlikeField<6> axes1_, axes2_;
    /// Parameters {c, s, rate, order} of joints that translate (LocalJoints::screw).
    FixedField<4> screw_;
    /// Masses and inertias, for articulated handles, runs on revolute joints and dynamics in joint
    /// coordinates.
    AlikeField<1> mass_;
    AlikeField<6> inertia_;
};

/// Handle of a group's model. Copies share the arrays.
class DeviceModel {
  public:
    /// Makes arrays of its own, for sweeps alone.
    explicit DeviceModel(ChainGroup const& group)
        : arrays_(std::make_shared<ModelArrays const>(group, false)) {}
    GroupView view() const { return arrays_->view(); }
    std::uint8_t const* restricted() const { return arrays_->restricted(); }
    ConstView<1> mass() const { return arrays_->mass(); }
    ConstView<6> inertia() const { return arrays_->inertia(); }

  private:
    friend class SharedModels<DeviceModel, ModelArrays>;
    explicit DeviceModel(std::shared_ptr<ModelArrays const> arrays) : arrays_(std::move(arrays)) {}

    std::shared_ptr<ModelArrays const> arrays_;
};

}  // namespace catena::cuda
