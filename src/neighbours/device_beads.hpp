// Exchange between beads and OpenMM's particles on one GPU, so that neither positions nor forces
// pass through the host.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/field.hpp"
#include "math/host_device.hpp"
#include "math/linear.hpp"

namespace catena {

/// Index of a bead's particle in OpenMM's arrays, and the periodic cell that is subtracted from its
/// position. Cells change only when OpenMM reorders its particles: OpenMM would treat a newly
/// wrapped bead as one that moved far.
struct DeviceBead {
    std::int32_t place = 0;
    std::int32_t cell[3] = {0, 0, 0};
};

/// OpenMM's arrays. All addresses are in GPU memory.
struct DeviceParticles {
    /// Particle of each bead.
    DeviceBead const* bead = nullptr;
    /// Records of x, y, z and charge, one per place, nm and e. Single precision uses `position`,
    /// with rounding errors in `correction` (may be null); double precision uses `double_position`.
    float *position = nullptr, *correction = nullptr;
    double* double_position = nullptr;
    /// Forces in units of 2^-32 kJ/mol/nm: x of every place, then y, then z.
    std::int64_t* force = nullptr;
    /// Number of places in the arrays, padding included.
    std::int64_t places = 0;
    /// Offset that is subtracted from all positions, and edges of the periodic box, nm.
    Vec3 origin = Vec3::zero(), box = Vec3::zero();
    /// Coordinates x, y, z, null without replicas, that replace `origin` for each bead, nm. `box`
    /// is then the distance between the places of replicas, and cells are places. `strayed` is set
    /// to 1 if a coordinate relative to `centre` exceeds `farthest`, nm.
    double const* centre = nullptr;
    double farthest = 0;
    std::int64_t* strayed = nullptr;
    /// Positions when OpenMM built its neighbour list, in the layout of `position` or
    /// `double_position`; null: no check. `far` is set to 1 if a particle has moved farther than
    /// `farthest_squared` allows (nm^2).
    float const* listed = nullptr;
    double const* double_listed = nullptr;
    float farthest_squared = 0;
    std::int64_t* far = nullptr;
    /// Set to the index of a bead whose position or force OpenMM cannot represent; -1: none.
    std::int64_t* trouble = nullptr;
    /// Index of bead 0 in the numbering of `trouble`.
    std::int64_t first = 0;
    /// Counter of OpenMM's particle orders; in another order, beads are at other places.
    std::int64_t order = 0;

    /// Returns the view for the beads from `bead_index` on.
    DeviceParticles from(std::int64_t bead_index) const {
        DeviceParticles rest = *this;
        rest.bead += bead_index;
        if (centre) rest.centre += 3 * bead_index;
        rest.first += bead_index;
        return rest;
    }
    /// Writes position x (nm, W) of bead k to its particle, and sets `far` and `trouble`.
    CATENA_HD void put(std::int64_t k, Vec3 const& x) const {
        DeviceBead const b = bead[k];
        std::int64_t const at = 4 * static_cast<std::int64_t>(b.place);
        float away = 0;
        for (int c = 0; c < 3; ++c) {
            double const local = x[c] - (centre ? centre[3 * k + c] : origin[c]);
            if (strayed && !(std::fabs(local) <= farthest)) *strayed = 1;
            double const y = local - box[c] * bead[k].cell[c];
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
    /// Force on bead k, kJ/mol/nm. Sets `trouble` if it is not a number.
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

    /// True if a fixed-point force is in range; OpenMM marks NaN and overflow by values beyond.
    CATENA_HD static bool is_number(std::int64_t fixed) { return fixed <= most && fixed >= -most; }
    static constexpr double far_away = 1e30;  // nm
    static constexpr std::int64_t most =
        std::int64_t{0x7ffffffffffff000};  // largest valid fixed-point force
};

/// Destinations of beads that are ghosts on other ranks, and the limit of their displacement. All
/// addresses are in GPU memory.
struct ShownBeads {
    /// Bead k is sent to places place[first[k]] to place[first[k + 1] - 1].
    std::int32_t const *first = nullptr, *place = nullptr;
    double* shown = nullptr;  // x, y, z of each place, nm
    /// Position (x, y, z) of each bead when the ghost lists were built; null: displacements are not
    /// limited.
    double const* listed = nullptr;
    /// Square of the displacement limit, nm^2.
    double farthest_squared = 0;
    /// `far` is set to 1 if a bead has moved farther; `trouble` to the index of a bead whose
    /// position is not finite.
    std::int64_t *far = nullptr, *trouble = nullptr;
    /// Index of bead 0 in the numbering of `trouble`.
    std::int64_t first_bead = 0;

    /// Returns the view for the beads from `bead_index` on.
    ShownBeads from(std::int64_t bead_index) const {
        ShownBeads rest = *this;
        rest.first += bead_index;
        if (listed) rest.listed += 3 * bead_index;
        rest.first_bead += bead_index;
        return rest;
    }
    /// Writes position x (nm, W) of bead k to all its destinations, and sets `far` and `trouble`.
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

/// Loop body that copies ghost positions from messages to OpenMM's arrays.
struct ArrivedBeads {
    DeviceParticles particles;  // the ghosts, as beads
    /// x, y, z of each ghost, nm.
    double const* position = nullptr;
    CATENA_HD void operator()(std::int64_t k) const {
        particles.put(k, {{position[3 * k], position[3 * k + 1], position[3 * k + 2]}});
    }
};

/// Beads of one chain group on a GPU.
class DeviceBeads {
  public:
    virtual ~DeviceBeads() = default;
    /// Number of beads.
    virtual std::int64_t count() const = 0;
    /// The cudaStream_t to which the functions below enqueue their work.
    virtual void* stream() const = 0;
    /// Enqueues the copy of bead positions to OpenMM's particles.
    virtual void put_positions(DeviceParticles const&) = 0;
    /// Enqueues the copy of bead positions to the ghosts of other ranks.
    virtual void show(ShownBeads const&) = 0;
    /// Adds the particles' forces to the forces since set_simple_forces(). The stream reads them
    /// where forces are needed, before OpenMM's next evaluation.
    virtual void add_forces(DeviceParticles const&) = 0;
    /// Positions in W on the host, nm; waits for them.
    virtual ConstView<3> host_positions() = 0;
};

}  // namespace catena
