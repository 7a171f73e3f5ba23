// Systems as the CALVADOS package writes them: run as they are, with OpenMM's energies term by
// term.
#include <OpenMM.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reader/load_scene.hpp"
#include "scene/scene.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

double constexpr edge = 30;  // nm
double constexpr bond = 0.38, bond_stiffness = 8033, network_stiffness = 700;

/// Coils of links of 0.38 nm, 1.2 nm apart.
std::vector<Vec3> coils(BeadSystem const& beads) {
    double const along = 0.3, across = std::sqrt(bond * bond - along * along);
    std::vector<Vec3> positions;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        Vec3 x{{0, 1.2 * static_cast<double>(c), 0}};
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k) {
            double const turn = 0.9 * static_cast<double>(k);
            positions.push_back(x);
            x = x + Vec3{{along, across * std::cos(turn), across * std::sin(turn)}};
        }
    }
    return positions;
}

void add_pairs(OpenMM::System& system, BeadSystem const& beads, OpenMM::CustomNonbondedForce* force,
               double cutoff) {
    force->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
    force->setCutoffDistance(cutoff);
    for (auto const& link : beads.links)
        force->addExclusion(static_cast<int>(link.inboard), static_cast<int>(link.outboard));
    system.addForce(force);
}

/// Two proteins, each with an elastic network over its first ten residues at the distances of
/// `positions`.
std::unique_ptr<OpenMM::System> written(BeadSystem const& beads,
                                        std::vector<Vec3> const& positions) {
    auto system = bare_system(beads);
    system->setDefaultPeriodicBoxVectors({edge, 0, 0}, {0, edge, 0}, {0, 0, edge});
    auto* charges = new OpenMM::CustomNonbondedForce(
        "q*1.7312259859891999*(exp(-1.2698571646327212*r)/r-0.0015558659308191655); q=q1*q2");
    auto* contacts = new OpenMM::CustomNonbondedForce(
        "0.8368*select(step(r-2^(1/6)*s),4*l*((s/r)^12-(s/r)^6-shift),4*((s/r)^12-(s/"
        "r)^6-l*shift)+(1-l)); "
        "l=select(id1+id2,(id1*id2)*0.5*(l1+l2),0); shift=(s/2.0)^12-(s/2.0)^6; s=0.5*(s1+s2)");
    charges->addPerParticleParameter("q");
    for (char const* const parameter : {"s", "l", "id"})
        contacts->addPerParticleParameter(parameter);
    for (std::int64_t k = 0; k < beads.size(); ++k) {
        charges->addParticle({k % 3 - 1.0});
        contacts->addParticle(
            {0.5 + 0.01 * static_cast<double>(k % 7), 0.1 * static_cast<double>(k % 9), 1});
    }
    add_pairs(*system, beads, charges, 4);
    add_pairs(*system, beads, contacts, 2);
    auto* bonds = new OpenMM::HarmonicBondForce;
    bonds->setUsesPeriodicBoundaryConditions(true);
    for (auto const& link : beads.links)
        bonds->addBond(static_cast<int>(link.inboard), static_cast<int>(link.outboard), bond,
                       bond_stiffness);
    system->addForce(bonds);
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        auto* network = new OpenMM::HarmonicBondForce;
        network->setUsesPeriodicBoundaryConditions(true);
        for (std::int64_t i = beads.chain_offset[c]; i < beads.chain_offset[c] + 10; ++i)
            for (std::int64_t j = i + 2; j < beads.chain_offset[c] + 10; ++j)
                network->addBond(static_cast<int>(i), static_cast<int>(j),
                                 1.05 * norm(positions[i] - positions[j]), network_stiffness);
        system->addForce(network);
    }
    system->addForce(new OpenMM::CMMotionRemover);
    return system;
}

/// Of each force of the System, by OpenMM alone.
std::vector<double> energies_by_openmm(OpenMM::System& system, std::vector<Vec3> const& positions) {
    for (int i = 0; i < system.getNumForces(); ++i) system.getForce(i).setForceGroup(i);
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(system, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    std::vector<OpenMM::Vec3> x;
    for (Vec3 const& p : positions) x.emplace_back(p[0], p[1], p[2]);
    context.setPositions(x);
    std::vector<double> energies;
    for (int i = 0; i < system.getNumForces(); ++i)
        energies.push_back(
            context.getState(OpenMM::State::Energy, false, 1 << i).getPotentialEnergy());
    return energies;
}

bool has_note(Scene const& scene, std::string const& part) {
    return std::any_of(scene.notes.begin(), scene.notes.end(), [&](std::string const& note) {
        return note.find(part) != std::string::npos;
    });
}

class PackageFolder : public ::testing::Test {
  protected:
    BeadSystem beads =
        proteins({random_sequence(24, 1), random_sequence(16, 2)}, 1, Vec3{{edge, edge, edge}});
    std::vector<Vec3> positions = coils(beads);
    std::unique_ptr<OpenMM::System> system = written(beads, positions);
    OpenMmSpec spec = [this] {
        OpenMmSpec made = on_reference("");
        made.system = scratch_file("package.xml", xml_of(*system));
        made.topology = scratch_file("package.pdb", pdb_of(beads, positions));
        return made;
    }();
};

TEST_F(PackageFolder, HasOpenMmsEnergiesTermByTerm) {
    auto const serial = serial_communicator();
    auto const force = make_openmm_force(spec, beads, *serial);
    evaluate(*force, positions);
    auto const terms = force->energies();
    auto const expected = energies_by_openmm(*system, positions);
    ASSERT_EQ(terms.size(), 4U);
    // By number in the System; 2 are the bonds along links.
    std::map<std::string, int> const number{
        {"yukawa", 0}, {"ashbaugh-hatch", 1}, {"HarmonicBondForce", 3}, {"HarmonicBondForce 2", 4}};
    for (auto const& [name, value] : terms) {
        ASSERT_TRUE(number.contains(name)) << name;
        EXPECT_NEAR(value, expected[static_cast<std::size_t>(number.at(name))],
                    1e-6 * std::abs(value))
            << name;
        EXPECT_GT(std::abs(value), 0.01) << name;
    }
}

TEST_F(PackageFolder, IsASceneWithoutAWordOfItsChains) {
    Scene const scene = parse_scene(
        fmt::format("forces: {{openmm: {{system: {}, topology: {}, platform: Reference}}}}\n"
                    "dynamics: {{integrator: g-baoab, step: 0.01, steps: 1, temperature: 293}}\n",
                    spec.system, spec.topology),
        "package.yaml");
    ASSERT_EQ(scene.chains.size(), 2U);
    EXPECT_EQ(scene.chains[0].beads.length[5], bond);
    EXPECT_EQ((*scene.box)[2], edge);
    EXPECT_TRUE(has_note(scene, "The System's CMMotionRemover"));
    EXPECT_FALSE(has_note(
        scene, "soft bonds"));  // bonds of 4.6 % are links, and the network is none of them
    EXPECT_FALSE(has_note(scene, "ring"));
}

/// A chain that the scene writes down with a rigid domain: links are as long as the System's bonds,
/// the domain keeps its shape.
TEST_F(PackageFolder, GivesWrittenChainsItsLinksLengths) {
    auto& bonds = dynamic_cast<OpenMM::HarmonicBondForce&>(system->getForce(2));
    for (int i = 0; i < bonds.getNumBonds(); ++i) {
        int a, b;
        double length, k;
        bonds.getBondParameters(i, a, b, length, k);
        bonds.setBondParameters(i, a, b, 0.40 + 0.001 * i, i == 3 ? 1000 : k);
    }
    std::string text = "x,y,z\n", letters = "GGGG";
    for (std::size_t k = 0; k < 4; ++k)
        text += fmt::format("{},{},0\n", 0.4 * static_cast<double>(k), k == 2 ? 0.3 : 0.0);
    auto const scene_of = [&](std::string const& more) {
        return parse_scene(fmt::format("chains: [{{name: a, count: 2, sequence: GGGGG, model: "
                                       "calvados2}}, {{name: b, sequence: GGGG, model: "
                                       "calvados2, positions: {}, {}}}]\n"
                                       "forces: {{openmm: {{system: {}, map: {{a-1: [0, 4], a-2: "
                                       "[30, 34], b: [10, 13]}}}}}}\n",
                                       scratch_file("written.csv", text), more,
                                       scratch_file("package.xml", xml_of(*system))),
                           "written.yaml");
    };
    Scene const scene = scene_of("rigid: [[2, 4]]");
    EXPECT_EQ(scene.chains[0].beads.length[3], 0.40 + 0.002);
    EXPECT_EQ(scene.chains[1].beads.length[3],
              0.40 + 0.001 * 31);  // the second protein's bonds begin with number 23
    EXPECT_EQ(scene.chains[2].linked.length[1], 0.40 + 0.010);
    EXPECT_TRUE(has_note(scene, "1 link of fixed length stands for soft bonds"));
    EXPECT_EQ(scene_of("links: as_given").chains[2].beads.length[1], 0.4);
}

}  // namespace
}  // namespace catena::testing
