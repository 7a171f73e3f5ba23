// The Fixman potential of chains of point beads against a matrix of links written down in extended
// precision, on however many ranks.
#include <gtest/gtest.h>

#include <cmath>

#include "error.hpp"
#include "tests/integrate/constrained_run.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using Real = long double;
using Point = Vector<Real, 3>;

/// Ends of a chain's links, ground included, and the inverse masses there.
struct Links {
    std::vector<Point> point;
    std::vector<Real> inverse_mass;
    std::size_t first_bead = 0;
};

Point point_of(Vec3 const& x) { return {{x[0], x[1], x[2]}}; }

Links links_of(ChainSpec const& chain) {
    Links links;
    auto const add = [&](Vec3 const& x, Real inverse_mass) {
        links.point.push_back(point_of(x));
        links.inverse_mass.push_back(inverse_mass);
    };
    BeadArrays const& beads = chain.beads;
    if (chain.base == Base::fixed) add(beads.anchor, 0);
    links.first_bead = links.point.size();
    for (std::size_t k = 0; k < beads.size(); ++k)
        add(beads.position[k], 1 / static_cast<Real>(beads.mass[k]));
    if (chain.tip == Tip::jointed) add(*chain.tip_joint.anchor, 0);
    return links;
}

/// log det T by elimination from one end (src/dca/README.md, "Link chains").
Real log_determinant(Links const& links) {
    Real sum = 0, pivot = 0;
    Point before{};
    for (std::size_t k = 1; k < links.point.size(); ++k) {
        Point const d = links.point[k] - links.point[k - 1], u = (1 / std::sqrt(dot(d, d))) * d;
        Real const beside = k == 1 ? 0 : -dot(before, u) * links.inverse_mass[k - 1];
        pivot = links.inverse_mass[k - 1] + links.inverse_mass[k] -
                (k == 1 ? 0 : beside * beside / pivot);
        sum += std::log(pivot);
        before = u;
    }
    return sum;
}

/// Minus its derivative by the bead's coordinates, times a half: central differences.
Point downhill(Links links, std::size_t bead) {
    Real constexpr step = 1e-6L;
    Point slope{};
    for (int c = 0; c < 3; ++c) {
        Real& x = links.point[links.first_bead + bead][c];
        Real const here = x;
        x = here + step;
        Real const above = log_determinant(links);
        x = here - step;
        slope[c] = -0.5L * (above - log_determinant(links)) / (2 * step);
        x = here;
    }
    return slope;
}

/// Short and long ones, every kind of end; the longest are shared by ranks.
std::vector<ChainSpec> chains() {
    std::vector<ChainSpec> all;
    for (std::size_t const beads : {1, 2, 3, 4, 5, 16, 17, 33, 150})
        for (Base const base : {Base::free, Base::fixed})
            for (Tip const tip : {Tip::free, Tip::jointed}) {
                if (beads < 3 && base == Base::fixed && tip == Tip::jointed) continue;
                all.push_back(random_bead_chain(beads, beads, base, tip));
                all.back().name = "chain " + std::to_string(all.size());
            }
    return all;
}

class Fixman : public ::testing::TestWithParam<std::tuple<Backend, Handles>> {};
INSTANTIATE_TEST_SUITE_P(Backends, Fixman,
                         ::testing::Values(std::tuple{Backend::serial, Handles::projected},
                                           std::tuple{Backend::segments, Handles::projected},
                                           std::tuple{Backend::segments, Handles::full}));

TEST_P(Fixman, IsTheLogDeterminantAndItsForceTheSlope) {
    Communicator const& world = catena::testing::world();
    Scene scene;
    scene.chains = chains();
    std::tie(scene.solver.backend, scene.solver.handles) = GetParam();
    scene.dynamics.fixman = true;
    ChainSystem system(scene, Axes::world, world);
    system.absolute().front()->update_configuration();
    system.forces_and_matrices(nullptr);
    double const kt = scene.boltzmann() * scene.dynamics.temperature;

    std::vector<EnergyTerm> const terms = system.potential_energy();
    ASSERT_EQ(terms.back().name, "fixman");
    Real expected = 0, size = 0;
    for (ChainSpec const& chain : scene.chains) {
        expected += 0.5L * kt * log_determinant(links_of(chain));
        size += kt * static_cast<Real>(chain.size());
    }
    double constexpr eps = 0x1p-53;
    if (world.rank() == 0) {
        EXPECT_NEAR(terms.back().value, static_cast<double>(expected),
                    100 * eps * static_cast<double>(size));
    }

    AbsoluteDynamics& beads = *system.absolute().front();
    View<3> const force = beads.bead_forces();
    double worst = 0;
    for (std::int64_t k = 0; k < beads.group().size; ++k) {
        auto const& chain = scene.chains[static_cast<std::size_t>(beads.group().scene_chain(k))];
        std::int64_t first = 0;
        for (int c = 0; c < beads.group().scene_chain(k); ++c)
            first += static_cast<std::int64_t>(scene.chains[static_cast<std::size_t>(c)].size());
        Point const slope = downhill(
            links_of(chain), static_cast<std::size_t>(beads.group().scene_index(k) - first));
        for (int c = 0; c < 3; ++c)
            worst =
                larger(worst, std::abs(force.at(k, c) - static_cast<double>(kt * slope[c])) / kt);
    }
    // Differences err by h^2 and eps / h, eps of extended precision: some 1e-12 of a slope of the
    // order of 1 / length.
    EXPECT_LE(worst, 1e-9);
}

/// Over a fixed time, halving the step. Ten times as hot as the chain, so that the potential
/// counts.
TEST(FixmanEnergy, IsKeptToSecondOrder) {
    if (catena::testing::world().rank() != 0) return;
    auto const wander = [](double step) {
        Constrained run(
            "chains: [{name: a, generator: {freely_jointed: {beads: 12, length: 0.38, mass: "
            "100}}}]\n"
            "dynamics: {integrator: rattle, step: 1, temperature: 3000, fixman: true}\n",
            step);
        double const start = run.energy();
        double largest = 0;
        for (int i = 0; i < 16; ++i) {
            run.run(static_cast<std::int64_t>(std::lround(0.25 / step)));
            largest = larger(largest, std::abs(run.energy() - start));
        }
        return largest;
    };
    EXPECT_NEAR(wander(0.01) / wander(0.005), 4, 0.1);
}

TEST(FixmanForce, IsNotComputedOnAGpu) {
    Scene scene;
    scene.chains = {random_bead_chain(1, 5, Base::free)};
    scene.dynamics.fixman = true;
    scene.solver.backend = Backend::cuda;
    try {
        ChainSystem const system(scene, Axes::world, catena::testing::world());
        FAIL() << "not refused";
    } catch (InputError const& error) {  // for this reason, whether there is a GPU or not
        EXPECT_NE(std::string(error.what()).find("Fixman"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace catena::test
