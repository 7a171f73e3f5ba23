// Where replicas are placed: apart, whatever their shapes and places are.
#include "neighbours/replica_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "error.hpp"
#include "math/cubic_lattice.hpp"

namespace catena::testing {
namespace {

double constexpr reach = 4;

class Places : public ::testing::Test {
  protected:
    /// Replicas of `points` points, scattered within `width` of centres up to `farthest` away.
    void scatter(int replicas, int points, double width, double farthest) {
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> within(-width / 2, width / 2),
            centre(-farthest, farthest);
        x_.clear();
        replica_.clear();
        for (int r = 0; r < replicas; ++r) {
            Vec3 const middle{{centre(random), centre(random), centre(random)}};
            for (int k = 0; k < points; ++k) {
                x_.push_back(middle + Vec3{{within(random), within(random), within(random)}});
                replica_.push_back(r);
            }
        }
    }
    /// Smallest distance of points of two replicas at their places, along the axis that separates
    /// them most.
    double apart(ReplicaPlaces const& places) const {
        double least = INFINITY;
        for (std::size_t i = 0; i < x_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (replica_[i] == replica_[j]) continue;
                Vec3 const d = (x_[i] - places.shift(i)) - (x_[j] - places.shift(j));
                least = std::min(least, std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}));
            }
        return least;
    }
    std::vector<Vec3> x_;
    std::vector<std::int32_t> replica_;
};

TEST_F(Places, AreFartherApartThanForcesReach) {
    for (double const width : {0.0, 3.0, 50.0})
        for (double const farthest : {0.0, 20.0, 1000.0}) {
            scatter(9, 12, width, farthest);
            ReplicaPlaces places(replica_, reach);
            places.find(x_);
            EXPECT_GT(apart(places), reach) << width << " nm wide, to " << farthest << " nm";
            EXPECT_TRUE(places.hold(x_));
        }
}

TEST_F(Places, AreLeftBeforeForcesReachAcross) {
    scatter(8, 4, 2, 5);
    ReplicaPlaces places(replica_, reach);
    places.find(x_);
    auto const centre = places.centre(0);
    // All replicas grow towards the next ones.
    auto const grown = [&](double by) {
        for (std::size_t i = 0; i < x_.size(); ++i)
            x_[i] = places.centre(i) + (i % 2 == 0 ? by : -by) * Vec3{{1, 1, 1}};
    };
    grown(places.farthest() - 1e-9);
    EXPECT_TRUE(places.hold(x_));
    EXPECT_GT(apart(places), reach);
    grown(places.farthest() + 1e-9);
    EXPECT_FALSE(places.hold(x_));
    EXPECT_EQ(norm(places.centre(0) - centre), 0);  // until they are found anew
    places.find(x_);
    EXPECT_TRUE(places.hold(x_));
    EXPECT_GT(apart(places), reach);
}

TEST_F(Places, AreNearTheOrigin) {
    scatter(256, 20, 15, 1000);
    ReplicaPlaces places(replica_, reach);
    places.find(x_);
    double farthest = 0;
    for (std::size_t i = 0; i < x_.size(); ++i)
        for (double const c : (x_[i] - places.shift(i)).data)
            farthest = std::max(farthest, std::abs(c));
    EXPECT_LT(farthest, 3.5 * (15 + 2 * ReplicaPlaces::slack + reach + ReplicaPlaces::gap));
}

TEST_F(Places, AreRefusedWhereSinglePrecisionEnds) {
    scatter(64, 2, 2500, 0);
    ReplicaPlaces places(replica_, reach);
    EXPECT_THROW(places.find(x_), ComputationError);
}

TEST_F(Places, WithoutReplicasThereAreNone) { EXPECT_TRUE(ReplicaPlaces().empty()); }

TEST(CubicLattices, AreAsSmallAsTheyCanBe) {
    using Edges = std::array<std::int64_t, 3>;
    EXPECT_EQ(CubicLattice(1).edge(), (Edges{1, 1, 1}));
    EXPECT_EQ(CubicLattice(2).edge(), (Edges{2, 1, 1}));
    EXPECT_EQ(CubicLattice(27).edge(), (Edges{3, 3, 3}));
    EXPECT_EQ(CubicLattice(256).edge(), (Edges{7, 7, 6}));
    for (std::int64_t n = 1; n < 300; ++n) {
        CubicLattice const lattice(n);
        EXPECT_LT(lattice.site(n - 1)[2], lattice.edge()[2]);
        EXPECT_GE(lattice.edge()[0] * lattice.edge()[1] * lattice.edge()[2], n);
    }
}

}  // namespace
}  // namespace catena::testing
