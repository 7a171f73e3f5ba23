// Branched chains of point beads: accelerations, tensions, the Fixman potential, steps and
// ensembles.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "error.hpp"
#include "integrate/constrained_integrator.hpp"
#include "mpi/communicator.hpp"
#include "scene/branch_limits.hpp"
#include "tests/dynamics/branched_chains.hpp"
#include "tests/dynamics/moving_trees.hpp"
#include "tests/integrate/constrained_run.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

/// Compares an evaluation of one chain with the dense matrix of its links. The tolerance is
/// relative to the largest acceleration and tension.
void expect_dense(ChainSpec const& chain, std::uint64_t seed, Backend backend, double tolerance) {
    Trees trees({chain}, solver_of(backend));
    std::vector<Vec3> const forces = random_forces(seed, chain.size());
    trees.push(forces);
    trees.system->evaluate();
    EXPECT_LE(trees.system->residual(), trees.system->residual_bound());
    SceneMotion const s = trees.system->snapshot();
    std::vector<double> expected_along;
    std::vector<Vec3> const expected =
        DenseLinks(chain, s.position).accelerations(s.velocity, forces, expected_along);
    ChainSystem::Accelerations const found = trees.system->accelerations();
    double largest = 0, tension = 0;
    for (std::size_t k = 0; k < chain.size(); ++k) {
        largest = std::max(largest, norm(expected[k]));
        tension = std::max(tension, std::abs(expected_along[k]));
    }
    DenseLinks const links(chain, s.position);
    for (std::size_t k = 0; k < chain.size(); ++k) {
        ASSERT_LE(norm(found.acceleration[k] - expected[k]), tolerance * largest) << "bead " << k;
        auto const& u = links.direction()[k];
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(found.joint_force[k][3 + i], expected_along[k] * static_cast<double>(u[i]),
                        tolerance * tension);
    }
}

TEST(BranchedChains, AreWhatTheDenseMatrixOfTheirLinksSays) {
    Random random(5);
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        auto const beads = static_cast<std::size_t>(random.uniform(2, 65));
        double const follow[] = {0, 0.5, 0.9};
        ChainSpec const chain = grown(seed, random_parents(seed, beads, follow[seed % 3]),
                                      seed % 4 < 2 ? Base::free : Base::fixed, 3);
        expect_dense(chain, seed, seed % 2 == 0 ? Backend::segments : Backend::serial, 1e-12);
        if (HasFailure()) FAIL() << "seed " << seed;
    }
}

TEST(BranchedChains, WithLongPathsAndManyArmsAreSo) {
    std::vector<std::vector<std::int64_t>> const shapes{star_parents(1), star_parents(300),
                                                        brush_parents(40, 9), brush_parents(5, 60),
                                                        random_parents(1, 400, 0.97)};
    for (auto const& parent : shapes)
        for (Base const base : {Base::free, Base::fixed})
            for (Backend const backend : {Backend::segments, Backend::serial})
                expect_dense(grown(parent.size(), parent, base), 3, backend, 1e-12);
}

TEST(BranchedChains, ThatAreALineLeaveTheBitsOfOne) {
    ChainSpec line = random_bead_chain(4, 150, Base::free);
    ChainSpec as_tree = line;
    for (std::size_t k = 0; k < line.size(); ++k)
        as_tree.parent.push_back(static_cast<std::int64_t>(k) - 1);
    Trees a({line}), b({as_tree});
    a.system->evaluate();
    b.system->evaluate();
    EXPECT_FALSE(b.system->groups()[0]->is_branched());
    EXPECT_TRUE(
        same_bits(a.system->accelerations().acceleration, b.system->accelerations().acceleration));
}

/// A line whose beads are numbered from its middle to both ends has two paths.
TEST(BranchedChains, ThatAreALineNumberedFromItsMiddleMoveAsOne) {
    ChainSpec line = random_bead_chain(4, 151, Base::free);
    ChainSpec tree = line;
    std::vector<std::size_t> bead{75};  // of the line
    tree.parent = {-1};
    for (std::size_t i = 1; i <= 75; ++i)
        for (std::size_t const k : {75 - i, 75 + i}) {
            tree.parent.push_back(i == 1 ? 0 : std::ssize(bead) - 2);
            tree.beads.length[bead.size()] = line.beads.length[k < 75 ? k + 1 : k];
            bead.push_back(k);
        }
    for (std::size_t i = 0; i < bead.size(); ++i) {
        tree.beads.mass[i] = line.beads.mass[bead[i]];
        tree.beads.position[i] = line.beads.position[bead[i]];
        tree.beads.velocity[i] = line.beads.velocity[bead[i]];
    }
    Trees a({line}), b({tree});
    for (Trees* const t : {&a, &b}) t->system->evaluate();
    EXPECT_TRUE(b.system->groups()[0]->is_branched());
    auto const of_line = a.system->accelerations().acceleration,
               of_tree = b.system->accelerations().acceleration;
    double largest = 0;
    for (Vec3 const& x : of_line) largest = std::max(largest, norm(x));
    for (std::size_t i = 0; i < bead.size(); ++i)
        EXPECT_LE(norm(of_tree[i] - of_line[bead[i]]), 1e-12 * largest);
}

TEST(BranchedChains, HaveTheFixmanPotentialOfTheirLinks) {
    std::vector<ChainSpec> chains;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        std::vector<std::int64_t> parent = random_parents(seed, 3 + 2 * seed, 0.4);
        parent[2] = 0;  // so that it branches
        chains.push_back(grown(seed, parent, seed % 2 == 0 ? Base::free : Base::fixed, 2));
    }
    chains.push_back(grown(9, star_parents(9), Base::fixed));
    Trees trees(chains, {}, true);
    trees.system->evaluate();
    double const kt = trees.scene.boltzmann() * trees.scene.dynamics.temperature;
    long double expected = 0;
    for (ChainSpec const& chain : chains)
        expected += 0.5L * kt * DenseLinks(chain, chain.beads.position).log_determinant();
    auto const terms = trees.system->potential_energy();
    ASSERT_EQ(terms.back().name, "fixman");
    EXPECT_NEAR(terms.back().value, static_cast<double>(expected), 1e-12 * kt * 100);

    ASSERT_EQ(trees.system->absolute().size(), 1u);
    View<3> const force = trees.system->absolute()[0]->bead_forces();
    std::int64_t bead = 0;
    for (ChainSpec const& chain : chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++bead)
            for (int i = 0; i < 3; ++i) {
                long double slope = 0;
                // A step of a power of two moves a coordinate exactly.
                double const step = 0x1p-20;
                for (int const side : {-1, 1}) {
                    std::vector<Vec3> moved = chain.beads.position;
                    moved[k][i] += side * step;
                    slope -=
                        side * 0.5L * kt * DenseLinks(chain, moved).log_determinant() / (2 * step);
                }
                ASSERT_NEAR(force.load(bead)[i], static_cast<double>(slope), 1e-8 * kt)
                    << "bead " << bead;
            }
}

/// Twenty beads of tests/data/reference/beadtree20.json, which were not computed with Catena.
TEST(BranchedChains, HaveTheNumbersOfAThirdParty) {
    std::ifstream file(std::string(CATENA_TEST_DATA) + "/reference/beadtree20.json");
    auto const json = nlohmann::json::parse(file);
    ChainSpec chain;
    chain.name = "beadtree20";
    for (std::int64_t const parent : json.at("parent")) chain.parent.push_back(parent - 1);
    chain.beads.mass = json.at("mass").get<std::vector<double>>();
    for (auto const& x : json.at("position")) chain.beads.position.push_back(vector3(x));
    for (auto const& v : json.at("unprojected_velocity"))
        chain.beads.velocity.push_back(vector3(v));
    chain.beads.residue.assign(chain.size(), "UNK");
    chain.beads.length.push_back(0);
    for (std::size_t k = 1; k < chain.size(); ++k)
        chain.beads.length.push_back(
            norm(chain.beads.position[k] -
                 chain.beads.position[static_cast<std::size_t>(chain.parent[k])]));
    Trees trees({chain}, {}, true);
    trees.system->evaluate();
    auto const& expected = json.at("expected");
    double const kt = trees.scene.boltzmann() * trees.scene.dynamics.temperature;
    EXPECT_NEAR(trees.system->potential_energy().back().value / (0.5 * kt),
                expected.at("log_det_T").get<double>(), 1e-12);
    std::vector<Vec3> const velocity = trees.system->snapshot().velocity;
    View<3> const force = trees.system->absolute()[0]->bead_forces();
    for (std::size_t k = 0; k < chain.size(); ++k) {
        EXPECT_LE(norm(velocity[k] - vector3(expected.at("projected_velocity").at(k))), 1e-14);
        EXPECT_LE(norm((1 / kt) * force.load(static_cast<std::int64_t>(k)) -
                       vector3(expected.at("fixman_force_over_kT").at(k))),
                  1e-13);
    }
}

std::vector<ChainSpec> some_trees() {
    return {grown(1, brush_parents(150, 7), Base::free), grown(2, star_parents(20), Base::fixed),
            grown(3, random_parents(3, 700, 0.5), Base::free),
            grown(4, random_parents(4, 700, 0.95), Base::fixed)};
}

TEST(BranchedChains, MoveBitByBitAlikeOnAnyThreadsAndVectors) {
    std::vector<std::map<std::string, std::vector<double>>> states;
    auto const add = [&](SolverSpec const& solver) {
        std::vector<ChainSpec> chains = some_trees();
        // Threads share the loops of large phases only.
        chains.push_back(grown(5, brush_parents(800, 9), Base::free));
        Trees trees(chains, solver);
        Motion(trees, langevin(trees, 0.002)).steps(0, 5);
        states.push_back(trees.system->state());
    };
    for (SimdLevel const level : simd_levels()) {
        SolverSpec solver = solver_of(Backend::segments);
        solver.simd = level;
        add(solver);
    }
    if (openmp_is_built())
        for (int const threads : {1, 2, 3}) add(solver_of(Backend::openmp, threads));
    for (auto const& state : states)
        for (char const* const name : {"position", "velocity"})
            EXPECT_TRUE(same_bits(state.at(name), states.front().at(name))) << name;
}

TEST(BranchedChains, GoOnFromAStateBitByBit) {
    Trees whole(some_trees()), first(some_trees()), second(some_trees());
    Motion all(whole, langevin(whole, 0.002)), begun(first, langevin(first, 0.002)),
        resumed(second, langevin(second, 0.002));
    all.steps(0, 6);
    begun.steps(0, 3);
    ConstrainedIntegrator::Kept kept = begun.integrator().keep();
    second.system->set_state(first.system->state());
    // What set_state() does not cover is the part of a kick that is due.
    kept.state.clear();
    for (AbsoluteDynamics* const group : second.system->absolute())
        kept.state.push_back(group->state());
    resumed.integrator().put_back(kept);
    resumed.begin();
    resumed.steps(3, 6);
    auto const expected = whole.system->state(), found = second.system->state();
    for (char const* const name : {"position", "velocity"})
        EXPECT_TRUE(same_bits(found.at(name), expected.at(name))) << name;
}

TEST(BranchedChains, KeepEnergyToSecondOrderAndMomenta) {
    std::vector<double> wandering;
    for (double const step : {0.004, 0.002, 0.001}) {
        Trees trees({grown(1, brush_parents(12, 5), Base::free)});
        Motion run(trees, {Integrator::rattle, step, 0, 0, 1, 1e-13});
        SceneMotion const start = run.snapshot();
        Momenta const before = momenta(trees.scene, start);
        double const energy = kinetic_energy(trees.scene, start);
        auto const count = static_cast<std::int64_t>(std::lround(0.2 / step));
        double square = 0;
        for (std::int64_t n = 0; n < count; ++n) {
            run.steps(n, n + 1);
            double const off = kinetic_energy(trees.scene, run.snapshot()) / energy - 1;
            square += off * off / static_cast<double>(count);
        }
        wandering.push_back(std::sqrt(square));
        Momenta const after = momenta(trees.scene, run.snapshot());
        EXPECT_LE(norm(after.linear - before.linear), 1e-11 * before.size);
        EXPECT_LE(norm(after.angular - before.angular), 1e-9 * before.size);
        EXPECT_LE(trees.system->absolute()[0]->constraint_error(), 1e-12);
    }
    EXPECT_GT(wandering[2], 0);
    for (int i = 0; i < 2; ++i) {
        EXPECT_GT(wandering[i] / wandering[i + 1], 3.2);
        EXPECT_LT(wandering[i] / wandering[i + 1], 4.8);
    }
}

/// Averages of stars of three arms with equal masses over a run: twice the kinetic energy per kT,
/// and the squared cosine between arms. Each star is an independent value.
std::pair<Mean, Mean> sample_stars(bool fixman) {
    std::size_t constexpr stars = 500;
    std::vector<ChainSpec> chains;
    for (std::size_t i = 0; i < stars; ++i) {
        chains.push_back(grown(i, star_parents(3), Base::free));
        chains.back().beads.mass.assign(4, 100);
    }
    Trees trees(chains, {}, fixman);
    Motion run(trees, {Integrator::g_baoab, 0.05, 0.5, trees.scene.boltzmann() * 300, 3, 1e-10});
    std::int64_t constexpr rest = 200, every = 20, frames = 100;
    std::vector<double> kinetic(stars, 0), cosine(stars, 0);
    run.steps(0, rest);
    for (std::int64_t frame = 0; frame < frames; ++frame) {
        run.steps(rest + frame * every, rest + (frame + 1) * every);
        SceneMotion const s = run.snapshot();
        for (std::size_t i = 0; i < stars; ++i) {
            Vec3 arm[3];
            for (std::size_t k = 0; k < 4; ++k) {
                kinetic[i] += 100 * dot(s.velocity[4 * i + k], s.velocity[4 * i + k]) /
                              (trees.scene.boltzmann() * 300 * frames);
                if (k > 0) arm[k - 1] = s.position[4 * i + k] - s.position[4 * i];
            }
            for (int a = 0; a < 3; ++a) {
                Vec3 const &u = arm[a], &v = arm[(a + 1) % 3];
                cosine[i] += dot(u, v) * dot(u, v) / (dot(u, u) * dot(v, v)) / (3 * frames);
            }
        }
    }
    return {mean_of(kinetic), mean_of(cosine)};
}

/// The squared cosine is that of the weight sqrt(det T), by product quadrature.
TEST(BranchedChains, SampleStarsOfEqualMasses) {
    auto const [kinetic, cosine] = sample_stars(false);
    EXPECT_NEAR(kinetic.value, 9, 3 * kinetic.error);
    EXPECT_NEAR(cosine.value, 0.323647, 3 * cosine.error);
    EXPECT_LT(cosine.error, 0.003);
}

TEST(BranchedChains, SampleStarsOfStiffSpringsWithTheFixmanPotential) {
    auto const [kinetic, cosine] = sample_stars(true);
    EXPECT_NEAR(kinetic.value, 9, 3 * kinetic.error);
    EXPECT_NEAR(cosine.value, 1.0 / 3, 3 * cosine.error);
    EXPECT_LT(cosine.error, 0.003);
}

TEST(BranchedChains, NameTheJointWhoseMatrixIsLost) {
    ChainSpec chain = grown(1, star_parents(3), Base::free);
    chain.beads.position[2][0] = NAN;
    Trees trees({chain});
    std::string text;
    try {
        trees.system->evaluate();
    } catch (ComputationError const& e) {
        text = e.what();
    }
    EXPECT_NE(text.find("not positive definite (chain tree, body 2)"), std::string::npos) << text;
}

/// Returns what refuses the scene.
std::string refusal(std::vector<ChainSpec> const& chains, SolverSpec const& solver) {
    try {
        Trees const trees(chains, solver);
    } catch (InputError const& e) {
        return e.what();
    }
    return {};
}

TEST(BranchedChains, RefuseWhatTheyDoNotSupport) {
    ChainSpec const tree = grown(1, star_parents(3), Base::free);
    SolverSpec full = solver_of(Backend::segments);
    full.handles = Handles::full;
    EXPECT_NE(refusal({tree}, full).find("projected handles only"), std::string::npos);
    Scene split;
    split.chains = {tree};
    split.solver.backend = Backend::cuda_levels;
    EXPECT_THROW(scene::refuse_unsupported_branches(split), InputError);
    ChainSpec tipped = tree;
    tipped.tip = Tip::jointed;
    EXPECT_NE(refusal({tipped}, {}).find("jointed tip"), std::string::npos);
    EXPECT_EQ(refusal({tree}, {}), "");
}

}  // namespace
}  // namespace catena::test
