#include "force/openmm_import.hpp"

#include <OpenMM.h>

#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

class Import : public ::testing::Test {
  protected:
    BeadSystem beads = proteins({"KDEK", "GG", "W"});
    std::unique_ptr<OpenMM::System> system = bare_system(beads);
    OpenMM::HarmonicBondForce* bonds = new OpenMM::HarmonicBondForce;

    void SetUp() override {
        system->addForce(bonds);
        bonds->addBond(0, 1, 0.38, 100);
        bonds->addBond(3, 2, 0.41, 100);
        bonds->addBond(0, 5, 7.0, 100);  // no neighbours: no link
        system->addConstraint(1, 2, 0.39);
    }
    ImportedSystem import(std::vector<Vec3> const& positions) {
        return import_openmm_system(scratch_file("import.xml", xml_of(*system)), scratch_file("import.pdb", pdb_of(beads, positions)),
                                    "scene.yaml");
    }
};

TEST_F(Import, ChainsMassesAndLengths) {
    bonds->addBond(4, 5, 0.5, 100);
    auto const positions = wound(beads, 1);
    auto const imported = import(positions);
    EXPECT_FALSE(imported.periodic);
    ASSERT_EQ(imported.chains.size(), 3u);
    EXPECT_EQ(imported.chains[0].name, "A");
    EXPECT_EQ(imported.chains[0].residue, (std::vector<std::string>{"LYS", "ASP", "GLU", "LYS"}));
    EXPECT_EQ(imported.chains[0].mass, std::vector<double>(beads.mass.begin(), beads.mass.begin() + 4));
    EXPECT_EQ(imported.chains[0].length, (std::vector<double>{0, 0.38, 0.39, 0.41}));
    EXPECT_EQ(imported.chains[1].length, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(imported.chains[2].length, std::vector<double>{0});
    EXPECT_LT(difference(imported.chains[1].position, positions, 4), 1e-4);
}

TEST_F(Import, Box) {
    bonds->addBond(4, 5, 0.5, 100);
    bonds->setUsesPeriodicBoundaryConditions(true);
    system->setDefaultPeriodicBoxVectors({5, 0, 0}, {0, 6, 0}, {0, 0, 7});
    auto const imported = import(wound(beads, 1));
    EXPECT_TRUE(imported.periodic);
    EXPECT_EQ(imported.box[0], 5);
    EXPECT_EQ(imported.box[1], 6);
    EXPECT_EQ(imported.box[2], 7);
}

TEST_F(Import, AlphaSynuclein) {
    std::string const reference = std::string(CATENA_TEST_DATA) + "/reference/calvados2-asyn-system-openmm7.xml";
    beads = proteins({std::string(
        "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGGAVVTGVTAVAQKTVEGAGSIAAATGFVKKDQLGKNEEGAPQEGILEDMPVDPDNEAYEMP"
        "SEEGYQDYEPEA")});
    auto const imported = import_openmm_system(reference, scratch_file("asyn.pdb", pdb_of(beads, wound(beads, 1))), "scene.yaml");
    ASSERT_EQ(imported.chains.size(), 1u);
    for (std::int64_t k = 0; k < beads.size(); ++k) {
        EXPECT_NEAR(imported.chains[0].mass[k], beads.mass[k], 1e-9) << k;
        EXPECT_EQ(imported.chains[0].length[k], k > 0 ? 0.38 : 0) << k;
    }
}

TEST_F(Import, Messages) {
    auto const positions = wound(beads, 1);
    EXPECT_EQ(complaint([&] { import(positions); }),
              "particles 4 and 5 (from 0) are joined by no harmonic bond and no constraint (scene.yaml: forces.openmm.system, chain B, "
              "body 2): join "
              "neighbours in a chain, or end the chain between them in the topology (TER)");
    bonds->addBond(4, 5, 0.5, 100);
    std::string const file = scratch_file("import.xml", xml_of(*system));
    EXPECT_EQ(complaint([&] { import_openmm_system(file, scratch_file("short.pdb", pdb_of(proteins({"KD"}), positions)), "scene.yaml"); }),
              "the topology has 2 atoms and the System 7 particles (scene.yaml: forces.openmm.topology): give one atom a particle, in the "
              "System's order");
    EXPECT_EQ(complaint([&] { import_openmm_system(file, "/nowhere/a.pdb", "scene.yaml"); }),
              "cannot open /nowhere/a.pdb (scene.yaml: forces.openmm.topology): name a PDB file that can be read");
    system->addForce(new OpenMM::CMMotionRemover);
    EXPECT_TRUE(
        complaint([&] { import(positions); }).starts_with("the System holds a CMMotionRemover (scene.yaml: forces.openmm.system): "));
}

}  // namespace
}  // namespace catena::testing
