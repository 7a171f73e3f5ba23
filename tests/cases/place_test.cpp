// Slabs and frames of other runs as people begin with them: one command each.
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string const peptides =
    "chains: [{name: p, count: 20, sequence: GSKEELRKALEDAGQYFKPSTWNHGMIVCD, model: calvados2}]\n"
    "forces: {openmm: {builder: calvados2, temperature: 293, ph: 7, platform: Reference}}\n"
    "dynamics: {integrator: g-baoab, step: 0.01, steps: 2, temperature: 293, friction: 0.01}\n"
    "output: {every: 1}\n";

class PlacedSlab : public testing::Test {
  protected:
    std::string write(std::string const& name, std::string const& rest) const {
        std::ofstream(folder_ / name) << peptides << rest;
        return folder_ / name;
    }
    TemporaryFolder folder_;
};

TEST_F(PlacedSlab, IsCheckedWithItsConcentration) {
    std::string const scene =
        write("s.yaml", "box: {periodic: [8, 8, 30]}\nplace: {slab: {axis: z, thickness: 8}}\n");
    Ended const e = catena({"check", scene});
    expect_good(e);
    EXPECT_NE(e.out.find("20 chains (p-1 .. p-20) in the box: "), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("20 chains (p-1 .. p-20) in z from 1"), std::string::npos) << e.out;
    Json const found = catena({"check", scene, "--json", "-"}).json()["concentrations"];
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0]["mmol_per_l"].get<double>(), 20 * 1660.539 / 1920, 1e-3);
    EXPECT_GE(found[1]["mmol_per_l"].get<double>(), 20 * 1660.539 / 512 - 1e-3);
    EXPECT_GT(found[1]["mg_per_ml"].get<double>(), 50);
}

TEST_F(PlacedSlab, GoesOnInALongerBox) {
    std::string const first =
        write("s.yaml", "box: {periodic: [8, 8, 14]}\nplace: {slab: {axis: z, thickness: 10}}\n");
    expect_good(catena({"run", first, "--output", folder_ / "out", "--quiet"}));
    std::string const second = write("t.yaml", "box: {periodic: [8, 8, 60]}\nstart: {from: out}\n");
    Ended const e = catena({"run", second, "--output", folder_ / "longer"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.err.find("positions come from frame 2 of 0 to 2 (step 2, 0.02 ps)"),
              std::string::npos)
        << e.err;
    EXPECT_NE(e.err.find("thermal ones drawn at 293 K"), std::string::npos) << e.err;
    EXPECT_NE(e.err.find("the frame's box is 8 x 8 x 14 nm"), std::string::npos) << e.err;
    Json const summary = Json::parse(std::ifstream(folder_ / "longer/summary.json"));
    EXPECT_EQ(summary["valid"], true);
    EXPECT_GE(summary["notes"].size(), 2U);
    Ended const alone = catena({"check", second, "--json", "-"}),
                ranks = catena_on(2, {"check", second, "--json", "-"});
    EXPECT_EQ(ranks.status, 0) << ranks.err;
    EXPECT_EQ(alone.json()["scene_hash"], ranks.json()["scene_hash"]);
    expect_refused(catena({"check", second, "--set", "chains[0].count=19"}), 2,
                   "has 20 chains, the scene has 19");
}

}  // namespace
}  // namespace catena::test
