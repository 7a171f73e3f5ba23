// Accelerations to the digits that are claimed: light bodies between heavy ones, loops, and tips
// that restrict less than others.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "error.hpp"
#include "measure/forward_error.hpp"
#include "measure/oracle_accelerations.hpp"
#include "measure/solver_errors.hpp"
#include "reader/load_scene.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using nlohmann::json;

std::string scene_of_case(std::string const& name) {
    return std::string(CATENA_SOURCE_DIR) + "/tests/data/cases/" + name + "/scene.yaml";
}

json solved(Words words) {
    words.insert(words.begin(), "solve");
    words.insert(words.end(), {"--json", "-"});
    return catena(words).json();
}

/// Over the largest of `right`.
double relative_error(json const& found, std::vector<double> const& right) {
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < right.size(); ++i) {
        worst = std::max(worst, std::abs(found.at(i).get<double>() - right[i]));
        largest = std::max(largest, std::abs(right[i]));
    }
    return worst / largest;
}
std::vector<double> right_of(std::string const& file) {
    return oracle_accelerations<oracle::Quad>(load_scene(file), {});
}

/// Two planar rods, at rest, each 1 long with its centre in the middle, J = 0.2 m about it, at
/// angles a = 0.3 and b = 0.6 below the horizontal: (J + m2 + m1 / 4) a'' + (m2 / 2) cos(b - a) b''
/// = g (m2 + m1 / 2) cos a and (m2 / 2) cos(b - a) a'' + (J2 + m2 / 4) b'' = g m2 / 2 cos b, m1 =
/// 1e-6, m2 = 1e6, solved with 60 digits: a'' and b'' - a''.
TEST(Accuracy, ArticulatedHandlesKeepTheirDigitsOnParallelAxes) {
    std::string const scene = scene_of_case("two-rods-mass-ratio");
    std::vector<double> const right{10.2942386495083, -12.2252602354844};
    EXPECT_LE(relative_error(json(right_of(scene)), right), 1e-14);
    json const found = solved({scene, "--handles", "articulated"});
    EXPECT_LE(relative_error(found["joint_accelerations"], right_of(scene)), 4e-15);
    EXPECT_EQ(found["refinement"]["steps_unasked"], 0);
    EXPECT_LT(found["estimated_error"].get<double>(), 1e-13);
    EXPECT_TRUE(found["valid"].get<bool>());
}

/// Twenty rods about y and z in turns; articulated bodies with 113 bits agree with the 120 digits
/// of mpmath.
TEST(Accuracy, ArticulatedHandlesTakeTorquesBetweenLightAndHeavyRods) {
    std::string const scene = scene_of_case("articulated-torque");
    json const found = solved({scene, "--handles", "articulated"});
    EXPECT_LE(relative_error(found["joint_accelerations"], right_of(scene)), 2e-14);
    EXPECT_EQ(found["refinement"]["steps_unasked"], 0);
    EXPECT_LE(found["residual"].get<double>(), found["residual_bound"].get<double>());
    EXPECT_TRUE(found["valid"].get<bool>());
}

TEST(Accuracy, ASmallResidualWithAWrongAnswerIsInvalid) {
    for (std::string const name : {"two-rods-mass-ratio", "articulated-torque"})
        for (std::string const handles : {"projected", "full"}) {
            SCOPED_TRACE(name + ", " + handles);
            std::string const scene = scene_of_case(name);
            Ended const e = catena({"solve", scene, "--handles", handles, "--json", "-"});
            double const error = relative_error(e.json()["joint_accelerations"], right_of(scene)),
                         estimate = e.json()["estimated_error"].get<double>();
            EXPECT_EQ(e.status, 1);
            EXPECT_GT(error, 1e-6);
            EXPECT_GT(estimate, error / 100);
            EXPECT_LT(estimate, error * 1000);
            EXPECT_NE(e.err.find("estimated error of the accelerations"), std::string::npos)
                << e.err;
            EXPECT_NE(e.err.find("--refine 2 or --handles articulated"), std::string::npos)
                << e.err;
            std::string const text = catena({"solve", scene, "--handles", handles}).out,
                              last = text.substr(text.rfind('\n', text.size() - 2) + 1);
            EXPECT_TRUE(last.starts_with("INVALID: estimated error of the accelerations")) << last;
            json const refined = solved({scene, "--handles", handles, "--refine", "4"});
            EXPECT_TRUE(refined["valid"].get<bool>());
            EXPECT_LE(relative_error(refined["joint_accelerations"], right_of(scene)), 1e-12);
        }
}

TEST(Accuracy, AChainAtRestHasNoLargeError) {
    TemporaryFolder const folder;
    std::ofstream(folder / "plumb.yaml")
        << "units: si\nforces: {gravity: [0, 0, -9.81]}\nchains: [{name: a, base: fixed, "
           "generator: {coil: {bodies: 100, turn: 0}}}]\n";
    std::string const text = catena({"solve", folder / "plumb.yaml"}).out;
    EXPECT_NE(text.find("estimated error"), std::string::npos) << text;
    std::string rods =
        "units: si\nforces: {gravity: [0, 0, -9.81]}\nchains:\n  - name: a\n    base: fixed\n    "
        "bodies:\n";
    for (int k = 0; k < 20; ++k)
        rods +=
            "      - {mass: 1, com: [0, 0, -0.5], inertia: [0.1, 0.1, 0.01], joint: {type: "
            "revolute, axis: [0, 1, 0], translation: [0, "
            "0, -1]}}\n";
    std::ofstream(folder / "hanging.yaml") << rods;
    json const hanging = solved({folder / "hanging.yaml"});
    EXPECT_TRUE(hanging["valid"].get<bool>());
    EXPECT_LT(hanging["estimated_error"].get<double>(), 1e-12);
}

TEST(Accuracy, ARunSaysThatItsFirstAccelerationsAreOff) {
    TemporaryFolder const folder;
    std::string const dynamics = "dynamics={integrator: rk4, step: 1e-4, steps: 2}";
    auto const run = [&](std::string const& handles, std::string const& to) {
        return catena({"run", scene_of_case("two-rods-mass-ratio"), "--set", dynamics, "--set",
                       "solver.handles=" + handles, "--output", folder / to});
    };
    Ended const projected = run("projected", "projected");
    EXPECT_EQ(projected.status, 0) << projected.err;
    EXPECT_NE(projected.err.find("the first accelerations may have errors of"), std::string::npos)
        << projected.err;
    EXPECT_NE(projected.err.find("use solver.refine: 2 or solver.handles: articulated"),
              std::string::npos)
        << projected.err;
    Ended const articulated = run("articulated", "articulated");
    EXPECT_EQ(articulated.status, 0) << articulated.err;
    EXPECT_EQ(articulated.err.find("the first accelerations"), std::string::npos)
        << articulated.err;
}

/// The bars stand upright: no force has a moment about a revolute joint, and what rounding leaves
/// of moments was said to be 136 % wrong.
TEST(Accuracy, InverseDynamicsSaysNothingOfLoops) {
    Ended const e = catena({"solve", scene_of_case("loop-inverse-dynamics")});
    expect_good(e);
    EXPECT_NE(e.out.find("residual not computed (bodies form a loop)"), std::string::npos) << e.out;
    json const found = solved({scene_of_case("loop-inverse-dynamics")});
    EXPECT_TRUE(found["rnea_residual"].is_null());
    EXPECT_LT(found["estimated_error"].get<double>(), 1e-12);
}

/// I = 0.021 about a bar's centre, 0.25 from its revolute joint: the parallelogram of four bars
/// turns by J t'' = -g (0.5 + 1) cos t with J = 2 (I + 0.25^2) + 2 0.5^2, from t = pi / 2 with rate
/// 1; by Runge-Kutta's formula with a step of 1e-4, good to 1e-12.
double angle_after(double time) {
    double const inertia = 2 * (0.021 + 0.0625) + 0.5;
    auto const rate = [&](double angle) { return -9.81 * 1.5 * std::cos(angle) / inertia; };
    double angle = std::acos(0.0), speed = 1, h = 1e-4;
    for (int n = 0; n < static_cast<int>(std::lround(time / h)); ++n) {
        double const a1 = rate(angle), v2 = speed + h / 2 * a1, a2 = rate(angle + h / 2 * speed),
                     v3 = speed + h / 2 * a2;
        double const a3 = rate(angle + h / 2 * v2), v4 = speed + h * a3, a4 = rate(angle + h * v3);
        angle += h / 6 * (speed + 2 * v2 + 2 * v3 + v4);
        speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return angle;
}

TEST(Accuracy, AUniversalTipMovesAsARevoluteOne) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", scene_of_case("universal-tip"), "--set", "dynamics.steps=1000",
                            "--output", folder / "run", "--quiet"});
    expect_good(e);
    std::ifstream table(folder / "run/observables.csv");
    std::string header, line, last;
    std::getline(table, header);
    while (std::getline(table, line)) last = line;
    // Potential energy 9.81 1.5 sin t; its column by name.
    auto const column = [](std::string const& text, std::ptrdiff_t at) {
        std::size_t begin = 0;
        for (; at > 0; --at) begin = text.find(',', begin) + 1;
        return text.substr(begin, text.find(',', begin) - begin);
    };
    std::string const before = header.substr(0, header.find("potential_energy"));
    double const found = std::stod(column(last, std::count(before.begin(), before.end(), ',')));
    EXPECT_NEAR(found, 9.81 * 1.5 * std::sin(angle_after(1.0)), 1e-8);
    EXPECT_EQ(solved({scene_of_case("universal-tip")})["dof"], 1);
}

/// In the plane a tip restricts two directions or three, whatever it is; what restricts less is not
/// refused where a weld is taken.
TEST(Accuracy, TipsOfPlanarChainsRestrictWhatThePlaneLeaves) {
    std::string const scene = scene_of_case("universal-tip"), tip = "chains[0].tip.joint=";
    auto const dof = [&](std::string const& joint) {
        Ended const e = catena({"solve", scene, "--json", "-", "--set", tip + joint});
        return e.status == 0 ? e.json()["dof"].get<int>() : -e.status;
    };
    std::string const at = ", translation: [0.5, 0, 0], anchor: [1, 0, 0]}";
    EXPECT_EQ(dof("{type: revolute, axis: [0, 0, 1]" + at), 1);
    EXPECT_EQ(dof("{type: spherical" + at), 1);
    EXPECT_EQ(dof("{type: universal, axes: [[0, 1, 0], [0, 0, 1]]" + at), 1);
    EXPECT_EQ(dof("{type: universal, axes: [[0, 1, 0], [1, 0, 0]]" + at), 0);
    EXPECT_EQ(dof("{type: prismatic, axis: [1, 0, 0]" + at), 1);
    EXPECT_EQ(dof("{type: weld" + at), 0);
}

/// Rods on revolute joints, parallel, in turns about two axes or about any, with masses over many
/// powers of ten.
ChainSpec extreme_chain(std::uint64_t seed) {
    Random random(seed);
    ChainSpec chain;
    chain.name = "chain";
    chain.base = Base::fixed;
    BodyArrays& b = chain.bodies;
    auto const bodies = static_cast<std::size_t>(random.uniform(2, 24));
    double const spread = random.uniform(0, 6);
    int const axes = static_cast<int>(seed % 3), masses = static_cast<int>(seed / 3 % 2);
    bool const loaded = random.chance(0.5);
    for (std::size_t k = 0; k < bodies; ++k) {
        double const m = std::pow(10, masses == 0  ? random.uniform(-spread, spread)
                                      : k % 2 == 0 ? -spread
                                                   : spread);
        b.mass.push_back(m);
        b.com.push_back({{0.5, 0, 0}});
        Sym3 inertia = Sym3::zero();
        inertia(0, 0) = 0.1 * m, inertia(1, 1) = inertia(2, 2) = 0.2 * m;
        b.inertia.push_back(inertia);
        b.joint.push_back(JointType::revolute);
        b.rotation.push_back(Mat3::identity());
        b.translation.push_back({{1, 0, 0}});
        b.axis.push_back(axes == 0   ? Vec3{{0, 1, 0}}
                         : axes == 1 ? (k % 2 == 0 ? Vec3{{0, 1, 0}} : Vec3{{0, 0, 1}})
                                     : random.direction());
        b.q.push_back({random.uniform(-3, 3), 0, 0, 0});
        b.qd.push_back(Vec3::zero());
        b.torque.push_back({{loaded ? random.uniform(-1, 1) : 0, 0, 0}});
    }
    return chain;
}

/// Within a factor of 100 below and 1000 above, where roundings are worth a figure at all; beyond
/// one in ten no digit is right either way.
void expect_honest(Scene const& scene) {
    auto const alone = serial_communicator();
    ChainSystem system(scene, Axes::joint, *alone);
    system.evaluate();
    Solution found;
    ForwardError const error = forward_error(system, [&] { found = solution_of(system); });
    double const right = largest_difference(scene, found,
                                            oracle_accelerations<oracle::Quad>(scene, {})),
                 estimate = *error.estimate;
    EXPECT_GE(estimate, std::min(right, 0.1) / 100 - 1e-15) << right;
    EXPECT_LE(estimate, 1000 * std::max(right, 1e-15)) << right;
    EXPECT_FALSE(right > 1e-4 && error.is_small()) << right << " " << estimate;
}

TEST(Accuracy, EstimatesOfTheErrorAreHonest) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Scene scene;
        scene.chains = {extreme_chain(seed)};
        if (seed % 4 != 0) scene.forces.gravity = {{0, 0, -9.81}};
        scene.solver.backend = Backend::segments;
        scene.solver.threads = 1;
        for (Handles const handles : {Handles::projected, Handles::full, Handles::articulated}) {
            scene.solver.handles = handles;
            SCOPED_TRACE("seed " + std::to_string(seed) + ", " + name_of(handles));
            try {
                expect_honest(scene);
            } catch (ComputationError const&) {  // refused: said, and no answer
            }
        }
    }
}

}  // namespace
}  // namespace catena::test
