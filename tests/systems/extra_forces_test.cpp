// Serialised forces that a scene adds to those of its builder or System.
#include "systems/extra_forces.hpp"

#include <OpenMM.h>
#include <fmt/format.h>

#include "scene/force_changes.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

class ExtraForces : public ::testing::Test {
  protected:
    BeadSystem beads = proteins({"KDEK", "GGW"});
    OpenMmSpec spec = on_reference();
    std::vector<Vec3> positions = wound(beads, 4);

    std::unique_ptr<Communicator> communicator = serial_communicator();  // outlives the forces
    int files = 0;

    void name(std::string const& file) { add_changes({{file}, {}, {}}, spec); }
    /// Takes the force and names its file.
    void add(OpenMM::Force* force) {
        std::unique_ptr<OpenMM::Force> const owned(force);
        name(scratch_file(fmt::format("extra{}.xml", files++), xml_of(*owned)));
    }
    std::unique_ptr<OpenMmForce> make() const {
        return make_openmm_force(spec, beads, *communicator);
    }
    std::string refusal() const {
        return complaint([&] { make(); });
    }
    /// Refusal of this force alone, after the name of its file.
    std::string refusal_of(OpenMM::Force* force) {
        spec.map.clear();
        add(force);
        std::string const text = refusal(), file = changes_of(spec).extra.at(0);
        EXPECT_TRUE(text.starts_with(file)) << text;
        return text.substr(std::min(text.size(), file.size()));
    }
};

/// A wall at x = 1 with 20 kJ/mol/nm2, and a bond of 5 kJ/mol/nm2 between the chains' first beads.
TEST_F(ExtraForces, ActBesideThoseOfTheBuilder) {
    auto const without = make();
    auto const before = evaluate(*without, positions);
    auto* wall = new OpenMM::CustomExternalForce("20*(x-1)^2");
    for (int p : {1, 5}) wall->addParticle(p);
    wall->setName("wall");
    auto* pull = new OpenMM::HarmonicBondForce;
    pull->addBond(0, 4, 1, 10);
    add(wall);
    add(pull);
    auto const force = make();
    auto const forces = evaluate(*force, positions);
    auto const terms = force->energies();
    ASSERT_EQ(terms.size(), 4U);
    EXPECT_EQ(terms[2].name, "wall");
    EXPECT_EQ(terms[3].name, "HarmonicBondForce");
    double const a = positions[1][0] - 1, b = positions[5][0] - 1,
                 stretch = norm(positions[4] - positions[0]) - 1;
    EXPECT_NEAR(terms[2].value, 20 * (a * a + b * b), 1e-9);
    EXPECT_NEAR(terms[3].value, 5 * stretch * stretch, 1e-9);
    EXPECT_NEAR(forces[1][0] - before[1][0], -40 * a, 1e-9);
    EXPECT_NEAR(norm(forces[4] - before[4]), 10 * std::abs(stretch), 1e-9);
}

TEST_F(ExtraForces, ActBesideThoseOfASystem) {
    auto const system = bare_system(beads);
    auto* own = new OpenMM::CustomExternalForce("y");
    own->addParticle(0);
    system->addForce(own);
    auto* more = new OpenMM::CustomExternalForce("2*y");
    more->addParticle(0);
    add(more);
    spec.builder.clear();
    spec.system = scratch_file("whole.xml", xml_of(*system));
    auto const force = make();
    evaluate(*force, positions);
    auto const terms = force->energies();
    ASSERT_EQ(terms.size(), 2U);
    EXPECT_EQ(terms[1].name, "CustomExternalForce 2");
    EXPECT_NEAR(terms[1].value, 2 * terms[0].value, 1e-12);
}

/// In a box, though no force of the System is periodic.
TEST_F(ExtraForces, HaveTheScenesBox) {
    beads.box = Vec3{{5, 6, 7}};
    positions[2] = positions[2] + Vec3{{50, 0, 0}};
    auto const system = bare_system(beads);
    system->setDefaultPeriodicBoxVectors({2, 0, 0}, {0, 2, 0}, {0, 0, 2});
    spec.builder.clear();
    spec.system = scratch_file("open.xml", xml_of(*system));
    auto* bond = new OpenMM::HarmonicBondForce;
    bond->addBond(1, 2, 0, 2);
    bond->setUsesPeriodicBoundaryConditions(true);
    add(bond);
    auto const force = make();
    evaluate(*force, positions);
    Vec3 const apart = positions[2] - Vec3{{50, 0, 0}} - positions[1];
    EXPECT_NEAR(force->energies().at(0).value, dot(apart, apart), 1e-9);
}

TEST_F(ExtraForces, ThatDoNotFitAreRefusedByName) {
    std::string const where = " (scene.yaml: forces.openmm.extra[0]): ",
                      count =
                          "number its particles from 0 to 6, in the order of the scene's beads "
                          "or of the System";
    auto* bond = new OpenMM::HarmonicBondForce;
    bond->addBond(0, 7, 1, 1);
    EXPECT_EQ(refusal_of(bond),
              " (HarmonicBondForce) does not fit the 7 particles: HarmonicBondForce: Illegal "
              "particle index for a bond: 7" +
                  where + count);
    auto* pairs = new OpenMM::CustomNonbondedForce("r");
    for (int i = 0; i < 6; ++i) pairs->addParticle();
    std::string const text = refusal_of(pairs);
    EXPECT_TRUE(text.starts_with(" (CustomNonbondedForce) does not fit the 7 particles: ")) << text;
    auto* centroids = new OpenMM::CustomCentroidBondForce(1, "x1");
    centroids->addGroup({3, 9});
    centroids->addBond({0});
    EXPECT_TRUE(refusal_of(centroids).starts_with(
        " (CustomCentroidBondForce) does not fit the 7 particles"));
    EXPECT_EQ(refusal_of(new OpenMM::MonteCarloBarostat(1, 300)),
              " (MonteCarloBarostat) is no force between beads" + where +
                  "leave it out: Catena has its own integrators, at constant volume");
    auto* box = new OpenMM::CustomExternalForce("periodicdistance(x,y,z,0,0,0)");
    box->addParticle(0);
    EXPECT_EQ(
        refusal_of(box),
        " (CustomExternalForce) is periodic and the scene has no box" + where +
            "give the scene `box: {periodic: [...]}`, or write the force without periodicity");
}

TEST_F(ExtraForces, OtherFilesAreRefused) {
    name(scratch_file("system.xml", xml_of(*bare_system(beads))));
    EXPECT_NE(
        refusal().find("is not a serialised Force (scene.yaml: forces.openmm.extra[0]): write "
                       "it with OpenMM's XmlSerializer.serialize(force)"),
        std::string::npos)
        << refusal();
    spec.map.clear();
    name(scratch_file("no.xml", "<Force type=\"System\" version=\"1\"></Force>"));
    EXPECT_NE(refusal().find("is not a serialised Force"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace catena::testing
