#include "tests/dca/campaign.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "joints/joint_models.hpp"
#include "measure/nudged.hpp"
#include "measure/solution.hpp"
#include "measure/solver_errors.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"

namespace catena::test {
namespace {

using V = Vector<long double, 3>;
double constexpr least = 1e-11;

struct Kind {
    char const* name;
    RandomJoints joints;
};
Kind constexpr kinds[] = {
    {"revolute", RandomJoints::revolute},   {"spherical", RandomJoints::spherical},
    {"universal", RandomJoints::universal}, {"prismatic", RandomJoints::prismatic},
    {"helical", RandomJoints::helical},     {"planar", RandomJoints::planar},
    {"weld mixture", RandomJoints::weld},   {"revolute+spherical", RandomJoints::mixed},
    {"every kind", RandomJoints::any}};
std::size_t constexpr kind_count = std::size(kinds);
Kind constexpr later_kinds[] = {{"cylindrical", RandomJoints::cylindrical},
                                {"planar3", RandomJoints::planar3},
                                {"all", RandomJoints::all}};
JointType constexpr tips[] = {JointType::spherical, JointType::revolute,  JointType::universal,
                              JointType::weld,      JointType::prismatic, JointType::helical};

JointType constexpr later_tips[] = {
    JointType::spherical, JointType::revolute, JointType::universal,   JointType::weld,
    JointType::prismatic, JointType::helical,  JointType::cylindrical, JointType::planar3};

std::size_t pick(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

/// Coordinates of the chain that move freely: turns and shifts.
struct Freedom {
    int turns = 0, all = 0;
};
Freedom freedom(ChainSpec const& chain) {
    Freedom f;
    BodyArrays const& b = chain.bodies;
    for (std::size_t k = 0; k < b.size(); ++k) {
        bool const driven = std::any_of(
            b.driven.begin(), b.driven.end(),
            [&](DrivenJoint const& d) { return d.body == static_cast<std::int64_t>(k); });
        int const coordinates = driven ? 0 : freedom_of(b.joint[k]);
        int turns = std::min(coordinates, 3);
        for (int i = 0; i < coordinates && i < 3; ++i) turns -= is_length(b.joint[k], i);
        f.turns += turns;
        f.all += coordinates;
    }
    return f;
}

/// All joints revolute about one direction of the ground.
bool in_a_plane(ChainSpec const& chain) {
    BodyArrays const& b = chain.bodies;
    if (b.size() == 0 || chain.base == Base::free) return false;
    Vec3 const z{{0, 0, 1}};
    for (std::size_t k = 0; k < b.size(); ++k)
        if (b.joint[k] != JointType::revolute || norm(cross(b.axis[k], z)) > 0 ||
            norm(b.rotation[k] * z - z) > 0)
            return false;
    return true;
}

/// Whether the chain can follow any motion of its tip: else the tip may hold it more than once, and
/// its forces are not unique.
bool tip_fits(CampaignCase const& c) {
    ChainSpec const& chain = c.chain;
    if (chain.tip == Tip::free || chain.bodies.size() == 0) return true;
    if (in_a_plane(chain)) {
        bool const pin = chain.tip_joint.type == JointType::spherical ||
                         chain.tip_joint.type == JointType::revolute;
        return pin && chain.size() >= 3 && chain.bodies.driven.empty() &&
               c.handles == Handles::projected;
    }
    Freedom const f = freedom(chain);
    bool const shifts_alone =
        f.turns == 0 && f.all >= 3 && chain.tip_joint.type == JointType::spherical;
    return (f.turns >= 3 && f.all >= 7) || shifts_alone;
}

/// What is compared: every vector of a quantity, one after the other.
struct Answer {
    std::vector<std::vector<V>> accelerations, forces;
};

template <class Scalar>
Answer answer_of(oracle::OracleResult<Scalar> const& r) {
    auto const wide = [](std::vector<Vector<Scalar, 3>> const& values) {
        return converted<long double>(values);
    };
    Answer a{{wide(r.com_acceleration)}, {}};
    if (!r.alpha.empty()) a.accelerations.push_back(wide(r.alpha));
    if (!r.constraint_force.empty())
        a.accelerations.insert(a.accelerations.end(), {wide(r.qdd), wide({r.base_acceleration})});
    std::vector<Vector<Scalar, 3>> torque, force;
    for (auto const& f : r.constraint_force) torque.push_back(f.torque), force.push_back(f.force);
    if (!force.empty()) a.forces = {wide(torque), wide(force)};
    std::vector<V> tension;
    for (Scalar const t : r.tension) tension.push_back({{t, 0, 0}});
    if (r.constraint_force.empty() && !tension.empty()) a.forces = {tension};
    return a;
}

Answer answer_of(ChainSystem& system, ChainSpec const& chain) {
    ChainSystem::Accelerations const found = system.accelerations();
    Answer a{{converted<long double>(found.acceleration)}, {}};
    if (chain.is_linked()) a.accelerations.push_back(converted<long double>(found.alpha));
    if (chain.bodies.size() == 0) {
        std::vector<double> const tension = solution_of(system).joint_force;
        a.forces = {{}};
        for (double const t : tension) a.forces[0].push_back({{t, 0, 0}});
        return a;
    }
    std::vector<Vec3> torque, force;
    for (auto const& f : found.joint_force)
        torque.push_back({{f[0], f[1], f[2]}}), force.push_back({{f[3], f[4], f[5]}});
    std::vector<V> const base =
        converted<long double>(std::vector<Vec3>{found.base_acceleration[0]});
    a.accelerations.insert(a.accelerations.end(),
                           {converted<long double>(found.alpha),
                            converted<long double>(found.joint_acceleration), base});
    a.forces = {converted<long double>(torque), converted<long double>(force)};
    return a;
}

long double largest(std::vector<V> const& values) {
    long double most = 0;
    for (V const& v : values)
        for (int i = 0; i < 3; ++i) most = std::max(most, v[i] < 0 ? -v[i] : v[i]);
    return most;
}

/// Largest difference, each quantity relative to its largest component; where that is below a
/// thousandth of the largest of all, to the latter, and where all of them are zero (nothing but
/// welds), to one of these chains' units.
double difference(std::vector<std::vector<V>> const& found,
                  std::vector<std::vector<V>> const& expected) {
    long double overall = 1, worst = 0;
    for (auto const& quantity : expected) overall = std::max(overall, largest(quantity));
    for (std::size_t i = 0; i < expected.size(); ++i) {
        std::vector<V> error;
        for (std::size_t k = 0; k < expected[i].size(); ++k)
            error.push_back(found[i][k] - expected[i][k]);
        long double const own = largest(expected[i]);
        long double const relative = largest(error) / (own > 1e-3L * overall ? own : overall);
        if (!(relative <= worst)) worst = relative;  // a NaN is the worst
    }
    return static_cast<double>(worst);
}

/// Largest difference of accelerations (or, `forces`, of constraint forces) per size of three
/// random changes of the chain and its equations; one random direction may happen to matter little.
double growth_of(CampaignCase const& c, oracle::OracleResult<long double> const& exact,
                 bool forces) {
    double constexpr size = 0x1p-40;
    Answer const answer = answer_of(exact);
    double growth = 1;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Nudged const n = nudged(seed, c.chain, c.loads, exact, size);
        Answer const moved = answer_of(oracle::aba<long double>(n.chain, n.loads));
        double const change = forces ? difference(moved.forces, answer.forces)
                                     : difference(moved.accelerations, answer.accelerations);
        growth = std::max(growth, change / size);
    }
    return growth;
}

/// 1e-11, where that is not kept the solver's own residual bound times the growth.
double bound_of(CampaignCase const& c, oracle::OracleResult<long double> const& exact,
                double residual_bound, double error, bool forces) {
    return error <= least ? least : std::max(least, residual_bound * growth_of(c, exact, forces));
}

/// openmp where it is built.
std::vector<Backend> const& backends() {
    static std::vector<Backend> const built = cpu_backends();
    return built;
}

struct Row {
    int seeds = 0, tips = 0, dense = 0, above_least = 0;
    double acceleration = 0, force = 0, over_bound = 0, residual_over_bound = 0, oracles = 0,
           in_double = 0;
    void add(CampaignCase const& c, CampaignErrors const& e) {
        ++seeds;
        tips += c.chain.tip == Tip::jointed;
        dense += c.chain.size() <= 12;
        acceleration = std::max(acceleration, e.acceleration);
        force = std::max(force, e.force);
        over_bound =
            std::max({over_bound, e.acceleration / e.acceleration_bound, e.force / e.force_bound});
        above_least += e.acceleration > least || e.force > least;
        residual_over_bound = std::max(residual_over_bound, e.residual / e.residual_bound);
        oracles = std::max(oracles, e.oracles);
        in_double = std::max(in_double, e.in_double);
    }
};

void print(std::map<std::string, Row> const& table) {
    fmt::print("{:<20}{:>7}{:>6}{:>7}{:>11}{:>11}{:>13}{:>13}{:>11}{:>15}{:>12}\n", "kind", "seeds",
               "tips", "dense", "q'' error", "force err.", "above 1e-11", "error/bound",
               "res./bound", "aba in double", "aba - dense");
    for (auto const& [kind, r] : table)
        fmt::print(
            "{:<20}{:>7}{:>6}{:>7}{:>11.1e}{:>11.1e}{:>13}{:>13.3f}{:>11.3f}{:>15.1e}{:>12.1e}\n",
            kind, r.seeds, r.tips, r.dense, r.acceleration, r.force, r.above_least, r.over_bound,
            r.residual_over_bound, r.in_double, r.oracles);
    std::fflush(stdout);
}

/// Empty where all is good.
std::string add_to(Row& row, CampaignCase const& c) {
    try {
        CampaignErrors const e = campaign_errors(c, c.chain);
        row.add(c, e);
        if (e.acceleration > least || e.force > least)
            fmt::print("seed {}, {}, {} bodies: {}\n", c.seed, c.kind, c.chain.size(), e.text());
        return e.good() ? "" : e.text();
    } catch (std::exception const& error) {
        return error.what();
    }
}

}  // namespace

std::string CampaignErrors::text() const {
    return fmt::format(
        "accelerations {:.3g} (bound {:.3g}), forces {:.3g} (bound {:.3g}), residual {:.3g} (bound "
        "{:.3g}), articulated bodies in double "
        "{:.3g}",
        acceleration, acceleration_bound, force, force_bound, residual, residual_bound, in_double);
}

CampaignCase campaign_case(std::uint64_t seed, CampaignJoints joints) {
    Random random(seed * 0x9e3779b97f4a7c15U + 1);
    CampaignCase c{.seed = seed, .kind = {}, .chain = {}, .loads = {}};
    bool const later = joints == CampaignJoints::later;
    std::size_t const kind = pick(random, later ? std::size(later_kinds) : kind_count + 2),
                      n = 1 + pick(random, 64);
    Base const base = random.chance(0.5) ? Base::fixed : Base::free;
    bool const tip = random.chance(0.4);
    JointType const tip_type = later ? later_tips[pick(random, std::size(later_tips))]
                                     : tips[pick(random, std::size(tips))];
    if (random.chance(0.8)) c.loads.gravity = random.vector(10);
    c.backend = backends()[pick(random, backends().size())];
    c.handles = random.chance(0.5) ? Handles::projected : Handles::full;
    if (!later && kind >= kind_count) {
        bool const linked = kind > kind_count;
        Tip const end = tip ? Tip::jointed : Tip::free;
        c.kind = linked ? "bodies on links" : "beads on links";
        c.chain = linked ? random_linked_chain(seed, n, base, end)
                         : random_bead_chain(seed, n, base, end);
        return c;
    }
    Kind const& of = later ? later_kinds[kind] : kinds[kind];
    c.kind = of.name;
    RandomChainOptions options{.bodies = n,
                               .joints = of.joints,
                               .base = base,
                               .moving = random.chance(0.9),
                               .loaded = random.chance(0.8),
                               .springs = random.chance(0.4),
                               .drag = random.chance(0.3),
                               .driven = random.chance(0.25) ? 0.2 : 0};
    if (random.chance(0.2)) c.loads.linear_drag = 0.3, c.loads.angular_drag = 0.05;
    c.chain = random_chain(seed, options);
    if (!tip) return c;
    CampaignCase with_tip = c;
    with_tip.chain.tip = Tip::jointed;
    with_tip.chain.tip_joint.type = tip_type;
    if (!tip_fits(with_tip)) return c;
    options.tip = tip_type;
    c.chain = random_chain(seed, options);
    return c;
}

CampaignErrors campaign_errors(CampaignCase const& c, ChainSpec const& solved) {
    auto const communicator = serial_communicator();
    Scene scene;
    scene.chains = {solved};
    scene.chains[0].name = "chain";
    scene.forces.gravity = c.loads.gravity;
    scene.forces.linear_drag = c.loads.linear_drag;
    scene.forces.angular_drag = c.loads.angular_drag;
    scene.solver.backend = c.backend;
    scene.solver.handles = c.handles;
    scene.solver.threads = 2;
    ChainSystem system(scene, Axes::joint, *communicator);
    system.evaluate();
    auto const exact = oracle::aba<long double>(c.chain, c.loads);
    Answer const found = answer_of(system, c.chain), expected = answer_of(exact);
    CampaignErrors e;
    e.acceleration = difference(found.accelerations, expected.accelerations);
    e.force = difference(found.forces, expected.forces);
    if (c.chain.size() <= 12) {
        Answer const dense = answer_of(oracle::dense<long double>(c.chain, c.loads));
        e.acceleration =
            std::max(e.acceleration, difference(found.accelerations, dense.accelerations));
        e.force = std::max(e.force, difference(found.forces, dense.forces));
        e.oracles = difference(dense.accelerations, expected.accelerations);
    }
    Answer const in_double = answer_of(oracle::aba<double>(c.chain, c.loads));
    e.in_double = std::max(difference(in_double.accelerations, expected.accelerations),
                           difference(in_double.forces, expected.forces));
    e.residual = system.residual();
    e.residual_bound = system.residual_bound();
    bool const held_twice =
        c.chain.tip == Tip::jointed &&
        in_a_plane(c.chain);  // forces are not unique, nor is there a growth out of plane
    if (held_twice)
        e.force = 0, e.in_double = difference(in_double.accelerations, expected.accelerations);
    e.acceleration_bound =
        held_twice ? least : bound_of(c, exact, e.residual_bound, e.acceleration, false);
    e.force_bound = bound_of(c, exact, e.residual_bound, e.force, true);
    return e;
}

Shrunk smallest_failing(CampaignCase const& c,
                        std::function<bool(CampaignCase const&)> const& good) {
    return shrink(c.chain, [&](ChainSpec const& chain) {
        CampaignCase smaller = c;
        smaller.chain = chain;
        return !tip_fits(smaller) || good(smaller);
    });
}

void run_campaign(std::uint64_t first, std::uint64_t last, CampaignJoints joints) {
    std::map<std::string, Row> table;
    std::string failures, smallest;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        CampaignCase const c = campaign_case(seed, joints);
        std::string const problem = add_to(table[c.kind], c);
        if (problem.empty()) continue;
        failures +=
            fmt::format("seed {}, {}, {} bodies, backend {}, handles {}: {}\n", seed, c.kind,
                        c.chain.size(), name_of(c.backend), name_of(c.handles), problem);
        auto const good = [](CampaignCase const& smaller) {
            return campaign_errors(smaller, smaller.chain).good();
        };
        if (smallest.empty()) smallest = smallest_failing(c, good).description;
    }
    print(table);
    EXPECT_TRUE(failures.empty()) << failures << "the smallest chain found for the first of them:\n"
                                  << smallest;
}

}  // namespace catena::test
