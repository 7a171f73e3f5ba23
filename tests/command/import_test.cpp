// `catena import`: folders of other tools become scenes that check and run, with OpenMM's energies.
#include <OpenMM.h>
#include <openmm/serialization/XmlSerializer.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "frames/trajectory_file.hpp"
#include "io/observables_table.hpp"
#include "systems/pdb_topology.hpp"
#include "tests/command/package_folder.hpp"

namespace catena::test {
namespace {

/// Serialises a System, State or Integrator.
template <class Object>
void write_xml(Object const& object, std::string const& root, std::string const& file) {
    std::ofstream out(file);
    OpenMM::XmlSerializer::serialize(&object, root, out);
}

std::unique_ptr<OpenMM::System> system_in(std::string const& file) {
    std::ifstream in(file);
    return std::unique_ptr<OpenMM::System>(OpenMM::XmlSerializer::deserialize<OpenMM::System>(in));
}

/// Energies of each force of the System by OpenMM alone (Reference), kJ/mol.
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

/// Energies of the terms in the first row of a run's observables.
std::vector<std::pair<std::string, double>> terms_of(std::string const& run) {
    ObservablesTable const table = read_observables(run + "/observables.csv");
    std::vector<std::pair<std::string, double>> terms;
    for (std::size_t i = 0; i < table.names.size(); ++i) {
        std::string const& name = table.names[i];
        auto const end = name.find("_energy [");
        if (end == std::string::npos) continue;
        std::string const term = name.substr(0, end);
        static std::set<std::string> const own{"gravity", "springs", "potential", "kinetic",
                                               "total"};
        if (!own.contains(term)) terms.emplace_back(term, table.columns[i].at(0));
    }
    return terms;
}

/// Runs the scene for no step and compares its terms with OpenMM's on the same positions. `forces`
/// are the numbers of the System's forces that are the terms, in their order.
void expect_openmms_energies(TemporaryFolder const& folder, std::string const& scene,
                             std::string const& system, std::vector<int> const& forces) {
    Ended const e = catena({"run", scene, "--steps", "0", "--output", "none", "--overwrite",
                            "--set", "forces.openmm.platform=Reference"},
                           folder.path());
    ASSERT_EQ(e.status, 0) << e.err;
    TrajectoryFile const trajectory(folder / "none");
    Snapshot start;
    trajectory.read(0, start);
    auto const whole = system_in(system);
    auto const expected = energies_by_openmm(*whole, start.position);
    auto const terms = terms_of(folder / "none");
    ASSERT_EQ(terms.size(), forces.size());
    for (std::size_t i = 0; i < forces.size(); ++i) {
        double const energy = expected.at(static_cast<std::size_t>(forces[i]));
        EXPECT_NEAR(terms[i].second, energy, 1e-6 * std::abs(energy)) << terms[i].first;
        EXPECT_GT(std::abs(energy), 1e-3) << terms[i].first;
    }
}

TEST(Import, AFolderOfTheCalvadosPackageBecomesAScene) {
    TemporaryFolder const here;
    package_folder(here, "idr");
    Ended const e = catena({"import", "idr", "--json", "import.json"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("CALVADOS package"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("catena run idr.yaml"), std::string::npos) << e.out;
    std::string const scene = text_in(here / "idr.yaml");
    EXPECT_NE(scene.find("system: idr/idr.xml\n    topology: idr/top.pdb\n"), std::string::npos)
        << scene;
    EXPECT_NE(scene.find("dynamics: {integrator: g-baoab, step: 0.01, steps: 7070000, temperature: "
                         "293.15, friction: 0.02, seed: 1}\noutput: {every: 7000}\nrelax: true\n"),
              std::string::npos)
        << scene;
    auto const json = nlohmann::json::parse(text_in(here / "import.json"));
    EXPECT_EQ(json["tool"], "CALVADOS package");
    EXPECT_EQ(json["check"]["valid"], true);
    expect_good(catena({"check", "idr.yaml"}, here.path()));
    expect_openmms_energies(here, "idr.yaml", here / "idr/idr.xml", {0, 1});
    expect_refused(catena({"import", "idr"}, here.path()), 2, "the scene exists (idr.yaml)");
    expect_good(catena({"import", "idr", "--overwrite"}, here.path()));
}

/// The package pulls the slab together for 50 steps, then removes that force.
TEST(Import, ASlabIsEquilibratedFirst) {
    TemporaryFolder const here;
    package_folder(here, "slab", "slab_eq: true\nsteps_eq: 50\nfriction: 0.5\n");
    Ended const e = catena({"import", "slab", "--output", "s.yaml"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("catena run s.yaml --restart s-equilibration-run/checkpoint.h5 --branch "
                         "--output s-run"),
              std::string::npos)
        << e.out;
    EXPECT_NE(e.out.find("friction 0.5 and friction_coeff 0.02"), std::string::npos) << e.out;
    EXPECT_NE(text_in(here / "s.yaml").find("leave_out: [CustomExternalForce]"), std::string::npos);
    EXPECT_EQ(text_in(here / "s-equilibration.yaml").find("leave_out"), std::string::npos);
    EXPECT_NE(text_in(here / "s-equilibration.yaml").find("steps: 50,"), std::string::npos);
    expect_openmms_energies(here, "s-equilibration.yaml", here / "slab/slab.xml", {0, 1, 3});
    expect_openmms_energies(here, "s.yaml", here / "slab/slab.xml", {0, 1});
    ASSERT_EQ(
        catena({"run", "s-equilibration.yaml", "--output", "s-equilibration-run"}, here.path())
            .status,
        0);
    Ended const production =
        catena({"run", "s.yaml", "--restart", "s-equilibration-run/checkpoint.h5", "--branch",
                "--output", "s-run", "--set", "dynamics.steps=50", "--set", "output.every=10"},
               here.path());
    EXPECT_EQ(production.status, 0) << production.err;
    EXPECT_EQ(terms_of(here / "s-run").size(), 2U);
}

/// Writes the positions of a topology as a State.
void write_state_of(std::string const& system, std::string const& topology,
                    std::string const& file) {
    auto const whole = system_in(system);
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(*whole, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    std::vector<OpenMM::Vec3> x;
    for (PdbChain const& chain : read_pdb_topology(topology, topology))
        for (Vec3 const& p : chain.position) x.emplace_back(p[0], p[1], p[2]);
    context.setPositions(x);
    write_xml(context.getState(OpenMM::State::Positions), "State", file);
}

/// Production, which is written last, goes to a full device.
TEST(Import, TwoScenesAreWrittenOrNone) {
    TemporaryFolder const here;
    std::string const folder = package_folder(here, "slab", "slab_eq: true\nsteps_eq: 50\n");
    write_state_of(folder + "/slab.xml", folder + "/top.pdb", folder + "/state.xml");
    fs::create_symlink("/dev/full", here / "s.yaml");
    auto const import = [&] {
        return catena({"import", "slab", "state.xml", "--output", "s.yaml", "--overwrite"},
                      here.path());
    };
    Ended const none = import();
    EXPECT_NE(none.status, 0) << none.out;
    EXPECT_NE(none.err.find("No space left"), std::string::npos) << none.err;
    EXPECT_FALSE(fs::exists(here / "s-equilibration.yaml"));
    EXPECT_FALSE(fs::exists(here / "s-start"));
    write(here / "s-equilibration.yaml", "of an earlier import\n");
    EXPECT_NE(import().status, 0);
    Ended const first = catena({"check", "s-equilibration.yaml"}, here.path());
    EXPECT_EQ(first.status, 0) << first.err;  // it was replaced, and has its start
    fs::remove(here / "s.yaml");
    EXPECT_EQ(import().status, 0) << import().err;
    EXPECT_EQ(catena({"check", "s.yaml"}, here.path()).status, 0);
}

TEST(Import, ASettingThatIsNoneIsRefusedWithItsLine) {
    TemporaryFolder const here;
    for (char const* const line : {"temp: 293.15", "friction_coeff: 0.02"}) {
        std::string const folder = package_folder(here, "idr"),
                          key(line, std::string(line).find(':'));
        std::string config = text_in(folder + "/config.yaml");
        config.replace(config.find(line), std::string(line).size(), key + ": -3");
        write(folder + "/config.yaml", config);
        expect_refused(catena({"import", "idr"}, here.path()), 2,
                       key + " -3 is negative (idr/config.yaml: " + key);
        fs::remove_all(folder);
    }
}

TEST(Import, ElasticNetworksStayForces) {
    TemporaryFolder const here;
    package_folder(here, "two-domains");
    Ended const e = catena({"import", "two-domains"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("elastic networks stay forces"), std::string::npos) << e.out;
    expect_openmms_energies(here, "two-domains.yaml", here / "two-domains/two-domains.xml",
                            {0, 1, 3});
}

TEST(Import, APackagesLastFrameIsTheStartUnlessAnotherIsNamed) {
    TemporaryFolder const here;
    std::string const folder = package_folder(here, "two-domains");
    fs::copy_file(folder + "/top.pdb", folder + "/checkpoint.pdb");
    Ended const e = catena({"import", "two-domains"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("The start is checkpoint.pdb, a frame of the package's run"),
              std::string::npos)
        << e.out;
    EXPECT_NE(e.out.find("`relax: true`, because the start is refused as it is: "),
              std::string::npos)
        << e.out;
    ASSERT_EQ(
        catena({"import", "two-domains", "top.pdb", "--output", "b.yaml"}, here.path()).status, 0);
    EXPECT_NE(text_in(here / "b.yaml").find("two-domains/top.pdb"), std::string::npos);
}

/// A polymer of own making: FENE bonds of 0.97 nm on a helix, a bending energy, pairs with a
/// cutoff, the middle of some beads held at a place. Written as system.xml, state.xml and
/// integrator.xml.
class OwnScript : public ::testing::Test {
  protected:
    static int constexpr beads = 30;
    static double constexpr edge = 12;  // nm
    TemporaryFolder here;
    OpenMM::System system;
    std::vector<OpenMM::Vec3> positions;

    void SetUp() override {
        fs::create_directories(here / "mine");
        system.setDefaultPeriodicBoxVectors({edge, 0, 0}, {0, edge, 0}, {0, 0, edge});
        auto* fene = new OpenMM::CustomBondForce("-0.5*k*R0^2*log(1-(r/R0)^2); R0=1.5; k=30");
        fene->setUsesPeriodicBoundaryConditions(true);
        auto* angles = new OpenMM::CustomAngleForce("2*(1+cos(theta))");
        angles->setUsesPeriodicBoundaryConditions(true);
        auto* pairs = new OpenMM::CustomNonbondedForce("3*(1/r)^12");
        pairs->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
        pairs->setCutoffDistance(2);
        auto* middle = new OpenMM::CustomCentroidBondForce(1, "5*((x1-3)^2+y1^2)");
        std::vector<int> group;
        for (int p = 0; p < beads; ++p) {
            system.addParticle(100);
            positions.emplace_back(0.55 * p, 0.8 * std::cos(p), 0.8 * std::sin(p));
            pairs->addParticle();
            if (p > 0) fene->addBond(p - 1, p);
            if (p > 0) pairs->addExclusion(p - 1, p);
            if (p > 1) angles->addAngle(p - 2, p - 1, p);
            if (p < 5) group.push_back(p);
        }
        middle->addGroup(group);
        middle->addBond({0});
        for (OpenMM::Force* force :
             std::initializer_list<OpenMM::Force*>{fene, angles, pairs, middle})
            system.addForce(force);
    }
    /// Writes the files. Positions are put into the box if `wrapped`.
    void write_files(bool wrapped, int parts = OpenMM::State::Positions) {
        if (wrapped)
            for (OpenMM::Vec3& x : positions)
                for (int i = 0; i < 3; ++i) x[i] -= edge * std::floor(x[i] / edge);
        OpenMM::LangevinMiddleIntegrator integrator(310, 0.5, 0.004);
        OpenMM::Context context(system, integrator,
                                OpenMM::Platform::getPlatformByName("Reference"));
        context.setPositions(positions);
        write_xml(system, "System", here / "mine/system.xml");
        write_xml(context.getState(parts), "State", here / "mine/state.xml");
        write_xml(integrator, "Integrator", here / "mine/integrator.xml");
    }
    Ended import(Words more = {}) {
        more.insert(more.begin(), {"import", "mine"});
        return catena(more, here.path());
    }
};

TEST_F(OwnScript, BondsThatCannotBecomeLinksStayForces) {
    write_files(true);
    Ended const e = import();
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("29 bonds of a CustomBondForce (FENE) between neighbours stay forces"),
              std::string::npos)
        << e.out;
    EXPECT_NE(e.out.find("`links: {CustomBondForce: LENGTH}`"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("made whole across the sides of the box"), std::string::npos) << e.out;
    std::string const scene = text_in(here / "mine.yaml");
    EXPECT_NE(scene.find("step: 0.004, steps: 100000, temperature: 310, friction: 0.5"),
              std::string::npos)
        << scene;
    expect_openmms_energies(here, "mine.yaml", here / "mine/system.xml", {0, 1, 2, 3});
    Ended const run =
        catena({"run", "mine.yaml", "--steps", "200", "--output", "out"}, here.path());
    EXPECT_EQ(run.status, 0) << run.err << run.out;
}

TEST_F(OwnScript, WhatAStateLosesIsNoted) {
    write_files(false, OpenMM::State::Positions | OpenMM::State::Velocities);
    Ended const e = import();
    ASSERT_EQ(e.status, 0) << e.err;
    std::string const velocities =
                          "The velocities of state.xml are not used: chains start with thermal "
                          "velocities.",
                      rounded =
                          "The positions of state.xml are rounded to the digits of a PDB file, by "
                          "at most 5.0e-05 nm.";
    EXPECT_NE(e.out.find(velocities), std::string::npos) << e.out;
    EXPECT_NE(e.out.find(rounded), std::string::npos) << e.out;
    EXPECT_NE(text_in(here / "mine.yaml").find("# " + velocities + "\n# " + rounded),
              std::string::npos);
    for (OpenMM::Vec3& x : positions)
        for (int i = 0; i < 3; ++i) x[i] = std::round(1e4 * x[i]) / 1e4;
    write_files(false);
    Ended const exact = import({"--overwrite"});
    ASSERT_EQ(exact.status, 0) << exact.err;
    EXPECT_EQ(exact.out.find("velocities of"), std::string::npos) << exact.out;
    EXPECT_EQ(exact.out.find("rounded"), std::string::npos) << exact.out;
}

TEST_F(OwnScript, NamesOfFoldersMayHoldAnyCharacter) {
    write_files(false);
    std::string const odd = "a\n\x1b[31m\"b";
    fs::rename(here / "mine", here / odd);
    Ended const e = catena({"import", odd, "--output", "s.yaml"}, here.path());
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(catena({"check", "s.yaml"}, here.path()).status, 0) << text_in(here / "s.yaml");
    EXPECT_EQ((e.out + e.err).find('\x1b'), std::string::npos);
}

/// The columns of a PDB file would make 0 of them.
TEST_F(OwnScript, PositionsThatNoTopologyHoldsAreRefused) {
    positions[3][0] = 2e7;
    write_files(false);
    expect_refused(import(), 2, "the position of particle 4 does not fit into a PDB file");
}

/// Forces on torn FENE bonds are small, and their energy is not a number.
TEST_F(OwnScript, AStateWhoseBondsAreTornIsRefused) {
    for (OpenMM::Vec3& x : positions) x *= 10;
    system.setDefaultPeriodicBoxVectors({900, 0, 0}, {0, 900, 0}, {0, 0, 900});
    write_files(false);
    expect_refused(import(), 2, "potential energy not a number, largest force");
    expect_refused(import(), 2, "a force is beyond its range, such as a torn FENE bond");
}

/// Nothing but their own length tells that bonds are ten times too short.
TEST_F(OwnScript, BondsInAnotherUnitAreSaid) {
    std::string const note = "Neighbours that a CustomBondForce (FENE) joins are ";
    write_files(false);
    EXPECT_EQ(import().out.find(note), std::string::npos);
    for (OpenMM::Vec3& x : positions) x *= 0.1;
    system.removeForce(2);  // pairs: they would push the beads apart
    write_files(false);
    Ended const e = import({"--overwrite"});
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find(note + "0.0"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("if the positions are in another unit, multiply them by 10"),
              std::string::npos)
        << e.out;
}

TEST_F(OwnScript, NamedBondsBecomeLinks) {
    write_files(false);
    Ended const e = import({"--links", "CustomBondForce=0.97"});
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.out.find("stay forces"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("1, 30 bodies"), std::string::npos) << e.out;
    EXPECT_NE(text_in(here / "mine.yaml").find("links: {CustomBondForce: 0.97}"),
              std::string::npos);
    Ended const check = catena({"check", "mine.yaml"}, here.path());
    EXPECT_NE(check.out.find("29 bonds of CustomBondForces along rigid links left out (length 0.97 "
                             "nm)"),
              std::string::npos)
        << check.out;
    expect_openmms_energies(here, "mine.yaml", here / "mine/system.xml", {1, 2, 3});
    Ended const wrong = import({"--overwrite", "--links", "CustomBondForce=9.7"});
    expect_refused(wrong, 2, "the positions or the lengths of `links` seem to be in another unit");
    expect_refused(wrong, 2, "correct these lengths, nm, or multiply the positions by 10");
    expect_refused(import({"--overwrite", "--links", "Bonds=0.97"}), 2,
                   "the System has no CustomBondForce `Bonds`");
    expect_refused(import({"--overwrite", "--links", "CustomBondForce"}), 2,
                   "`CustomBondForce` names no force and length");
}

TEST_F(OwnScript, ConstraintsBecomeLinksAndTheStartIsUnwrapped) {
    system.removeForce(0);
    for (int p = 1; p < beads; ++p) {
        OpenMM::Vec3 const step = positions[p] - positions[p - 1];
        system.addConstraint(p - 1, p, std::sqrt(step.dot(step)));
    }
    system.addForce(new OpenMM::CMMotionRemover);
    auto* bond = new OpenMM::HarmonicBondForce;  // far apart: a spring that stays one
    bond->addBond(0, 20, 9, 3);
    bond->setUsesPeriodicBoundaryConditions(true);
    system.addForce(bond);
    write_files(true);
    Ended const e = import();
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("The System's CMMotionRemover"), std::string::npos) << e.out;
    expect_openmms_energies(here, "mine.yaml", here / "mine/system.xml", {0, 1, 2, 4});
}

TEST_F(OwnScript, BarostatsAreRefusedWithTheWayOut) {
    system.addForce(new OpenMM::MonteCarloBarostat(1, 310));
    write_files(false);
    expect_refused(import(), 2, "the System holds a MonteCarloBarostat");
    expect_refused(import(), 2, "catena import --leave-out MonteCarloBarostat");
    Ended const e = import({"--leave-out", "MonteCarloBarostat"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("MonteCarloBarostat is left out by `leave_out`"), std::string::npos)
        << e.out;
    expect_refused(import({"--overwrite", "--leave-out", "MonteCarloBarostat,Walls"}), 2,
                   "the System has no force `Walls`");
}

TEST_F(OwnScript, WhatIsAmbiguousOrMissingIsRefused) {
    write_files(false);
    fs::copy_file(here / "mine/system.xml", here / "mine/other.xml");
    expect_refused(import(), 2, "the folder holds 2 Systems: other.xml, system.xml (mine)");
    Ended const named = catena({"import", "mine/other.xml"}, here.path());
    EXPECT_EQ(named.status, 0) << named.err;
    fs::remove(here / "mine/other.xml");
    expect_refused(import({"c.pdb"}), 2, "no such file (c.pdb)");
    expect_refused(import({"integrator.xml"}), 2, "is not a serialised State");
    fs::remove(here / "mine/state.xml");
    expect_refused(import(), 2, "the folder holds no topology (PDB, mmCIF) and no State");
    fs::remove(here / "mine/system.xml");
    expect_refused(import(), 2, "the folder holds no serialised System");
    expect_refused(catena({"import", "nowhere"}), 2, "no such file or folder (nowhere)");
    expect_refused(catena({"import"}), 2, "no folder or System is named");
}

}  // namespace
}  // namespace catena::test
