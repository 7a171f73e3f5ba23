// Cross-linked chains of point beads: accelerations, tensions, the Fixman potential, steps and
// ensembles.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <fstream>

#include "error.hpp"
#include "generate/crosslinks.hpp"
#include "scene/bead_links.hpp"
#include "scene/freedom.hpp"
#include "tests/dynamics/branched_chains.hpp"
#include "tests/dynamics/moving_trees.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Point = Eigen::Matrix<Real, 3, 1>;

Point point(Vec3 const& v) { return {v[0], v[1], v[2]}; }

/// All links of a chain as a dense matrix T in extended precision, with its eigenvalues. Links are
/// those of beads 1 to n - 1, that of bead 0 on a fixed base, and the cross-links.
class DenseNetwork {
  public:
    DenseNetwork(ChainSpec const& chain, std::vector<Vec3> const& position) : chain_(chain) {
        auto const n = static_cast<std::int64_t>(chain.size());
        for (std::int64_t k = chain.base == Base::fixed ? 0 : 1; k < n; ++k)
            add(k == 0
                    ? -1
                    : static_cast<std::int64_t>(
                          chain.parent.empty() ? k - 1 : chain.parent[static_cast<std::size_t>(k)]),
                k, position);
        for (CrossLink const& link : chain.crosslinks) add(link.inboard, link.outboard, position);
        auto const links = static_cast<Eigen::Index>(ends_.size());
        g_ = Matrix::Zero(links, 3 * n);
        for (Eigen::Index i = 0; i < links; ++i) {
            auto const [from, to] = ends_[static_cast<std::size_t>(i)];
            g_.block(i, 3 * to, 1, 3) = along_[static_cast<std::size_t>(i)].transpose();
            if (from >= 0)
                g_.block(i, 3 * from, 1, 3) = -along_[static_cast<std::size_t>(i)].transpose();
        }
        inverse_mass_ = Column(3 * n);
        for (std::int64_t k = 0; k < 3 * n; ++k)
            inverse_mass_[k] =
                1 / static_cast<Real>(chain.beads.mass[static_cast<std::size_t>(k / 3)]);
        Matrix const t = g_ * inverse_mass_.asDiagonal() * g_.transpose();
        scale_ = t.diagonal().cwiseSqrt().cwiseInverse();
        eigen_.compute(Matrix(scale_.asDiagonal() * t * scale_.asDiagonal()));
    }
    std::int64_t redundant() const { return (eigen_.eigenvalues().array() < nothing).count(); }
    /// Condition number of the matrix, without the eigenvalues that are 0.
    double condition() const {
        Real least = eigen_.eigenvalues().maxCoeff();
        for (Real const value : eigen_.eigenvalues())
            if (value >= nothing) least = std::min(least, value);
        return static_cast<double>(eigen_.eigenvalues().maxCoeff() / least);
    }
    Real log_determinant() const {
        return eigen_.eigenvalues().array().log().sum() - 2 * scale_.array().log().sum();
    }
    /// Forces along the links, and accelerations of the beads.
    Column forces(std::vector<Vec3> const& velocity, std::vector<Vec3> const& force,
                  std::vector<Vec3>& acceleration) const {
        Column v(g_.cols()), a(g_.cols()), r(g_.rows());
        for (Eigen::Index k = 0; k < v.size(); ++k) {
            auto const bead = static_cast<std::size_t>(k / 3);
            v[k] = velocity[bead][static_cast<int>(k % 3)];
            a[k] = inverse_mass_[k] * static_cast<Real>(force[bead][static_cast<int>(k % 3)]);
        }
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            auto const at = static_cast<std::size_t>(i);
            auto const [from, to] = ends_[at];
            Point apart = v.segment<3>(3 * to);
            if (from >= 0) apart -= v.segment<3>(3 * from);
            Point const across = apart - apart.dot(along_[at]) * along_[at];
            r[i] = -across.squaredNorm() / length_[at];
        }
        r -= g_ * a;
        Column const x = eigen_.eigenvectors().transpose() * scale_.cwiseProduct(r);
        Column y = x;
        for (Eigen::Index i = 0; i < y.size(); ++i)
            y[i] = eigen_.eigenvalues()[i] < nothing ? 0 : x[i] / eigen_.eigenvalues()[i];
        Column const along = scale_.cwiseProduct(eigen_.eigenvectors() * y);
        a += inverse_mass_.cwiseProduct(g_.transpose() * along);
        acceleration.assign(chain_.size(), Vec3::zero());
        for (Eigen::Index k = 0; k < a.size(); ++k)
            acceleration[static_cast<std::size_t>(k / 3)][static_cast<int>(k % 3)] =
                static_cast<double>(a[k]);
        return along;
    }
    /// Forces on the beads by forces along the links.
    Column on_beads(Column const& along) const { return g_.transpose() * along; }

  private:
    static constexpr Real nothing = 1e-12L;
    void add(std::int64_t from, std::int64_t to, std::vector<Vec3> const& at) {
        Point const d = point(at[static_cast<std::size_t>(to)]) -
                        point(from < 0 ? chain_.beads.anchor : at[static_cast<std::size_t>(from)]);
        ends_.emplace_back(from, to);
        length_.push_back(d.norm());
        along_.push_back(d / d.norm());
    }
    ChainSpec const& chain_;
    std::vector<std::pair<std::int64_t, std::int64_t>> ends_;
    std::vector<Real> length_;
    std::vector<Point> along_;
    Matrix g_;
    Column inverse_mass_, scale_;
    Eigen::SelfAdjointEigenSolver<Matrix> eigen_;
};

/// Adds up to `count` cross-links of random beads, with their distances as lengths.
ChainSpec cross_linked(std::uint64_t seed, ChainSpec chain, std::size_t count) {
    Random random(seed);
    auto const n = static_cast<double>(chain.size());
    for (std::size_t attempt = 0; attempt < 4 * count && chain.crosslinks.size() < count;
         ++attempt) {
        auto a = static_cast<std::int64_t>(random.uniform() * n),
             b = static_cast<std::int64_t>(random.uniform() * n);
        if (a > b) std::swap(a, b);
        auto const known = [&](CrossLink const& c) { return c.inboard == a && c.outboard == b; };
        std::int64_t const on = b == 0                 ? -1
                                : chain.parent.empty() ? b - 1
                                                       : chain.parent[static_cast<std::size_t>(b)];
        if (a == b || on == a ||
            std::any_of(chain.crosslinks.begin(), chain.crosslinks.end(), known))
            continue;
        chain.crosslinks.push_back({a, b,
                                    norm(chain.beads.position[static_cast<std::size_t>(b)] -
                                         chain.beads.position[static_cast<std::size_t>(a)])});
    }
    chain.redundant_links = scene::redundant_links(chain);
    return chain;
}

/// Compares an evaluation of one chain with the dense matrix of its links. The tolerance is 1e-12
/// of the largest acceleration and tension, more where the matrix is ill-conditioned.
void expect_dense(ChainSpec const& chain, std::uint64_t seed, Backend backend) {
    Trees trees({chain}, solver_of(backend));
    std::vector<Vec3> const forces = random_forces(seed, chain.size());
    trees.push(forces);
    trees.system->evaluate();
    EXPECT_LE(trees.system->residual(), trees.system->residual_bound());
    SceneMotion const s = trees.system->snapshot();
    DenseNetwork const dense(chain, s.position);
    EXPECT_EQ(dense.redundant(), chain.redundant_links);
    double const tolerance = std::max(1e-12, 4e-15 * dense.condition());
    std::vector<Vec3> expected;
    Column const along = dense.forces(s.velocity, forces, expected);
    ChainSystem::Accelerations const found = trees.system->accelerations();
    double largest = 0;
    for (Vec3 const& a : expected) largest = std::max(largest, norm(a));
    for (std::size_t k = 0; k < chain.size(); ++k)
        ASSERT_LE(norm(found.acceleration[k] - expected[k]), tolerance * largest) << "bead " << k;
    if (chain.redundant_links > 0) return;
    auto const first = along.size() - std::ssize(chain.crosslinks);
    double const most = static_cast<double>(along.cwiseAbs().maxCoeff());
    for (std::size_t c = 0; c < chain.crosslinks.size(); ++c)
        ASSERT_NEAR(-found.crosslink_tension[c],
                    static_cast<double>(along[first + static_cast<Eigen::Index>(c)]),
                    tolerance * most);
}

TEST(CrossLinks, AreWhatTheDenseMatrixOfAllLinksSays) {
    Random random(6);
    int redundant = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        auto const beads = static_cast<std::size_t>(random.uniform(3, seed % 3 == 0 ? 8 : 65));
        double const follow[] = {0, 0.9, 1};
        ChainSpec const chain =
            cross_linked(seed,
                         grown(seed, random_parents(seed, beads, follow[seed % 3]),
                               seed % 4 < 2 ? Base::free : Base::fixed, 1),
                         1 + seed % 6);
        redundant += chain.redundant_links > 0 ? 1 : 0;
        expect_dense(chain, seed, seed % 2 == 0 ? Backend::segments : Backend::serial);
        if (HasFailure()) FAIL() << "seed " << seed;
    }
    EXPECT_GT(redundant, 0);
}

/// Five beads with all ten links between them have one more than they can need.
TEST(CrossLinks, OfFiveBeadsAreSoWhereTheyAreRedundant) {
    int redundant = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        ChainSpec const chain =
            cross_linked(seed, grown(seed, random_parents(seed, 5, 0.7), Base::free), 6);
        redundant += chain.redundant_links > 0 ? 1 : 0;
        expect_dense(chain, seed, Backend::segments);
        if (HasFailure()) FAIL() << "seed " << seed;
    }
    EXPECT_GT(redundant, 50);
}

TEST(CrossLinks, OfManyBeadsAreSo) {
    for (Base const base : {Base::free, Base::fixed})
        for (Backend const backend : {Backend::segments, Backend::serial}) {
            expect_dense(cross_linked(1, grown(1, random_parents(1, 300, 1), base), 40), 1,
                         backend);
            expect_dense(cross_linked(2, grown(2, brush_parents(30, 9), base), 40), 2, backend);
        }
}

nlohmann::json reference(std::string const& name) {
    std::ifstream file(std::string(CATENA_TEST_DATA) + "/reference/" + name + ".json");
    return nlohmann::json::parse(file);
}

/// The chain of a reference, with its velocities before their projection.
ChainSpec chain_of(nlohmann::json const& json) {
    ChainSpec chain;
    chain.name = json.at("name");
    chain.beads.mass = json.at("mass").get<std::vector<double>>();
    for (auto const& x : json.at("position")) chain.beads.position.push_back(vector3(x));
    for (auto const& v : json.at("unprojected_velocity"))
        chain.beads.velocity.push_back(vector3(v));
    chain.beads.residue.assign(chain.size(), "UNK");
    auto const distance = [&](std::size_t a, std::size_t b) {
        return norm(chain.beads.position[b] - chain.beads.position[a]);
    };
    chain.beads.length.push_back(0);
    for (std::size_t k = 1; k < chain.size(); ++k) chain.beads.length.push_back(distance(k - 1, k));
    for (auto const& link : json.at("cross_links")) {
        std::int64_t const a = link.at(0), b = link.at(1), low = std::min(a, b) - 1,
                           high = std::max(a, b) - 1;
        chain.crosslinks.push_back(
            {low, high, distance(static_cast<std::size_t>(low), static_cast<std::size_t>(high))});
    }
    chain.redundant_links = scene::redundant_links(chain);
    return chain;
}

/// An evaluation under the forces of a reference at its projected velocities.
struct Evaluated {
    Evaluated(nlohmann::json const& json, ChainSpec chain) {
        std::vector<Vec3> forces;
        chain.beads.velocity.clear();
        for (auto const& v : json.at("velocity")) chain.beads.velocity.push_back(vector3(v));
        for (auto const& f : json.at("force")) forces.push_back(vector3(f));
        Trees trees({chain});
        trees.push(forces);
        trees.system->evaluate();
        found = trees.system->accelerations();
        SceneMotion const s = trees.system->snapshot();
        for (std::size_t k = 1; k < chain.size(); ++k) {
            Vec3 const d = s.position[k] - s.position[k - 1];
            auto const& f = found.joint_force[k];
            tension.push_back(-dot((1 / norm(d)) * d, Vec3{{f[3], f[4], f[5]}}));
        }
        tension.insert(tension.end(), found.crosslink_tension.begin(),
                       found.crosslink_tension.end());
        double largest = 0;
        for (auto const& a : json.at("expected").at("acceleration"))
            largest = std::max(largest, norm(vector3(a)));
        for (std::size_t k = 0; k < chain.size(); ++k)
            EXPECT_LE(
                norm(found.acceleration[k] - vector3(json.at("expected").at("acceleration").at(k))),
                1e-12 * largest);
    }
    ChainSystem::Accelerations found;
    /// Of links and cross-links.
    std::vector<double> tension;
};

std::vector<double> tensions_of(nlohmann::json const& json) {
    auto tension = json.at("expected").at("tension").get<std::vector<double>>();
    tension.erase(tension.begin());
    for (double const t : json.at("expected").at("cross_link_tension")) tension.push_back(t);
    return tension;
}

/// A ring of thirty beads with two more cross-links, which was not computed with Catena.
TEST(CrossLinks, OfARingHaveTheNumbersOfAThirdParty) {
    nlohmann::json const json = reference("beadring30");
    ChainSpec const chain = chain_of(json);
    EXPECT_EQ(scene::degrees_of_freedom(chain), json.at("expected").at("degrees_of_freedom"));
    Evaluated const evaluated(json, chain);
    std::vector<double> const expected = tensions_of(json);
    double most = 0;
    for (double const t : expected) most = std::max(most, std::abs(t));
    ASSERT_EQ(evaluated.tension.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(evaluated.tension[i], expected[i], 1e-12 * most) << i;

    Trees trees({chain}, {}, true);
    trees.system->evaluate();
    double const kt = trees.scene.boltzmann() * trees.scene.dynamics.temperature;
    EXPECT_NEAR(trees.system->potential_energy().back().value / (0.5 * kt),
                json.at("expected").at("log_det_T").get<double>(), 1e-11);
    std::vector<Vec3> const velocity = trees.system->snapshot().velocity;
    View<3> const force = trees.system->absolute()[0]->bead_forces();
    for (std::size_t k = 0; k < chain.size(); ++k) {
        EXPECT_LE(norm(velocity[k] - vector3(json.at("expected").at("projected_velocity").at(k))),
                  1e-14);
        EXPECT_LE(norm((1 / kt) * force.load(static_cast<std::int64_t>(k)) -
                       vector3(json.at("expected").at("fixman_force_over_kT").at(k))),
                  1e-12);
    }
}

/// Its six cross-links are one more than the beads can need. Forces are unique up to a self-stress;
/// those of the cross-links have the least norm in the metric of their beads.
TEST(CrossLinks, ThatAreRedundantHaveUniqueAccelerationsAndLeastForces) {
    nlohmann::json const json = reference("beadoverbraced8");
    ChainSpec const chain = chain_of(json);
    EXPECT_EQ(chain.redundant_links, 1);
    EXPECT_EQ(scene::degrees_of_freedom(chain), json.at("expected").at("degrees_of_freedom"));
    std::vector<double> const tension = Evaluated(json, chain).tension,
                              expected = tensions_of(json);
    auto const stress = json.at("expected").at("self_stress").at(0).get<std::vector<double>>();
    double along = 0, most = 0, least = 0;
    for (std::size_t i = 0; i < stress.size(); ++i) {
        along += (tension[i] - expected[i]) * stress[i];
        most = std::max(most, std::abs(expected[i]));
    }
    for (std::size_t i = 0; i < stress.size(); ++i)
        EXPECT_NEAR(tension[i] - along * stress[i], expected[i], 1e-12 * most) << i;
    for (std::size_t c = 0; c < chain.crosslinks.size(); ++c) {
        CrossLink const& link = chain.crosslinks[c];
        std::size_t const i = chain.size() - 1 + c;
        least += tension[i] * stress[i] *
                 (1 / chain.beads.mass[static_cast<std::size_t>(link.inboard)] +
                  1 / chain.beads.mass[static_cast<std::size_t>(link.outboard)]);
    }
    EXPECT_NEAR(least, 0, 1e-12 * most / chain.beads.mass[0]);
}

/// A ring of beads, closed by a tip or by a cross-link.
ChainSpec ring_of(bool by_crosslink) {
    ChainSpec chain = random_bead_chain(3, 40, Base::free);
    double const distance = norm(chain.beads.position.back() - chain.beads.position.front());
    if (by_crosslink) {
        chain.crosslinks = {{0, 39, distance}};
        return chain;
    }
    chain.tip = Tip::jointed;
    chain.tip_joint.ring = true;
    chain.tip_joint.type = JointType::link;
    chain.tip_joint.length = distance;
    return chain;
}

TEST(CrossLinks, ThatCloseARingMoveItAsARing) {
    Trees ring({ring_of(false)}), linked({ring_of(true)});
    std::vector<Vec3> const forces = random_forces(1, 40);
    for (Trees* const trees : {&ring, &linked}) {
        trees->push(forces);
        trees->system->evaluate();
    }
    auto const expected = ring.system->accelerations().acceleration,
               found = linked.system->accelerations().acceleration;
    double largest = 0;
    for (Vec3 const& a : expected) largest = std::max(largest, norm(a));
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_LE(norm(found[k] - expected[k]), 1e-12 * largest) << k;
}

/// Three beads in a row, which a cross-link holds stretched: the middle one cannot move across.
TEST(CrossLinks, ThatContradictLinksLeaveALargeResidual) {
    ChainSpec chain;
    chain.name = "stretched";
    chain.beads.mass = {1, 1, 1};
    chain.beads.position = {Vec3{{0, 0, 0}}, Vec3{{1, 0, 0}}, Vec3{{2, 0, 0}}};
    chain.beads.velocity = {Vec3::zero(), Vec3{{0, 1, 0}}, Vec3::zero()};
    chain.beads.length = {0, 1, 1};
    chain.beads.residue.assign(3, "UNK");
    chain.crosslinks = {{0, 2, 2}};
    Trees trees({chain});
    trees.system->evaluate();
    EXPECT_GT(trees.system->residual(), 0.1);
}

TEST(CrossLinks, HaveTheFixmanPotentialOfAllLinks) {
    std::vector<ChainSpec> chains;
    for (std::uint64_t seed = 0; chains.size() < 8; ++seed) {
        ChainSpec const chain =
            cross_linked(seed,
                         grown(seed, random_parents(seed, 5 + 2 * (seed % 7), 0.6),
                               seed % 2 == 0 ? Base::free : Base::fixed, 1),
                         1 + seed % 3);
        if (chain.redundant_links == 0 && chain.is_cross_linked()) chains.push_back(chain);
    }
    Trees trees(chains, {}, true);
    trees.system->evaluate();
    double const kt = trees.scene.boltzmann() * trees.scene.dynamics.temperature;
    Real expected = 0;
    for (ChainSpec const& chain : chains)
        expected += 0.5L * kt * DenseNetwork(chain, chain.beads.position).log_determinant();
    auto const terms = trees.system->potential_energy();
    ASSERT_EQ(terms.back().name, "fixman");
    EXPECT_NEAR(terms.back().value, static_cast<double>(expected), 1e-12 * kt * 100);
    View<3> const force = trees.system->absolute()[0]->bead_forces();
    std::int64_t bead = 0;
    for (ChainSpec const& chain : chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++bead)
            for (int i = 0; i < 3; ++i) {
                Real slope = 0, largest = 1;
                double const step = 0x1p-20;
                for (int const side : {-1, 1}) {
                    std::vector<Vec3> moved = chain.beads.position;
                    moved[k][i] += side * step;
                    slope -= side * 0.5L * kt * DenseNetwork(chain, moved).log_determinant() /
                             (2 * step);
                }
                largest = std::max(largest, std::abs(slope));
                ASSERT_NEAR(force.load(bead)[i], static_cast<double>(slope),
                            static_cast<double>(1e-7L * kt * largest))
                    << "bead " << bead;
            }
}

/// Beads of a ring with two further cross-links.
ChainSpec braced_ring() { return chain_of(reference("beadring30")); }

TEST(CrossLinks, KeepEnergyToSecondOrderAndMomenta) {
    std::vector<double> wandering;
    for (double const step : {0.02, 0.01, 0.005}) {
        Trees trees({braced_ring()});
        Motion run(trees, {Integrator::rattle, step, 0, 0, 1, 1e-13});
        SceneMotion const start = run.snapshot();
        Momenta const before = momenta(trees.scene, start);
        double const energy = kinetic_energy(trees.scene, start);
        auto const count = static_cast<std::int64_t>(std::lround(1 / step));
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

std::vector<ChainSpec> some_chains() {
    return {braced_ring(), chain_of(reference("beadoverbraced8")),
            cross_linked(1, grown(1, brush_parents(40, 7), Base::free), 12),
            cross_linked(2, grown(2, random_parents(2, 300, 1), Base::fixed), 5),
            grown(3, random_parents(3, 200, 0.5), Base::free)};
}

TEST(CrossLinks, MoveBitByBitAlikeOnAnyThreadsAndVectors) {
    std::vector<std::map<std::string, std::vector<double>>> states;
    auto const add = [&](SolverSpec const& solver) {
        Trees trees(some_chains(), solver);
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

/// Twice the kinetic energy per kT of copies of a chain under the thermostat. Each copy is an
/// independent value.
Mean equipartition(ChainSpec const& chain, std::size_t copies) {
    std::vector<ChainSpec> const chains(copies, chain);
    Trees trees(chains);
    Motion run(trees, {Integrator::g_baoab, 0.02, 1, trees.scene.boltzmann() * 300, 3, 1e-10});
    std::int64_t constexpr rest = 200, every = 20, frames = 20;
    std::vector<double> kinetic(copies, 0);
    run.steps(0, rest);
    for (std::int64_t frame = 0; frame < frames; ++frame) {
        run.steps(rest + frame * every, rest + (frame + 1) * every);
        SceneMotion const s = run.snapshot();
        for (std::size_t i = 0, bead = 0; i < copies; ++i)
            for (std::size_t k = 0; k < chain.size(); ++k, ++bead)
                kinetic[i] += chain.beads.mass[k] * dot(s.velocity[bead], s.velocity[bead]) /
                              (trees.scene.boltzmann() * 300 * frames);
    }
    return mean_of(kinetic);
}

TEST(CrossLinks, LeaveTheirDegreesOfFreedomTheirEnergy) {
    for (char const* const name : {"beadring30", "beadoverbraced8"}) {
        ChainSpec const chain = chain_of(reference(name));
        Mean const found = equipartition(chain, 60);
        EXPECT_NEAR(found.value, static_cast<double>(scene::degrees_of_freedom(chain)),
                    3.5 * found.error)
            << name;
        EXPECT_LT(found.error, 0.02 * found.value);
    }
}

/// Returns what refuses the scene.
std::string refusal(ChainSpec const& chain, SolverSpec const& solver) {
    try {
        Trees const trees({chain}, solver);
    } catch (InputError const& e) {
        return e.what();
    }
    return {};
}

TEST(CrossLinks, RefuseWhatTheyDoNotSupport) {
    ChainSpec chain = ring_of(true);
    SolverSpec full = solver_of(Backend::segments);
    full.handles = Handles::full;
    EXPECT_NE(refusal(chain, full).find("cross-linked chains have projected handles only"),
              std::string::npos);
    chain.tip = Tip::jointed;
    chain.tip_joint.type = JointType::link;
    chain.tip_joint.anchor = Vec3{{9, 9, 9}};
    EXPECT_NE(
        refusal(chain, solver_of(Backend::segments)).find("a cross-linked chain has a jointed tip"),
        std::string::npos);
}

}  // namespace
}  // namespace catena::test
