// Beads on links read from their positions and velocities: each link's direction is computed once and serves the beads at its two ends.
#pragma once

#include <cmath>

#include "dca/leaf.hpp"
#include "dca/places.hpp"
#include "dca/tree.hpp"

namespace catena::dca {

template <class Real, int K>
struct BiasedSegment {
    SegmentMatrix<Real, K> matrix;
    SegmentBias<Real, K> bias;
    static CATENA_HD BiasedSegment zero() { return {SegmentMatrix<Real, K>::zero(), SegmentBias<Real, K>::zero()}; }
};

/// As Resting (evaluation.hpp). No jointed tips. K = 1 projected, 3 full.
template <int K>
struct MovingBeads {
    template <class Real>
    struct Link {
        Vector<Real, 3> direction;  // 0 where there is none
        Real swing;                 // formulas, "Link chains": -c
        static CATENA_HD Link none() { return {Vector<Real, 3>::zero(), Real(0)}; }
    };
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

    /// Of bodies `begin` to `end` - 1 and their neighbours all is read at once, in the place of what is not there something that is:
    /// reads that wait for each other cost more.
    class Part {
      public:
        CATENA_HD_IN_PLACE Part(MovingBeads const& beads, std::int64_t begin, std::int64_t end)
            : beads_(beads), begin_(begin), starts_(beads.group.is_first[begin] != 0), left_(static_cast<int>(end - begin)) {
            goes_on_ = beads.group.is_last[end - 1] == 0;
            CATENA_UNROLL
            for (int i = 0; i < part_length + 2; ++i) {
                std::int64_t const k = begin - 1 + i < end ? begin - 1 + i : end;  // fields have a halo, and `restricted` more
                position_[i] = beads.configuration.position.load(k);
                velocity_[i] = beads.loads.velocity.load(k);
                if (i == 0 || i > part_length) continue;
                inverse_mass_[i - 1] = beads.group.inverse_mass.at(k, 0);
                restricted_[i - 1] = beads.restricted[k];
                force_[i - 1] = beads.loads.force.origin ? beads.loads.force.load(k) : Vec3::zero();
            }
            outboard_ = starts_ ? ground_link() : link(position_[1] - position_[0], velocity_[1] - velocity_[0]);
        }
        /// Body i: one after the other.
        CATENA_HD_IN_PLACE Body<std::int64_t> body(int i) {
            Body<std::int64_t> body{begin_ + i, outboard_, Link<double>::none(), force_[i], inverse_mass_[i], restricted_[i]};
            Link<double> const after = link(position_[i + 2] - position_[i + 1], velocity_[i + 2] - velocity_[i + 1]);
            if (i + 1 < left_ || goes_on_) body.outboard = after;
            outboard_ = body.outboard;
            return body;
        }

      private:
        CATENA_HD Link<double> ground_link() const {
            if (restricted_[0] == 0) return Link<double>::none();
            ConfigurationView const& c = beads_.configuration;
            return link(position_[1] - piece_of(c.piece, c.pieces, begin_).anchor, velocity_[1]);
        }
        MovingBeads const& beads_;
        std::int64_t begin_;
        bool starts_, goes_on_;
        int left_;
        Vec3 position_[part_length + 2], velocity_[part_length + 2], force_[part_length];
        double inverse_mass_[part_length];
        std::uint8_t restricted_[part_length];
        Link<double> outboard_;
    };
    CATENA_HD_IN_PLACE Part part(std::int64_t begin, std::int64_t end) const { return Part(*this, begin, end); }
    template <class Place>
    CATENA_HD static Body<Place> keep(Body<Place> const& body) {
        return body;
    }

    /// Of several beads side by side, none of which begins or ends a chain: as Part.
    template <class Place>
    class Walk {
      public:
        CATENA_HD_IN_PLACE Walk(MovingBeads const& beads, Place begin) : beads_(beads), begin_(begin), outboard_(beads.link_before(begin)) {}
        CATENA_HD_IN_PLACE Body<Place> body(int i) {
            Body<Place> const body = beads_.between(begin_ + i, outboard_);
            outboard_ = body.outboard;
            return body;
        }

      private:
        MovingBeads const& beads_;
        Place begin_;
        Link<RealAt<Place>> outboard_;
    };
    template <class Place>
    CATENA_HD_IN_PLACE Walk<Place> walk(Place begin) const {
        return Walk<Place>(*this, begin);
    }

    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, K> segment(Body<Place> const& body) const {
        using Kind = Vector<RealAt<Place>, K>;
        auto const &u1 = body.inboard.direction, &u2 = body.outboard.direction;
        BiasedSegment<RealAt<Place>, K> s{bead_matrix(body.inverse_mass, u1, u2, Kind{}),
                                          bead_bias(body.inverse_mass, body.force, u1, u2, Kind{})};
        s.bias.b1[0] = s.bias.b1[0] + body.inboard.swing;
        return s;
    }
    template <class Place>
    CATENA_HD void accelerate(Body<Place> const& body, Vector<RealAt<Place>, K> const& inboard_force,
                              Vector<RealAt<Place>, K> const& outboard_force, AccelerationsView const& out) const {
        write(out.acceleration, body.k,
              bead_acceleration(body.inverse_mass, body.force, inboard_force[0], body.inboard.direction, outboard_force[0],
                                body.outboard.direction));
    }

  private:
    template <class Real>
    CATENA_HD static Link<Real> link(Vector<Real, 3> const& d, Vector<Real, 3> const& v) {
        Real const per_length = Real(1) / norm(d);
        Vector<Real, 3> const u = per_length * d, across = plus_scaled(v, -dot(v, u), u);
        return {u, per_length * dot(across, across)};
    }
    template <class Place>
    CATENA_HD Link<RealAt<Place>> link_before(Place k) const {
        return link(read(configuration.position, k) - read(configuration.position, k - 1), read(loads.velocity, k) - read(loads.velocity, k - 1));
    }
    template <class Place>
    CATENA_HD Body<Place> between(Place k, Link<RealAt<Place>> const& inboard) const {
        auto const force = loads.force.origin ? read(loads.force, k) : Vector<RealAt<Place>, 3>::zero();
        return {k, inboard, link_before(k + 1), force, read(group.inverse_mass, k)[0], K};
    }
};

}  // namespace catena::dca
