// Beads on links read from their positions and velocities: each link's direction is computed once and serves the beads at its two ends.
#pragma once

#include <cmath>

#include "dca/leaf.hpp"
#include "dca/solver.hpp"

namespace catena::dca {

template <int K>
struct BiasedSegment {
    SegmentMatrix<double, K> matrix;
    SegmentBias<double, K> bias;
    static CATENA_HD BiasedSegment zero() { return {SegmentMatrix<double, K>::zero(), SegmentBias<double, K>::zero()}; }
};

/// As Resting (evaluation.hpp). No jointed tips. K = 1 projected, 3 full.
template <int K>
struct MovingBeads {
    struct Link {
        Vec3 direction;  // 0 where there is none
        double swing;    // formulas, "Link chains": -c
    };
    struct Body {
        std::int64_t k;
        Link inboard, outboard;
        Vec3 next_position, next_velocity;
        Vec3 force;
        double inverse_mass;
    };
    GroupView group;
    std::uint8_t const* restricted = nullptr;
    ConfigurationView configuration;
    LoadsView loads;

    CATENA_HD Body at(std::int64_t k) const {
        Vec3 const x = configuration.position.load(k), v = loads.velocity.load(k);
        Link inboard{Vec3::zero(), 0.0};
        if (!group.is_first[k])
            inboard = link(x - configuration.position.load(k - 1), v - loads.velocity.load(k - 1));
        else if (restricted[k] > 0)
            inboard = link(x - piece_of(configuration.piece, configuration.pieces, k).anchor, v);
        return with_outboard(k, inboard, x, v);
    }
    CATENA_HD Body after(Body const& body) const {
        return with_outboard(body.k + 1, body.outboard, body.next_position, body.next_velocity);
    }

    CATENA_HD BiasedSegment<K> segment(Body const& body) const {
        Vec3 const &u1 = body.inboard.direction, &u2 = body.outboard.direction;
        BiasedSegment<K> s{bead_matrix(body.inverse_mass, u1, u2, Vector<double, K>{}),
                           bead_bias(body.inverse_mass, body.force, u1, u2, Vector<double, K>{})};
        s.bias.b1[0] = s.bias.b1[0] + body.inboard.swing;
        return s;
    }
    CATENA_HD void accelerate(Body const& body, Vector<double, K> const& inboard_force, Vector<double, K> const& outboard_force,
                              AccelerationsView const& out) const {
        out.acceleration.store(body.k, bead_acceleration(body.inverse_mass, body.force, inboard_force[0], body.inboard.direction,
                                                         outboard_force[0], body.outboard.direction));
    }

  private:
    CATENA_HD static Link link(Vec3 const& d, Vec3 const& v) {
        double const per_length = 1.0 / norm(d);
        Vec3 const u = per_length * d, across = plus_scaled(v, -dot(v, u), u);
        return {u, per_length * dot(across, across)};
    }
    CATENA_HD Body with_outboard(std::int64_t k, Link const& inboard, Vec3 const& x, Vec3 const& v) const {
        Body b{k, inboard, {Vec3::zero(), 0.0}, Vec3::zero(), Vec3::zero(), Vec3::zero(), group.inverse_mass.at(k, 0)};
        if (loads.force.origin) b.force = loads.force.load(k);
        if (!group.is_last[k]) {
            b.next_position = configuration.position.load(k + 1);
            b.next_velocity = loads.velocity.load(k + 1);
            b.outboard = link(b.next_position - x, b.next_velocity - v);
        }
        return b;
    }
};

}  // namespace catena::dca
