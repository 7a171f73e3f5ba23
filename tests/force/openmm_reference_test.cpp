// Energies and forces against independent computations: tests/data/reference.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/force/beads.hpp"
#include "tests/force/pair_sum.hpp"

namespace catena::testing {
namespace {

std::string const folder = std::string(CATENA_TEST_DATA) + "/reference/";
bool const is_openmm_7 = openmm_version().starts_with("OpenMM 7");

struct Synuclein {
    explicit Synuclein(std::string const& name)
        : data(nlohmann::json::parse(std::ifstream(folder + "calvados2-asyn-" + name + ".json"))),
          beads(proteins({data["sequence"].get<std::string>()})),
          positions(vectors(data["positions"])),
          contact(vectors(data["forces"]["ashbaugh-hatch"])),
          charges(vectors(data["forces"]["yukawa"])) {}

    static std::vector<Vec3> vectors(nlohmann::json const& rows) {
        std::vector<Vec3> made;
        for (auto const& row : rows) made.push_back({{row[0], row[1], row[2]}});
        return made;
    }
    std::vector<Vec3> expected() const {
        std::vector<Vec3> sum;
        for (std::size_t k = 0; k < contact.size(); ++k) sum.push_back(contact[k] + charges[k]);
        return sum;
    }

    nlohmann::json data;
    BeadSystem beads;
    std::vector<Vec3> positions, contact, charges;
};

void compare(OpenMmForce& force, Synuclein const& synuclein, double tolerance) {
    auto const expected = synuclein.expected();
    auto const forces = evaluate(force, synuclein.positions);
    EXPECT_LT(difference(forces, expected), tolerance * largest(expected));
    auto const energies = force.energies();
    ASSERT_EQ(energies.size(), 2u);
    for (auto const& term : energies) {
        double const value = synuclein.data["energy"][term.name].get<double>();
        EXPECT_NEAR(term.value, value, tolerance * std::abs(value)) << term.name;
    }
}

class Reference : public ::testing::TestWithParam<std::string> {
  protected:
    Synuclein synuclein{GetParam()};
    std::unique_ptr<Communicator> serial = serial_communicator();

    std::unique_ptr<OpenMmForce> from_system(std::string const& file) {
        OpenMmSpec spec = on_reference("");
        spec.system = folder + file;
        spec.topology = scratch_file("asyn.pdb", pdb_of(synuclein.beads, synuclein.positions));
        return make_openmm_force(spec, synuclein.beads, *serial);
    }
};

// The Reference platform computes in double precision as the reference did: what is left is the
// order of sums, some ulps of the largest terms.
double constexpr in_double = 1e-10;
double constexpr in_single = 1e-3;

TEST_P(Reference, BuilderInDoublePrecision) {
    auto const force = make_openmm_force(on_reference(), synuclein.beads, *serial);
    EXPECT_EQ(force->platform(), "Reference");
    compare(*force, synuclein, in_double);
    auto const terms = force->energies();
    EXPECT_EQ(terms[0].name, "ashbaugh-hatch");
    EXPECT_EQ(terms[1].name, "yukawa");
}

TEST_P(Reference, BuilderOnTheCpuPlatform) {
    OpenMmSpec spec = on_reference();
    spec.platform.clear();
    spec.path = "host";
    auto const force = make_openmm_force(spec, synuclein.beads, *serial);
    EXPECT_EQ(force->platform(), "CPU");
    compare(*force, synuclein, in_single);
}

TEST_P(Reference, FarFromTheOriginToo) {
    for (auto& x : synuclein.positions) x = x + Vec3{{4096, -4096, 8192}};
    OpenMmSpec spec = on_reference();
    spec.platform.clear();
    auto const force = make_openmm_force(spec, synuclein.beads, *serial);
    compare(*force, synuclein, in_single);
}

TEST_P(Reference, SystemOfTheSameModel) {
    if (is_openmm_7)
        GTEST_SKIP() << "NOT RUN: OpenMM 7 cannot read it: see SystemForOpenMm7 and Unreadable";
    compare(*from_system("calvados2-asyn-system.xml"), synuclein, in_double);
}

TEST_P(Reference, SystemForOpenMm7) {
    auto const force = from_system("calvados2-asyn-system-openmm7.xml");
    compare(*force, synuclein, in_double);
    std::string const text = fmt::format("{}", fmt::join(force->description(), "\n"));
    EXPECT_NE(text.find("139 harmonic bonds along rigid links left out (length 0.38 nm)"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("terms: ashbaugh-hatch, yukawa"), std::string::npos) << text;
}

TEST_P(Reference, OneGroupOfTheSystem) {
    OpenMmSpec spec = on_reference("");
    spec.system = folder + "calvados2-asyn-system-openmm7.xml";
    spec.force_groups = {2};
    auto const force = make_openmm_force(spec, synuclein.beads, *serial);
    EXPECT_LT(difference(evaluate(*force, synuclein.positions), synuclein.charges),
              in_double * largest(synuclein.charges));
    ASSERT_EQ(force->energies().size(), 1u);
    EXPECT_EQ(force->energies()[0].name, "yukawa");
}

INSTANTIATE_TEST_SUITE_P(Synuclein, Reference, ::testing::Values("extended", "coil"),
                         [](auto const& i) { return i.param; });

/// Against the pair sum: what the reference data have no numbers for.
class PairSum : public ::testing::Test {
  protected:
    BeadSystem beads = proteins(
        {random_sequence(40, 1) + "HHH", "H" + random_sequence(30, 2), random_sequence(25, 3)});
    std::unique_ptr<Communicator> serial = serial_communicator();

    void compare(OpenMmSpec const& spec, std::vector<Vec3> const& positions) {
        auto const force = make_openmm_force(spec, beads, *serial);
        evaluate(*force, positions);
        auto const energies = force->energies();
        auto const expected = pair_sum(beads, spec, positions);
        EXPECT_NEAR(energies[0].value, expected.ashbaugh_hatch,
                    1e-11 * std::abs(expected.ashbaugh_hatch));
        EXPECT_NEAR(energies[1].value, expected.yukawa, 1e-11 * std::abs(expected.yukawa));
    }
};

TEST_F(PairSum, HistidineAtGivenPh) {
    OpenMmSpec spec = on_reference();
    auto const positions = wound(beads, 4);
    compare(spec, positions);
    double const neutral = pair_sum(beads, spec, positions).yukawa;
    for (double const ph : {4.0, 6.0, 7.0}) {
        spec.ph = ph;
        compare(spec, positions);
        EXPECT_GT(std::abs(pair_sum(beads, spec, positions).yukawa - neutral), 1e-3);
    }
}

TEST_F(PairSum, TemperatureAndSalt) {
    OpenMmSpec spec = on_reference();
    spec.temperature = 277;
    spec.ionic_strength = 0.01;
    compare(spec, wound(beads, 5));
}

TEST_F(PairSum, InABox) {
    beads.box = Vec3{{9, 8.5, 8.25}};
    auto positions = wound(beads, 6);
    compare(on_reference(), positions);
    for (std::size_t k = 0; k < positions.size(); ++k)
        positions[k][k % 3] += (*beads.box)[k % 3] * static_cast<double>(k % 5);
    compare(on_reference(), positions);  // unwrapped as it comes
}

TEST_F(PairSum, SwitchedOffBeforeTheCutoffs) {
    OpenMmSpec spec = on_reference();
    spec.switch_width = 0.3;
    compare(spec, wound(beads, 7));
}

TEST_F(PairSum, SwitchedForcesAreTheGradient) {
    OpenMmSpec spec = on_reference();
    spec.switch_width = 0.3;
    auto const force = make_openmm_force(spec, beads, *serial);
    auto positions = wound(beads, 8);
    auto const forces = evaluate(*force, positions);
    auto const energy = [&] {
        auto const sum = pair_sum(beads, spec, positions);
        return sum.ashbaugh_hatch + sum.yukawa;
    };
    double const step = 1e-5;
    for (std::size_t k = 0; k < positions.size(); k += 9) {
        double const x = positions[k][1];
        positions[k][1] = x + step;
        double const above = energy();
        positions[k][1] = x - step;
        double const below = energy();
        positions[k][1] = x;
        EXPECT_NEAR(forces[k][1], (below - above) / (2 * step), 1e-6 * largest(forces)) << k;
    }
}

/// Two charges that a cutoff lies between: the force jumps there unless it is switched.
TEST(Switching, TakesTheForceJumpAway) {
    auto const serial = serial_communicator();
    BeadSystem const beads = proteins({"K", "KK"});
    auto const jump = [&](double width) {
        OpenMmSpec spec = on_reference();
        spec.switch_width = width;
        auto const force = make_openmm_force(spec, beads, *serial);
        auto const at = [&](double r) {
            return evaluate(*force, {Vec3::zero(), {{r, 0, 0}}, {{r + 0.38, 0, 0}}})[0][0];
        };
        return std::abs(at(4 - 1e-9) - at(4 + 1e-9));
    };
    EXPECT_GT(jump(0), 1e-3);
    EXPECT_LT(jump(0.2), 1e-9);
}

}  // namespace
}  // namespace catena::testing
