// `catena import`: files that are damaged or are not what their names say, and folders of
// OpenMiChroM, polychrom and OpenABC. The folders are made up; names and units are the tools' own.
#include <hdf5.h>

#include "tests/command/tool_folder.hpp"

namespace catena::test {
namespace {

TEST_F(ToolFolder, AConfigurationThatIsNotWellFormedIsRefused) {
    write_pdb("start.pdb", beads, 10);
    write("config.yaml", "sysname: mine\ntemp: 293\nbox: [1, 2\n");
    expect_refused(import(), 2, "(mine/config.yaml: line ");
    write("components.yaml", "defaults: {nmol: 1}\nsystem: {mine: {restraint: false}}\n");
    for (char const* const text : {"", "# nothing\n", "- sysname\n", "sysname\n"}) {
        write("config.yaml", text);
        expect_refused(import(), 2, "the file holds no keys with values (mine/config.yaml)");
    }
    write("config.yaml", "learning_rate: 3\n");
    expect_refused(import(), 2, "the configuration has no `sysname` (mine/config.yaml)");
    fs::remove(file("components.yaml"));
    // The package writes its keys in alphabetical order.
    write("config.yaml", "box: [9, 9, 9]\next_force_expr: x\nfriction_coeff: 0.01\nfrestart: a\n");
    expect_refused(import(), 2, "the configuration has no `sysname` (mine/config.yaml)");
    write("config.yaml", "learning_rate: 3\n");
    expect_noted("config.yaml is not read: it has no `sysname`");
}

/// Files of Catena and of programs whose input is not read are called by name.
TEST_F(ToolFolder, FilesThatAreNotReadAreCalledByName) {
    fs::remove(file("system.xml"));
    auto const refused = [&](std::string const& name, std::string const& text,
                             std::string const& what, std::string const& advice) {
        write(name, text);
        expect_refused(import(), 2,
                       "the folder holds " + what + " (" + name +
                           "), and no serialised System (mine): " + advice);
        expect_refused(catena({"import", "mine/" + name}, here.path()), 2,
                       "the file belongs to " + what + ", and is no serialised System (mine/" +
                           name + "): " + advice);
        fs::remove(file(name));
    };
    std::string const by_hand = "write its chains in a scene, or build the System with OpenMM";
    refused("in.melt", "# melt\nunits lj\natom_style bond\n", "LAMMPS input", by_hand);
    refused("data.melt", "LAMMPS data file\n\n  320 atoms\n", "LAMMPS input", by_hand);
    refused("log.lammps", "", "LAMMPS input", by_hand);
    refused("topol.top", "[ defaults ]\n", "GROMACS input",
            "read it with OpenMM's app.GromacsTopFile");
    refused("x.prmtop", "%VERSION\n", "Amber input", "read it with OpenMM's app.AmberPrmtopFile");
    refused("x.psf", "PSF\n", "CHARMM input", "read it with OpenMM's app.CharmmPsfFile");
    refused("x.gsd", "", "HOOMD-blue input", by_hand);
    refused("s.yaml", "title: a\nchains: []\n", "a scene of Catena",
            "run it by `catena run mine/s.yaml`");
    refused("checkpoint.h5", "", "a run of Catena",
            "continue it by `catena run SCENE --restart mine/checkpoint.h5`, or start a scene from "
            "it by `start: {from: mine, frame: last}`");
    for (auto const& [name, text] :
         {std::pair{"data.csv", "1,2\n"}, {"in.txt", "hello\n"}, {"c.yaml", "learning: 3\n"}})
        write(name, text);
    expect_refused(import(), 2,
                   "the folder holds no serialised System (mine): write it in your script");
}

TEST_F(ToolFolder, WhatACalvadosConfigurationLacksIsNoted) {
    write_pdb("top.pdb", beads, 10);
    fs::rename(file("system.xml"), file("asyn.xml"));
    write("config.yaml", "sysname: asyn\ntemp: 293\nsteps: 10\n");
    expect_noted("config.yaml has no `wfreq`; 100000 is assumed.");
    expect_noted("config.yaml has no `friction_coeff`; 0.01 is assumed.");
}

TEST_F(ToolFolder, AnIntegratorThatIsNoneIsRefused) {
    write_pdb("start.pdb", beads, 10);
    OpenMM::LangevinMiddleIntegrator const integrator(310, 0.5, 0.004);
    serialize(integrator, "Integrator", "integrator.xml");
    expect_noted(
        "integrator.xml (LangevinMiddleIntegrator): 310 K, friction 0.5/ps, steps of "
        "0.004 ps.");
    cut("integrator.xml", 0.7);
    expect_refused(import(), 2, "integrator.xml is not well-formed: ");
    for (char const* const text : {"", "<Force type=\"HarmonicBondForce\"/>\n", "friction 0.5\n"}) {
        write("integrator.xml", text);
        expect_refused(import(), 2,
                       "the file holds no serialised Integrator (mine/integrator.xml)");
    }
    write("integrator.xml",
          "<?xml version=\"1.0\" ?>\n<Integrator friction=\"-1\" stepSize=\".01\" "
          "temperature=\"300\" type=\"LangevinIntegrator\" version=\"1\"/>\n");
    expect_refused(import(), 2, "friction of the integrator is `-1` (mine/integrator.xml)");
    fs::remove(file("integrator.xml"));
    expect_noted("No settings of the run were found (config.yaml, one serialised Integrator)");
}

TEST_F(ToolFolder, DynamicsThatCatenaDoesNotHaveIsNoted) {
    write_pdb("start.pdb", beads, 10);
    serialize(OpenMM::BrownianIntegrator(290, 20, 0.002), "Integrator", "integrator.xml");
    expect_noted(
        "Brownian dynamics has no inertia, Catena's has: the scene is Langevin dynamics "
        "with the same friction, 20/ps");
    EXPECT_NE(text_in("mine.yaml").find("temperature: 290, friction: 20"), std::string::npos);
    serialize(OpenMM::VerletIntegrator(0.002), "Integrator", "integrator.xml");
    expect_noted("That integrator has no thermostat, the scene's has: 300 K, friction 0.01/ps.");
    serialize(OpenMM::VariableLangevinIntegrator(300, 1, 0.001), "Integrator", "integrator.xml");
    expect_noted("The steps of that integrator vary, the scene's are 0.01 ps.");
    serialize(OpenMM::VariableVerletIntegrator(0.001), "Integrator", "integrator.xml");
    expect_noted(
        "The steps of that integrator vary, the scene's are 0.01 ps. That integrator has no "
        "thermostat, the scene's has: 300 K, friction 0.01/ps.");
}

TEST_F(ToolFolder, IntegratorsOfSeveralPartsAndOfExpressionsAreRead) {
    write_pdb("start.pdb", beads, 10);
    OpenMM::CompoundIntegrator two;
    two.addIntegrator(new OpenMM::VerletIntegrator(0.001));
    two.addIntegrator(new OpenMM::VerletIntegrator(0.002));
    serialize(two, "Integrator", "integrator.xml");
    expect_noted("integrator.xml (CompoundIntegrator): 300 K assumed");
    OpenMM::CustomIntegrator custom(0.004);
    custom.addGlobalVariable("ke", 0);
    custom.addComputeSum("ke", "0.5*m*v*v");
    custom.setKineticEnergyExpression("0.5*m*v*v");
    serialize(custom, "Integrator", "integrator.xml");
    expect_noted("steps of 0.004 ps");
    write("integrator.xml",
          "<Integrator type = \"LangevinMiddleIntegrator\"\n stepSize = \"0.005\"\n friction= "
          "'0.2' temperature = \"310\"/>\n");
    expect_noted("310 K, friction 0.2/ps, steps of 0.005 ps.");
}

TEST_F(ToolFolder, SeveralIntegratorsAndWrongUnitsAreSaid) {
    write_pdb("start.pdb", beads, 10);
    serialize(OpenMM::LangevinMiddleIntegrator(25, 0.5, 1), "Integrator", "integrator.xml");
    expect_noted("the temperature is 25 K: did you mean 298.15 K (25 degrees Celsius)?");
    expect_noted("dynamics.step is 1 ps, that is 1000 fs:");
    serialize(OpenMM::LangevinMiddleIntegrator(300, 0.5, 0.01), "Integrator", "old.xml");
    expect_refused(import(), 2, "the folder holds 2 Integrators: integrator.xml, old.xml (mine)");
}

TEST_F(ToolFolder, ACutStateIsToldFromASystem) {
    write_state("state.xml");
    cut("state.xml", 0.6);
    Ended const e = import();
    expect_refused(e, 2, "state.xml is not well-formed: ");
    EXPECT_NE(e.err.find("write the State again with OpenMM's XmlSerializer"), std::string::npos)
        << e.err;
}

TEST_F(ToolFolder, OutputInNoFolderIsRefusedByItsName) {
    write_pdb("start.pdb", beads, 10);
    expect_refused(
        import({"--output", "nodir/x.yaml"}), 2,
        "no such folder: nodir (--output nodir/x.yaml): create it, or name another file");
    expect_refused(import({"--output", "mine"}), 2, "this is a folder, not a file (--output mine)");
}

TEST_F(ToolFolder, ALineFeedInANameBreaksNoLine) {
    write_pdb("start.pdb", beads, 10);
    fs::rename(here / "mine", here / "a\nb");
    Ended const e = catena({"import", "a\nb"}, here.path());
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.out.substr(0, e.out.find('\n')), "a b") << e.out;
    EXPECT_NE(e.out.find("catena run $'a\\x0ab.yaml'"), std::string::npos) << e.out;
}

/// OpenABC's scripts leave the structures of single molecules beside the start of all.
TEST_F(ToolFolder, TheTopologyIsTheOneWithTheSystemsParticles) {
    write_pdb("start.pdb", beads, 10);
    write_pdb("dimer_CA.pdb", beads / 2, 10);
    write_pdb("dimer.pdb", 5 * beads, 1.5);
    expect_noted(
        "The topology is start.pdb (12 atoms). Not read are dimer.pdb (60 atoms), "
        "dimer_CA.pdb (6 atoms): the System has 12 particles.");
    EXPECT_NE(text_in("mine.yaml").find("topology: mine/start.pdb"), std::string::npos);
    write_pdb("other.pdb", beads, 10);
    expect_refused(import(), 2,
                   "2 topologies of the folder have the System's 12 particles: "
                   "other.pdb (12 atoms), start.pdb (12 atoms)");
    fs::remove(file("other.pdb")), fs::remove(file("start.pdb"));
    expect_refused(import(), 2, "no topology of the folder has the System's 12 particles: ");
    write_state("NPT_final_state.xml");
    expect_noted("The start is NPT_final_state.xml. Not read are dimer.pdb (60 atoms)");
}

/// OpenMiChroM writes each chain into a file of its own, in nanometres.
TEST_F(ToolFolder, StructuresOfOpenMiChromAreInNanometres) {
    write("sim_0_block0.ndb", "HEADER    NDB File\n");
    write_pdb("sim_0_state0.pdb", beads, 1, "sim - chain 0");
    expect_refused(import(), 2,
                   "OpenMiChroM writes nanometres where a PDB file has angstrom "
                   "(mine/sim_0_state0.pdb): leave one State in the folder");
    expect_refused(import({"sim_0_state0.pdb"}), 2, "OpenMiChroM writes nanometres");
    write_state("state.xml");
    expect_noted("The start has the positions of state.xml; sim_0_state0.pdb has nanometres");
    EXPECT_NE(text_in("mine-start/topology.pdb").find("ASP"), std::string::npos);
    write_pdb("sim_1_state0.pdb", beads / 2, 1, "sim - chain 1");
    expect_noted("The start has the positions of state.xml; sim_0_state0.pdb has nanometres");
    fs::remove(file("system.xml"));
    expect_refused(
        import(), 2,
        "the folder holds no serialised System (mine): write it in OpenMiChroM's script");
    expect_refused(import(), 2, "open('system.xml', 'w').write(X.serialize(sim.system))");
}

/// Writes initArgs_N.h5 as polychrom's HDF5Reporter does: the arguments are attributes.
void write_arguments(std::string const& name, std::string const& integrator,
                     std::vector<std::pair<char const*, double>> const& numbers) {
    hid_t const file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                scalar = H5Screate(H5S_SCALAR), text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, H5T_VARIABLE);
    H5Tset_cset(text, H5T_CSET_UTF8);
    auto const put = [&](char const* key, hid_t type, void const* value) {
        hid_t const attribute = H5Acreate2(file, key, type, scalar, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, type, value);
        H5Aclose(attribute);
    };
    char const* const words = integrator.c_str();
    put("integrator", text, static_cast<void const*>(&words));
    for (auto const& [key, value] : numbers) put(key, H5T_NATIVE_DOUBLE, &value);
    H5Tclose(text), H5Sclose(scalar), H5Fclose(file);
}

TEST_F(ToolFolder, ArgumentsOfPolychromAreTheSettings) {
    write_state("state.xml");
    write_arguments(file("initArgs_0.h5"), "variableLangevin",
                    {{"temperature", 305.0}, {"collision_rate", 0.03}, {"error_tol", 0.01}});
    expect_noted(
        "initArgs_0.h5 (variablelangevin): 305 K, friction 0.03/ps, steps of 0.01 ps "
        "assumed.");
    expect_noted("The steps of that integrator vary");
    write_arguments(file("initArgs_1.h5"), "langevin",
                    {{"temperature", 300.0}, {"collision_rate", 0.05}, {"timestep", 80.0}});
    expect_noted("initArgs_1.h5 (langevin): 300 K, friction 0.05/ps, steps of 0.08 ps.");
    EXPECT_NE(text_in("mine.yaml").find("step: 0.08,"), std::string::npos);
    EXPECT_NE(text_in("mine.yaml").find("(polychrom)"), std::string::npos);
    write_arguments(file("initArgs_1.h5"), "verlet",
                    {{"temperature", 300.0}, {"collision_rate", 0.0}, {"timestep", 20.0}});
    expect_noted("300 K, friction 0/ps, steps of 0.02 ps");
    write_arguments(file("initArgs_1.h5"), "langevin", {{"timestep", 0.0}});
    expect_refused(import(), 2, "polychrom's arguments cannot be read: timestep is 0");
    write_arguments(file("initArgs_1.h5"), "langevin", {{"timestep", 80.0}});
    cut("initArgs_1.h5", 0.5);
    expect_refused(import(), 2, "polychrom's arguments cannot be read: ");
    fs::remove(file("initArgs_1.h5")), fs::remove(file("system.xml"));
    expect_refused(import(), 2, "write it in polychrom's script, once its Context exists");
}

}  // namespace
}  // namespace catena::test
