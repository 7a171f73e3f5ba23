// Starts as packages for coarse-grained proteins write them: run from their System and topology
// without editing.
#include <filesystem>
#include <fstream>

#include "io/observables_table.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string file(std::string const& name) { return CATENA_TEST_DATA "/cases/" + name; }

Json summary_of(std::string const& folder) {
    return Json::parse(std::ifstream(folder + "/summary.json"));
}

/// One column of a run's observables.
std::vector<double> column(std::string const& folder, std::string const& name) {
    ObservablesTable const table = read_observables(folder + "/observables.csv");
    auto const found = std::find(table.names.begin(), table.names.end(), name);
    EXPECT_NE(found, table.names.end()) << name;
    return found == table.names.end()
               ? std::vector<double>{NAN}
               : table.columns[static_cast<std::size_t>(found - table.names.begin())];
}

/// Relaxed, then 10 ps at the scene's temperature: below 400 K in every frame.
void expect_cool_run(std::string const& scene, double nearest) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", file(scene), "--output", folder / "out"});
    ASSERT_EQ(e.status, 0) << scene << e.err;
    for (double const temperature : column(folder / "out", "temperature [K]"))
        EXPECT_LT(temperature, 400) << scene;
    Json const summary = summary_of(folder / "out"), start = summary["start"],
               relaxation = start["relaxation"];
    EXPECT_EQ(summary["valid"], true);
    EXPECT_LT(start["potential_energy"].get<double>(), 2 * start["thermal_energy"].get<double>())
        << scene;
    if (relaxation["from"]["potential_energy"].is_number()) {
        EXPECT_LT(relaxation["to"]["potential_energy"].get<double>(),
                  relaxation["from"]["potential_energy"].get<double>());
    }
    if (start.contains("nearest_distance")) {
        EXPECT_GT(start["nearest_distance"].get<double>(), nearest) << scene;
    }
}

/// CALVADOS's own starts are compact lattices of 0.38 nm. Energies of the starts by OpenMM itself
/// (Reference) on the topology: Yukawa 8.1036 and Ashbaugh-Hatch 16238.6008 kJ/mol of one chain of
/// 34 residues; 14.9266, 22206.9387 and 1.5840 (towards the middle of the box) of 8 chains of 16.
/// Links of the topology are 0.38 nm to its digits, 5e-5 nm, which the steepest overlaps (dE/dr 1e5
/// kJ/mol/nm at most on a bead) turn into 3e-5 of these energies.
TEST(CalvadosFolder, OfDisorderedChainsIsRefusedWithItsEnergyAndRelaxed) {
    for (auto const& [name, energy] : {std::pair("calvados-folders/idr", 16246.7044),
                                       std::pair("calvados-folders/slab", 22223.4494)}) {
        std::string const scene = std::string(name) + ".yaml";
        expect_refused(catena({"check", file(scene), "--set", "relax=false"}), 2,
                       "overlapping beads");
        Ended const e = catena({"check", file(scene), "--json", "-"});
        ASSERT_EQ(e.status, 0) << e.err;
        EXPECT_NEAR(e.json()["start"]["relaxation"]["from"]["potential_energy"].get<double>(),
                    energy, 1e-4 * energy);
        expect_cool_run(scene, 0.4);
    }
}

/// Beads at the centres of mass of residues: neighbours are up to 0.6 nm apart where their bond
/// rests at 0.38 nm.
TEST(CalvadosFolder, OfTwoDomainsIsRelaxed) {
    std::string const scene = "calvados-folders/two-domains.yaml";
    Ended const refused = catena({"check", file(scene), "--set", "relax=false"});
    expect_refused(refused, 2,
                   "beads 14 and 15 of chain `A` are 0.5964 nm apart, their link is 0.38 nm long");
    EXPECT_NE(refused.err.find("or `relax: true`"), std::string::npos) << refused.err;
    Ended const e = catena({"check", file(scene)});
    EXPECT_NE(e.out.find("the largest change of a link is 57 %"), std::string::npos) << e.out;
    expect_cool_run(scene, 0.3);
}

/// A straight chain. Right: -3.684907 and -1.410328 kJ/mol (OpenMM itself, Reference, on the
/// topology).
TEST(OpenAbcFolder, OfHpsRunsFromItsStraightStart) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", file("openabc-straight/hps.yaml"), "--output", folder / "out"});
    ASSERT_EQ(e.status, 0) << e.err;
    EXPECT_NEAR(column(folder / "out", "ashbaugh-hatch_energy [kJ/mol]").at(0), -3.684907, 1e-3);
    EXPECT_NEAR(column(folder / "out", "yukawa_energy [kJ/mol]").at(0), -1.410328, 1e-3);
    for (double const temperature : column(folder / "out", "temperature [K]"))
        EXPECT_LT(temperature, 500);
}

/// Torsions of beads on a line have no direction: OpenMM's forces are not finite there. Angles rest
/// at 130 degrees at most (`clip=True`), as the package advises for steps of 10 fs.
TEST(OpenAbcFolder, OfMoffIsToldThatItsTorsionsAreUndefinedAndBent) {
    std::string const scene = "openabc-straight/moff.yaml";
    for (std::string const command : {"check", "run"}) {
        Ended const e = catena({command, file(scene), "--set", "relax=false"});
        EXPECT_EQ(e.status, 2);
        EXPECT_NE(e.err.find("bead 2 of chain `A` and its neighbours lie on a line, where torsions "
                             "are undefined"),
                  std::string::npos)
            << e.err;
    }
    expect_cool_run(scene, 0.3);
}

/// Whatever relaxation does is bounded, and what it leaves is judged.
TEST(Relaxation, SaysHowFarItCameWhereItCannotMend) {
    TemporaryFolder const folder;
    std::ofstream(folder / "start.csv") << "0,0,0\n0.38,0,0\n0.38,0.38,0\n0,0.38,0\n";
    // A square whose ring of links cannot open, with beads that want to be further apart than it
    // lets them.
    std::ofstream(folder / "s.yaml") << "relax: true\nforces: {openmm: {builder: calvados2, "
                                        "temperature: 1, platform: Reference}}\n"
                                        "chains: [{sequence: WWWW, model: calvados2, positions: "
                                        "start.csv, tip: {ring: {type: link, length: "
                                        "0.38}}}]\n";
    expect_refused(catena({"check", folder / "s.yaml"}), 2, "after relaxation (");
}

}  // namespace
}  // namespace catena::test
