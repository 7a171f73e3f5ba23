// Beads and OpenMM's particles on one GPU: what each side shows the other, so that neither
// positions nor forces pass through the host.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/field.hpp"
#include "math/host_device.hpp"
#include "math/linear.hpp"

namespace catena {

/// Where a bead's particle stands in OpenMM's arrays, and the periodic cell that its coordinates
/// are taken from: they change only when OpenMM puts its particles into a new order, because OpenMM
/// takes a wrapped bead for one that has moved far.
struct DeviceBead {
    std::int32_t place = 0;
    std::int32_t cell[3] = {0, 0, 0};
};

/// OpenMM's arrays. All addresses are the GPU's.
struct DeviceParticles {
    DeviceBead const* bead = nullptr;
    /// x, y, z and a charge, a place after the other: in single precision (`correction`: what
    /// rounding took away; may be absent) or double.
    float *position = nullptr, *correction = nullptr;
    double* double_position = nullptr;
    /// 2^-32 kJ/mol/nm: x of every place, then y, then z.
    std::int64_t* force = nullptr;
    std::int64_t places = 0;
    Vec3 origin = Vec3::zero(), box = Vec3::zero();
    /// Where they were when OpenMM's list of pairs was made, as `position` and `double_position`;
    /// absent: it is not asked for. `far` becomes 1 where a particle is farther from there.
    float const* listed = nullptr;
    double const* double_listed = nullptr;
    float farthest_squared = 0;
    std::int64_t* far = nullptr;
    /// Becomes the index of a bead whose position or force is no number OpenMM can hold; -1: there
    /// was none.
    std::int64_t* trouble = nullptr;
    std::int64_t first = 0;  // index of bead 0 among all that trouble can name
    std::int64_t order =
        0;  // of the particles: which one, counted; in another one beads stand at other places

    /// The same for beads that follow others.
    DeviceParticles from(std::int64_t bead_index) const {
        DeviceParticles rest = *this;
        rest.bead += bead_index;
        rest.first += bead_index;
        return rest;
    }
    CATENA_HD void put(std::int64_t k, Vec3 const& x) const {
        DeviceBead const b = bead[k];
        std::int64_t const at = 4 * static_cast<std::int64_t>(b.place);
        float away = 0;
        for (int c = 0; c < 3; ++c) {
            double const y = x[c] - origin[c] - box[c] * bead[k].cell[c];
            if (!(std::fabs(y) < far_away)) *trouble = first + k;
            if (double_position) {
                double_position[at + c] = y;
                float const moved =
                    double_listed ? static_cast<float>(y - double_listed[at + c]) : 0.0f;
                away += moved * moved;
                continue;
            }
            float const rounded = static_cast<float>(y);
            position[at + c] = rounded;
            if (correction)
                correction[at + c] = static_cast<float>(y - static_cast<double>(rounded));
            float const moved = listed ? rounded - listed[at + c] : 0.0f;
            away += moved * moved;
        }
        if (far && !(away < farthest_squared)) *far = 1;
    }
    /// kJ/mol/nm
    CATENA_HD Vec3 force_on(std::int64_t k) const {
        std::int64_t const at = bead[k].place;
        Vec3 f;
        for (int c = 0; c < 3; ++c) {
            std::int64_t const fixed = force[at + c * places];
            if (!is_number(fixed)) *trouble = first + k;
            f[c] = (1.0 / 4294967296.0) * static_cast<double>(fixed);
        }
        return f;
    }

    CATENA_HD static bool is_number(std::int64_t fixed) { return fixed <= most && fixed >= -most; }
    static constexpr double far_away = 1e30;  // nm
    static constexpr std::int64_t most =
        std::int64_t{0x7ffffffffffff000};  // of fixed-point numbers; what is none lies beyond
};

/// Where beads go that other ranks have as ghosts, and how far they may be from where they stood.
/// All addresses are the GPU's.
struct ShownBeads {
    std::int32_t const
        *first = nullptr,
        *place = nullptr;     // bead k goes to places place[first[k]] to place[first[k + 1] - 1]
    double* shown = nullptr;  // x, y, z of each place
    double const* listed =
        nullptr;  // x, y, z of each bead when this was made; absent: it may go anywhere
    double farthest_squared = 0;
    /// Become 1 where a bead is farther away, and the index of one that is at no finite place.
    std::int64_t *far = nullptr, *trouble = nullptr;
    std::int64_t first_bead = 0;

    /// The same for beads that follow others.
    ShownBeads from(std::int64_t bead_index) const {
        ShownBeads rest = *this;
        rest.first += bead_index;
        if (listed) rest.listed += 3 * bead_index;
        rest.first_bead += bead_index;
        return rest;
    }
    CATENA_HD void show(std::int64_t k, Vec3 const& x) const {
        for (std::int32_t i = first[k]; i < first[k + 1]; ++i)
            for (int c = 0; c < 3; ++c) shown[3 * static_cast<std::int64_t>(place[i]) + c] = x[c];
        double away = 0;
        for (int c = 0; c < 3; ++c) {
            double const d = listed ? x[c] - listed[3 * k + c] : 0.0;
            away += d * d;
            if (!(std::fabs(x[c]) < DeviceParticles::far_away)) *trouble = first_bead + k;
        }
        if (far && !(away < farthest_squared)) *far = 1;
    }
};

/// Ghosts on their way from messages into OpenMM's arrays.
struct ArrivedBeads {
    DeviceParticles particles;  // whose beads are the ghosts
    double const* position = nullptr;
    CATENA_HD void operator()(std::int64_t k) const {
        particles.put(k, {{position[3 * k], position[3 * k + 1], position[3 * k + 2]}});
    }
};

/// Beads of one group of chains, on a GPU.
class DeviceBeads {
  public:
    virtual ~DeviceBeads() = default;
    virtual std::int64_t count() const = 0;
    /// cudaStream_t; what is asked for below runs there.
    virtual void* stream() const = 0;
    /// The particles are where the beads are, once the stream has come here.
    virtual void put_positions(DeviceParticles const&) = 0;
    /// Other ranks' ghosts are where the beads are, once the stream has come here.
    virtual void show(ShownBeads const&) = 0;
    /// Adds to the forces since set_simple_forces() what the particles feel when the stream comes
    /// to where forces are needed: before OpenMM computes again.
    virtual void add_forces(DeviceParticles const&) = 0;
    /// On the host, W; waits for them.
    virtual ConstView<3> host_positions() = 0;
};

}  // namespace catena
