// Energies with residue tables: OpenMM's with the formula of the CALVADOS package, term by term.
#include <OpenMM.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

double constexpr edge = 40;  // nm

std::string table_file(std::string const& name) {
    return std::string(CATENA_SOURCE_DIR) + "/inputs/residues_" + name + ".csv";
}

/// Columns MW, lambdas, sigmas, q by one-letter code; of a file of inputs/, whose order it knows.
std::map<char, std::array<double, 4>> read_table(std::string const& file) {
    std::map<char, std::array<double, 4>> table;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (line.size() < 6 || line[1] != ',') continue;
        std::istringstream numbers(line.substr(6));
        for (double& value : table[line[0]]) {
            std::string cell;
            std::getline(numbers, cell, ',');
            value = std::stod(cell);
        }
    }
    return table;
}

/// Conditions of the package's config.yaml.
struct Conditions {
    double temperature = 293.15, ionic = 0.15, ph = 7.5;
};

/// genParamsDH() of the package: prefactor (kJ nm/mol) and inverse Debye length (1/nm).
std::pair<double, double> debye_hueckel(Conditions const& at) {
    double const t = at.temperature, kt = 8.3145 * t * 1e-3;
    double const water =
        5321 / t + 233.76 - 0.9297 * t + 0.1417 * 1e-2 * t * t - 0.8292 * 1e-6 * t * t * t;
    double const bjerrum =
        1.6021766 * 1.6021766 / (4 * M_PI * 8.854188 * water) * 6.02214076 * 1000 / kt;
    return {bjerrum * kt, std::sqrt(8 * M_PI * bjerrum * at.ionic * 6.02214076 / 10)};
}

/// A chain as the package takes it: codes, and whether its ends are charged.
struct Sequence {
    std::string letters;
    bool charged_ends = true;
};

/// Energies of Ashbaugh-Hatch and Yukawa as the package computes them, by OpenMM alone.
std::vector<double> package_energies(std::vector<Sequence> const& chains, std::string const& file,
                                     std::vector<Vec3> const& positions, Conditions const& at) {
    auto const table = read_table(file);
    auto const [prefactor, kappa] = debye_hueckel(at);
    double constexpr cutoff = 4;
    auto* contacts = new OpenMM::CustomNonbondedForce(
        "0.8368*select(step(r-2^(1/6)*s),4*l*((s/r)^12-(s/r)^6-shift),4*((s/r)^12-(s/"
        "r)^6-l*shift)+(1-l)); l=0.5*(l1+l2); shift=(s/2.0)^12-(s/2.0)^6; s=0.5*(s1+s2)");
    auto* charges = new OpenMM::CustomNonbondedForce(
        fmt::format("q*{0:.17g}*(exp(-{1:.17g}*r)/r-{2:.17g}); q=q1*q2", prefactor, kappa,
                    std::exp(-kappa * cutoff) / cutoff));
    for (char const* const name : {"s", "l"}) contacts->addPerParticleParameter(name);
    charges->addPerParticleParameter("q");
    OpenMM::System system;
    system.setDefaultPeriodicBoxVectors({edge, 0, 0}, {0, edge, 0}, {0, 0, edge});
    for (Sequence const& chain : chains)
        for (std::size_t k = 0; k < chain.letters.size(); ++k) {
            auto const [mass, lambda, sigma, q] = table.at(chain.letters[k]);
            double charge = chain.letters[k] == 'H' ? 1 / (1 + std::pow(10, at.ph - 6)) : q;
            if (chain.charged_ends) charge += (k == 0) - (k + 1 == chain.letters.size());
            int const particle = system.addParticle(mass);
            contacts->addParticle({sigma, lambda});
            charges->addParticle({charge});
            if (k == 0) continue;
            contacts->addExclusion(particle - 1, particle);
            charges->addExclusion(particle - 1, particle);
        }
    for (auto* const force : {contacts, charges}) {
        force->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
        force->setForceGroup(system.addForce(force));
    }
    contacts->setCutoffDistance(2);
    charges->setCutoffDistance(cutoff);
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(system, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    std::vector<OpenMM::Vec3> x;
    for (Vec3 const& p : positions) x.emplace_back(p[0], p[1], p[2]);
    context.setPositions(x);
    std::vector<double> energies;
    for (int group = 0; group < 2; ++group)
        energies.push_back(
            context.getState(OpenMM::State::Energy, false, 1 << group).getPotentialEnergy());
    return energies;
}

/// A scene of chains at given positions. `model` is the value of each chain's key.
std::string scene_text(std::vector<Sequence> const& chains, std::string const& model,
                       std::string const& builder, std::vector<Vec3> const& positions,
                       Conditions const& at) {
    std::string text = "chains:\n";
    std::size_t bead = 0;
    for (Sequence const& chain : chains) {
        std::string table;
        for (std::size_t k = 0; k < chain.letters.size(); ++k, ++bead)
            table += fmt::format("{:.17g},{:.17g},{:.17g}\n", positions[bead][0],
                                 positions[bead][1], positions[bead][2]);
        text += fmt::format(
            "  - {{sequence: {}, model: {}, links: as_given, positions: {}, charge_termini: {}}}\n",
            chain.letters, model, scratch_file(fmt::format("x{}.csv", bead), table),
            chain.charged_ends ? "both" : "none");
    }
    return text +
           fmt::format(
               "box: {{periodic: [{0}, {0}, {0}]}}\nforces: {{openmm: {{builder: {1}, temperature: "
               "{2}, ionic_strength: {3}, ph: {4}, platform: Reference, path: inline}}}}\n",
               edge, builder, at.temperature, at.ionic, at.ph);
}

/// Energies of the scene by Catena: ashbaugh-hatch and yukawa, as of package_energies().
std::vector<double> energies_of(std::string const& text) {
    Scene const scene = parse_scene(text, "tables.yaml");
    auto const ranks = serial_communicator();
    ChainSystem system(scene, Axes::joint, *ranks);
    system.evaluate(false);
    std::map<std::string, double> energies;
    for (auto const& [name, value] : system.openmm()->energies()) energies[name] = value;
    EXPECT_EQ(energies.size(), 2U);
    return {energies.at("ashbaugh-hatch"), energies.at("yukawa")};
}

void expect_the_package(std::vector<Sequence> const& chains, std::string const& table,
                        std::string const& model, std::string const& builder) {
    std::vector<std::string> letters;
    // Positions do not depend on the residues.
    for (Sequence const& chain : chains) letters.emplace_back(chain.letters.size(), 'G');
    std::vector<Vec3> const positions = wound(proteins(letters), 3);
    Conditions const at;
    auto const expected = package_energies(chains, table_file(table), positions, at);
    auto const found = energies_of(scene_text(chains, model, builder, positions, at));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], 1e-9 * std::abs(expected[i])) << i;
        EXPECT_GT(std::abs(found[i]), 0.01) << i;
    }
}

std::string own(std::string const& table) { return "{residues: \"" + table_file(table) + "\"}"; }

TEST(Tables, OfCalvados3GiveThePackagesEnergies) {
    expect_the_package({{random_sequence(60, 5)}, {random_sequence(40, 6), false}}, "CALVADOS3",
                       "calvados3", "calvados3");
}

TEST(Tables, OfPhosphorylatedResiduesGiveThePackagesEnergies) {
    expect_the_package({{"SASSBPBPSOPTKSGKMRSRSSBPVRPKAYOPBPRBPNYHRF"}, {"OHKRDB"}}, "pCALVADOS2",
                       own("pCALVADOS2"), "calvados2");
}

TEST(Tables, OfPolyethyleneGlycolGiveThePackagesEnergies) {
    expect_the_package({{"GSMASASSSQRGRSGSGNFGGG"}, {"JJJJJJJJJJJJJJJ", false}}, "C2PEG",
                       own("C2PEG"), "calvados2");
}

/// Two residues without charged ends, 0.7 nm apart.
double pair_energy(char a, char b) {
    std::vector<Vec3> const positions = {{{1, 1, 1}}, {{1.7, 1, 1}}};
    Conditions at;
    at.temperature = 298;
    auto const energies =
        energies_of(scene_text({{std::string(1, a), false}, {std::string(1, b), false}},
                               "calvados2", "calvados2", positions, at));
    return energies.at(0) + energies.at(1);
}

TEST(Tables, GiveTheEnergiesOfPairs) {
    EXPECT_NEAR(pair_energy('E', 'R'), -1.339330, 1e-5);
    EXPECT_NEAR(pair_energy('E', 'D'), 1.019402, 1e-5);
    EXPECT_NEAR(pair_energy('Y', 'W'), -0.663275, 1e-5);
    EXPECT_NEAR(pair_energy('R', 'W'), -0.509125, 1e-5);
}

}  // namespace
}  // namespace catena::testing
