// Generators of chains that are difficult to solve.
#include "measure/stability_cases.hpp"

#include <fmt/format.h>

#include <cmath>

#include "generate/generators.hpp"
#include "generate/random.hpp"
#include "joints/joint_models.hpp"

namespace catena {
namespace {

using scene::RandomJoint;
constexpr double earth = 9.81;
Vec3 const down{{-0.36, -0.48, -0.8}};  // parallel to no axis of any chain

Scene scene_of(ChainSpec chain, double gravity = earth) {
    Scene scene;
    scene.si = true;
    chain.name = "chain";
    scene.chains.push_back(std::move(chain));
    scene.forces.gravity = gravity * down;
    return scene;
}

ChainSpec chain_of(BodyArrays bodies, Base base = Base::fixed) {
    ChainSpec chain;
    chain.base = base;
    chain.bodies = std::move(bodies);
    return chain;
}

scene::RandomChain random_kind(RandomJoint joint, std::uint64_t seed, Base base = Base::fixed) {
    scene::RandomChain kind;
    kind.bodies = hard_bodies;
    kind.joint = joint;
    kind.base = base;
    kind.seed = seed;
    return kind;
}
ChainSpec random_bodies_on(RandomJoint joint, std::uint64_t seed, Base base = Base::fixed) {
    return chain_of(scene::random_bodies(random_kind(joint, seed, base)), base);
}
ChainSpec random_beads_on_links(std::uint64_t seed) {
    ChainSpec chain;
    chain.beads = scene::random_beads(random_kind(RandomJoint::link, seed, Base::free));
    return chain;
}

/// Returns rods whose masses differ by up to a tenth, so that seeds differ.
scene::Rods rods(std::int64_t bodies, std::uint64_t seed) {
    scene::Rods rods;
    rods.bodies = bodies;
    rods.mass = {scene::Distribution::Kind::uniform, {0.9, 1.1}};
    rods.seed = seed;
    return rods;
}
ChainSpec wound(std::uint64_t seed, double turn, double twist) {
    return chain_of(scene::coil(rods(hard_bodies, seed), {.turn = turn, .twist = twist}));
}

/// Multiplies masses and inertias by factor(place, k), where `place` is 0 at the base and 1 at the
/// tip.
void scale_masses(ChainSpec& chain,
                  std::function<double(double place, std::size_t k)> const& factor) {
    for (std::size_t k = 0; k < chain.size(); ++k) {
        double const f = factor(static_cast<double>(k) / static_cast<double>(chain.size() - 1), k);
        if (chain.is_beads()) {
            chain.beads.mass[k] *= f;
            continue;
        }
        chain.bodies.mass[k] *= f;
        for (double& x : chain.bodies.inertia[k].data) x *= f;
    }
}

/// Returns the same chain in other units of mass, length and time.
ChainSpec in_units(ChainSpec chain, double mass, double length, double time) {
    BodyArrays& b = chain.bodies;
    double const torque = mass * length * length / (time * time);
    for (std::size_t k = 0; k < b.size(); ++k) {
        b.mass[k] *= mass;
        b.com[k] = length * b.com[k];
        b.translation[k] = length * b.translation[k];
        for (double& x : b.inertia[k].data) x *= mass * length * length;
        b.qd[k] = (1 / time) * b.qd[k];
        if (!b.torque.empty()) b.torque[k] = torque * b.torque[k];
        if (!b.wrench.empty())
            b.wrench[k] = {torque * b.wrench[k].first, (torque / length) * b.wrench[k].second};
    }
    return chain;
}

/// Returns beads at rest on an arc of angle `angle` between two points of the ground.
ChainSpec bridge(std::uint64_t seed, double angle) {
    std::vector<Vec3> points{Vec3::zero()};
    double const each = angle / static_cast<double>(hard_bodies + 1);
    for (std::int64_t k = 0; k <= hard_bodies; ++k) {
        double const along =
            each * (static_cast<double>(k) - 0.5 * static_cast<double>(hard_bodies));
        points.push_back(points.back() + Vec3{{std::cos(along), 0, std::sin(along)}});
    }
    ChainSpec chain;
    chain.base = Base::fixed;
    chain.tip = Tip::jointed;
    chain.tip_joint.type = LinkJoint::type;
    chain.tip_joint.anchor = points.back();
    chain.tip_joint.length = 1;
    points.pop_back();
    chain.beads = scene::beads_at(points, 1, 1, Base::fixed, Vec3::zero());
    for (std::size_t k = 0; k < chain.size(); ++k)
        chain.beads.mass[k] = scene::Draws(seed, static_cast<std::int64_t>(k)).between(0.9, 1.1);
    return chain;
}

/// Adds springs to revolute joints: every `every`-th gets `stiffness`, the others 1.
void add_springs(ChainSpec& chain, std::uint64_t seed, double stiffness, std::size_t every) {
    BodyArrays& b = chain.bodies;
    b.stiffness.assign(b.size(), Vec3{{1, 0, 0}});
    b.rest = b.q;
    for (std::size_t k = 0; k < b.size(); ++k) {
        b.rest[k][0] += scene::Draws(seed, static_cast<std::int64_t>(k)).between(-0.1, 0.1);
        if (k % every == 0) b.stiffness[k][0] = stiffness;
    }
}

/// Collects cases by family.
class Cases {
  public:
    explicit Cases(bool quick) : quick_(quick) {}
    void add(std::string family, std::string name, std::function<Scene(std::uint64_t)> scene,
             std::int64_t bodies = hard_bodies) {
        all_.push_back({std::move(family), std::move(name), bodies, std::move(scene)});
    }
    /// Calls `action` for each power of ten, or with `quick` for the first and the last.
    template <class Action>
    void powers(std::vector<int> const& exponents, Action const& action) const {
        for (int const e : exponents)
            if (!quick_ || e == exponents.front() || e == exponents.back())
                action(std::pow(10.0, e), fmt::format("1e{}", e));
    }
    void long_chain(std::int64_t bodies);
    void masses();
    void inertias();
    void shapes();
    void rates();
    void springs();
    void units();
    std::vector<StabilityCase> take() { return std::move(all_); }

  private:
    bool quick_;
    std::vector<StabilityCase> all_;
};

void Cases::long_chain(std::int64_t n) {
    add(
        "coil", fmt::format("{} bodies", n),
        [n](std::uint64_t seed) { return scene_of(chain_of(scene::coil(rods(n, seed), {}))); }, n);
    add(
        "dill", fmt::format("{} bodies", n),
        [n](std::uint64_t seed) { return scene_of(chain_of(scene::dill(rods(n, seed), {}))); }, n);
}

void Cases::masses() {
    powers({4, 8, 12}, [&](double ratio, std::string const& name) {
        auto const every_second = [=](double, std::size_t k) { return k % 2 == 1 ? ratio : 1.0; };
        auto const graded = [=](double place, std::size_t) { return std::pow(ratio, place); };
        auto const thinning = [=](double place, std::size_t) { return std::pow(ratio, -place); };
        auto const tip = [=](double place, std::size_t) { return place == 1 ? ratio : 1.0; };
        auto const with = [&](char const* what, auto const& factor) {
            add("masses, bodies on revolute joints", fmt::format("{}, {}", what, name),
                [=](std::uint64_t seed) {
                    ChainSpec chain = random_bodies_on(RandomJoint::revolute, seed);
                    scale_masses(chain, factor);
                    return scene_of(chain);
                });
            add("masses, beads on links", fmt::format("{}, {}", what, name),
                [=](std::uint64_t seed) {
                    ChainSpec chain = random_beads_on_links(seed);
                    scale_masses(chain, factor);
                    return scene_of(chain);
                });
        };
        with("alternating", every_second);
        with("heavier outwards", graded);
        with("lighter outwards", thinning);
        with("heavy tip", tip);
        auto const of_both = [=](double, std::size_t k) {
            return k % 2 == 1 ? std::sqrt(ratio) : 1 / std::sqrt(ratio);
        };
        add("masses, parallel revolute joints", name, [=](std::uint64_t seed) {
            ChainSpec chain = wound(seed, 0.3, 0);
            scale_masses(chain, of_both);
            return scene_of(chain);
        });
        add("masses, torques in joints", name, [=](std::uint64_t seed) {
            ChainSpec chain = wound(seed, 0.3, 0.1);
            scale_masses(chain, of_both);
            chain.bodies.torque.assign(chain.size(), Vec3{{1, 0, 0}});
            return scene_of(chain, 0);
        });
    });
}

void Cases::inertias() {
    powers({2, 4, 6, 8}, [&](double ratio, std::string const& name) {
        for (auto const& [joint, kind] : {std::pair{RandomJoint::spherical, "spherical joints"},
                                          {RandomJoint::revolute, "revolute joints"}})
            add(fmt::format("thin bodies, {}", kind), name,
                [ratio, type = joint](std::uint64_t seed) {
                    ChainSpec chain = random_bodies_on(type, seed);
                    for (std::size_t k = 0; k < chain.size(); ++k) {
                        Mat3 const r = to_matrix(
                            scene::Draws(seed, static_cast<std::int64_t>(k), 1).rotation());
                        double const j = 0.1 * chain.bodies.mass[k];
                        for (int row = 0; row < 3; ++row)
                            for (int c = 0; c <= row; ++c)
                                chain.bodies.inertia[k](row, c) =
                                    j * (r(row, 0) * r(c, 0) / ratio + r(row, 1) * r(c, 1) +
                                         r(row, 2) * r(c, 2));
                    }
                    return scene_of(chain);
                });
    });
}

void Cases::shapes() {
    double const pi = scene::Draws::pi;
    powers({-2, -5, -8}, [&](double angle, std::string const& name) {
        add("straight", name, [=](std::uint64_t seed) { return scene_of(wound(seed, angle, 0)); });
        add("straight, twisted", name,
            [=](std::uint64_t seed) { return scene_of(wound(seed, angle, 0.1)); });
        add("folded", name,
            [=](std::uint64_t seed) { return scene_of(wound(seed, pi - angle, 0)); });
        add("folded, twisted", name,
            [=](std::uint64_t seed) { return scene_of(wound(seed, pi - angle, 0.1)); });
        add("bridge of beads", name,
            [=](std::uint64_t seed) { return scene_of(bridge(seed, angle)); });
    });
}

void Cases::rates() {
    powers({2, 4, 6, 8}, [&](double rate, std::string const& name) {
        add("spinning", name, [=](std::uint64_t seed) {
            ChainSpec chain = random_bodies_on(RandomJoint::spherical, seed, Base::free);
            chain.bodies.qd[0] = chain.bodies.qd[0] + Vec3{{0, 0, rate}};
            return scene_of(chain);
        });
    });
}

void Cases::springs() {
    powers({2, 6, 10}, [&](double value, std::string const& name) {
        for (std::size_t const every : {1, 8})
            add("springs",
                fmt::format("{}, {}", name,
                            every == 1 ? "each revolute joint" : "every eighth revolute joint"),
                [=](std::uint64_t seed) {
                    ChainSpec chain = random_bodies_on(RandomJoint::revolute, seed);
                    add_springs(chain, seed, value, every);
                    return scene_of(chain);
                });
        add("dampers", name, [=](std::uint64_t seed) {
            ChainSpec chain = random_bodies_on(RandomJoint::revolute, seed);
            chain.bodies.damping.assign(chain.size(), Vec3{{value, 0, 0}});
            return scene_of(chain);
        });
    });
}

void Cases::units() {
    struct Units {
        char const* name;
        double mass, length, time;
    };
    for (Units const u : {Units{"molecule in SI", 1e-25, 1e-10, 1e-13},
                          {"tether in space", 1e4, 1e5, 1e3},
                          {"planets", 1e24, 1e11, 1e7}})
        for (auto const& [joint, kind] : {std::pair{RandomJoint::spherical, "spherical joints"},
                                          {RandomJoint::revolute, "revolute joints"}})
            add("units", fmt::format("{}, {}", u.name, kind),
                [u, type = joint](std::uint64_t seed) {
                    return scene_of(
                        in_units(random_bodies_on(type, seed), u.mass, u.length, u.time),
                        u.length / (u.time * u.time));
                });
}

}  // namespace

std::vector<StabilityCase> stability_cases(std::int64_t longest, bool quick) {
    Cases cases(quick);
    for (std::int64_t n = 16; n <= longest; n *= 4) cases.long_chain(n);
    cases.masses();
    cases.inertias();
    cases.shapes();
    cases.rates();
    cases.springs();
    cases.units();
    return cases.take();
}

std::vector<StabilityCase> coils_and_dills(std::vector<std::int64_t> const& sizes) {
    Cases cases(false);
    for (std::int64_t const n : sizes) cases.long_chain(n);
    return cases.take();
}

}  // namespace catena
