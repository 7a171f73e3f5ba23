// Structures, sequences and topologies that people have, with what Catena must make of them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string folder_of(std::string const& name) {
    return std::string(CATENA_SOURCE_DIR) + "/tests/data/cases/" + name;
}

/// What `check` says of a scene that it takes.
Json checked(std::string const& folder, std::string const& scene) {
    Ended const e = catena({"check", scene + ".yaml", "--json", "-"}, folder_of(folder));
    EXPECT_EQ(e.status, 0) << e.err;
    return e.status == 0 ? e.json() : Json::object();
}

void expect_note(Json const& check, std::string const& part) {
    std::string const notes = check.value("notes", Json::array()).dump();
    EXPECT_NE(notes.find(part), std::string::npos) << notes;
}

std::vector<std::string> cells(std::string const& line) {
    std::vector<std::string> found;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
    return found;
}

/// A column of the first frame of a run.
double first_frame(std::string const& folder, std::string const& scene, std::string const& column) {
    TemporaryFolder const output;
    Ended const e =
        catena({"run", scene + ".yaml", "--output", output / "out", "--quiet"}, folder_of(folder));
    EXPECT_EQ(e.status, 0) << e.err;
    std::ifstream table(output / "out/observables.csv");
    std::string names, values;
    std::getline(table, names);
    std::getline(table, values);
    std::vector<std::string> const name = cells(names), value = cells(values);
    for (std::size_t k = 0; k < value.size(); ++k)
        if (name[k].starts_with(column)) return std::stod(value[k]);
    ADD_FAILURE() << "no column " << column << " in " << names;
    return 0;
}

/// 30 chains of three beads, letters A to Z and A to D, each ended by TER. OpenMM's Reference
/// platform gives -5.112086 kJ/mol for the pairs where links (0.3798 nm in the file) get 0.38 nm
/// from bead 1 outwards, -5.114377 where by the least change of positions.
TEST(Structures, ChainsOfATopologyAreToldApartByTer) {
    Json const check = checked("01-many-chains-one-letter", "scene");
    EXPECT_EQ(check.at("chains").size(), 30u);
    EXPECT_EQ(check.at("chains").at(25).at("name"), "Z");
    EXPECT_EQ(check.at("chains").at(26).at("name"), "A-2");
    EXPECT_NEAR(first_frame("01-many-chains-one-letter", "scene", "potential_energy"), -5.114377,
                3e-3);
}

/// Ten dumb-bells on one letter; the backbone's bonds stay springs. OpenMM's energies at the file's
/// positions: the side bonds have their length, so that no position changes.
TEST(Structures, DumbBellsEndedByTer) {
    EXPECT_EQ(checked("13-two-beads-a-unit", "ter").at("chains").size(), 10u);
    EXPECT_NEAR(first_frame("13-two-beads-a-unit", "ter", "HarmonicBondForce"), 0.143043, 1e-6);
    EXPECT_NEAR(first_frame("13-two-beads-a-unit", "ter", "HarmonicAngleForce"), 8.174290, 1e-6);
}

/// Residues 21 to 27 are missing; the alpha carbons of 20 and 28 are 2.633 nm apart.
TEST(Structures, AGapIsNotClosed) {
    expect_refused(
        catena({"check", "scene.yaml"}, folder_of("03-missing-residues")), 2,
        "residues ILE 20 and LEU 28 of `gap.pdb` stand 2.633 nm apart: the chain has a gap");
    Ended const e =
        catena({"check", "scene.yaml", "--set", "chains[0].links=as_given", "--json", "-"},
               folder_of("03-missing-residues"));
    ASSERT_EQ(e.status, 0) << e.err;
    expect_note(e.json(), "(first: 20 and 28, 2.633 nm)");
}

/// The record `second` has 20 residues, `first` 10.
TEST(Structures, TheRecordThatBearsTheChainsName) {
    EXPECT_EQ(checked("05-fasta-library", "scene").at("bodies"), 20);
    Words const check = {"check", "scene.yaml", "--set", "chains[0].name=p"};
    expect_refused(catena(check, folder_of("05-fasta-library")), 2,
                   "contains 3 records: `first`, `second`, `third`");
    Json const lower = checked("05-fasta-library", "lower");
    EXPECT_EQ(lower.at("bodies"), 10);
    expect_note(lower, "10 of 10 letters are lower case");
}

/// Eight residues each; the calcium ion's name begins in column 13, that of an alpha carbon in
/// column 14.
TEST(Structures, IonsAndOtherNamesInPdbFiles) {
    for (char const* const scene : {"calcium", "calcium_own_chain", "mse", "hie", "cyx"})
        EXPECT_EQ(checked("07-hetatm-and-names", scene).at("bodies"), 8) << scene;
    expect_note(checked("07-hetatm-and-names", "calcium"), "1 ion left out (1 CA)");
    expect_note(checked("07-hetatm-and-names", "calcium_own_chain"), "1 ion left out (1 CA)");
    expect_note(checked("07-hetatm-and-names", "mse"), "1 MSE as MET");
    expect_note(checked("07-hetatm-and-names", "hie"), "1 HIE as HIS");
    expect_note(checked("07-hetatm-and-names", "cyx"), "1 CYX as CYS");
}

/// The eight residues of the file's minimal table, without authors' names of chains. A build
/// without gemmi says so.
TEST(Structures, MmcifIsRead) {
    bool const built = catena({"--version"}).out.find("gemmi   none") == std::string::npos;
    Words const check = {"check", "cif.yaml", "--json", "-"};
    Ended const e = catena(check, folder_of("07-hetatm-and-names"));
    if (!built) return expect_refused(e, 2, "built without gemmi");
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.json().at("bodies"), 8);
    for (char const* const key : {"positions=structure.cif", "conformation={pdb: structure.cif}"}) {
        Ended const from =
            catena({"check", "mse.yaml", "--set", "chains[0].pdb=null", "--set",
                    "chains[0].sequence=GGGGGGGG", "--set", std::string("chains[0].") + key},
                   folder_of("07-hetatm-and-names"));
        EXPECT_EQ(from.status, 0) << from.err;
    }
}

/// Read as nine one-letter codes, which is what is written, and said.
TEST(Structures, ThreeLetterCodesAreNoticed) {
    Json const check = checked("22-slips-of-the-pen", "three-letters");
    EXPECT_EQ(check.at("bodies"), 9);
    expect_note(check, "looks like three-letter codes");
}

TEST(Structures, AnIonIsAChainOfOneBead) {
    TemporaryFolder const folder;
    std::ofstream(folder / "s.yaml") << R"(
chains:
  - {name: p, sequence: GSKEELRKAL, model: calvados2}
  - {name: ion, bodies: [{mass: 40, position: [0, 3, 0], residue: LYS}]}
forces: {openmm: {builder: calvados2, temperature: 293, ionic_strength: 0.15, ph: 7, platform: Reference}}
dynamics: {integrator: g-baoab, step: 0.01, steps: 20, temperature: 293, friction: 0.01}
output: {every: 10, observables: [energy, temperature, radius_of_gyration, end_to_end_distance, constraint_error]}
)";
    expect_good(catena({"check", folder / "s.yaml"}));
    expect_good(catena({"run", folder / "s.yaml", "--output", folder / "out", "--quiet"}));
}

}  // namespace
}  // namespace catena::test
