// `catena import`: every key of the CALVADOS package's files is compared with the System, taken
// over or noted. The tests change one key of a whole folder at a time.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "foreign/calvados_keys.hpp"
#include "tests/command/package_folder.hpp"

namespace catena::test {
namespace {

using foreign::KeyUse;
using Keys = std::map<std::string, std::string>;

/// All keys of config.yaml in versions 0.1 to 1.0 of the package, for the slab.
Keys whole_config() {
    return {{"bilayer_eq", "false"},
            {"box", "[8.2, 8.2, 30]"},
            {"box_eq", "false"},
            {"boxscaling_xyz", "[true, true, true]"},
            {"custom_restraint_type", "harmonic"},
            {"custom_restraints", "false"},
            {"cutoff_lj", "2.0"},
            {"cutoff_yu", "4.0"},
            {"eps_lj", "0.2"},
            {"ext_force", "false"},
            {"ext_force_expr", "step(d2-18)*d2; d2=periodicdistance(x, y, z, 0, 0, z)^2"},
            {"fcustom_restraints", "custom_restraints.txt"},
            {"fixed_lambda", "0"},
            {"frestart", "restart.chk"},
            {"friction", "0.02"},
            {"friction_coeff", "0.02"},
            {"gpu_id", "0"},
            {"ionic", "0.15"},
            {"k_eq", "0.02"},
            {"logfreq", "1000000"},
            {"pH", "7.0"},
            {"platform", "CPU"},
            {"pressure", "[0, 0, 0]"},
            {"pressure_coupling", "false"},
            {"random_number_seed", "null"},
            {"ref_bead", "0"},
            {"report_potential_energy", "false"},
            {"restart", "checkpoint"},
            {"runtime", "0"},
            {"slab_eq", "true"},
            {"slab_eq_axis", "[false, false, true]"},
            {"slab_outer", "40"},
            {"slab_width", "10"},
            {"steps", "5000"},
            {"steps_eq", "50"},
            {"sysname", "slab"},
            {"temp", "293.15"},
            {"threads", "1"},
            {"topol", "slab"},
            {"verbose", "true"},
            {"wfreq", "1000"}};
}

/// All properties of a component in versions 0.1 to 1.0 of the package.
Keys whole_component() {
    return {{"alpha", "0"},
            {"bfac_shift", "0.8"},
            {"bfac_width", "50.0"},
            {"charge_termini", "both"},
            {"colabfold", "0"},
            {"cutoff_restr", "0.9"},
            {"ext_restraint", "true"},
            {"fdomains", "domains.yaml"},
            {"ffasta", "slab.fasta"},
            {"fresidues", "residues.csv"},
            {"k_go", "15.0"},
            {"k_harmonic", "700.0"},
            {"kb", "8033.0"},
            {"molecule_type", "protein"},
            {"n_ends", "1"},
            {"nmol", "8"},
            {"pae_shift", "0.3"},
            {"pae_width", "15.0"},
            {"pdb_folder", "pdbs"},
            {"periodic", "false"},
            {"ptm_locations", "[]"},
            {"ptm_name", "example_ptm"},
            {"restraint", "false"},
            {"restraint_type", "harmonic"},
            {"rna_ka", "7.24"},
            {"rna_kb1", "8033.0"},
            {"rna_kb2", "8033.0"},
            {"rna_nb_cutoff", "0.6"},
            {"rna_nb_scale", "15"},
            {"rna_nb_sigma", "0.4"},
            {"rna_pa", "3.14"},
            {"use_com", "true"}};
}

std::set<std::string> names_of(Keys const& keys) {
    std::set<std::string> names;
    for (auto const& [name, value] : keys) names.insert(name);
    return names;
}

std::set<std::string> names_of(std::span<foreign::PackageKey const> keys) {
    std::set<std::string> names;
    for (foreign::PackageKey const& key : keys) names.emplace(key.name);
    return names;
}

/// The slab of the package with all of its files.
class WholePackage : public ::testing::Test {
  protected:
    TemporaryFolder here;
    std::string const folder = package_folder(here, "slab");
    Keys config = whole_config(), component = whole_component();
    std::string name = "slab";  // of the component

    void SetUp() override {
        fs::copy_file(CATENA_SOURCE_DIR "/inputs/residues_CALVADOS2.csv", folder + "/residues.csv");
        write(folder + "/slab.fasta", ">slab\nGSMASASSSQRGRSGS\n>other\nGSMASASSSQRGRSGG\n");
    }
    void save() const {
        std::string text, parts = "defaults:\n";
        for (auto const& [key, value] : config) text += key + ": " + value + "\n";
        for (auto const& [key, value] : component) parts += "  " + key + ": " + value + "\n";
        write(folder + "/config.yaml", text);
        write(folder + "/components.yaml",
              parts + "system:\n  " + name + ":\n    nmol: " + component.at("nmol") + "\n");
    }
    Ended import() const {
        save();
        return catena({"import", "slab", "--overwrite", "--output", "s.yaml"}, here.path());
    }
    /// What an import answers and writes.
    std::string result() const {
        Ended const e = import();
        EXPECT_EQ(e.status, 0) << e.err;
        return e.out + text_in(here / "s.yaml") + text_in(here / "s-equilibration.yaml");
    }
    void refuse(std::string const& part) const { expect_refused(import(), 2, part); }
    void expect_note(std::string const& part) const {
        std::string const text = result();
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
};

TEST_F(WholePackage, NoKeyOfThePackageIsForgotten) {
    EXPECT_EQ(names_of(config), names_of(foreign::config_keys()));
    EXPECT_EQ(names_of(component), names_of(foreign::component_keys()));
}

TEST_F(WholePackage, AFolderThatAgreesIsNotDoubted) {
    std::string const text = result();
    for (char const* const doubt : {"not checked", "as it is", "Not compared", "no key"})
        EXPECT_EQ(text.find(doubt), std::string::npos) << text;
}

/// Another value of each key is refused, or changes the scene or the answer. The values of keys
/// that are not taken over change neither, and their names are in the answer.
TEST_F(WholePackage, EachKeyOfTheConfigurationCounts) {
    Keys const other{{"bilayer_eq", "true"},
                     {"box", "[8.2, 8.2, 31]"},
                     {"box_eq", "true"},
                     {"custom_restraint_type", "go"},
                     {"custom_restraints", "true"},
                     {"cutoff_lj", "2.5"},
                     {"cutoff_yu", "3.5"},
                     {"eps_lj", "0.21"},
                     {"ext_force", "true"},
                     {"fixed_lambda", "0.5"},
                     {"frestart", "frame.pdb"},
                     {"friction", "0.5"},
                     {"friction_coeff", "0.5"},
                     {"ionic", "0.1"},
                     {"k_eq", "0.2"},
                     {"pressure_coupling", "true"},
                     {"random_number_seed", "42"},
                     {"restart", "pdb"},
                     {"runtime", "2"},
                     {"slab_eq", "false"},
                     {"slab_eq_axis", "[true, false, false]"},
                     {"steps", "6000"},
                     {"steps_eq", "60"},
                     {"sysname", "slap"},
                     {"temp", "310"},
                     {"wfreq", "500"}};
    std::set<std::string> const only_with_others{"custom_restraint_type", "ext_force_expr",
                                                 "fcustom_restraints", "frestart", "pH"};
    std::string const usual = result();
    for (foreign::PackageKey const& key : foreign::config_keys()) {
        std::string const of(key.name);
        if (only_with_others.contains(of)) continue;  // tests of their own
        if (key.use != KeyUse::compared && key.use != KeyUse::taken) {
            EXPECT_NE(usual.find(of), std::string::npos) << of;
            continue;
        }
        config = whole_config();
        config[of] = other.at(of);
        Ended const e = import();
        if (e.status == 2)
            EXPECT_NE(e.err.find(of == "sysname" ? "slap" : of), std::string::npos) << e.err;
        else
            EXPECT_NE(result(), usual) << of;
        bool const noted = of == "slab_eq";  // the force acts throughout, which is said
        EXPECT_EQ(e.status, key.use == KeyUse::compared && !noted ? 2 : 0) << of << e.out << e.err;
    }
}

TEST_F(WholePackage, EachPropertyOfComponentsCounts) {
    Keys const other{{"charge_termini", "N"},
                     {"ext_restraint", "false"},
                     {"ffasta", "other.fasta"},
                     {"fresidues", "residues3.csv"},
                     {"kb", "4000"},
                     {"molecule_type", "crowder"},
                     {"nmol", "7"},
                     {"restraint", "true"}};
    fs::copy_file(CATENA_SOURCE_DIR "/inputs/residues_CALVADOS3.csv", folder + "/residues3.csv");
    write(folder + "/other.fasta", ">slab\nGSMASASSSQRGRSGG\n");
    for (auto const& [key, value] : other) {
        component = whole_component();
        component[key] = value;
        EXPECT_EQ(import().status, 2) << key;
    }
}

TEST_F(WholePackage, KeysThatThePackageDoesNotReadAreNoted) {
    config["slab_eq_axes"] = "[true, false, false]";
    component["charge_terminus"] = "none";
    expect_note(
        "config.yaml has `slab_eq_axes`, which is not among the package's keys: it is not taken "
        "over (is `slab_eq_axis` meant?).");
    expect_note("components.yaml has `charge_terminus`, which is not among the package's keys");
}

/// Numbers and truths are those of PyYAML, which reads YAML 1.1.
TEST_F(WholePackage, NumbersAndTruthsAreThoseOfPyYaml) {
    auto const steps = [&](char const* written) {
        config["steps"] = written;
        std::string const text = result();
        std::size_t const at = text.find("steps: ");
        return text.substr(at + 7, text.find_first_of(",}", at) - at - 7);
    };
    EXPECT_EQ(steps("1_000_000"), "1000000");
    EXPECT_EQ(steps("0x400"), "1024");
    EXPECT_EQ(steps("02000"), "1024");
    EXPECT_EQ(steps("0b10000000000"), "1024");
    EXPECT_EQ(steps("1:30:00"), "5400");
    EXPECT_EQ(steps("5_000.0"), "5000");
    EXPECT_EQ(steps("1.0e+6"), "1000000");
    config["steps"] = "1e6";
    expect_note(
        "config.yaml has steps `1e6`, which PyYAML takes for a text, so that the package stops; "
        "here it is a number");
    config["steps"] = "\"5000\"";
    refuse("`5000` in quotes is not a number (slab/config.yaml: steps");
    config = whole_config();
    for (char const* const yes : {"yes", "True", "ON", "1"}) {
        config["slab_eq"] = yes;
        EXPECT_EQ(import().status, 0) << yes << import().err;
    }
    for (char const* const no : {"no", "False", "off", "0"}) {
        config["slab_eq"] = no;
        expect_note("slab.xml has a CustomExternalForce that config.yaml does not ask for");
    }
    config["slab_eq"] = "'false'";
    refuse("`false` in quotes is not true or false (slab/config.yaml: slab_eq");
}

TEST_F(WholePackage, NamesThatLookLikeNumbersAreNotNumbers) {
    fs::rename(folder + "/slab.xml", folder + "/1e10.xml");
    config["sysname"] = "1e10";
    EXPECT_EQ(result().find("PyYAML"), std::string::npos);
}

TEST_F(WholePackage, SeedsMayBeNegative) {
    config["random_number_seed"] = "-3";
    expect_note("config.yaml has random_number_seed -3; the scene has 3.");
}

/// A property that is null overrides the defaults: no end is charged, no force acts.
TEST_F(WholePackage, PropertiesThatAreNullOverrideTheDefaults) {
    auto const with = [&](std::string const& more) {
        save();
        std::string const file = folder + "/components.yaml";
        write(file, text_in(file) + "    " + more + "\n");
        return catena({"import", "slab", "--overwrite"}, here.path());
    };
    EXPECT_EQ(with("restraint: null").status, 0);
    expect_refused(with("charge_termini: null"), 2,
                   "with an empty `charge_termini` the N end of `slab` has 0 e, and particle 0");
    expect_refused(with("ext_restraint: ~"), 2, "`ext_restraint` of `slab` is false");
    expect_refused(with("kb:"), 2,
                   "`kb` has no value, with which the package stops (slab/components.yaml: "
                   "system.slab.kb");
}

TEST_F(WholePackage, ACheckpointOfOpenMMIsNoStructure) {
    config["restart"] = "pdb";
    write(folder + "/restart.chk", std::string("\0\1chk", 5));
    refuse(
        "`restart` is pdb, and restart.chk (`frestart`) is no PDB or mmCIF file "
        "(slab/config.yaml: frestart");
    config.erase("frestart");
    refuse("and restart.chk (the default of `frestart`) is no PDB or mmCIF file");
    config["restart"] = "checkpoint";
    EXPECT_EQ(import().status, 0);
}

TEST_F(WholePackage, AnotherAxisThanTheSystemsIsRefused) {
    config["slab_eq_axis"] = "[true, false, false]";
    refuse(
        "`slab_eq_axis` is x, and the CustomExternalForce of slab.xml pulls along z "
        "(slab/config.yaml: slab_eq_axis");
    config["slab_eq_axis"] = "[true, false]";
    refuse("`slab_eq_axis` has other than three entries");
    config.erase("slab_eq_axis");
    EXPECT_EQ(import().status, 0);
    replace_in(folder + "/slab.xml", "k*abs(periodicdistance(x,y,z,x,y,z0))",
               "k*abs(periodicdistance(x,y,z,x0,y,z0))");
    replace_in(folder + "/slab.xml", "<Parameter default=\"15\" name=\"z0\"/>",
               "<Parameter default=\"15\" name=\"z0\"/><Parameter default=\"4.1\" name=\"x0\"/>");
    refuse(
        "`slab_eq_axis` is absent, which means z, and the CustomExternalForce of slab.xml "
        "pulls along x and z (slab/config.yaml: slab_eq");
    config["slab_eq_axis"] = "[true, false, true]";
    EXPECT_EQ(import().status, 0);
    replace_in(folder + "/slab.xml", "default=\"4.1\"", "default=\"5\"");
    refuse(
        "the middle of the box is at x = 4.1 nm, and the CustomExternalForce of slab.xml pulls "
        "towards 5 nm");
}

/// A cylinder's expression in place of the slab's.
TEST_F(WholePackage, ASlabThatIsACylinderIsRefused) {
    std::string const cylinder = "step(d-3)*0.5*(d-3)^2; d=periodicdistance(x, y, z, 4, 4, z)";
    replace_in(folder + "/slab.xml", "k*abs(periodicdistance(x,y,z,x,y,z0))", cylinder);
    config["ext_force_expr"] = cylinder;
    refuse(
        "`slab_eq` is true, and the CustomExternalForce of slab.xml pulls towards no slab: "
        "`step(d-3)");
    config["ext_force"] = "true";
    refuse("`slab_eq` and `ext_force` are both true");
    config["slab_eq"] = "false";
    EXPECT_EQ(import().status, 0) << import().err;
    config["ext_force_expr"] = "d; d=periodicdistance(x, y, z, 4, 4, z)";
    refuse("`ext_force_expr` is not the CustomExternalForce of slab.xml");
}

TEST_F(WholePackage, EndsWithOtherChargesAreRefused) {
    component["charge_termini"] = "none";
    refuse(
        "with `charge_termini` none the N end of `slab` has 0 e, and particle 0 (from 0) of "
        "slab.xml has 1 e (slab/components.yaml: defaults.charge_termini");
    component["charge_termini"] = "C";
    refuse("with `charge_termini` C the N end of `slab` has 0 e");
    component["charge_termini"] = "N";
    refuse("with `charge_termini` N the C end of `slab` has 0 e, and particle 15");
}

TEST_F(WholePackage, AMissingPhIsSaid) {
    config.erase("pH");
    expect_note("config.yaml has no `pH`, and slab.xml has no histidine within a chain.");
    config.erase("ionic"), config.erase("eps_lj");
    expect_note("config.yaml has no eps_lj, ionic: slab.xml decides.");
    component.erase("fresidues");
    replace_in(folder + "/top.pdb", "MET A   3", "HIS A   3");
    expect_note(
        "config.yaml has no `pH`: the histidine of particle 2 (from 0) of slab.xml has 0 e.");
}

TEST_F(WholePackage, TablesThatAreNotTheSystemsAreSaid) {
    component["fresidues"] = "/nowhere/table.csv";
    expect_note(
        "Not compared with slab.xml, because the files are not there: fresidues "
        "(/nowhere/table.csv). Copies in the folder would be read.");
    component["fresidues"] = "residues.csv";
    std::string const table = text_in(folder + "/residues.csv");
    auto const changed = [&](std::string const& part, std::string const& by) {
        write(folder + "/residues.csv", table);
        replace_in(folder + "/residues.csv", part, by);
    };
    changed("M,MET,131.2", "M,MET,131.3");
    refuse(
        "MET has a mass of 131.3 amu, and particle 2 (from 0) of slab.xml has 131.2 amu "
        "(slab/residues.csv)");
    changed("M,MET,", "M,MEX,");
    refuse("residue `MET` of top.pdb is not in the table (slab/residues.csv)");
    write(folder + "/residues.csv", table);
    write(folder + "/slab.fasta", ">slab\nGSMASASSSQRGRSG\n");
    refuse("`slab` has 15 residues, and chain A of top.pdb has 16 (slab/slab.fasta)");
    fs::rename(folder + "/slab.fasta", here / "elsewhere.fasta");
    component["ffasta"] = "../elsewhere.fasta";
    expect_note("has 15 residues, and chain A of top.pdb has 16 (");
    expect_note("The System is simulated as it is.");
}

TEST_F(WholePackage, CustomRestraintsAreThoseOfTheSystem) {
    std::string xml = text_in(folder + "/slab.xml");
    xml.insert(xml.find("</Forces>"),
               "<Force forceGroup=\"0\" name=\"HarmonicBondForce\" type=\"HarmonicBondForce\" "
               "usesPeriodic=\"1\" version=\"2\"><Bonds><Bond d=\"1.25\" k=\"30\" p1=\"0\" "
               "p2=\"20\"/></Bonds></Force>");
    write(folder + "/slab.xml", xml);
    expect_note("slab.xml has 2 HarmonicBondForces and 0 CustomBondForces, where the components");
    config["custom_restraints"] = "true";
    std::string const file = folder + "/custom_restraints.txt";
    write(file, "slab 1 1 | slab 2 5 | 1.25 30.0\n");
    EXPECT_EQ(import().status, 0) << import().err;
    write(file, "slab 2 5 | slab 1 1 | 1.25 30.0\n");
    EXPECT_EQ(import().status, 0) << import().err;
    write(file, "slab 1 2 | slab 2 5 | 1.25 30.0\n");
    refuse("the 1 custom restraints are not the 1 bonds of the last force of bonds of slab.xml");
    write(file, "slab 1 1 | slab 9 5 | 1.25 30.0\n");
    refuse("the components have no such molecule or bead: `slab 1 1 | slab 9 5 | 1.25 30.0`");
    write(file, "slab 1 1 | slob 2 5 | 1.25 30.0\n");
    refuse("the components have no such molecule or bead");
    write(file, "slab 1 1 | slab 2 5 | 1.25 31.0\n");
    refuse("the 1 custom restraints are not the 1 bonds of the last force of bonds of slab.xml");
    write(file, "slab 1 1 | slab 2 5 | 1.25\n");
    refuse("the line holds no length and stiffness");
    config["custom_restraint_type"] = "go";
    refuse("make 1 HarmonicBondForce and 1 CustomBondForce, and slab.xml has 2");
}

TEST_F(WholePackage, MoleculesOfOtherKindsAreNotCompared) {
    component["molecule_type"] = "seastar";
    expect_note("components.yaml has molecules other than proteins, RNA and crowders");
    expect_note("Not compared from components.yaml: n_ends");
}

/// A peptide and two strands of RNA, as the package writes them.
class PackageWithRna : public ::testing::Test {
  protected:
    TemporaryFolder here;
    std::string const folder = package_folder(here, "rna");
    Keys rna{{"rna_ka", "4.2"},        {"rna_kb1", "1400"},    {"rna_kb2", "2200"},
             {"rna_nb_cutoff", "2.0"}, {"rna_nb_scale", "15"}, {"rna_nb_sigma", "0.4"},
             {"rna_pa", "3.14"}};
    std::string strand = "rrrrr";
    std::string table = text_in(CATENA_SOURCE_DIR "/inputs/residues_CALVADOS2.csv") +
                        "p,RBC,194.1,0.00,0.6954,-1,0.59\nr,RNA,126.3,1.18,0.6238,0,0.54\n";

    Ended import() const {
        std::string text =
            "defaults:\n  charge_termini: both\n  fresidues: residues.csv\n"
            "  ffasta: all.fasta\n";
        for (auto const& [key, value] : rna) text += "  " + key + ": " + value + "\n";
        write(folder + "/components.yaml",
              text +
                  "system:\n  peptide:\n    molecule_type: protein\n  strand:\n    "
                  "molecule_type: rna\n    nmol: 2\n");
        write(folder + "/all.fasta", ">peptide\nMRGGDYRKEEGSHG\n>strand\n" + strand + "\n");
        write(folder + "/residues.csv", table);
        return catena({"import", "rna", "--overwrite", "--output", "s.yaml"}, here.path());
    }
};

TEST_F(PackageWithRna, IsComparedAndRunsAsItIs) {
    Ended const e = import();
    expect_good(e);
    for (char const* const doubt : {"not checked", "as it is", "Not compared", "not compared"})
        EXPECT_EQ(e.out.find(doubt), std::string::npos) << e.out;
    EXPECT_NE(
        e.out.find(
            "2 chains are branched, the first is B (particle 16 hangs on particle 14, "
            "from 0): one rank computes a whole branched chain, however many ranks there are."),
        std::string::npos)
        << e.out;
    Ended const run = catena({"run", "s.yaml", "--output", "o", "--steps", "20"}, here.path());
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("VALID"), std::string::npos) << run.out;
}

TEST_F(PackageWithRna, EachPropertyCounts) {
    for (auto const& [key, value] : Keys{{"rna_ka", "4.3"},
                                         {"rna_kb1", "1401"},
                                         {"rna_kb2", "8033"},
                                         {"rna_nb_cutoff", "0.6"},
                                         {"rna_nb_scale", "16"},
                                         {"rna_nb_sigma", "0.41"},
                                         {"rna_pa", "3.1"}}) {
        Keys const whole = rna;
        rna[key] = value;
        Ended const e = import();
        expect_refused(e, 2, key);
        rna = whole;
    }
}

TEST_F(PackageWithRna, ListsOfBondsCount) {
    std::string list = "i\tj\tb_idx\td[nm]\tk[kJ/mol/nm^2]\n";
    int index = 0;
    for (int first : {15, 25})  // of a strand, from 1
        for (int bead = first; bead < first + 10; bead += 2) {
            list += fmt::format("{}\t{}\t{}\t0.5400\t2200.0000\n", bead, bead + 1, index++);
            if (bead + 2 < first + 10)
                list += fmt::format("{}\t{}\t{}\t0.5900\t1400.0000\n", bead, bead + 2, index++);
        }
    std::string const file = folder + "/bonds_strand.txt";
    write(file, list);
    expect_good(import());
    replace_in(file, "15\t17\t1\t0.5900", "15\t17\t1\t0.5800");
    expect_refused(import(), 2, "of `strand` in rna.xml are not those of the list");
}

TEST_F(PackageWithRna, DepthOfStackedBasesCounts) {
    std::string const config = folder + "/config.yaml";
    write(config, "eps_lj: 0.2\n" + text_in(config));
    expect_good(import());
    replace_in(folder + "/rna.xml", "\".8368000000000001\" name=\"eps\"", "\".9\" name=\"eps\"");
    expect_refused(import(), 2, "`eps_lj` is 0.2, and rna.xml was written with 0.215");
}

TEST_F(PackageWithRna, AnglesThatIgnoreTheBoxAreNoted) {
    std::string const angles =
        "name=\"HarmonicAngleForce\" type=\"HarmonicAngleForce\" usesPeriodic=";
    replace_in(folder + "/rna.xml", angles + "\"1\"", angles + "\"0\"");
    Ended const e = import();
    expect_good(e);
    EXPECT_NE(e.out.find("A HarmonicAngleForce of `strand` in rna.xml does not use the box"),
              std::string::npos)
        << e.out;
}

TEST_F(PackageWithRna, TablesAndSequencesCount) {
    auto const refused = [&](std::string const& part, std::string const& by,
                             std::string const& message) {
        std::string const whole = table;
        table.replace(table.find(part), part.size(), by);
        expect_refused(import(), 2, message);
        table = whole;
    };
    refused("RBC,194.1", "RBC,195", "RBC has a mass of 195 amu, and particle 14");
    refused("RNA,126.3,1.18", "RNA,126.3,1.1", "RNA has a stickiness of 1.1, and particle 15");
    refused("-1,0.59", "-1,0.6", "RBC has a bond to the preceding residue of 0.6 nm");
    refused("0,0.54", "0,0.55", "RNA has a bond to the preceding residue of 0.55 nm");
    refused("0.6954,-1", "0.6954,0", "RBC has a charge of 0 e, and particle 14");
    strand = "rrrr";
    expect_refused(import(), 2, "`strand` has 4 residues, and chain B of top.pdb has 5");
    strand = "rrrrA";
    expect_refused(import(), 2, "`strand` has A as residue 5, and top.pdb has r");
}

/// What of the System a table or the configuration tells.
TEST_F(WholePackage, NumbersOfTheSystemThatWereChangedAreRefused) {
    std::string const system = folder + "/slab.xml", whole = text_in(system);
    auto const refused = [&](std::string const& part, std::string const& by,
                             std::string const& message) {
        write(system, whole);
        ASSERT_NE(whole.find(part), std::string::npos) << part;
        replace_in(system, part, by);
        refuse(message);
    };
    refused("r)/r-0.00", "r)/r-0.01", "the energy of charges is shifted by 0.01");
    refused("cutoff=\"2\"", "cutoff=\"1.5\"",
            "`cutoff_lj` is 2, and slab.xml was written with 1.5");
    refused("d=\".38\"", "d=\".37\"", "has 0.37 and 8033 between beads 1 and 2 in molecule 1");
    refused("<Particle param1=\"1\"/>\n\t\t\t\t<Particle param1=\"0\"/>",
            "<Particle param1=\"1\"/>\n\t\t\t\t<Particle param1=\"-1\"/>",
            "SER has a charge of 0 e, and particle 1 (from 0) of slab.xml has -1 e");
    refused("param3=\"1\"", "param3=\"-1\"", "GLY has an `id` of 1, and particle 0");
    refused("param1=\".45\"", "param1=\".54\"", "GLY has a diameter of 0.45 nm");
}

/// Limits of an elastic network.
TEST(PackageNetworks, ReachAndDepthAreThoseOfTheSystem) {
    TemporaryFolder const here;
    std::string const folder = package_folder(here, "two-domains");
    auto const imported = [&](std::string const& more) {
        write(folder + "/components.yaml",
              "system:\n  two-domains:\n    nmol: 1\n    restraint: true\n" + more);
        return catena({"import", "two-domains", "--overwrite"}, here.path());
    };
    EXPECT_EQ(imported("").status, 0) << imported("").err;
    expect_refused(imported("    cutoff_restr: 0.6\n"), 2,
                   "the network of `two-domains` joins pairs up to 0.6 nm (`cutoff_restr`), and "
                   "two-domains.xml has one of ");
}

/// Each bond of a network has the length that its particles have in top.pdb.
class ChangedNetwork : public ::testing::Test {
  protected:
    TemporaryFolder here;
    std::string const folder = package_folder(here, "two-domains"),
                      system = folder + "/two-domains.xml";
    Ended import() const { return catena({"import", "two-domains", "--overwrite"}, here.path()); }
    void expect_note(std::string const& part) const {
        Ended const e = import();
        ASSERT_EQ(e.status, 0) << e.err;
        EXPECT_NE(e.out.find(part), std::string::npos) << e.out;
    }
};

TEST_F(ChangedNetwork, AnotherLengthIsRefused) {
    EXPECT_EQ(import().out.find("not checked"), std::string::npos);
    std::string const bond = "<Bond d=\".673740115907153\" k=\"700\" p1=\"2\" p2=\"4\"/>";
    replace_in(system, bond, "<Bond d=\".68\" k=\"700\" p1=\"2\" p2=\"4\"/>");
    std::string const found =
        "the network of `two-domains` in two-domains.xml joins particles 2 and 4 (from 0) at 0.68 "
        "nm, and in top.pdb they are 0.6737";
    expect_refused(import(), 2, found);
    replace_in(folder + "/config.yaml", "restart: checkpoint", "restart: pdb");
    expect_note(found);
    fs::copy_file(folder + "/top.pdb", folder + "/start.pdb");
    fs::remove(folder + "/top.pdb");
    replace_in(folder + "/config.yaml", "restart.chk", "start.pdb");
    expect_note(
        "Whether the network of `two-domains` has the lengths of its structure is not checked: "
        "there is no top.pdb of that System.");
}

TEST_F(ChangedNetwork, BondsInDomainsHaveTheirLengthsFromTheStructure) {
    std::string const components = folder + "/components.yaml";
    fs::copy_file(CATENA_SOURCE_DIR "/inputs/residues_CALVADOS3.csv", folder + "/residues.csv");
    write(components, text_in(components) + "    fresidues: residues.csv\n");
    EXPECT_EQ(import().status, 0) << import().err;
    replace_in(system, ".5308032112709891", ".52");
    expect_refused(import(), 2,
                   "has a bond to the preceding residue (outside of domains) of 0.38 nm, and "
                   "particle 2 (from 0) of "
                   "two-domains.xml has 0.52 nm");
}

/// The package lists bonds of each molecule with four decimals if it is verbose.
TEST_F(ChangedNetwork, ListsOfThePackageAreThoseOfTheSystem) {
    std::string const text = text_in(system);
    std::string list = "i j d[nm] fc\n";
    static std::regex const bond(R"re(<Bond d="([^"]+)" k="700" p1="(\d+)" p2="(\d+)"/>)re");
    for (std::sregex_iterator at(text.begin(), text.end(), bond), end; at != end; ++at)
        list += fmt::format("{} {} {:.4f} 700.0000\n", std::stoi((*at)[2]) + 1,
                            std::stoi((*at)[3]) + 1, std::stod("0" + (*at)[1].str()));
    std::string const file = folder + "/restr_two-domains.txt";
    write(file, list);
    EXPECT_EQ(import().status, 0) << import().err;
    write(file, list.substr(0, list.rfind('\n', list.size() - 2) + 1));
    std::string const refused = " of `two-domains` in two-domains.xml are not those of the list";
    expect_refused(import(), 2, refused);
    write(file, list);
    replace_in(file, "1 3 0.7260", "1 4 0.7260");
    expect_refused(import(), 2, refused + " (two-domains/restr_two-domains.txt, line 2)");
}

TEST_F(ChangedNetwork, ABondThatIgnoresTheBoxIsNoted) {
    EXPECT_EQ(import().out.find("does not use the box"), std::string::npos);
    std::string text = text_in(system);
    std::size_t const at = text.rfind("HarmonicBondForce\" usesPeriodic=\"1\"");
    ASSERT_NE(at, std::string::npos);
    text[text.find("\"1\"", at) + 1] = '0';
    write(system, text);
    expect_note(
        "A HarmonicBondForce of `two-domains` in two-domains.xml does not use the box, where the "
        "package's does");
}

/// All molecules of a component have the bonds of the first.
TEST_F(WholePackage, MoleculesWithOtherBondsAreRefused) {
    component["fresidues"] = "nowhere.csv";
    replace_in(folder + "/slab.xml", "<Bond d=\".38\" k=\"8033\" p1=\"20\" p2=\"21\"/>",
               "<Bond d=\".39\" k=\"8033\" p1=\"20\" p2=\"21\"/>");
    refuse(
        "a HarmonicBondForce of `slab` has 0.38 and 8033 between beads 5 and 6 in molecule 1, and "
        "0.39 and 8033 between beads 5 and 6 in molecule 2 (slab/slab.xml)");
}

}  // namespace
}  // namespace catena::test
