// Starts that went wrong: wrapped into the box, stretched, overlapping, frames of other programs'
// runs.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string file(std::string const& name) { return CATENA_SOURCE_DIR "/tests/data/cases/" + name; }

Json summary_of(std::string const& folder) {
    return Json::parse(std::ifstream(folder + "/summary.json"));
}

/// A copy of a case's scene with a chain of its own positions.
std::string scene_with(TemporaryFolder const& folder, std::string const& positions,
                       std::string const& more) {
    std::ofstream(folder / "start.csv") << positions;
    std::ofstream(folder / "scene.yaml")
        << "forces: {openmm: {builder: calvados2, temperature: 293, platform: Reference}}\n"
           "dynamics: {integrator: g-baoab, step: 0.01, steps: 20, temperature: 293, friction: "
           "0.01}\n"
        << more;
    return folder / "scene.yaml";
}

/// 2 strands of `beads` each, `apart` from each other, all links 0.38.
std::string strands(int beads, double apart) {
    std::string table;
    for (int strand : {0, 1})
        for (int k = 0; k < beads; ++k)
            table += std::to_string(5 + 0.38 * (strand == 0 ? k : beads - 1 - k)) + "," +
                     std::to_string(5 + apart * strand) + ",5\n";
    return table;
}

/// Right: Rg 1.637972 nm and 4.757799 nm from end to end (numpy: the links' directions to the
/// nearest image, lengths 0.38, CALVADOS 2's masses; link by link from bead 1 on, while the least
/// change of positions differs by the table's rounding of 5e-5). Turned round at the cut link, the
/// chain had 1.398143 and 4.130651.
TEST(WrappedStart, IsMadeWholeAlongTheChain) {
    TemporaryFolder const folder;
    for (std::string const name : {"whole", "wrapped"}) {
        Ended const e = catena({"run", file("02-wrapped-start/" + name + ".yaml"), "--output",
                                folder / name, "--quiet"});
        EXPECT_EQ(e.status, 0) << e.err;
        EXPECT_EQ(count(e.err, "cut by the sides of the periodic box"),
                  0U);  // --quiet: in the summary
        Json const summary = summary_of(folder / name);
        std::ifstream table(folder / (name + "/observables.csv"));
        EXPECT_EQ(summary["notes"].dump().find("1 link of 1 chain is cut by the sides of the "
                                               "periodic box, the first between beads 19 and 20 "
                                               "of chain `p`") != std::string::npos,
                  name == "wrapped")
            << summary["notes"];
        std::string header, row;
        std::getline(table, header), std::getline(table, row);
        Json const start = summary["start"];
        EXPECT_LT(start["largest_displacement"].get<double>(), 1.5e-4);
        EXPECT_GT(start["largest_displacement"].get<double>(), 0);
        auto const column = [&](std::string const& wanted) {
            std::istringstream names(header), values(row);
            for (std::string n, v; std::getline(names, n, ',') && std::getline(values, v, ',');)
                if (n.starts_with(wanted)) return std::stod(v);
            return std::nan("");
        };
        EXPECT_NEAR(column("radius_of_gyration"), 1.637972, 5e-5) << header;
        EXPECT_NEAR(column("end_to_end_distance"), 4.757799, 3e-4) << header;
    }
}

TEST(WrappedStart, IsRefusedWithoutABox) {
    expect_refused(catena({"check", file("02-wrapped-start/wrapped.yaml"), "--set", "box=none"}), 2,
                   "beads 19 and 20 of chain `p` are 9.8");
}

/// Lengths as the positions say: those of the nearest images, not of the cut.
TEST(WrappedStart, IsMadeWholeBeforeLengthsAreTaken) {
    Ended const e = catena({"check", file("02-wrapped-start/wrapped.yaml"), "--set",
                            "chains[0].links=as_given", "--json", "-"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.json()["notes"].dump().find("made whole"), std::string::npos) << e.out;
}

/// Right: positions of links 0.203 to 1.952 nm long are no start of links of 0.38 nm; projected,
/// beads moved by up to 6.09 nm (numpy).
TEST(StretchedPositions, AreRefusedWithTheWorstLinkAndTheWayOut) {
    for (std::string const command : {"check", "run"}) {
        Ended const e = catena({command, file("stretched-positions/scene.yaml")});
        expect_refused(e, 2, "their link is 0.38 nm long");
        EXPECT_NE(e.err.find("are 1.952 nm apart"), std::string::npos) << e.err;
        EXPECT_NE(e.err.find("links: as_given"), std::string::npos) << e.err;
        EXPECT_NE(e.err.find("beads 3 and 10 overlap: 0.229 nm apart"), std::string::npos) << e.err;
    }
}

/// Right: the springs have 315.0 kJ/mol (numpy: Newton's iteration for the lengths, least squares;
/// 306.7 in the file, 362.5 from bead 1 outwards) and no bead moves by more than 0.0237 nm.
TEST(FrameOfARun, StartsWithTheLeastChangeOfItsPositions) {
    TemporaryFolder const folder;
    Ended const e =
        catena({"run", file("28-frame-of-a-run-as-start/scene.yaml"), "--output", folder / "out"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.err.find("the start's positions were moved so that links have their lengths"),
              std::string::npos)
        << e.err;
    Json const start = summary_of(folder / "out")["start"];
    EXPECT_NEAR(start["potential_energy"].get<double>(), 315.05, 0.05);
    EXPECT_NEAR(start["largest_displacement"].get<double>(), 0.02371, 5e-5);
    EXPECT_NE(e.out.find("links changed by up to"), std::string::npos) << e.out;
}

/// Right: 52,193.8 kJ/mol at the start (OpenMM with the published constants), 223 times 3/2 kT a
/// bead.
TEST(OverlappingStart, IsRefusedByCheckAndRunWithItsNearestBeads) {
    struct Case {
        std::string name, part;
    };
    for (Case const& c : {Case{"08-overlapping-start/scene.yaml", "52193.8 kJ/mol"},
                          Case{"08-overlapping-start/close.yaml", "overlapping"},
                          Case{"08-overlapping-start/hairpin.yaml", "overlap"},
                          Case{"start-overlap/scene.yaml", "overlap"}})
        for (std::string const command : {"check", "run"}) {
            Ended const e = catena({command, file(c.name), "--quiet"});
            expect_refused(e, 2, c.part);
            for (char const* const innocent : {"masses", "dynamics.step", "inertias"})
                EXPECT_EQ(e.err.find(innocent), std::string::npos) << e.err;
        }
    expect_refused(
        catena({"check", file("start-overlap/scene.yaml"), "--set", "chains[0].links=as_given"}), 2,
        "beads 3 and 10 of chain `c` 0.229 nm apart: potential energy 27787.1 kJ/mol");
}

TEST(OverlappingStart, IsMendedByRelaxation) {
    TemporaryFolder const folder;
    for (std::string const name : {"scene", "close", "hairpin"}) {
        std::string const out = folder / name;
        Ended const e = catena({"run", file("08-overlapping-start/" + name + ".yaml"), "--set",
                                "relax=true", "--set", "dynamics.steps=100", "--output", out});
        EXPECT_EQ(e.status, 0) << name << e.err;
        EXPECT_NE(e.out.find("relaxation"), std::string::npos) << e.out;
        Json const summary = summary_of(out), start = summary["start"],
                   relaxation = start["relaxation"];
        EXPECT_LT(start["potential_energy"].get<double>(), start["thermal_energy"].get<double>())
            << name;
        EXPECT_LT(relaxation["to"]["potential_energy"].get<double>(),
                  relaxation["from"]["potential_energy"].get<double>());
        EXPECT_GT(relaxation["to"]["nearest_distance"].get<double>(), 0.4) << name;
        EXPECT_LT(summary["last_observables"]["temperature [K]"].get<double>(), 450) << name;
        EXPECT_EQ(summary["valid"], true);
    }
    Ended const solved = catena({"solve", file("08-overlapping-start/hairpin.yaml"), "--set",
                                 "relax=true", "--repeat", "1"});
    EXPECT_NE(solved.out.find("relaxation"), std::string::npos) << solved.out << solved.err;
}

TEST(OverlappingStart, IsRelaxedToTheSameBitsOnTwoRanksAndCanBeGoneOnWith) {
    TemporaryFolder const folder;
    Words const words{"run",     file("08-overlapping-start/close.yaml"),
                      "--set",   "relax=true",
                      "--set",   "dynamics.steps=4",
                      "--set",   "output.every=2",
                      "--quiet", "--output"};
    auto const with = [&](std::string const& out, Words more) {
        Words all = words;
        all.push_back(folder / out);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    ASSERT_EQ(catena(with("one", {})).status, 0);
    ASSERT_EQ(catena_on(2, with("two", {})).status, 0);
    Json const one = summary_of(folder / "one"), two = summary_of(folder / "two");
    EXPECT_EQ(one["start"]["relaxation"], two["start"]["relaxation"]);
    EXPECT_EQ(one["scene_hash"], two["scene_hash"]);
    // Sums of forces over ranks round otherwise.
    EXPECT_NEAR(one["last_observables"]["temperature [K]"].get<double>(),
                two["last_observables"]["temperature [K]"].get<double>(), 1e-6);
    ASSERT_EQ(catena(with("parts", {"--steps", "2"})).status, 0);
    Ended const e =
        catena(with("parts", {"--steps", "4", "--restart", folder / "parts/checkpoint.h5"}));
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(summary_of(folder / "parts")["last_observables"], one["last_observables"]);
}

/// Domains are shifted and turned as one.
TEST(OverlappingStart, IsRelaxedWithRigidDomains) {
    TemporaryFolder const folder;
    std::string const scene =
        scene_with(folder, strands(12, 0.42),
                   "chains: [{name: p, sequence: GSKEELRKALEDAGQYFKPSTWNH, model: calvados2, "
                   "positions: start.csv, rigid: [[11, 14]]}]\n");
    expect_refused(catena({"check", scene}), 2, "overlapping");
    Ended const e = catena({"run", scene, "--set", "relax=true", "--output", folder / "out"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_LT(summary_of(folder / "out")["last_observables"]["temperature [K]"].get<double>(), 600);
}

TEST(OverlappingStart, CannotBeRelaxedWithoutForces) {
    TemporaryFolder const folder;
    std::ofstream(folder / "s.yaml")
        << "relax: true\nchains: [{generator: {freely_jointed: {beads: 4, length: 0.38}}}]\n";
    expect_refused(catena({"check", folder / "s.yaml"}), 2, "`relax` needs forces between beads");
}

/// Both beads on one point: nothing is finite, nothing is said of steps or masses.
TEST(OverlappingStart, OfBeadsOnOnePointIsCalledOne) {
    TemporaryFolder const folder;
    std::string const square = "0,0,0\n0.38,0,0\n0.38,0.38,0\n0,0.38,0\n0,0,0\n-0.38,0,0\n";
    std::string const scene = scene_with(
        folder, square,
        "chains: [{name: p, sequence: GSKEEL, model: calvados2, positions: start.csv}]\n");
    for (std::string const command : {"check", "run"})
        expect_refused(catena({command, scene, "--quiet"}), 2,
                       "beads 1 and 5 of chain `p` 0 nm apart");
    Ended const e = catena({"run", scene, "--set", "relax=true", "--output", folder / "out"});
    EXPECT_EQ(e.status, 0) << e.err;
}

TEST(Check, SaysHowFarPositionsWereChangedAndTheStartsEnergy) {
    Ended const e = catena({"check", file("02-wrapped-start/whole.yaml")});
    expect_good(e);
    EXPECT_NE(e.out.find("largest link change"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("times the kinetic energy at 293 K"), std::string::npos) << e.out;
    EXPECT_EQ(e.out.find("moved so that"), std::string::npos) << e.out;
}

/// A residue that is missing between two CA atoms leaves 0.5 nm or more.
TEST(Gap, IsNeverClosed) {
    TemporaryFolder const folder;
    std::string const scene =
        scene_with(folder, "0,0,0\n0.38,0,0\n0.9,0,0\n1.28,0,0\n",
                   "chains: [{name: p, sequence: GSKE, model: calvados2, positions: start.csv}]\n");
    for (std::string const relax : {"relax=false", "relax=true"})
        expect_refused(catena({"check", scene, "--set", relax}), 2,
                       "beads 2 and 3 of chain `p` are 0.52 nm apart, their link is 0.38 nm long");
}

/// A ring of 5 links whose table rounds is closed with the others' lengths kept.
TEST(Ring, ClosesByTheLeastChangeOfItsBeads) {
    TemporaryFolder const folder;
    std::string bodies;
    for (int k = 0; k < 5; ++k) {
        double const radius = 0.5 / std::sin(M_PI / 5) + (k == 2 ? 0.01 : 0),
                     angle = 2 * M_PI * k / 5;
        bodies += std::string(k ? ", " : "") + "{mass: 1, position: [" +
                  std::to_string(radius * std::cos(angle)) + ", " +
                  std::to_string(radius * std::sin(angle)) + ", 0], joint: {type: link" +
                  (k ? ", length: 1" : "") + "}}";
    }
    std::ofstream(folder / "ring.yaml")
        << "units: si\nchains: [{name: r, tip: {ring: {type: link, length: 1}}, bodies: [" << bodies
        << "]}]\ndynamics: {integrator: rattle, step: 1e-3, steps: 5}\noutput: {every: 1}\n";
    Ended const e = catena({"run", folder / "ring.yaml", "--output", folder / "out"});
    EXPECT_EQ(e.status, 0) << e.err;
    Json const summary = summary_of(folder / "out");
    EXPECT_EQ(summary["valid"], true);
    EXPECT_LT(summary["start"]["largest_displacement"].get<double>(), 0.02);
    EXPECT_GT(summary["start"]["largest_link_change"].get<double>(), 1e-3);
}

/// Starts of this repository's scenes are begun from without a word.
/// Right: all beads within the region, but for ends that stand out (20 chains of 30 beads in 8 x 8
/// x 10 nm around the middle of a long box).
TEST(Slab, IsFilledInTheMiddleOfTheBox) {
    TemporaryFolder const folder;
    std::ofstream(folder / "s.yaml")
        << "chains: [{name: p, count: 20, sequence: GSKEELRKALEDAGQYFKPSTWNHGMIVCD, model: "
           "calvados2, "
           "conformation: self_avoiding}]\n"
           "box: {periodic: [8, 8, 60], fill: [8, 8, 10]}\n"
           "forces: {openmm: {builder: calvados2, temperature: 293, platform: Reference}}\n"
           "dynamics: {integrator: g-baoab, step: 0.01, steps: 1, temperature: 293, friction: "
           "0.01}\n"
           "output: {every: 1}\n";
    expect_good(catena({"run", folder / "s.yaml", "--output", folder / "out", "--quiet"}));
    std::ifstream pdb(folder / "out/topology.pdb");
    int beads = 0, within = 0;
    for (std::string line; std::getline(pdb, line);) {
        if (!line.starts_with("ATOM") && !line.starts_with("HETATM")) continue;
        double const z = 0.1 * std::stod(line.substr(46, 8));
        ++beads, within += z > 25 && z < 35;
        EXPECT_NEAR(z, 30, 8);
    }
    EXPECT_EQ(beads, 600);
    EXPECT_GT(within, 500);
    expect_refused(catena({"check", folder / "s.yaml", "--set", "box.fill=[8, 8, 70]"}), 2,
                   "edge 70 is longer than the box's, 60");
}

TEST(HealthyStarts, PassWithoutAWord) {
    for (std::string const name :
         {"alpha-synuclein.yaml", "three-domains.yaml", "several-chains.yaml"})
        expect_good(catena({"check", input(name)}));
}

}  // namespace
}  // namespace catena::test
