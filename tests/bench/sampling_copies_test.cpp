#include "bench/sampling_copies.hpp"

#include <gtest/gtest.h>

#include <random>

#include "bench/dense_chains.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "structure/calvados2.hpp"

namespace catena::command {
namespace {

std::unique_ptr<Communicator> const alone = serial_communicator();

SamplingCopies copies_of(std::int64_t count, char const* platform) {
    BenchRequest request;
    request.sampling.copies = count;
    request.set = {std::string("forces.openmm.platform=") + platform};
    return {request, *alone, Backend::segments};
}

std::vector<Vec3> positions_of(Scene const& scene) {
    std::vector<Vec3> x;
    for (ChainSpec const& chain : scene.chains)
        x.insert(x.end(), chain.beads.position.begin(), chain.beads.position.end());
    return x;
}

double largest_difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b,
                          std::size_t from) {
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k) worst = larger(worst, norm(a[k] - b[from + k]));
    return worst;
}

TEST(SamplingCopies, EachHasTheForcesThatItHasAlone) {
    double constexpr nanoseconds = 15e3;  // a thousand nanometres from end to end
    SamplingCopies many = copies_of(9, "CPU"), one = copies_of(1, "CPU"),
                   exact = copies_of(1, "Reference");
    std::vector<Vec3> const x = positions_of(many.scene(0.01, nanoseconds));
    EXPECT_GT(many.extent(nanoseconds), 200);
    std::vector<Vec3> const force = many.forces(x);
    double largest = 0;
    for (Vec3 const& each : force) largest = std::max(largest, norm(each));
    for (std::size_t const copy : {0U, 4U, 8U}) {
        std::vector<Vec3> const own(x.begin() + 140 * static_cast<std::ptrdiff_t>(copy),
                                    x.begin() + 140 * static_cast<std::ptrdiff_t>(copy + 1));
        EXPECT_LT(largest_difference(one.forces(own), force, 140 * copy), 1e-4 * largest);
        EXPECT_LT(largest_difference(exact.forces(own), force, 140 * copy), 1e-4 * largest);
    }
}

TEST(DenseChains, PairsAreCountedAsByComparingAll) {
    std::mt19937_64 draw(5);
    for (Vec3 const& box : {Vec3{3, 4, 9}, Vec3{1.7, 1.7, 1.7}, Vec3{20, 2, 5}}) {
        std::uniform_real_distribution<double> anywhere(-2, 3);
        std::vector<Vec3> x(400);
        for (Vec3& each : x)
            for (int i = 0; i < 3; ++i) each[i] = box[i] * anywhere(draw);
        for (double const radius : {0.3, 0.8}) {
            std::int64_t pairs = 0;
            for (std::size_t a = 0; a < x.size(); ++a)
                for (std::size_t b = 0; b < a; ++b) {
                    Vec3 d = x[a] - x[b];
                    for (int i = 0; i < 3; ++i) d[i] -= box[i] * std::round(d[i] / box[i]);
                    pairs += norm(d) <= radius;
                }
            EXPECT_GT(pairs, 0);
            EXPECT_EQ(pairs_within(x, radius, box, this_thread()), pairs) << radius;
        }
    }
}

TEST(DenseChains, DensityIsSeenByMass) {
    Vec3 const box{2, 3, 10};
    ASSERT_EQ(long_axis(box), 2);
    EXPECT_FALSE(long_axis({2, 3, 5}).has_value());
    EXPECT_EQ(long_axis({9, 3, 4}), 0);
    // All mass in one slice of 6 nm^3, then shared between two, one of them across the boundary.
    EXPECT_NEAR(density_seen({{0, 0, 3.5}, {1, 1, 13.9}}, {60, 120}, box, 2), 180 / 6.0, 1e-12);
    EXPECT_NEAR(density_seen({{0, 0, -0.5}, {1, 1, 3.9}}, {60, 60}, box, 2), 60 / 6.0, 1e-12);
}

/// The forces and energies are those that OpenMM finds in the box, and no copy is moved.
TEST(DenseChains, HaveNumbersOfTheirBox) {
    BenchRequest request;
    request.sampling.copies = 6;
    request.sampling.dense = true;
    request.quiet = true;
    request.set = {"forces.openmm.platform=Reference"};
    DenseChains chains(request, *alone, Backend::segments);
    ASSERT_EQ(chains.chains(), 6);
    std::vector<Vec3> x = positions_of(chains.scene(0.01, 100));
    auto const samples = chains.sample(x, BondMeasure::rigid);
    auto const values = chains.system_values(x);
    ASSERT_EQ(values.size(), 4U);
    EXPECT_EQ(values[0].name, "ashbaugh-hatch energy");
    EXPECT_EQ(values[1].name, "yukawa energy");
    EXPECT_GT(values[3].value, values[2].value);
    // A chain that leaves the box at one side is the same at the other.
    Vec3 const box = *chains.model().box;
    for (std::size_t k = 0; k < 140; ++k) x[k] = x[k] + Vec3{box[0], 0, -box[2]};
    auto const moved = chains.sample(x, BondMeasure::rigid);
    auto const same = chains.system_values(x);
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(same[i].value, values[i].value, 1e-9 * std::abs(values[i].value));
    EXPECT_NEAR(moved[0].virial, samples[0].virial, 1e-7 * std::abs(samples[0].virial));
    x[3][1] = NAN;
    EXPECT_TRUE(std::isnan(chains.nearest(x)));
}

/// The variance of a bond is kT over its stiffness, and no bead goes far: beads that are close
/// together and far apart in the sequence stay apart.
TEST(WarmBonds, HaveThermalLengthsAndMoveNoBeadFar) {
    std::size_t constexpr n = 20001;
    double const kt = 2.5, thermal = kt / calvados2::bond_stiffness;
    std::vector<Vec3> const straight = [] {
        std::vector<Vec3> x;
        for (std::size_t k = 0; k < n; ++k) x.push_back({0.38 * static_cast<double>(k), 0, 0});
        return x;
    }();
    std::vector<Vec3> x = straight;
    std::mt19937_64 draw(1);
    warm_bonds(x, kt, draw);
    double sum = 0;
    for (std::size_t k = 1; k < n; ++k) {
        double const change = norm(x[k] - x[k - 1]) - 0.38;
        sum += change * change;
    }
    // Five standard errors of a variance; neighbouring bonds are correlated by one half.
    EXPECT_NEAR(sum / (n - 1), thermal, 5 * thermal * std::sqrt(2 * 1.5 / (n - 1)));
    EXPECT_LT(largest_difference(straight, x, 0), 6 * std::sqrt(thermal));
}

TEST(SamplingCopies, TheyStandApartAndAMeetingIsSeen) {
    SamplingCopies copies = copies_of(5, "Reference");
    std::vector<Vec3> x = positions_of(copies.scene(0.01, 1000));
    EXPECT_GT(copies.nearest(x), copies.spacing(1000) - 53);  // none is longer than its contour
    EXPECT_GT(copies.spacing(4000), copies.spacing(1000) + 10);
    Vec3 const shift = x[2 * 140] + Vec3{0, 0, 1.5} - x[4 * 140 + 139];
    for (std::size_t k = 4 * 140; k < 5 * 140; ++k) x[k] = x[k] + shift;
    EXPECT_LE(copies.nearest(x), 1.5 + 1e-9);
    x[0][1] = NAN;
    EXPECT_TRUE(std::isnan(copies.nearest(x)));
}

TEST(SamplingCopies, TheyStartFromConformationsOfTheirOwn) {
    SamplingCopies copies = copies_of(3, "Reference");
    std::vector<ChainSample> const samples =
        copies.sample(positions_of(copies.scene(0.01, 1)), BondMeasure::rigid);
    EXPECT_NE(samples[0].radius_of_gyration, samples[1].radius_of_gyration);
    EXPECT_NE(samples[1].radius_of_gyration, samples[2].radius_of_gyration);
    std::vector<Vec3> moved = positions_of(copies.scene(0.01, 1));
    for (Vec3& each : moved) each = 0.9 * each;
    copies.start_from(moved);
    EXPECT_NE(copies.scene(0.01, 1).dynamics.seed, copies.scene(0.01, 1).dynamics.seed);
    EXPECT_NEAR(copies.sample(positions_of(copies.scene(0.01, 1)), BondMeasure::rigid)[2]
                    .radius_of_gyration,
                0.9 * samples[2].radius_of_gyration, 1e-12);
}

}  // namespace
}  // namespace catena::command
