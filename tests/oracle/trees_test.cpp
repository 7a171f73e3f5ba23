// Branched chains of point beads: the two solvers against each other, Newton's law, and 50-digit
// accelerations and tensions of a random tree.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/branches.hpp"
#include "tests/oracle/compare.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;
using oracle::Quad;
using scene::inboard_of;

/// Random beads on a random tree. Beads hang on the one before them with the probability `follow`,
/// else on any earlier one.
ChainSpec random_bead_tree(std::uint64_t seed, std::size_t beads, Base base, double follow) {
    ChainSpec chain = random_bead_chain(seed, beads, base);
    BeadArrays& b = chain.beads;
    Random random(seed + 1000);
    std::vector<Vec3> along, pace;
    for (std::size_t k = 0; k < beads; ++k) {
        along.push_back(b.length[k] * random.direction());
        pace.push_back(cross(random.vector(3), along.back()));
    }
    std::vector<std::int64_t> parent{-1};
    for (std::size_t k = 1; k < beads; ++k) {
        bool const next = random.chance(follow);
        auto const on = static_cast<std::size_t>(random.uniform() * static_cast<double>(k));
        parent.push_back(static_cast<std::int64_t>(next ? k - 1 : on));
        auto const p = static_cast<std::size_t>(parent.back());
        b.position[k] = b.position[p] + along[k];
        b.velocity[k] = b.velocity[p] + pace[k];
    }
    chain.parent = scene::as_parents(std::move(parent));
    return chain;
}

std::optional<Case> random_case(std::uint64_t seed, double largest) {
    auto const n = static_cast<std::size_t>(std::pow(largest + 0.99, Random(seed + 77).uniform()));
    ChainSpec const chain = random_bead_tree(seed, n, seed % 2 == 0 ? Base::fixed : Base::free,
                                             0.25 * static_cast<double>(seed % 4));
    return Case{chain, {Random(seed).vector(10), random_forces(seed + 9, n)}};
}

TEST(Trees, SolversAgree) {
    solvers_agree<double>(400, 16, [](std::uint64_t s) { return random_case(s, 60); });
}
TEST(Trees, SolversAgreeInLongDouble) {
    solvers_agree<long double>(60, 16, [](std::uint64_t s) { return random_case(s, 30); });
}
TEST(Trees, SolversAgreeIn113Bits) {
    solvers_agree<Quad>(24, 16, [](std::uint64_t s) { return random_case(s, 12); });
}

/// A random tree whose first, middle and last beads have cross-links.
std::optional<Case> cross_linked_case(std::uint64_t seed, double largest) {
    auto const n = static_cast<std::size_t>(9 + Random(seed + 77).uniform() * (largest - 9));
    ChainSpec chain = random_bead_tree(seed, n, seed % 2 == 0 ? Base::fixed : Base::free,
                                       0.25 * static_cast<double>(seed % 4));
    std::vector<Vec3> const& x = chain.beads.position;
    for (auto const& [a, b] :
         {std::pair<std::size_t, std::size_t>{0, n - 1}, {n / 2, n - 1}, {n / 3, n / 2}})
        if (inboard_of(chain.parent, b) != a)
            chain.crosslinks.push_back(
                {static_cast<std::int64_t>(a), static_cast<std::int64_t>(b), norm(x[b] - x[a])});
    oracle::project_velocities(chain, 0);
    return Case{chain, {Random(seed).vector(10), random_forces(seed + 9, n)}};
}

TEST(Trees, SolversOfCrossLinksAgree) {
    solvers_agree<double>(200, 16, [](std::uint64_t s) { return cross_linked_case(s, 40); });
}
TEST(Trees, SolversOfCrossLinksAgreeInLongDouble) {
    solvers_agree<long double>(40, 16, [](std::uint64_t s) { return cross_linked_case(s, 20); });
}

/// Projected velocities keep all lengths, and accelerations keep them to second order in time.
TEST(Trees, CrossLinksKeepTheirLengths) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        auto const [chain, loads] = *cross_linked_case(seed + 300, 40);
        auto const r = oracle::aba<double>(chain, loads);
        ASSERT_EQ(r.crosslink_tension.size(), chain.crosslinks.size());
        for (CrossLink const& link : chain.crosslinks) {
            auto const a = static_cast<std::size_t>(link.inboard),
                       b = static_cast<std::size_t>(link.outboard);
            BeadArrays const& beads = chain.beads;
            Vec3 const d = beads.position[b] - beads.position[a],
                       v = beads.velocity[b] - beads.velocity[a],
                       second = r.com_acceleration[b] - r.com_acceleration[a];
            EXPECT_NEAR(dot(d, v), 0, 1e-12 * norm(d)) << "seed " << seed;
            EXPECT_NEAR(dot(v, v) + dot(d, second), 0, 1e-9 * (dot(v, v) + norm(d) * norm(second)))
                << "seed " << seed;
        }
    }
}

/// The residual by inverse dynamics is rounding for the accelerations found, and not for others.
TEST(Trees, InverseDynamics) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        auto const [chain, loads] = *random_case(seed + 500, 80);
        auto const found = oracle::aba<double>(chain, loads);
        double const allowed =
            4 * static_cast<double>(chain.size()) * 0x1p-52 * oracle::condition_estimate(chain);
        ASSERT_LE(oracle::rnea_residual(chain, loads, found.com_acceleration), allowed)
            << "seed " << seed;
        std::vector<Vec3> changed = found.com_acceleration;
        changed[chain.size() / 2] = changed[chain.size() / 2] + Vec3{{1e-3, 2e-3, -1e-3}};
        ASSERT_GT(oracle::rnea_residual(chain, loads, changed), 1e-6) << "seed " << seed;
    }
}

/// Mass times acceleration is the load and the pulls of all links at the bead, and each link keeps
/// its length to second order in time.
TEST(Trees, NewtonAndLengths) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        auto const [chain, loads] = *random_case(seed + 900, 80);
        BeadArrays const& b = chain.beads;
        auto const r = oracle::aba<double>(chain, loads);
        std::vector<Vec3> rest(chain.size());
        double size = 0, strain = 0;
        for (std::size_t k = 0; k < chain.size(); ++k) {
            rest[k] = b.mass[k] * (r.com_acceleration[k] - loads.gravity) - loads.bead_forces[k];
            size = std::max(size,
                            b.mass[k] * norm(r.com_acceleration[k]) + norm(loads.bead_forces[k]));
        }
        for (std::size_t k = chain.base == Base::fixed ? 0 : 1; k < chain.size(); ++k) {
            std::size_t const p = k == 0 ? 0 : inboard_of(chain.parent, k);
            auto const apart = [&](std::vector<Vec3> const& of, Vec3 const& ground) {
                return of[k] - (k == 0 ? ground : of[p]);
            };
            Vec3 const link = apart(b.position, b.anchor), none = Vec3::zero();
            Vec3 const pull = (r.tension[k] / norm(link)) * link;
            rest[k] = rest[k] + pull;
            if (k > 0) rest[p] = rest[p] - pull;
            size = std::max(size, norm(pull));
            Vec3 const v = apart(b.velocity, none), a = apart(r.com_acceleration, none);
            strain = std::max(
                strain, std::abs(dot(v, v) + dot(link, a)) / (dot(v, v) + norm(link) * norm(a)));
        }
        double const allowed =
            4 * static_cast<double>(chain.size()) * 0x1p-52 * oracle::condition_estimate(chain);
        for (Vec3 const& each : rest) ASSERT_LE(norm(each), allowed * size) << "seed " << seed;
        ASSERT_LE(strain, allowed) << "seed " << seed;
    }
}

TEST(Trees, ProjectedVelocitiesKeepAllLinks) {
    ChainSpec chain = random_bead_tree(5, 40, Base::free, 0.3);
    Random random(6);
    for (Vec3& v : chain.beads.velocity) v = random.vector(1);
    oracle::project_velocities(chain);
    for (std::size_t k = 1; k < chain.size(); ++k) {
        std::size_t const p = inboard_of(chain.parent, k);
        Vec3 const link = chain.beads.position[k] - chain.beads.position[p];
        EXPECT_LE(std::abs(dot(link, chain.beads.velocity[k] - chain.beads.velocity[p])), 1e-14);
    }
}

Vec3 vector3(Json const& v) {
    return {{v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()}};
}

/// The random tree of 20 beads, at the velocities that satisfy its links.
Case reference_tree(Json const& json) {
    Case made;
    ChainSpec& chain = made.chain;
    chain.name = json.at("name");
    chain.base = Base::free;
    for (std::int64_t const parent : json.at("parent").get<std::vector<std::int64_t>>())
        chain.parent.push_back(parent - 1);
    chain.beads.mass = json.at("mass").get<std::vector<double>>();
    for (Json const& x : json.at("position")) chain.beads.position.push_back(vector3(x));
    for (Json const& v : json.at("velocity")) chain.beads.velocity.push_back(vector3(v));
    for (Json const& f : json.at("force")) made.loads.bead_forces.push_back(vector3(f));
    chain.beads.length.assign(chain.size(), 0.0);
    chain.beads.residue.assign(chain.size(), "UNK");
    return made;
}

template <class S>
class ReferenceTree : public ::testing::Test {};
using Scalars = ::testing::Types<double, long double, Quad>;
TYPED_TEST_SUITE(ReferenceTree, Scalars);

TYPED_TEST(ReferenceTree, FiftyDigits) {
    using S = TypeParam;
    std::ifstream file(std::string(CATENA_TEST_DATA) + "/reference/beadtree20.json");
    Json const json = Json::parse(file), expected = json.at("expected");
    auto const [chain, loads] = reference_tree(json);
    ASSERT_EQ(chain.size(), 20U);
    std::vector<Vector<S, 3>> acceleration, tension;
    for (Json const& row : expected.at("acceleration_50_digits")) {
        acceleration.emplace_back();
        for (int i = 0; i < 3; ++i)
            acceleration.back()[i] = parse<S>(row.at(static_cast<std::size_t>(i)));
    }
    for (Json const& text : expected.at("tension_50_digits"))
        tension.push_back({{parse<S>(text), S(0), S(0)}});
    for (bool const is_dense : {false, true}) {
        auto const found = is_dense ? oracle::dense<S>(chain, loads) : oracle::aba<S>(chain, loads);
        std::vector<Vector<S, 3>> pulls;
        for (S const& t : found.tension) pulls.push_back({{t, S(0), S(0)}});
        double const of_a = static_cast<double>(
                         relative_difference(found.com_acceleration, acceleration)),
                     of_t = static_cast<double>(relative_difference(pulls, tension));
        std::printf("%s: accelerations %.1e, tensions %.1e\n", is_dense ? "dense" : "elimination",
                    of_a, of_t);
        double const allowed = 32 * static_cast<double>(epsilon<S>());
        EXPECT_LE(of_a, allowed);
        EXPECT_LE(of_t, allowed);
    }
    EXPECT_NEAR(oracle::condition_estimate(chain),
                json.at("agreement").at("condition_number_of_T").get<double>(), 1e-9);
    EXPECT_NEAR(static_cast<double>(oracle::kinematics<S>(chain, loads).kinetic_energy),
                expected.at("kinetic_energy").get<double>(), 1e-12);
}

}  // namespace
}  // namespace catena::test
