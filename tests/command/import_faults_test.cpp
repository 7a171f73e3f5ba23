// `catena import`: files of a folder that contradict each other or themselves are refused or noted,
// with the file, the key and the number that do not fit.
#include "structure/calvados2.hpp"
#include "tests/command/package_folder.hpp"
#include "tests/command/tool_folder.hpp"

namespace catena::test {
namespace {

TEST_F(ToolFolder, ATopologyThatDoesNotFitGivesWayToAState) {
    write_pdb("start.pdb", beads / 2, 10);
    std::string const unfit =
        "the topology has 6 atoms and the System 12 particles (mine/start.pdb): give one atom per "
        "particle, in the System's order";
    expect_refused(import(), 2, unfit);
    expect_refused(import({"start.pdb"}), 2, unfit);
    write_state("state.xml");
    expect_noted(
        "The start is state.xml. Not read is start.pdb (6 atoms): the System has 12 parti");
    expect_noted("Not read is start.pdb (6 atoms): the System has 12 particles.", {"state.xml"});
    write("start.pdb", "HEADER\n");
    expect_noted("Not read is start.pdb (cannot be read): the System has 12 particles.");
    fs::remove(file("state.xml"));
    expect_refused(import(), 2, "holds no ATOM record (mine/start.pdb)");
}

TEST_F(ToolFolder, ASystemThatWasCutIsNamedAndNotTheTopology) {
    write_pdb("start.pdb", beads, 10);
    cut("system.xml", 0.3);
    expect_refused(import(), 2, "mine/system.xml is not well-formed: ");
    for (char const* const text : {"", "no XML\n", "<Force type=\"HarmonicBondForce\"/>\n"}) {
        write("system.xml", text);
        expect_refused(import(), 2, "the file holds no serialised System (mine/system.xml)");
    }
}

TEST_F(ToolFolder, AStateThatIsNoneIsSaid) {
    write_pdb("start.pdb", beads, 10);
    for (char const* const text : {"", "no XML\n", "<Force type=\"HarmonicBondForce\"/>\n"}) {
        write("state.xml", text);
        expect_noted("state.xml holds no serialised State: the start is that of start.pdb.");
    }
    fs::remove(file("start.pdb"));
    expect_refused(import(), 2, "the file holds no serialised State (mine/state.xml)");
    write_pdb("start.pdb", beads / 2, 10);
    expect_refused(import(), 2, "the file holds no serialised State (mine/state.xml)");
}

TEST_F(ToolFolder, AnIntegratorWithoutItsSettingsIsRefused) {
    write_pdb("start.pdb", beads, 10);
    auto const refused = [&](std::string const& attributes, std::string const& part) {
        write("integrator.xml", "<?xml version=\"1.0\" ?>\n<Integrator " + attributes + "/>\n");
        expect_refused(import(), 2, part + " (mine/integrator.xml");
    };
    std::string const kind = " type=\"LangevinMiddleIntegrator\" version=\"1\"";
    refused("friction=\".5\" stepSize=\".01\"" + kind,
            "the integrator has no temperature: the file is damaged");
    refused("temperature=\"300\" stepSize=\".01\"" + kind,
            "the integrator has no friction: the file is damaged");
    refused("friction=\".5\" temperature=\"300\"" + kind,
            "the integrator has no stepSize: the file is damaged");
    refused("friction=\".5\" stepSize=\"0\" temperature=\"300\"" + kind,
            "stepSize of the integrator is `0`");
    refused("friction=\".5\" stepSize=\".01\" temperature=\"0\"" + kind, "the temperature is 0 K");
    refused("stepSize=\"0\" type=\"VerletIntegrator\" version=\"1\"",
            "stepSize of the integrator is `0`");
    serialize(OpenMM::VariableLangevinIntegrator(300, 1, 0.001), "Integrator", "integrator.xml");
    expect_noted("The steps of that integrator vary");
}

/// A scene that is refused is not written: messages name the files that its values came from.
TEST_F(ToolFolder, RefusalsNameTheImportedFileAndNoScene) {
    write_pdb("start.pdb", beads, 30);
    Ended const far = import();
    expect_refused(far, 2, "(mine/start.pdb");
    EXPECT_EQ(far.err.find("mine.yaml"), std::string::npos) << far.err;
    fs::remove(file("start.pdb"));
    write_state("state.xml");
    expect_refused(import({"--leave-out", "Walls"}), 2, "(--leave-out)");
    expect_refused(import({"--links", "Walls=1"}), 2, "(--links)");
}

TEST_F(ToolFolder, AnIntegratorThatIsNotKnownIsRefused) {
    write_pdb("start.pdb", beads, 10);
    write("integrator.xml",
          "<?xml version=\"1.0\" ?>\n<Integrator friction=\".5\" stepSize=\".01\" "
          "temperature=\"300\" type=\"FooIntegrator\" version=\"1\"/>\n");
    expect_refused(import(), 2,
                   "`FooIntegrator` is no integrator that is known (mine/integrator.xml)");
    for (std::string const kind : {"ICLangevinIntegrator", "ConstVLangevinMiddleIntegrator"}) {
        std::string const attributes = "friction=\".5\" temperature=\"310\" type=\"" + kind + "\"";
        write("integrator.xml", "<Integrator " + attributes + " stepSize=\".004\"/>\n");
        expect_noted("(" + kind + "): 310 K, friction 0.5/ps, steps of 0.004 ps.");
        expect_noted("what else that integrator does is not taken over");
        write("integrator.xml", "<Integrator " + attributes + "/>\n");
        expect_refused(import(), 2, "`" + kind + "` is no integrator that is known");
    }
    serialize(OpenMM::NoseHooverIntegrator(300, 1, 0.001), "Integrator", "integrator.xml");
    expect_noted("what else that integrator does is not taken over");
}

/// A folder of twelve beads whose System a test changes.
class ChangedSystem : public ToolFolder {
  protected:
    OpenMM::System system;
    void SetUp() override {
        ToolFolder::SetUp();
        auto* bonds = new OpenMM::HarmonicBondForce;
        for (int p = 0; p < beads; ++p) {
            system.addParticle(100);
            if (p > 0) bonds->addBond(p - 1, p, 0.38, 8033);
        }
        system.addForce(bonds);
        save();
        write_pdb("start.pdb", beads, 3.8);
    }
    void save() const { serialize(system, "System", "system.xml"); }
    /// Charges that act as in water of that temperature, at 0.15 mol/l.
    void add_yukawa(double temperature) {
        calvados2::Yukawa const y = calvados2::yukawa(temperature, 0.15);
        auto* force = new OpenMM::CustomNonbondedForce("A*charge1*charge2*exp(-r/D)/r");
        force->addGlobalParameter("A", y.prefactor);
        force->addGlobalParameter("D", 1 / y.kappa);
        force->addPerParticleParameter("charge");
        for (int p = 0; p < beads; ++p) force->addParticle({p % 2 == 0 ? 1.0 : 0.0});
        for (int p = 1; p < beads; ++p) force->addExclusion(p - 1, p);
        system.addForce(force);
        save();
    }
    void save_integrator(double temperature, double step) const {
        serialize(OpenMM::LangevinMiddleIntegrator(temperature, 0.5, step), "Integrator",
                  "integrator.xml");
    }
    void expect_no_note(std::string const& part) const {
        Ended const e = import();
        EXPECT_EQ(e.status, 0) << e.err;
        EXPECT_EQ(e.out.find(part), std::string::npos) << e.out;
    }
};

TEST_F(ChangedSystem, LongStepsAreNotedAsThoseOfBuiltModels) {
    save_integrator(300, 0.06);
    expect_no_note("dynamics.step is");
    save_integrator(300, 0.1);
    expect_noted("dynamics.step is 100 fs: steps up to 60 fs were shown");
    save_integrator(300, 0.3);
    expect_noted("dynamics.step is 0.3 ps, that is 300 fs: steps of such chains are 0.01 to 0.06");
    for (int p = 0; p < beads; ++p) system.setParticleMass(p, 1);
    save();
    save_integrator(300, 0.02);
    expect_noted(
        "steps up to 60 fs were shown for residues, which are 7.9 fs for the System's beads of 1 "
        "amu on links of 0.38 nm.");
}

TEST_F(ChangedSystem, WaterOfAnotherTemperatureIsNoted) {
    add_yukawa(293);
    save_integrator(294.9, 0.01);
    expect_no_note("water");
    fs::remove(file("integrator.xml"));
    expect_noted(
        "the System's charges act as in water at 293 K (permittivity 80.31), the run is at 300 K");
    save_integrator(340, 0.01);
    expect_noted(
        "the System's charges act as in water at 293 K (permittivity 80.31), the run is at 340 K");
    save_integrator(400, 0.01);
    expect_noted("water boils at 400 K, and the System's charges act as in water.");
}

TEST_F(ChangedSystem, AChainThatTheTopologyCutsIsNoted) {
    std::string text = text_in("mine/start.pdb");
    std::size_t const at = text.find("ATOM      7");
    write("start.pdb", text.substr(0, at) + "TER\n" + text.substr(at));
    expect_noted(
        "1 stiff bond joins two chains of the topology (particles 5 and 6, from 0, of chains A and "
        "A-2) and stays a spring");
}

TEST_F(ChangedSystem, PositionsInAnotherUnitAreSaid) {
    write_pdb("start.pdb", beads, 38);
    expect_refused(import(), 2,
                   "neighbours in chain `A` are 10 times as far apart as their links are long: the "
                   "positions seem to be in another unit (mine/start.pdb");
    expect_refused(import(), 2, "multiply the positions by 0.1: PDB and mmCIF files hold angstrom");
    write_pdb("start.pdb", beads, 0.38);
    expect_refused(import(), 2, "are 0.1 times as far apart as their links are long");
}

TEST_F(ChangedSystem, AStateInAnotherUnitIsSaidAndLeavesNoFolder) {
    fs::remove(file("start.pdb"));
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(system, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    std::vector<OpenMM::Vec3> positions;
    for (int p = 0; p < beads; ++p) positions.emplace_back(3.8 * p, 0, 0);
    context.setPositions(positions);
    serialize(context.getState(OpenMM::State::Positions), "State", "state.xml");
    expect_refused(import(), 2, "multiply the positions by 0.1");
    EXPECT_FALSE(fs::exists(here / "mine-start"));
    fs::create_directories(here / "mine-start");  // of an earlier import
    expect_refused(import(), 2, "multiply the positions by 0.1");
    EXPECT_TRUE(fs::exists(here / "mine-start"));
}

TEST_F(ChangedSystem, ATriclinicBoxIsNamed) {
    system.setDefaultPeriodicBoxVectors({9, 0, 0}, {0, 9, 0}, {3, 0, 9});
    auto* pairs = new OpenMM::CustomNonbondedForce("(0.4/r)^12");
    pairs->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
    for (int p = 0; p < beads; ++p) pairs->addParticle();
    system.addForce(pairs);
    save();
    expect_refused(import(), 2,
                   "the System's box is not rectangular: its vector c is (3, 0, 9) nm "
                   "(mine/system.xml)");
}

TEST_F(ChangedSystem, AMassBelowZeroIsNamed) {
    system.setParticleMass(3, -5);
    save();
    expect_refused(import(), 2, "particle 3 (from 0) has mass -5 (mine/system.xml)");
}

/// Ends of chains within a chain of the topology have 2 or 16 amu more.
TEST_F(ChangedSystem, MassesOfEndsAreNoOtherOrder) {
    system.setParticleMass(4, 116);
    system.setParticleMass(5, 102);
    save();
    expect_no_note("in the order of the particles");
    system.setParticleMass(5, 103);
    save();
    expect_noted("ASP has the masses 100 and 103 amu in the System (the latter is particle 5");
}

/// Two beads per residue: the second is lighter.
TEST_F(ChangedSystem, BeadsOfOneResidueMayHaveDifferentMasses) {
    std::string text = text_in("mine/start.pdb");
    for (int p = 0; p < beads; ++p) {
        system.setParticleMass(p, p % 2 == 0 ? 57.05 : 30);
        std::size_t const at = text.find(fmt::format("ATOM  {:5d}", p + 1));
        text.replace(at + 22, 4, fmt::format("{:4d}", p / 2 + 1));
    }
    save();
    write("start.pdb", text);
    expect_no_note("in the order of the particles");
    system.setParticleMass(5, 57.05);
    save();
    expect_noted("ASP has the masses 30 and 57.05 amu in the System (the latter is particle 5");
}

/// Glycine and alanine in turn, in the order of the particles and backwards.
TEST_F(ChangedSystem, AtomsInAnotherOrderThanTheParticlesAreNoted) {
    std::string text = text_in("mine/start.pdb");
    for (int p = 0; p < beads; ++p) {
        system.setParticleMass(p, p < beads / 2 ? 57.05 : 71.08);
        std::size_t const at = text.find(fmt::format("ATOM  {:5d}", p + 1));
        text.replace(at + 17, 3, p < beads / 2 ? "GLY" : "ALA");
    }
    save();
    write("start.pdb", text);
    expect_no_note("in the order of the particles");
    text.replace(text.find("GLY A   3"), 3, "ALA");
    write("start.pdb", text);
    expect_noted(
        "ALA has the masses 57.05 and 71.08 amu in the System (the latter is particle 6, from 0): "
        "does `mine/start.pdb` have its atoms in the order of the particles?");
}

TEST_F(ToolFolder, AConfigurationOfAnotherProgramIsNotedAndLeftOut) {
    write_pdb("start.pdb", beads, 10);
    for (char const* const text : {"a: [1, 2\n", "\tb: 3\n", "", "- a\n"}) {
        write("config.yaml", text);
        expect_noted("config.yaml is not read: ");
        expect_noted("It is not the CALVADOS package's, for it has no `sysname`");
    }
    write("config.yaml", "a: [1, 2\n");
    write("components.yaml", "system: {mine: {nmol: 1}}\n");
    expect_refused(import(), 2, "(mine/config.yaml: line ");
}

TEST_F(ToolFolder, SettingsThatAreNotReadAreNamed) {
    write_pdb("top.pdb", beads, 10);
    serialize(OpenMM::LangevinMiddleIntegrator(310, 0.5, 0.004), "Integrator", "integrator.xml");
    fs::rename(file("system.xml"), file("asyn.xml"));
    write("config.yaml", "sysname: asyn\ntemp: 293\nsteps: 10\n");
    expect_noted("integrator.xml is not read: the settings are those of config.yaml.");
    fs::remove(file("config.yaml"));
    write("components.yaml", "system: {mine: {nmol: 1}}\n");
    expect_noted("components.yaml is not read: the CALVADOS package's config.yaml is not beside");
}

std::unique_ptr<OpenMM::System> system_in(std::string const& file) {
    std::ifstream in(file);
    return std::unique_ptr<OpenMM::System>(OpenMM::XmlSerializer::deserialize<OpenMM::System>(in));
}

/// A folder of the package that a test damages.
class DamagedPackage : public ::testing::Test {
  protected:
    TemporaryFolder here;
    std::string folder = package_folder(here, "idr");

    void replace(std::string const& part, std::string const& other) const {
        replace_in(folder + "/config.yaml", part, other);
    }
    Ended import() const { return catena({"import", "idr", "--overwrite"}, here.path()); }
    void expect_note(std::string const& part) const {
        Ended const e = import();
        ASSERT_EQ(e.status, 0) << e.err;
        EXPECT_NE(e.out.find(part), std::string::npos) << e.out;
    }
};

TEST_F(DamagedPackage, ABoxThatIsNotTheSystemsIsRefused) {
    replace("- 50\n- 50\n- 50\n", "- 20\n- 20\n- 20\n");
    expect_refused(import(), 2,
                   "the box is 20 x 20 x 20 nm, that of idr.xml 50 x 50 x 50 nm (idr/config.yaml: "
                   "box, line 1)");
}

TEST_F(DamagedPackage, AForceThatTheSystemLacksIsRefused) {
    for (auto const& [key, force] : {std::pair{"slab_eq", "CustomExternalForce"},
                                     {"ext_force", "CustomExternalForce"},
                                     {"box_eq", "MonteCarloAnisotropicBarostat"},
                                     {"bilayer_eq", "MonteCarloMembraneBarostat"}}) {
        write(folder + "/config.yaml", config_of("idr", std::string(key) + ": true\n"));
        expect_refused(import(), 2,
                       fmt::format("`{}` is true, but idr.xml has no {} (idr/config.yaml: {}", key,
                                   force, key));
    }
    // The package's continued runs do without the equilibration.
    write(folder + "/config.yaml", config_of("idr", "slab_eq: true\n"));
    fs::copy_file(folder + "/top.pdb", folder + "/checkpoint.pdb");
    expect_note("The start is checkpoint.pdb");
}

TEST_F(DamagedPackage, AnExternalForceThatWasNotAskedForIsSaid) {
    std::string xml = text_in(folder + "/idr.xml");
    xml.insert(xml.find("</Forces>"),
               "<Force type=\"CustomExternalForce\" version=\"1\" forceGroup=\"0\" energy=\"0\">"
               "<PerParticleParameters/><GlobalParameters/><Particles/></Force>");
    write(folder + "/idr.xml", xml);
    expect_note("idr.xml has a CustomExternalForce that config.yaml does not ask for");
}

TEST_F(DamagedPackage, SettingsThatNobodyMeansAreSaid) {
    replace("wfreq: 7000", "wfreq: 70000000");
    expect_note("config.yaml has wfreq 70000000 and 7070000 steps: the package would write no fra");
    replace("friction_coeff: 0.02", "friction_coeff: 1e6");
    expect_note("A friction of 1e+06/ps stops velocities within 1e-06 ps");
    expect_note("Correct (idr/config.yaml: friction_coeff, line 7)");
    replace("restart: checkpoint", "restart: 7");
    expect_refused(import(), 2, "`restart` is `7` (idr/config.yaml: restart, line 9)");
    replace("restart: 7", "restart: null");
    replace("temp: 293.15", "temp: 29315");
    expect_refused(import(), 2, "the temperature is 29315 K (idr/config.yaml: temp, line 13)");
}

TEST_F(DamagedPackage, AConfigurationThatWasCutIsRefused) {
    std::string const whole = text_in(folder + "/config.yaml");
    for (std::string const end : {"te", "temp", "temp:", "temp: 29"}) {
        write(folder + "/config.yaml", whole.substr(0, whole.find("temp: ")) + end);
        Ended const e = import();
        EXPECT_EQ(e.status, 2) << end << e.out;
        EXPECT_NE(e.err.find("(idr/config.yaml)"), std::string::npos) << e.err;
    }
    write(folder + "/config.yaml", whole.substr(0, whole.find(".15")));
    expect_refused(import(), 2,
                   "the configuration ends with `temp`, where the package's ends with `wfreq`");
    write(folder + "/config.yaml", whole.substr(0, whole.find(" 7000\nslab_eq")));
    expect_refused(import(), 2,
                   "the configuration ends within its last line, `wfreq:` (idr/config.yaml): "
                   "write it again with the package's prepare.py, or give that key a value");
    write(folder + "/config.yaml", whole.substr(0, whole.find("000\nslab_eq")));
    expect_note(
        "config.yaml ends with `wfreq: 7` and without a line feed: see that no digit is missing.");
    write(folder + "/config.yaml", whole.substr(0, whole.size() - 1));
    expect_note("config.yaml ends with `slab_eq: false` and without a line feed");
    for (std::string const last : {"temp", "topol"}) {
        std::size_t const end = whole.find('\n', whole.find("\n" + last + ":") + 1) + 1;
        write(folder + "/config.yaml", whole.substr(0, end));
        expect_refused(import(), 2,
                       "the configuration ends with `" + last +
                           "`, where the package's ends with `wfreq`: it was cut "
                           "(idr/config.yaml)");
    }
}

TEST_F(DamagedPackage, AnotherTemperatureOrSaltThanTheSystemsIsRefused) {
    replace("temp: 293.15", "temp: 350");
    expect_refused(import(), 2,
                   "at 350 K charges act with a prefactor of 2.2555 kJ nm/mol, those of idr.xml "
                   "with 1.73001: it was written at another temperature (idr/config.yaml: temp, "
                   "line 13)");
    replace("temp: 350", "temp: 293.15");
    replace("friction_coeff: 0.02\n", "friction_coeff: 0.02\nionic: 0.15\n");
    EXPECT_EQ(import().status, 0) << import().err;
    replace("ionic: 0.15", "ionic: 0.5");
    expect_refused(import(), 2, "0.5 mol/l at 293.15 K screen charges with 2.318/nm");
    expect_refused(import(), 2, "idr.xml does with 1.27/nm: it was written with another ionic");
    replace("ionic: 0.5", "cutoff_yu: 3.5");
    expect_refused(import(), 2, "charges are cut at 3.5 nm, those of idr.xml at 4 nm (idr/config.");
}

TEST_F(DamagedPackage, ContactsThatAreNotTheSystemsAreRefused) {
    for (auto const& [line, made] : {std::pair{"eps_lj: 0.8368", "0.2"},
                                     {"cutoff_lj: 2.5", "2"},
                                     {"fixed_lambda: 0.5", "0"}}) {
        std::string const text = line, key = text.substr(0, text.find(':'));
        write(folder + "/config.yaml", config_of("idr", text + "\n"));
        expect_refused(import(), 2,
                       fmt::format("`{}` is {}, and idr.xml was written with {} (idr/config.yaml: "
                                   "{}",
                                   key, text.substr(key.size() + 2), made, key));
    }
    write(folder + "/config.yaml",
          config_of("idr", "eps_lj: 0.2\ncutoff_lj: 2.0\nfixed_lambda: 0\n"));
    EXPECT_EQ(import().status, 0) << import().err;
    write(folder + "/config.yaml", config_of("idr", "pressure_coupling: true\n"));
    expect_note("`pressure_coupling` is not taken over: the scene has a constant volume.");
}

TEST_F(DamagedPackage, ComponentsOfAnotherSystemAreRefused) {
    std::string const file = folder + "/components.yaml", idr = "system:\n  idr:\n    nmol: 1\n";
    write(file, idr + "    restraint: true\n");
    expect_refused(import(), 2,
                   "the components, their `restraint` and `custom_restraints` of config.yaml make "
                   "2 HarmonicBondForces and 0 CustomBondForces, and idr.xml has 1 "
                   "HarmonicBondForce and 0 CustomBondForces (idr/components.yaml)");
    write(file, idr + "    kb: 4000\n");
    expect_refused(
        import(), 2,
        "bonds of idr.xml have a stiffness of 8033 kJ/mol/nm2, those of `idr` (`kb`) 4000 "
        "(idr/components.yaml: system.idr.kb, line 4)");
    write(file, idr);
    write(folder + "/config.yaml", config_of("idr", "custom_restraints: true\n"));
    expect_refused(import(), 2, "make 2 HarmonicBondForces and 0 CustomBondForces, and idr.xml");
}

TEST_F(DamagedPackage, NetworksThatAreNotTheSystemsAreSaid) {
    std::string const two = package_folder(here, "two-domains"), file = two + "/components.yaml";
    auto const imported = [&](std::string const& more) {
        write(file, "system:\n  two-domains:\n    nmol: 1\n" + more);
        return catena({"import", "two-domains", "--overwrite"}, here.path());
    };
    EXPECT_EQ(imported("    restraint: true\n").status, 0);
    expect_refused(imported("    restraint: true\n    k_harmonic: 70\n"), 2,
                   "bonds of two-domains.xml have a stiffness of 700 kJ/mol/nm2");
    expect_refused(imported("    restraint: true\n    restraint_type: go\n"), 2,
                   "make 1 HarmonicBondForce and 3 CustomBondForces, and two-domains.xml has 2");
    Ended const e = imported("    restraint: false\n");
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("make 1 HarmonicBondForce and 0 CustomBondForces: the others act, too."),
              std::string::npos)
        << e.out;
}

TEST_F(DamagedPackage, APullThatIsNotTheSystemsIsRefused) {
    std::string const slab = package_folder(here, "slab");
    auto const imported = [&](std::string const& more) {
        write(slab + "/config.yaml", config_of("slab", more));
        return catena({"import", "slab", "--overwrite"}, here.path());
    };
    expect_refused(imported("ext_force: true\n"), 2,
                   "`ext_force_expr` is not the CustomExternalForce of slab.xml, "
                   "`k*abs(periodicdistance(x,y,z,x,y,z0))` (slab/config.yaml: ext_force_expr");
    expect_refused(imported("slab_eq: true\nk_eq: 0.2\n"), 2,
                   "`k_eq` is 0.2, and slab.xml was written with 0.02 (slab/config.yaml: k_eq");
    Ended const e = imported("slab_eq: true\nk_eq: 0.02\n");
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("config.yaml has no `steps_eq`; 1000 is assumed."), std::string::npos)
        << e.out;
}

/// Beyond the critical point there is nothing to compare with: the permittivity would be negative.
TEST_F(DamagedPackage, WaterThatIsHotterThanAnyIsNotCompared) {
    for (std::string const temperature : {"700", "2000"}) {
        write(folder + "/config.yaml", config_of("idr", "slab_eq: false\n"));
        replace("temp: 293.15", "temp: " + temperature);
        expect_note("temp is " + temperature +
                    " K, and the permittivity of water is known up to 643 K: whether the charges "
                    "of idr.xml are those of config.yaml's `temp` and `ionic` is not checked.");
    }
}

/// The package writes a complex of two segments as one chain, whose inner ends have no bond between
/// them and the charges of ends.
TEST_F(DamagedPackage, HistidinesAtInnerEndsOfAComplexHaveTheirCharges) {
    double const histidine = calvados2::histidine_charge(7);
    auto const system = system_in(folder + "/idr.xml");
    auto& charges = dynamic_cast<OpenMM::CustomNonbondedForce&>(system->getForce(0));
    charges.setParticleParameters(16, {histidine - 1});
    charges.setParticleParameters(17, {histidine + 1});
    system->removeForce(2);
    auto* const bonds = new OpenMM::HarmonicBondForce;
    for (int p = 1; p < system->getNumParticles(); ++p)
        if (p != 17) bonds->addBond(p - 1, p, 0.38, 8033);
    auto* const network = new OpenMM::HarmonicBondForce;
    network->addBond(0, 2, 0.76, 700);
    system->addForce(bonds), system->addForce(network);
    auto const save = [&] {
        std::ofstream out(folder + "/idr.xml");
        OpenMM::XmlSerializer::serialize(system.get(), "System", out);
    };
    save();
    for (char const* const residue : {"GLY A  17", "GLY A  18"})
        replace_in(folder + "/top.pdb", residue, "HIS" + std::string(residue).substr(3));
    replace("random_number_seed", "pH: 7\nrandom_number_seed");
    expect_refused(import(), 2,
                   "particles 16 and 17 (from 0) are joined by no harmonic bond and no constraint");
    replace_in(folder + "/top.pdb", "ATOM     18", "TER\nATOM     18");
    expect_refused(import(), 2, "the components make 1 molecule, and top.pdb has 2 chains");
    write(folder + "/components.yaml", "system:\n  idr:\n    nmol: 1\n    restraint: true\n");
    expect_note("2, 34 bodies");
    bonds->addBond(16, 17, 0.38, 8033);  // no end: the charge is wrong
    save();
    expect_refused(import(), 2, "that of particle 16 (from 0) of idr.xml has -0.909 e");
}

TEST_F(DamagedPackage, HistidinesAtAnotherPhAreRefused) {
    replace_in(folder + "/top.pdb", "GLY A   4", "HIS A   4");  // it has no charge
    replace("random_number_seed", "pH: 14\nrandom_number_seed");
    EXPECT_EQ(import().status, 0) << import().err;
    replace("pH: 14", "pH: 7");
    expect_refused(
        import(), 2,
        "at that pH a histidine has 0.0909 e, that of particle 3 (from 0) of idr.xml has "
        "0 e: it was written at another pH, or top.pdb has its atoms in another order than the "
        "particles (idr/config.yaml: pH, line 8)");
}

TEST_F(DamagedPackage, ForcesAreLeftOutByTheNamesThatCheckShows) {
    auto const with = [&](std::string const& names) {
        return catena({"import", "idr", "--overwrite", "--leave-out", names}, here.path());
    };
    Ended const one = with("yukawa");
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_NE(one.out.find("The System's yukawa (CustomNonbondedForce) is left out"),
              std::string::npos)
        << one.out;
    Ended const both = with("CustomNonbondedForce");
    EXPECT_EQ(both.status, 0) << both.err;
    EXPECT_NE(both.out.find("2 forces of the System are left out by `leave_out: "
                            "[CustomNonbondedForce]`: yukawa (CustomNonbondedForce), "
                            "ashbaugh-hatch (CustomNonbondedForce)."),
              std::string::npos)
        << both.out;
    expect_refused(with("Yukawa"), 2,
                   "name a force or a kind of force: yukawa (CustomNonbondedForce), ashbaugh-hatch "
                   "(CustomNonbondedForce), HarmonicBondForce");
}

TEST_F(DamagedPackage, ComponentsThatWereCutAreRefused) {
    std::string const components = folder + "/components.yaml";
    write(components, "defaults:\n  nmol: 1\nsystem:\n  idr:\n    nmol: 3\n");
    expect_refused(import(), 2,
                   "the components make 3 molecules, and top.pdb has 1 chain "
                   "(idr/components.yaml)");
    for (char const* const text : {"defaults:\n  nmol: 1\n", "defaults:\n  nmol: 1\nsystem:\n",
                                   "defaults:\n  nmol: 1\nsystem: {}\n"}) {
        write(components, text);
        expect_refused(import(), 2, "the file has no components under `system` (idr/components.");
    }
    write(components, "defaults:\n  nmol: 1\nsystem:\n  idr:\n");
    expect_refused(import(), 2, "component `idr` has no properties (idr/components.yaml)");
    write(components, "defaults:\n  nmol: 1\nsystem:\n  idr:\n    nmol: few\n");
    expect_refused(import(), 2, "`few` is not a number (idr/components.yaml: system.idr.nmol");
}

TEST_F(DamagedPackage, SettingsOfAnotherSystemAreSaid) {
    fs::copy_file(folder + "/idr.xml", folder + "/other.xml");
    Ended const e = catena({"import", "idr/other.xml", "--overwrite"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("The settings are those of config.yaml, which is of idr and not of other"),
              std::string::npos)
        << e.out;
}

TEST_F(DamagedPackage, AFolderAboveTheRunAndItsConfigurationSayWhatToName) {
    expect_refused(catena({"import", "."}, here.path()), 2, "its folder idr holds one: name that");
    expect_refused(catena({"import", "idr/config.yaml"}, here.path()), 2,
                   "the file is not a serialised System (idr/config.yaml): name its folder");
}

TEST_F(DamagedPackage, SequencesAndStructuresBelongIntoAScene) {
    write(here / "rna.fasta", ">one\nGGCUA\n");
    std::string const remedy = "): name the System first, or write a scene whose `chains` have `";
    expect_refused(catena({"import", "rna.fasta"}, here.path()), 2,
                   "the file is not a serialised System (rna.fasta" + remedy + "fasta: rna.fasta`");
    expect_refused(catena({"import", "idr/top.pdb"}, here.path()), 2,
                   "the file is not a serialised System (idr/top.pdb" + remedy + "pdb: top.pdb`");
}

TEST_F(DamagedPackage, AFrictionOfZeroIsSaid) {
    replace("friction_coeff: 0.02", "friction_coeff: 0");
    expect_note("config.yaml has friction 0: without a thermostat");
}

TEST_F(DamagedPackage, ASystemThatIsEmptyIsNamed) {
    write(folder + "/idr.xml", "");
    expect_refused(import(), 2, "the file idr.xml holds no serialised System (idr)");
}

TEST_F(DamagedPackage, AFrameOfAnotherSystemIsRefusedByItsName) {
    std::string const top = text_in(folder + "/top.pdb");
    write(folder + "/checkpoint.pdb", top.substr(0, top.find("ATOM     20")) + "END\n");
    expect_refused(import(), 2,
                   "the topology has 19 atoms and the System 34 particles (idr/checkpoint.pdb): "
                   "name another frame after the folder");
    EXPECT_EQ(catena({"import", "idr", "top.pdb"}, here.path()).status, 0);
    replace("restart: checkpoint", "restart: pdb");
    replace("frestart: restart.chk", "frestart: frame.pdb");
    fs::remove(folder + "/checkpoint.pdb");
    expect_note("config.yaml starts from idr/frame.pdb, which is not there: the start is top.pdb.");
}

}  // namespace
}  // namespace catena::test
