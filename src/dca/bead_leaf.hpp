// Leaf of beads on links that reads positions and velocities. The direction of each link is
// computed once and serves the beads at its two ends.
#pragma once

#include <cmath>

#include "dca/lane_access.hpp"
#include "dca/leaf.hpp"
#include "tree/tree.hpp"

namespace catena::dca {

/// Computes 1 / |d|. Faster versions that may fail return NaN where they do.
struct InverseLength {
    static constexpr bool may_fail = false;
    template <class Real>
    CATENA_HD Real operator()(Vector<Real, 3> const& d) const {
        return Real(1) / norm(d);
    }
};

/// A segment with its matrices and its biases.
template <class Real, int K>
struct BiasedSegment {
    SegmentMatrix<Real, K> matrix;
    SegmentBias<Real, K> bias;
    static CATENA_HD BiasedSegment zero() {
        return {SegmentMatrix<Real, K>::zero(), SegmentBias<Real, K>::zero()};
    }
};

/// Leaf of beads without jointed tips, with the interface of Resting (fused_sweep.hpp). K = 1:
/// projected handles, 3: full handles.
template <int K>
struct BeadLeafFromPositions {
    static constexpr bool one_by_one = false;
    /// Direction and velocity term of one link.
    template <class Real>
    struct Link {
        // Unit direction from inboard to outboard, W; 0 if there is no link.
        Vector<Real, 3> direction;
        // Velocity term -c = |v_rel,perp|^2 / length (src/dca/README.md, "Link chains").
        Real velocity_bias;
        static CATENA_HD Link none() { return {Vector<Real, 3>::zero(), Real(0)}; }
    };
    /// All data of one bead and its two links; the force is in W.
    template <class Place>
    struct Body {
        using Real = RealAt<Place>;
        Place k;
        Link<Real> inboard, outboard;
        Vector<Real, 3> force;
        Real inverse_mass;
        int restricted;
    };
    GroupView group;
    std::uint8_t const* restricted = nullptr;
    ConfigurationView configuration;
    LoadsView loads;

    /// Beads from `begin` on, the links between them and those to their neighbours.
    template <int most>
    struct Neighbours {
        std::int64_t begin;
        Link<double> link[most + 1];
        Vec3 force[most];
        double inverse_mass[most];
        std::uint8_t restricted[most];
    };
    using Part = Neighbours<part_length>;
    /// Reads the beads [begin, end) of one part.
    template <class InverseLength = dca::InverseLength, class Reader = ReadHere>
    CATENA_HD_IN_PLACE Part part(std::int64_t begin, std::int64_t end,
                                 InverseLength const& inverse_length = {},
                                 Reader const& by = {}) const {
        return neighbours<part_length>(begin, end, inverse_length, by);
    }
    /// Reads a single bead.
    template <class InverseLength>
    CATENA_HD_IN_PLACE Body<std::int64_t> body_at(std::int64_t k,
                                                  InverseLength const& inverse_length) const {
        return body(neighbours<1>(k, k + 1, inverse_length, ReadHere{}), 0);
    }
    /// Reads the beads [begin, end), at most `most`. All reads are issued at once, and missing data
    /// are replaced by valid neighbours: reads that wait for each other take longer.
    template <int most, class InverseLength, class Reader>
    CATENA_HD_IN_PLACE Neighbours<most> neighbours(std::int64_t begin, std::int64_t end,
                                                   InverseLength const& inverse_length,
                                                   Reader const& by) const {
        Neighbours<most> read;
        read.begin = begin;
        bool const starts = group.is_first[begin] != 0, goes_on = group.is_last[end - 1] == 0;
        Vec3 position[most + 2], velocity[most + 2];
        CATENA_UNROLL
        for (int i = 0; i < most + 2; ++i) {
            // Fields have one halo body; `restricted` has more.
            std::int64_t const k = begin - 1 + i < end ? begin - 1 + i : end;
            position[i] = by(configuration.position, k);
            velocity[i] = by(loads.velocity, k);
            if (i == 0 || i > most) continue;
            read.inverse_mass[i - 1] = by(group.inverse_mass, k)[0];
            read.restricted[i - 1] = restricted[k];
            read.force[i - 1] = by.if_any(loads.force, k);
        }
        bool const floats = starts && read.restricted[0] == 0;
        // This variant has no branch for which other reads would wait.
        if constexpr (InverseLength::may_fail) {
            if (starts) {
                if (!floats)
                    position[0] = piece_of(configuration.piece, configuration.pieces, begin).anchor;
                velocity[0] = Vec3::zero();
            }
            read.link[0] =
                link(position[1] - position[0], velocity[1] - velocity[0], inverse_length);
            if (floats) read.link[0] = Link<double>::none();
        } else if (!starts) {
            read.link[0] = link(position[1] - position[0], velocity[1] - velocity[0]);
        } else {
            read.link[0] =
                floats ? Link<double>::none()
                       : link(position[1] -
                                  piece_of(configuration.piece, configuration.pieces, begin).anchor,
                              velocity[1]);
        }
        CATENA_UNROLL
        for (int i = 1; i <= most; ++i) {
            read.link[i] =
                link(position[i + 1] - position[i], velocity[i + 1] - velocity[i], inverse_length);
            if (begin + i >= end && !goes_on) read.link[i] = Link<double>::none();
        }
        if constexpr (InverseLength::may_fail) {
            double sum = read.link[0].velocity_bias;
            CATENA_UNROLL
            for (int i = 1; i <= most; ++i) sum = sum + read.link[i].velocity_bias;
            if (sum != sum) return neighbours<most>(begin, end, dca::InverseLength{}, by);
        }
        return read;
    }
    /// Returns bead `i` of those read.
    template <int most>
    CATENA_HD_IN_PLACE Body<std::int64_t> body(Neighbours<most> const& part, int i) const {
        return {part.begin + i, part.link[i],         part.link[i + 1],
                part.force[i],  part.inverse_mass[i], part.restricted[i]};
    }
    /// Writes the acceleration of bead `i` of a part from the forces at its two links.
    template <class Factorizer>
    CATENA_HD_IN_PLACE void accelerate(Part const& part, int i, Vector<double, K> const& inboard,
                                       Vector<double, K> const& outboard,
                                       AccelerationsView const& out,
                                       Factorizer const& factors) const {
        accelerate(body(part, i), inboard, outboard, out, factors);
    }
    template <class Place>
    CATENA_HD static Body<Place> keep(Body<Place> const& body) {
        return body;
    }

    /// Reads several beads side by side, none of which begins or ends a chain. Beads of a lane are
    /// read in order, so that each link is computed once.
    template <class Place>
    class Walk {
      public:
        CATENA_HD_IN_PLACE Walk(BeadLeafFromPositions const& beads, Place begin)
            : beads_(beads), begin_(begin), outboard_(beads.link_before(begin)) {}
        CATENA_HD_IN_PLACE Body<Place> body(int i) {
            Body<Place> const body = beads_.between(begin_ + i, outboard_);
            outboard_ = body.outboard;
            return body;
        }

      private:
        BeadLeafFromPositions const& beads_;
        Place begin_;
        Link<RealAt<Place>> outboard_;
    };
    template <class Place>
    CATENA_HD_IN_PLACE Walk<Place> walk(Place begin) const {
        return Walk<Place>(*this, begin);
    }

    /// Returns the segment of one bead.
    template <class Place, class Factorizer = dca::Factorizer>
    CATENA_HD BiasedSegment<RealAt<Place>, K> segment(Body<Place> const& body,
                                                      Factorizer const& /*factors*/ = {}) const {
        using Kind = Vector<RealAt<Place>, K>;
        auto const &u1 = body.inboard.direction, &u2 = body.outboard.direction;
        BiasedSegment<RealAt<Place>, K> s{bead_matrix(body.inverse_mass, u1, u2, Kind{}),
                                          bead_bias(body.inverse_mass, body.force, u1, u2, Kind{})};
        s.bias.b1[0] = s.bias.b1[0] + body.inboard.velocity_bias;
        return s;
    }
    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, K> segment(Body<Place> const& body,
                                                      Body<Place> const& /*kept*/) const {
        return segment(body);
    }
    /// Writes the acceleration of one bead from the forces at its two links.
    template <class Place, class Factorizer = dca::Factorizer>
    CATENA_HD void accelerate(Body<Place> const& body,
                              Vector<RealAt<Place>, K> const& inboard_force,
                              Vector<RealAt<Place>, K> const& outboard_force,
                              AccelerationsView const& out,
                              Factorizer const& /*factors*/ = {}) const {
        write(
            out.acceleration, body.k,
            bead_acceleration(body.inverse_mass, body.force, inboard_force[0],
                              body.inboard.direction, outboard_force[0], body.outboard.direction));
    }

  private:
    /// Returns the link with the vector `d` and the relative velocity `v` of its ends.
    template <class Real, class InverseLength = dca::InverseLength>
    CATENA_HD static Link<Real> link(Vector<Real, 3> const& d, Vector<Real, 3> const& v,
                                     InverseLength const& inverse_length = {}) {
        Real const per_length = inverse_length(d);
        Vector<Real, 3> const u = per_length * d, across = plus_scaled(v, -dot(v, u), u);
        return {u, per_length * dot(across, across)};
    }
    /// Returns the link inboard of bead k.
    template <class Place>
    CATENA_HD Link<RealAt<Place>> link_before(Place k) const {
        return link(read(configuration.position, k) - read(configuration.position, k - 1),
                    read(loads.velocity, k) - read(loads.velocity, k - 1));
    }
    template <class Place>
    CATENA_HD Body<Place> between(Place k, Link<RealAt<Place>> const& inboard) const {
        auto const force =
            loads.force.origin ? read(loads.force, k) : Vector<RealAt<Place>, 3>::zero();
        return {k, inboard, link_before(k + 1), force, read(group.inverse_mass, k)[0], K};
    }
};

}  // namespace catena::dca
