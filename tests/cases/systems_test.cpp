// Systems of OpenMM's that went wrong: their right energies, their notes, their refusals.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "io/observables_table.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string case_file(std::string const& name) { return CATENA_TEST_DATA "/cases/" + name; }

Ended check(std::string const& name, Words extra = {}) {
    extra.insert(extra.begin(), {"check", case_file(name)});
    return catena(extra);
}

/// The notes of a scene that `check` accepts, and nothing on standard error.
std::string notes_of(std::string const& name, Words extra = {}) {
    extra.insert(extra.end(), {"--json", "-"});
    Ended const e = check(name, extra);
    expect_good(e);
    return e.status == 0 ? e.json().at("notes").dump() : "";
}

bool holds(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

/// A run of a few steps, and the table that it left.
class Finished {
  public:
    explicit Finished(std::string const& name, Words extra = {}) {
        extra.insert(extra.begin(), {"run", case_file(name), "--output", folder_ / "o", "--set",
                                     "output.every=1"});
        ended = catena(extra);
        if (std::filesystem::exists(folder_ / "o/observables.csv"))
            table_ = read_observables(folder_ / "o/observables.csv");
    }
    /// In the first frame.
    double energy(std::string const& term) const {
        auto const found =
            std::find(table_.names.begin(), table_.names.end(), term + "_energy [kJ/mol]");
        EXPECT_NE(found, table_.names.end()) << term;
        return found == table_.names.end()
                   ? NAN
                   : table_.columns[static_cast<std::size_t>(found - table_.names.begin())].at(0);
    }
    std::string file(std::string const& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / ("o/" + name)).rdbuf();
        return text.str();
    }
    Ended ended;

  private:
    TemporaryFolder folder_;
    ObservablesTable table_;
};

// OpenABC and ForceField.createSystem add a CMMotionRemover. Energies by an independent OpenMM
// script on the same start.
TEST(MotionRemover, IsLeftOutWithANoteAndTheRunGoesOn) {
    EXPECT_TRUE(holds(notes_of("11-cm-motion-remover/scene.yaml"),
                      "The System's CMMotionRemover, which has no energy"));
    Finished const run("11-cm-motion-remover/scene.yaml");
    EXPECT_EQ(run.ended.status, 0) << run.ended.err;
    EXPECT_TRUE(holds(run.ended.err, "catena: warning: The System's CMMotionRemover"))
        << run.ended.err;
    EXPECT_NEAR(run.energy("WCA"), 0, 1e-6);
    EXPECT_NEAR(run.energy("stiffness"), 16.308472,
                1e-3);  // at the digits of the topology, as the cage
    EXPECT_NEAR(run.energy("cage"), 634.878132,
                0.02);  // 0.009 less at the digits of the topology, before links have their length
}

TEST(MotionRemover, IsLeftOutWithANoteInAGroupThatIsNotAskedForToo) {
    EXPECT_TRUE(holds(notes_of("11-cm-motion-remover/groups.yaml"), "CMMotionRemover"));
}

// Particle 2i is bonded to 2i + 1, a side bead, and to 2i + 2: a branched chain. Only the
// observable has no meaning.
TEST(BranchedMolecules, AreFoundInTheSystemsBonds) {
    expect_refused(check("13-two-beads-a-unit/scene.yaml"), 2,
                   "branched chains have no end-to-end distance");
    Words const energy{"--set", "output.observables=[energy]"};
    Ended const checked = check("13-two-beads-a-unit/scene.yaml", energy);
    EXPECT_TRUE(holds(checked.out, "branched beads")) << checked.out;
    EXPECT_TRUE(holds(checked.out, "19 harmonic bonds along rigid links left out")) << checked.out;
    Finished const run("13-two-beads-a-unit/scene.yaml", energy);
    EXPECT_EQ(run.ended.status, 0) << run.ended.err;
    // By an independent OpenMM script on the start, whose links have the lengths of the bonds.
    EXPECT_NEAR(run.energy("HarmonicAngleForce"), 9.002089, 1e-4);
    Finished const written("13-two-beads-a-unit/branched.yaml");
    auto const bonds = [](std::string const& psf) { return psf.substr(psf.find("!NBOND")); };
    EXPECT_EQ(bonds(run.file("topology.psf")), bonds(written.file("topology.psf")));
}

// A TER before each unit: ten dumb-bells. Energies by an independent OpenMM script on the same
// start.
TEST(BranchedMolecules, RunAsPiecesWhoseOtherBondsStaySprings) {
    Finished const run("13-two-beads-a-unit/ter.yaml");
    EXPECT_EQ(run.ended.status, 0) << run.ended.err;
    EXPECT_NEAR(run.energy("HarmonicBondForce"), 0.143043, 1e-5);
    EXPECT_NEAR(run.energy("HarmonicAngleForce"), 8.174290, 1e-4);
}

// Written bead by bead with `parent`: the bonds become links, the angles are those of the same
// start.
TEST(BranchedMolecules, RunWholeIfTheSceneSaysOnWhichBeadEachHangs) {
    Ended const checked = check("13-two-beads-a-unit/branched.yaml");
    EXPECT_TRUE(holds(checked.out, "19 harmonic bonds along rigid links left out")) << checked.out;
    EXPECT_TRUE(holds(checked.out, "(particles 0 and 2 from 0: 1400 kJ/mol/nm2")) << checked.out;
    Finished const run("13-two-beads-a-unit/branched.yaml");
    EXPECT_EQ(run.ended.status, 0) << run.ended.err;
    EXPECT_NEAR(run.energy("HarmonicAngleForce"), 8.174290, 1e-4);
}

/// Notes of case 13's branched chain with another text of the scene in place of `from`, with the
/// System's bonds or without them.
std::string notes_of_branched(std::string const& from, std::string const& to, bool bonds = true) {
    TemporaryFolder const folder;
    std::ostringstream scene;
    scene << std::ifstream(case_file("13-two-beads-a-unit/branched.yaml")).rdbuf();
    std::string text = scene.str();
    std::size_t const at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    // Bonds that stay springs are periodic.
    std::ofstream(folder / "s.yaml") << text << "box: {periodic: [20, 20, 20]}\n";
    std::ostringstream system;
    system << std::ifstream(case_file("13-two-beads-a-unit/system.xml")).rdbuf();
    std::ofstream(folder / "system.xml")
        << (bonds ? system.str()
                  : std::regex_replace(system.str(), std::regex("<Bond [^>]*>"), ""));
    Ended const e = catena({"check", folder / "s.yaml", "--json", "-"});
    expect_good(e);
    return e.status == 0 ? e.json().at("notes").dump() : "";
}

// Bead 19 hangs on bead 17 in the System.
TEST(LinksOfTheScene, ThatJoinOtherParticlesThanTheSystemAreNoted) {
    std::string const own = "parent: 17";
    EXPECT_FALSE(holds(notes_of_branched(own, own), "are `parent` and `map`"));
    std::string const notes = notes_of_branched(own, "parent: 18");
    EXPECT_TRUE(holds(notes,
                      "1 of 19 links joins particles that the System neither bonds nor constrains, "
                      "the first beads 18 and 19 of chain `rna`, and 1 of its bonds within these "
                      "chains is along no link: are `parent` and `map` those of the System?"))
        << notes;
}

TEST(LinksOfTheScene, AreLeftToItByASystemWithoutBonds) {
    std::string const own = "parent: 17";
    EXPECT_FALSE(holds(notes_of_branched(own, "parent: 18", false), "neither bonds"));
}

// Bonds of a side bead are 0.54 nm long; 1 % more is not noted.
TEST(LinksOfTheScene, ThatAreMuchLongerThanTheSystemsBondsAreNoted) {
    std::string const own = "[9.9500, 5.2000, 5.5400]";
    EXPECT_FALSE(holds(notes_of_branched(own, "[9.9500, 5.2000, 5.5450]"), "longer or shorter"));
    std::string const notes = notes_of_branched(own, "[9.9500, 5.2000, 5.6000]");
    EXPECT_TRUE(holds(notes,
                      "1 link is at least 2 % longer or shorter than the System's bond, the first "
                      "beads 19 and 20 of chain `rna`: 0.6 nm, its bond 0.54 nm"))
        << notes;
}

// sqrt(kT/k) = sqrt(2.436 / 20) nm = 0.349 nm, 92 % of 0.38 nm.
TEST(Springs, ThatAreSoftAreNoLinks) {
    expect_refused(check("20-springs-that-are-no-links/soft.yaml"), 2,
                   "the bond between particles 0 and 1 (from 0) is too soft for a rigid link: with "
                   "20 kJ/mol/nm2 its thermal spread "
                   "sqrt(kT/k) at 293 K is 0.349 nm, 91.8 % of its length of 0.38 nm");
}

// Link 5 to 6 of the topology is 0.525 nm long, 38 % too long: 3 thermal spreads of a spring of
// 1022 kJ/mol/nm2, as MOFF's, and 8 of CALVADOS's.
TEST(Springs, ThatAreSoftMayBeStretchedByThermalMotion) {
    TemporaryFolder const folder;
    std::string const from = case_file("20-springs-that-are-no-links/");
    std::ifstream topology(from + "topology.pdb");
    std::ofstream stretched(folder / "topology.pdb");
    for (std::string line; std::getline(topology, line);) {
        if (line.starts_with("ATOM") && std::stoi(line.substr(22, 4)) > 5)
            line.replace(30, 8, fmt::format("{:8.3f}", std::stod(line.substr(30, 8)) + 1.6));
        stretched << line << '\n';
    }
    stretched.close();
    std::filesystem::copy_file(from + "soft.yaml", folder / "soft.yaml");
    std::ostringstream system;
    system << std::ifstream(from + "soft.xml").rdbuf();
    auto const check_with = [&](std::string const& stiffness) {
        std::ofstream(folder / "soft.xml")
            << std::regex_replace(system.str(), std::regex("k=\"20\""), "k=\"" + stiffness + "\"");
        return catena({"check", folder / "soft.yaml"});
    };
    Ended const soft = check_with("1022");
    EXPECT_EQ(soft.status, 0) << soft.err;
    EXPECT_TRUE(holds(soft.out, "9 links of fixed length stand for soft bonds")) << soft.out;
    EXPECT_TRUE(holds(soft.out, "the largest change of a link is 38 %")) << soft.out;
    expect_refused(check_with("8033"), 2,
                   "beads 5 and 6 of chain `A` are 0.5246 nm apart, their link is 0.38 nm long");
}

TEST(Springs, WithoutStiffnessJoinNothing) {
    expect_refused(check("20-springs-that-are-no-links/zero.yaml"), 2,
                   "particles 4 and 5 (from 0) are joined by no harmonic bond and no constraint");
}

// 8033 kJ/mol/nm2 at 0.38 nm and 700 at 0.60: together they rest at (8033 0.38 + 700 0.60) / 8733
// nm = 0.397634 nm.
TEST(Springs, OnOnePairRestTogether) {
    EXPECT_TRUE(holds(notes_of("20-springs-that-are-no-links/twice.yaml"),
                      "1 link stands for several harmonic bonds of different lengths, at the "
                      "length at which these rest together (particles 3 "
                      "and 4 from 0: 2 bonds, 0.397634 nm)"));
    Ended const e = check("20-springs-that-are-no-links/twice.yaml");
    EXPECT_TRUE(holds(e.out, "their links differ from them by up to 0.202 nm")) << e.out;
}

// Published constants, an independent OpenMM script: charged ends add 0.72 kJ/mol. That script gave
// links their lengths from bead 1 outwards; the least change of positions differs from it by the
// digits of the file, times forces of some kJ/mol/nm.
TEST(ChargeTermini, AreTheChainsOwn) {
    double const digits = 1e-3;
    Finished const without("15-uncapped-ends/scene.yaml");
    EXPECT_EQ(without.ended.status, 0) << without.ended.err;
    EXPECT_NEAR(without.energy("yukawa"), -4.062575, digits);
    EXPECT_NEAR(without.energy("ashbaugh-hatch"), -2.251378, digits);
    Finished const with("15-uncapped-ends/scene.yaml", {"--set", "chains[0].charge_termini=both"});
    EXPECT_NEAR(with.energy("yukawa"), -3.341184, digits);
    EXPECT_NEAR(with.energy("ashbaugh-hatch"), -2.251378, digits);
}

// KEELRKALEDAG: K, R, K against E, E, E, D is -1 e; an N-terminus has one more, a C-terminus one
// less.
TEST(ChargeTermini, AreInTheNetChargeThatCheckSays) {
    auto const charge = [](std::string const& termini, std::string const& expected) {
        Ended const e =
            check("15-uncapped-ends/scene.yaml", {"--set", "chains[0].charge_termini=" + termini});
        expect_good(e);
        EXPECT_TRUE(holds(e.out, "net charge: fragment " + expected)) << e.out;
    };
    charge("none", "-1.000 e");
    charge("both", "-1.000 e");
    charge("N", "0.000 e");
    charge("C", "-2.000 e");
    expect_refused(check("15-uncapped-ends/scene.yaml", {"--set", "chains[0].charge_termini=left"}),
                   2, "both");
}

TEST(ChargeTermini, OfAllChainsStandInTheForceField) {
    Ended const e =
        check("22-slips-of-the-pen/temperatures.yaml", {"--set", "forces.openmm.charge_termini=N"});
    EXPECT_TRUE(holds(e.out, "net charge: p 0.091 e"))
        << e.out;  // four K and R, five D and E, a histidine of 1/11 e at pH 7
}

TEST(Slips, TwoTemperaturesAreNoted) {
    EXPECT_TRUE(holds(notes_of("22-slips-of-the-pen/temperatures.yaml"),
                      "forces.openmm.temperature is 293 K and dynamics.temperature 320 K: water's "
                      "permittivity and the Debye length are "
                      "those at 293 K."));
    EXPECT_EQ(
        notes_of("22-slips-of-the-pen/temperatures.yaml", {"--set", "dynamics.temperature=293"}),
        "[]");
}

TEST(Slips, MillimolarIsNoted) {
    EXPECT_TRUE(holds(notes_of("22-slips-of-the-pen/millimolar.yaml"),
                      "forces.openmm.ionic_strength is 150 mol/l, more than the solubility of any "
                      "salt: did you mean 0.15"));
}

TEST(Slips, StepsInFemtosecondsAreNoted) {
    EXPECT_TRUE(
        holds(notes_of("22-slips-of-the-pen/temperatures.yaml", {"--set", "dynamics.step=10"}),
              "dynamics.step is 10 ps, that is 10000 fs: steps of such chains are 0.01 to 0.06 ps. "
              "Did you mean 0.01?"));
}

TEST(Slips, StepsBeyondThoseShownAreNoted) {
    auto const at = [](std::string const& step) {
        return notes_of("22-slips-of-the-pen/temperatures.yaml",
                        {"--set", "dynamics.step=" + step});
    };
    EXPECT_TRUE(holds(at("0.1"), "dynamics.step is 100 fs: steps up to 60 fs were shown"));
    EXPECT_FALSE(holds(at("0.06"), "dynamics.step"));
}

TEST(Slips, ResiduesWithoutForcesAreNoted) {
    std::vector<std::string> const without{"--set", "forces.openmm=null"};
    EXPECT_TRUE(holds(notes_of("22-slips-of-the-pen/temperatures.yaml", without),
                      "no forces act between the residues of chain `p`: did you mean forces: "
                      "{openmm: {builder: calvados2}}?"));
    EXPECT_EQ(notes_of("22-slips-of-the-pen/temperatures.yaml",
                       {"--set", "forces.openmm=null", "--set", "dynamics=null"}),
              "[]");
}

TEST(Slips, FrozenWaterAndCelsiusAreNoted) {
    auto const at = [](std::string const& temperature) {
        return notes_of("22-slips-of-the-pen/temperatures.yaml",
                        {"--set", "dynamics.temperature=" + temperature, "--set",
                         "forces.openmm.temperature=" + temperature});
    };
    std::string const frozen = "water is frozen at ", celsius = "did you mean 298.15 K";
    EXPECT_TRUE(holds(at("210"), frozen + "210 K"));
    EXPECT_FALSE(holds(at("210"), "did you mean"));
    EXPECT_TRUE(holds(at("25"), "the temperature is 25 K: " + celsius + " (25 degrees Celsius)?"));
    EXPECT_FALSE(holds(at("298"), frozen));
    EXPECT_TRUE(holds(at("500"), "water boils at 500 K"));
    EXPECT_FALSE(holds(at("370"), "boils"));
}

/// Beyond the warmest water the refusal is the only line.
TEST(Slips, WaterThatIsTooHotIsRefusedInOneLine) {
    TemporaryFolder const folder;
    expect_refused(catena({"run", case_file("22-slips-of-the-pen/temperatures.yaml"), "--set",
                           "dynamics.temperature=1000", "--set", "forces.openmm.temperature=1000",
                           "--output", folder / "o"}),
                   2, "the permittivity of water, which scales the electrostatics, is not known");
}

/// Nothing depends on water where nothing is charged.
TEST(Slips, UnchargedBeadsMayBeCold) {
    Ended const e = catena({"check", input("polymer-melt.yaml"), "--set", "chains[0].sequence=XX",
                            "--set", "relax=false"});
    expect_good(e);
    EXPECT_EQ(count(e.out, "frozen"), 0U) << e.out;
    EXPECT_EQ(count(e.out, "did you mean"), 0U) << e.out;
}

TEST(Residues, OfAFileGiveTheChainsCharge) {
    Ended const e = check("16-residue-table/scene.yaml");
    expect_good(e);
    EXPECT_EQ(count(e.out, "net charge           p -1.969 e\n"), 1U) << e.out;
    EXPECT_EQ(count(e.out, "residues.csv`\n"), 1U) << e.out;
}

TEST(Residues, OfAFileBelongToTheChains) {
    expect_refused(check("16-residue-table/of-the-forces.yaml"), 2,
                   "residue tables belong to the chains (");
}

// A line was lost, `</Force>` of the first of five forces; OpenMM's reader then takes the others
// for its children.
TEST(DamagedXml, WithALostTagIsRefused) {
    expect_refused(check("xml-lost-closing-tag/scene.yaml"), 2,
                   "s.xml is not well-formed: a <Force> is not closed before the next begins (");
}

TEST(DamagedXml, WithAnOpenCommentIsRefused) {
    expect_refused(check("xml-open-comment/scene.yaml"), 2,
                   "x.xml is not well-formed: a comment that is not closed (line 25)");
}

// The second of five forces bears the name `Bonds, soft`.
TEST(ForceNames, AreMadeHarmlessInTables) {
    Finished const run("force-name-comma/scene.yaml");
    EXPECT_EQ(run.ended.status, 0) << run.ended.err;
    EXPECT_TRUE(std::isfinite(run.energy("Bonds_ soft")));
    std::string const table = run.file("observables.csv");
    std::string const head = table.substr(0, table.find('\n'));
    std::string const row =
        table.substr(head.size() + 1, table.find('\n', head.size() + 1) - head.size() - 1);
    EXPECT_EQ(count(head, ","), count(row, ","));
}

TEST(ControlCharacters, OfATopologyDoNotReachTheTerminal) {
    Ended const e = check("pdb-control/scene.yaml");
    EXPECT_EQ(e.status, 2);
    EXPECT_EQ(count(e.err, "\n"), 1U) << e.err;
    EXPECT_TRUE(std::none_of(e.err.begin(), e.err.end() - 1, [](unsigned char c) {
        return c < 0x20 || c == 0x7f;
    })) << e.err;
}

}  // namespace
}  // namespace catena::test
