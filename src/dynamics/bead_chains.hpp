// Operations of a step on one bead or link of chains of point beads, in any Space. Ground axes (W);
// nm, ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include <cmath>

#include "dca/solver.hpp"
#include "dynamics/bead_forces.hpp"
#include "kinematics/link_geometry.hpp"
#include "kinematics/ring_ends.hpp"
#include "math/philox.hpp"

namespace catena {

/// Positions of a rank's beads within their chains.
struct BeadPlaces {
    std::int64_t size = 0;
    /// is_first: bead k begins its chain. has_link: bead k has an inboard link.
    std::uint8_t const *is_first = nullptr, *has_link = nullptr;
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;

    /// The part of a chain that contains bead k.
    CATENA_HD_IN_PLACE LocalPiece const& piece_of(std::int64_t k) const {
        return catena::piece_of(piece, pieces, k);
    }
    /// True if bead k has an inboard link. k = size is the first bead of the outboard neighbour,
    /// which continues the chain.
    CATENA_HD_IN_PLACE bool linked(std::int64_t k) const { return k >= size || has_link[k] != 0; }
    /// True if the inboard link of bead k would end on the ground.
    CATENA_HD_IN_PLACE bool to_ground(std::int64_t k) const { return k < size && is_first[k] != 0; }
    /// Bead on which the inboard link of bead k ends, unless it ends on the ground.
    CATENA_HD_IN_PLACE std::int64_t inboard(std::int64_t k) const { return k - 1; }
    /// Bead at the outboard end of link k.
    CATENA_HD_IN_PLACE std::int64_t outboard(std::int64_t k) const { return k; }
};
/// BeadPlaces of branched and cross-linked chains. Link k > size is a cross-link
/// (ChainGroup::first_crosslink()).
struct BranchedPlaces : BeadPlaces {
    /// Branching::inboard.
    std::int64_t const* inboard_bead = nullptr;
    /// Branching::crosslinks.
    LocalCrossLink const* crosslink = nullptr;
    CATENA_HD_IN_PLACE std::int64_t inboard(std::int64_t k) const {
        return k < size ? inboard_bead[k] : crosslink[k - size - 1].inboard;
    }
    CATENA_HD_IN_PLACE std::int64_t outboard(std::int64_t k) const {
        return k < size ? k : crosslink[k - size - 1].outboard;
    }
};
/// Field types for the beads of a rank, in arrays of a Space. PartFields (bead_part.hpp) is the
/// alternative in registers.
struct BeadFields {
    using Places = BeadPlaces;
    template <int D>
    using Given = ConstView<D>;
    template <int D>
    using Found = View<D>;
    using Biases = DirectionsView;
    /// True if chains may have cross-links.
    static constexpr bool has_crosslinks = false;
};
/// BeadFields of branched and cross-linked chains.
struct BranchedFields : BeadFields {
    using Places = BranchedPlaces;
    static constexpr bool has_crosslinks = true;
};

/// State and operations of beads. `Fields` chooses the storage, as BeadFields does; bead k counts
/// within that storage.
template <class Fields>
struct BeadChainsIn {
    template <int D>
    using Given = typename Fields::template Given<D>;
    template <int D>
    using Found = typename Fields::template Found<D>;
    typename Fields::Places places;
    Given<1> mass, inverse_mass, length, half_over_length;
    HeldTip const* tip = nullptr;
    /// Position, velocity and force by bead; observed: velocities of the last observe(). change:
    /// solution of the last sweep (correction of a drift, or acceleration). direction: unit vector
    /// of the inboard link, from inboard to outboard.
    Found<3> position, velocity, observed, force, momentum, change, direction, tip_direction;
    RingEndsView ring_ends;
    /// Biases of the link of bead k and of its tip's link, along the link's direction, component 0.
    /// The other directions of full handles stay 0.
    typename Fields::Biases bias, tip_bias;

    CATENA_HD_IN_PLACE bool linked(std::int64_t k) const { return places.linked(k); }
    CATENA_HD_IN_PLACE bool to_ground(std::int64_t k) const { return places.to_ground(k); }
    /// Outboard end of link k from its inboard one, a bead or the anchor on the ground.
    CATENA_HD_IN_PLACE Vec3 link(std::int64_t k) const {
        return position.load(places.outboard(k)) -
               (to_ground(k) ? places.piece_of(k).anchor : position.load(places.inboard(k)));
    }
    /// Value of the field `of` (positions or velocities) at the bead that tip i is attached to;
    /// `at_ground` if that is the ground. Rings that are whole on this rank are read from the
    /// field, others from the exchanged ends.
    CATENA_HD_IN_PLACE Vec3 beyond_tip(std::int64_t i, Found<3> const& of,
                                       Vec3 const& at_ground) const {
        HeldTip const& t = tip[i];
        return t.ring < 0     ? at_ground
               : t.first >= 0 ? of.load(t.first)
                              : ring_ends.first.load(t.ring);
    }
    /// Value of the field `of` at the last bead of tip i.
    CATENA_HD_IN_PLACE Vec3 at_tip(std::int64_t i, Found<3> const& of) const {
        return tip[i].body >= 0 ? of.load(tip[i].body) : ring_ends.last.load(tip[i].ring);
    }
    /// Link of tip i, from the last bead to its attachment.
    CATENA_HD_IN_PLACE Vec3 tip_link(std::int64_t i) const {
        return beyond_tip(i, position, tip[i].anchor) - at_tip(i, position);
    }

    /// Sets the unit direction of the link of bead k; zero without a link.
    CATENA_HD_IN_PLACE void set_direction(std::int64_t k) const {
        Vec3 const d = linked(k) ? link(k) : Vec3::zero();
        direction.store(k, linked(k) ? (1.0 / norm(d)) * d : d);
    }
    /// Sets the unit direction of the link of tip i. In a ring it is also the direction of the
    /// first bead's link.
    CATENA_HD_IN_PLACE void set_tip_direction(std::int64_t i) const {
        Vec3 const d = tip_link(i), u = (1.0 / norm(d)) * d;
        if (tip[i].body >= 0) tip_direction.store(tip[i].body, u);
        if (tip[i].first >= 0) direction.store(tip[i].first, u);
    }
    /// Sums gravity, constant forces and OpenMM's forces into the force array.
    CATENA_HD_IN_PLACE void take_forces(std::int64_t k, BeadForces const& forces) const {
        force.store(k, forces.on(k, mass.at(k, 0)));
    }
    /// Computes m v + h f, the right-hand side of a kick.
    CATENA_HD_IN_PLACE void set_momentum(std::int64_t k, double h) const {
        momentum.store(k, plus_scaled(mass.at(k, 0) * velocity.load(k), h, force.load(k)));
    }
    /// Moves bead k along its velocity for time h.
    CATENA_HD_IN_PLACE void drift(std::int64_t k, double h) const {
        position.store(k, plus_scaled(position.load(k), h, velocity.load(k)));
    }
    /// Sets the bias of the link of bead k to its length error, for a sweep that closes links.
    CATENA_HD_IN_PLACE void set_excess(std::int64_t k) const {
        bias.at(k, 0) =
            linked(k) ? excess(link(k), length.at(k, 0), half_over_length.at(k, 0)) : 0.0;
    }
    /// Sets the bias of the link of tip i to its length error.
    CATENA_HD_IN_PLACE void set_tip_excess(std::int64_t i) const {
        if (tip[i].body >= 0)
            tip_bias.at(tip[i].body, 0) = excess(tip_link(i), tip[i].length, 0.5 / tip[i].length);
    }
    /// Applies the correction of a sweep to the position, and to the velocity as its mean over the
    /// drift. `per_step` is 1 / h.
    CATENA_HD_IN_PLACE void close(std::int64_t k, double per_step) const {
        Vec3 const c = change.load(k);
        position.store(k, position.load(k) + c);
        velocity.store(k, plus_scaled(velocity.load(k), per_step, c));
    }
    /// Normal noise of the thermostat for bead k at `step`.
    CATENA_HD_IN_PLACE Vec3 noise(std::int64_t k, std::uint64_t seed, std::uint64_t step) const {
        return normal3(seed, step, places.piece_of(k).body_of(k), NoiseStage::thermostat);
    }
    /// Draws the thermal starting velocity of bead k, before projection.
    CATENA_HD_IN_PLACE void draw_velocity(std::int64_t k, double kt, std::uint64_t seed) const {
        velocity.store(k, std::sqrt(kt * inverse_mass.at(k, 0)) *
                              normal3(seed, 0, places.piece_of(k).body_of(k), NoiseStage::start));
    }
    /// Mixes the velocity of bead k with noise.
    CATENA_HD_IN_PLACE void thermalise(std::int64_t k, double keep, double spread,
                                       Vec3 const& noise) const {
        velocity.store(k, plus_scaled(keep * velocity.load(k),
                                      spread * std::sqrt(inverse_mass.at(k, 0)), noise));
    }
    /// Velocity bias of the link of bead k at the observed velocities.
    CATENA_HD_IN_PLACE double swing_of(std::int64_t k) const {
        Vec3 const v = observed.load(places.outboard(k)) -
                       (to_ground(k) ? Vec3::zero() : observed.load(places.inboard(k)));
        return velocity_bias(v, direction.load(k), length.at(k, 0));
    }
    /// Velocity bias of the link of tip i at the observed velocities.
    CATENA_HD_IN_PLACE double tip_swing(std::int64_t i) const {
        return velocity_bias(beyond_tip(i, observed, Vec3::zero()) - at_tip(i, observed),
                             tip_direction.load(tip[i].body), tip[i].length);
    }
    /// Sets the bias of the link of bead k for accelerations.
    CATENA_HD_IN_PLACE void set_swing(std::int64_t k) const {
        bias.at(k, 0) = linked(k) ? swing_of(k) : 0.0;
    }
    /// Sets the bias of the link of tip i for accelerations.
    CATENA_HD_IN_PLACE void set_tip_swing(std::int64_t i) const {
        if (tip[i].body >= 0) tip_bias.at(tip[i].body, 0) = tip_swing(i);
    }
    /// Relative length error of the link of bead k.
    CATENA_HD_IN_PLACE double error(std::int64_t k) const {
        return linked(k) ? std::fabs(norm(link(k)) - length.at(k, 0)) / length.at(k, 0) : 0.0;
    }
    /// True if error(k) is known to be at most `tolerance` for all beads [begin, end), which must
    /// have links to other beads. It has no branch and no square root, so that compilers
    /// vectorise it.
    bool closed_along(std::int64_t begin, std::int64_t end, double tolerance) const {
        // The factor covers the squares of relative errors, which the linearisation neglects.
        double const near = 0.999 * tolerance * (1 - tolerance);
        std::int64_t open = 0;
        for (std::int64_t k = begin; k < end; ++k) {
            double const off = excess(position.load(k) - position.load(places.inboard(k)),
                                      length.at(k, 0), half_over_length.at(k, 0));
            open += std::fabs(off) <= near * length.at(k, 0) ? 0 : 1;
        }
        return open == 0;
    }
    /// Relative length error of the link of tip i.
    CATENA_HD_IN_PLACE double tip_error(std::int64_t i) const {
        return tip[i].body >= 0 ? std::fabs(norm(tip_link(i)) - tip[i].length) / tip[i].length
                                : 0.0;
    }
};
using BeadChains = BeadChainsIn<BeadFields>;

}  // namespace catena
