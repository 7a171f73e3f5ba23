// What VALID says over restarts, of thermostatted and pushed chains and of `solve`; messages that
// name the cause.
#include <cmath>
#include <cstdio>
#include <fstream>

#include "io/output.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::string case_file(std::string const& name) {
    return CATENA_SOURCE_DIR "/tests/data/cases/" + name;
}

Words with(Words words, Words const& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

nlohmann::json summary_in(std::string const& folder) {
    return nlohmann::json::parse(std::ifstream(folder + "/summary.json"));
}

nlohmann::json check_of(nlohmann::json const& summary, std::string const& name) {
    for (auto const& check : summary.at("verdict").at("checks"))
        if (check.at("name") == name) return check;
    return nullptr;
}

void write(std::string const& file, std::string const& text) { std::ofstream(file) << text; }

// ---- Restarts

/// 200 rods whose energy, a constant, goes up by 38 % in 3000 steps
/// (tests/data/cases/energy-drift-valid). Parts of 300 steps drift by too little, beside what their
/// energies fluctuate, to be told from none.
class CutRun : public testing::Test {
  protected:
    Words const run_{"run", case_file("energy-drift-valid/scene.yaml"), "--quiet"};
    Ended whole() { return catena(with(run_, {"--output", "whole"}), folder_.path()); }
    Words part(int steps) const {
        Words const where =
            steps == 300 ? Words{"--output", "parts"} : Words{"--restart", "parts/checkpoint.h5"};
        return with(with(run_, {"--steps", std::to_string(steps)}), where);
    }
    TemporaryFolder folder_;
};

TEST_F(CutRun, HasTheVerdictOfTheWhole) {
    Ended const whole = this->whole();
    EXPECT_EQ(whole.status, 1);
    Ended last;
    for (int steps = 300; steps <= 3000; steps += 300) last = catena(part(steps), folder_.path());
    EXPECT_EQ(last.status, 1);
    EXPECT_NE(last.err.find("energy at step 3000"), std::string::npos) << last.err;
    EXPECT_EQ(last.err, whole.err);
    EXPECT_EQ(summary_in(folder_ / "parts").at("verdict"),
              summary_in(folder_ / "whole").at("verdict"));
}
TEST_F(CutRun, HasItOnTwoRanks) {
    Ended const whole = this->whole();
    catena_on(2, part(300), folder_.path());
    catena(part(2700), folder_.path());
    Ended const last = catena_on(2, part(3000), folder_.path());
    EXPECT_NE(last.err.find("energy at step 3000"), std::string::npos) << last.err;
    EXPECT_EQ(summary_in(folder_ / "parts").at("verdict"),
              summary_in(folder_ / "whole").at("verdict"));
}
TEST_F(CutRun, OfACheckpointWithoutEnergiesSaysWhatItsVerdictCovers) {
    catena(part(300), folder_.path());
    Checkpoint earlier = read_checkpoint(folder_ / "parts/checkpoint.h5");
    earlier.arrays.erase("verdict_frames");
    write_checkpoint(folder_ / "parts/checkpoint.h5", earlier);
    Ended const rest = catena(part(600), folder_.path());
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_NE(
        summary_in(folder_ / "parts").at("notes").dump().find("covers only the steps from 300 on"),
        std::string::npos);
}
TEST_F(CutRun, RefusesEnergiesThatNoRunWrites) {
    catena(part(300), folder_.path());
    Checkpoint const good = read_checkpoint(folder_ / "parts/checkpoint.h5");
    auto const expect_refused_for = [&](Checkpoint const& changed, std::string const& words) {
        write_checkpoint(folder_ / "changed.h5", changed);
        Ended const e =
            catena(with(run_, {"--restart", "changed.h5", "--output", "never"}), folder_.path());
        EXPECT_EQ(e.status, 2) << words;
        EXPECT_NE(e.err.find(words), std::string::npos) << e.err;
    };
    auto const expect_refused_after = [&](std::size_t at, double value) {
        Checkpoint c = good;
        c.arrays.at("verdict_frames").at(at) = value;
        expect_refused_for(c, "verdict_frames are not energies of its run");
    };
    expect_refused_after(0, -1);            // frames of an entry
    expect_refused_after(5, 1e300);         // a step
    expect_refused_after(6, 1e6);           // beyond the checkpoint's
    expect_refused_after(7, std::nan(""));  // frames
    Checkpoint c = good;
    c.arrays.at("verdict_frames").pop_back();
    expect_refused_for(c, "verdict_frames are not energies of its run");
    c.integers["largest_constraint_error_at"] = 1000;
    expect_refused_for(c, "largest_constraint_error_at is 1000");
}
TEST_F(CutRun, BeginsItsVerdictAnewInABranch) {
    catena(part(300), folder_.path());
    Ended const branch = catena(with(run_, {"--restart", "parts/checkpoint.h5", "--branch",
                                            "--output", "branch", "--set", "dynamics.step=0.1"}),
                                folder_.path());
    EXPECT_EQ(branch.status, 0) << branch.err;
    nlohmann::json const summary = summary_in(folder_ / "branch");
    EXPECT_NE(summary.at("notes").dump().find("the verdict covers the branch only"),
              std::string::npos)
        << summary.at("notes");
    EXPECT_EQ(summary.at("run").at("last_step"), 3300);
    // Without --steps its restart ends where it does, though dynamics.steps are fewer than the
    // checkpoint's.
    Ended const again =
        catena(with(run_, {"--restart", "branch/checkpoint.h5", "--set", "dynamics.step=0.1"}),
               folder_.path());
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(summary_in(folder_ / "branch").at("run").at("last_step"), 3300);
    expect_refused(
        catena(with(run_, {"--restart", "branch/checkpoint.h5", "--set", "dynamics.step=0.1",
                           "--steps", "3000"}),
               folder_.path()),
        2, "request more than 3300 steps with --steps, which counts from the scene's start");
}

// ---- Temperatures of pushed chains

/// 40 free bodies of 10 amu, inertia 1 amu nm^2, without forces between them, at 300 K, friction 1
/// / ps; 2000 frames, 1 ps apart.
class Pushed : public testing::Test {
  protected:
    nlohmann::json run(std::string const& body, std::string const& more,
                       std::string const& dynamics = "") {
        write(folder_ / "s.yaml",
              "chains: [{name: b, count: 40, velocities: thermal, bodies: [{mass: 10, inertia: [1, "
              "1, 1], joint: {type: "
              "free}" +
                  body + "}]}]\n" + more +
                  "dynamics: {integrator: baoab, step: 0.05, steps: 40000, temperature: 300, "
                  "friction: 1, seed: 3" +
                  dynamics + "}\noutput: {every: 20, observables: [energy, temperature]}\n");
        ended_ =
            catena({"run", "s.yaml", "--output", "o", "--overwrite", "--quiet"}, folder_.path());
        return summary_in(folder_ / "o");
    }
    TemporaryFolder folder_;
    Ended ended_;
};

// A free body falls at g / friction in the end: 1/2 m (g / friction)^2 = 0.5 * 10 * 0.25 = 1.25
// kJ/mol beside 3 kT = 7.48 kJ/mol, which is 50 K above the thermostat's 300 K. The fall of
// potential energy tells of it.
TEST_F(Pushed, UnderGravityIsAsWarmAsFrictionLeavesIt) {
    nlohmann::json const summary = run("", "forces: {gravity: [0, 0, -0.5]}\n");
    EXPECT_EQ(ended_.status, 0) << ended_.err;
    nlohmann::json const check = check_of(summary, "temperature");
    EXPECT_NEAR(check.at("value").get<double>(), 350, 5);
    EXPECT_EQ(check.at("advice"), "") << check;
}
// A constant force of 5 kJ/mol/nm on 10 amu is the same push. Its potential energy is in no column,
// but it adds no more than 50 K.
TEST_F(Pushed, ByAConstantForceIsCheckedBeyondWhatThatCanAdd) {
    nlohmann::json const summary = run(", wrench: {force: [5, 0, 0]}", "");
    EXPECT_EQ(ended_.status, 0) << ended_.err;
    nlohmann::json const check = check_of(summary, "temperature");
    EXPECT_NEAR(check.at("value").get<double>(), 350, 5);
    EXPECT_NE(check.at("advice").get<std::string>().find("may add up to 50.1 K"), std::string::npos)
        << check;
}

// ---- solve and plan

// Beads 4 and 16 of the projected start are 0.0903 nm apart (numpy); `check` and `run` refuse it.
TEST(Solve, RefusesAStartWhoseForcesMeanNothing) {
    expect_refused(catena({"solve", case_file("start-overlap/scene.yaml"), "--set",
                           "chains[0].links=as_given"}),
                   2, "overlapping beads");
}
TEST(Solve, TakesAStartThatARunBeginsFrom) {
    expect_good(catena({"solve", input("alpha-synuclein.yaml"), "--repeat", "1"}));
}

TEST(Plan, SaysWhatTheReaderNotedAsCheckDoes) {
    TemporaryFolder const folder;
    write(folder / "s.yaml",
          "chains: [{name: c, generator: {freely_jointed: {beads: 10, length: 0.38, mass: 100}}}]\n"
          "dynamics: {integrator: rattle, step: 0.001, steps: 10}\noutput: {every: 100}\n");
    std::string const note = "output.every = 100 exceeds dynamics.steps = 10";
    Ended const plan = catena({"plan", folder / "s.yaml", "--json", "-"}),
                text = catena({"plan", folder / "s.yaml"});
    EXPECT_NE(plan.json().at("notes").dump().find(note), std::string::npos) << plan.out;
    EXPECT_NE(text.out.find(note), std::string::npos) << text.out;
    EXPECT_EQ(plan.json().at("notes"),
              catena({"check", folder / "s.yaml", "--json", "-"}).json().at("notes"));
}
TEST(Plan, TakesLinksFromTheCommandLineWhereTheFileHasNone) {
    TemporaryFolder const folder;
    write(folder / "none.json", R"({"network": {"near": null, "far": null}})");
    Words const words{"plan",      case_file("plan-one-host/scene.yaml"),
                      "--ranks",   "8",
                      "--hosts",   "2",
                      "--network", folder / "none.json"};
    expect_refused(catena(words), 2, "measured on one rank");
    Ended const given =
        catena(with(words, {"--latency", "1.5us", "--bandwidth", "12.5GB/s", "--json", "-"}));
    EXPECT_EQ(given.status, 0) << given.err;
    EXPECT_EQ(given.json().at("network").at("near"), given.json().at("network").at("far"));
}

// ---- Causes

// 450 rods with stiff springs, a step of 2 ps. More than 400 bodies are warned, not refused. Their
// state is lost within a few steps, while masses and positions are those that the run began with.
TEST(Messages, NameTheStepAndTheStiffestSpringBeforeTheMasses) {
    TemporaryFolder const folder;
    write(folder / "s.yaml",
          "chains: [{name: helix, velocities: thermal, generator: {elastic_rod: {bodies: 450, "
          "mass: 650, length: 0.34, radius: 1, bend: "
          "5000, "
          "twist: 10000, seed: 1}}}]\n"
          "dynamics: {integrator: baoab, step: 2, steps: 3000, temperature: 300}\n");
    Ended const lost = catena({"run", "s.yaml", "--output", "o", "--quiet"}, folder.path());
    EXPECT_EQ(lost.status, 1);
    auto const at = lost.err.find("catena: at step ");
    ASSERT_NE(at, std::string::npos) << lost.err;
    std::string const line = lost.err.substr(at);
    EXPECT_LT(line.find("dynamics.step = 2 is too long"), line.find("masses")) << line;
    EXPECT_NE(line.find("(the stiffest spring, 73362.9, is that of chain `helix`, body 2)"),
              std::string::npos)
        << line;  // 10000 kT / 0.34 nm
}

// A file without numbers that can be read: `rigid` then counts beads.
TEST(Messages, SayThatRigidCountsBeadsWhereResiduesHaveNoNumbers) {
    TemporaryFolder const folder;
    std::ofstream pdb(folder / "a.pdb");
    char const* const numbers[] = {"   1", "   2", "****", "****", "****"};
    for (int k = 0; k < 5; ++k) {
        char line[96];
        std::snprintf(line, sizeof line,
                      "ATOM  %5d  CA  ALA A%s    %8.3f%8.3f%8.3f  1.00  0.00           C\n", k + 1,
                      numbers[k], 3.8 * (k / 2), 3.8 * ((k + 1) / 2), 0.0);
        pdb << line;
    }
    pdb.close();
    write(folder / "s.yaml", "chains: [{pdb: a.pdb, model: calvados2, rigid: [[1, 3]]}]\n");
    Ended const check = catena({"check", "s.yaml"}, folder.path());
    EXPECT_EQ(check.status, 0) << check.err;
    EXPECT_NE(check.out.find("`rigid` means beads, numbered from 1: `a.pdb` has no residue number "
                             "that can be read for bead 3, ALA `****`"),
              std::string::npos)
        << check.out;
}

TEST(Messages, CallTheRegionThatIsFilledByItsName) {
    TemporaryFolder const folder;
    auto const filled = [&](std::string const& edges, int chains) {
        write(folder / "s.yaml", "chains: [{name: p, count: " + std::to_string(chains) +
                                     ", sequence: GSKEELRKALEDAGQYFKPSTWNHGMIVCD, model: "
                                     "calvados2, conformation: self_avoiding}]\n"
                                     "box: {periodic: [8, 8, 60], fill: " +
                                     edges + "}\n");
        return catena({"check", folder / "s.yaml"});
    };
    Ended const narrow = filled("[1, 8, 10]", 20), full = filled("[4, 4, 4]", 90);
    expect_refused(narrow, 2, "the region to fill 1 x 8 x 10 is too narrow");
    expect_refused(full, 2, "of the region to fill 4 x 4 x 4");
}

}  // namespace
}  // namespace catena::test
