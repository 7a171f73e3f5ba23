// What a step does to one bead or link of chains of point beads, for every Space. Canonical units;
// ground axes.
#pragma once

#include <cmath>

#include "dca/solver.hpp"
#include "dynamics/bead_forces.hpp"
#include "kinematics/link_geometry.hpp"
#include "kinematics/ring_ends.hpp"
#include "math/philox.hpp"

namespace catena {

/// Where the beads of a rank stand in their chains.
struct BeadPlaces {
    std::int64_t size = 0;
    std::uint8_t const *is_first = nullptr, *has_link = nullptr;  // of its chain; an inboard link
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;

    CATENA_HD_IN_PLACE LocalPiece const& piece_of(std::int64_t k) const {
        return catena::piece_of(piece, pieces, k);
    }
    /// k = size: the first bead of the next rank, where the chain goes on there.
    CATENA_HD_IN_PLACE bool linked(std::int64_t k) const { return k >= size || has_link[k] != 0; }
    CATENA_HD_IN_PLACE bool to_ground(std::int64_t k) const { return k < size && is_first[k] != 0; }
};
/// Fields of a rank's beads.
struct BeadFields {
    using Places = BeadPlaces;
    template <int D>
    using Given = ConstView<D>;
    template <int D>
    using Found = View<D>;
    using Biases = DirectionsView;
};

/// `Fields`: as BeadFields; bead k is one of those that they hold.
template <class Fields>
struct BeadChainsIn {
    template <int D>
    using Given = typename Fields::template Given<D>;
    template <int D>
    using Found = typename Fields::template Found<D>;
    typename Fields::Places places;
    Given<1> mass, inverse_mass, length, half_over_length;
    HeldTip const* tip = nullptr;
    Found<3> position, velocity, observed, force, momentum, change, direction, tip_direction;
    RingEndsView ring_ends;
    typename Fields::Biases bias,
        tip_bias;  // the link's direction comes first; full handles' other directions stay 0

    CATENA_HD_IN_PLACE bool linked(std::int64_t k) const { return places.linked(k); }
    CATENA_HD_IN_PLACE bool to_ground(std::int64_t k) const { return places.to_ground(k); }
    CATENA_HD_IN_PLACE Vec3 link(std::int64_t k) const {
        return position.load(k) - (to_ground(k) ? places.piece_of(k).anchor : position.load(k - 1));
    }
    /// What tip i is joined to, and its last bead: of their positions or velocities; `at_ground`:
    /// of the ground. Rings that a rank has whole are read as they are, the others' other ends were
    /// shown.
    CATENA_HD_IN_PLACE Vec3 beyond_tip(std::int64_t i, Found<3> const& of,
                                       Vec3 const& at_ground) const {
        HeldTip const& t = tip[i];
        return t.ring < 0     ? at_ground
               : t.first >= 0 ? of.load(t.first)
                              : ring_ends.first.load(t.ring);
    }
    CATENA_HD_IN_PLACE Vec3 at_tip(std::int64_t i, Found<3> const& of) const {
        return tip[i].body >= 0 ? of.load(tip[i].body) : ring_ends.last.load(tip[i].ring);
    }
    CATENA_HD_IN_PLACE Vec3 tip_link(std::int64_t i) const {
        return beyond_tip(i, position, tip[i].anchor) - at_tip(i, position);
    }

    CATENA_HD_IN_PLACE void set_direction(std::int64_t k) const {
        Vec3 const d = linked(k) ? link(k) : Vec3::zero();
        direction.store(k, linked(k) ? (1.0 / norm(d)) * d : d);
    }
    CATENA_HD_IN_PLACE void set_tip_direction(std::int64_t i) const {
        Vec3 const d = tip_link(i), u = (1.0 / norm(d)) * d;
        if (tip[i].body >= 0) tip_direction.store(tip[i].body, u);
        if (tip[i].first >= 0) direction.store(tip[i].first, u);
    }
    CATENA_HD_IN_PLACE void take_forces(std::int64_t k, BeadForces const& forces) const {
        force.store(k, forces.on(k, mass.at(k, 0)));
    }
    CATENA_HD_IN_PLACE void set_momentum(std::int64_t k, double h) const {
        momentum.store(k, plus_scaled(mass.at(k, 0) * velocity.load(k), h, force.load(k)));
    }
    CATENA_HD_IN_PLACE void drift(std::int64_t k, double h) const {
        position.store(k, plus_scaled(position.load(k), h, velocity.load(k)));
    }
    CATENA_HD_IN_PLACE void set_excess(std::int64_t k) const {
        bias.at(k, 0) =
            linked(k) ? excess(link(k), length.at(k, 0), half_over_length.at(k, 0)) : 0.0;
    }
    CATENA_HD_IN_PLACE void set_tip_excess(std::int64_t i) const {
        if (tip[i].body >= 0)
            tip_bias.at(tip[i].body, 0) = excess(tip_link(i), tip[i].length, 0.5 / tip[i].length);
    }
    CATENA_HD_IN_PLACE void close(std::int64_t k, double per_step) const {
        Vec3 const c = change.load(k);
        position.store(k, position.load(k) + c);
        velocity.store(k, plus_scaled(velocity.load(k), per_step, c));
    }
    CATENA_HD_IN_PLACE Vec3 noise(std::int64_t k, std::uint64_t seed, std::uint64_t step) const {
        return normal3(seed, step, places.piece_of(k).body_of(k), NoiseStage::thermostat);
    }
    CATENA_HD_IN_PLACE void draw_velocity(std::int64_t k, double kt, std::uint64_t seed) const {
        velocity.store(k, std::sqrt(kt * inverse_mass.at(k, 0)) *
                              normal3(seed, 0, places.piece_of(k).body_of(k), NoiseStage::start));
    }
    CATENA_HD_IN_PLACE void thermalise(std::int64_t k, double keep, double spread,
                                       Vec3 const& noise) const {
        velocity.store(k, plus_scaled(keep * velocity.load(k),
                                      spread * std::sqrt(inverse_mass.at(k, 0)), noise));
    }
    CATENA_HD_IN_PLACE double swing_of(std::int64_t k) const {
        Vec3 const v = observed.load(k) - (to_ground(k) ? Vec3::zero() : observed.load(k - 1));
        return swing(v, direction.load(k), length.at(k, 0));
    }
    CATENA_HD_IN_PLACE double tip_swing(std::int64_t i) const {
        return swing(beyond_tip(i, observed, Vec3::zero()) - at_tip(i, observed),
                     tip_direction.load(tip[i].body), tip[i].length);
    }
    CATENA_HD_IN_PLACE void set_swing(std::int64_t k) const {
        bias.at(k, 0) = linked(k) ? swing_of(k) : 0.0;
    }
    CATENA_HD_IN_PLACE void set_tip_swing(std::int64_t i) const {
        if (tip[i].body >= 0) tip_bias.at(tip[i].body, 0) = tip_swing(i);
    }
    /// Of a link's length, relative.
    CATENA_HD_IN_PLACE double error(std::int64_t k) const {
        return linked(k) ? std::fabs(norm(link(k)) - length.at(k, 0)) / length.at(k, 0) : 0.0;
    }
    /// Whether error(k) is known to be at most `tolerance` for beads [begin, end), all of which
    /// have links to the beads before them. Neither branches nor roots, so that compilers make
    /// vectors of it.
    bool closed_along(std::int64_t begin, std::int64_t end, double tolerance) const {
        double const near =
            0.999 * tolerance * (1 - tolerance);  // the squares of relative errors are left out
        std::int64_t open = 0;
        for (std::int64_t k = begin; k < end; ++k) {
            double const off = excess(position.load(k) - position.load(k - 1), length.at(k, 0),
                                      half_over_length.at(k, 0));
            open += std::fabs(off) <= near * length.at(k, 0) ? 0 : 1;
        }
        return open == 0;
    }
    CATENA_HD_IN_PLACE double tip_error(std::int64_t i) const {
        return tip[i].body >= 0 ? std::fabs(norm(tip_link(i)) - tip[i].length) / tip[i].length
                                : 0.0;
    }
};
using BeadChains = BeadChainsIn<BeadFields>;

}  // namespace catena
