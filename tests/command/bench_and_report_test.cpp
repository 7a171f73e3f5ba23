#include <filesystem>
#include <fstream>
#include <map>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

TEST(Bench, ListNamesTheBenchmarks) {
    Ended const e = catena({"bench", "list"});
    expect_good(e);
    EXPECT_TRUE(e.out.starts_with("solve ")) << e.out;
    EXPECT_NE(e.out.find("\nfigures "), std::string::npos) << e.out;
}

TEST(Bench, PlanComparesPredictionsWithWhatIsMeasured) {
    Ended const e =
        catena({"bench", "plan", "--sizes", "20,300", "--joints", "link,planar", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    ASSERT_EQ(json.at("results").size(), 6U);  // beads, bodies and beads on links; planar
    for (Json const& row : json.at("results")) {
        EXPECT_EQ(row.at("valid"), true);
        EXPECT_GE(row.at("slower_by").get<double>(), 0);
        for (Json const& each : row.at("arrangements")) {
            EXPECT_GT(each.at("ratio").get<double>(), 0);
            EXPECT_LE(each.at("residual").get<double>(), each.at("residual_bound").get<double>());
        }
    }
}

TEST(Bench, FiguresStandBesideTheChapters) {
    TemporaryFolder const folder;
    Ended const e = catena(
        {"bench", "figures", "--sizes", "2,8,64", "--repeat", "3", "--output", folder / "figures"});
    expect_good(e);
    EXPECT_NE(e.out.find("\nVALID"), std::string::npos) << e.out;
    Json const json = Json::parse(std::ifstream(folder / "figures/figures.json"));
    std::size_t const gpu = json.at("hardware").at("gpu").is_null() ? 0 : 5;
    EXPECT_EQ(json.at("points").size() % (2 * 3), 0U);
    EXPECT_GE(json.at("points").size(),
              2 * 3 * (2 + gpu));  // serial and segments, and openmp where it is
    for (Json const& point : json.at("points")) {
        for (char const* const time : {"solve", "full_step"})
            EXPECT_GT(point.at(time).at("median").get<double>(), 0) << time;
        EXPECT_LE(point.at("residual").get<double>(), point.at("residual_bound").get<double>());
        EXPECT_EQ(point.at("upload").is_null(), point.at("gpu_levels").is_null());
    }
    EXPECT_EQ(json.at("chapter").at("milliseconds").at("solve").at(0),
              Json({8, 0.1934, 0.1582, 1.033, 2.582, 2.585, 2.581}));
    EXPECT_FALSE(json.at("left_out").empty());
    for (char const* const picture :
         {"figure-2.3-full.svg", "figure-2.5-full.svg", "figure-2.6-projected.svg"})
        EXPECT_TRUE(std::filesystem::exists(folder / (std::string("figures/") + picture)))
            << picture;
    EXPECT_EQ(json.at("figure_2.3").at(0).at("levels").size(), 6U);
}

TEST(Bench, TheChaptersTableIsCounted) {
    TemporaryFolder const folder;
    Ended const e = catena({"bench", "figures", "--figure", "table-2.1", "--output",
                            folder / "figures", "--json", "-"});
    expect_good(e);
    Json const table = e.json().at("table_2.1");
    for (Json const& row : table.at("levels")) {
        EXPECT_EQ(row.at("kernel_operations"), row.at("chapter_kernel_operations"));
        EXPECT_NEAR(row.at("percent").get<double>(), row.at("chapter_percent").get<double>(), 0.6);
    }
    EXPECT_EQ(table.at("operations").size(), 7U);
    EXPECT_TRUE(e.json().at("points").empty());
}

TEST(Bench, SolveGivesEachFigureWithItsResidual) {
    Ended const e = catena({"bench", "solve", "--sizes", "20,1e2", "--joints", "link,revolute",
                            "--backend", "serial,segments", "--repeat", "3", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json.at("results").size(), 8U);
    EXPECT_TRUE(json.at("hardware").contains("processor"));
    for (Json const& row : json.at("results")) {
        for (char const* const key : {"matrix_sweep", "bias_sweep", "evaluation", "aba_oracle"})
            EXPECT_GT(row.at("ns_per_body").at(key).at("median").get<double>(), 0);
        EXPECT_LE(row.at("residual").get<double>(), row.at("residual_bound").get<double>());
        EXPECT_EQ(row.at("valid"), true);
        EXPECT_EQ(row.at("sweeps_an_evaluation").at("matrix"), 1);
    }
    EXPECT_EQ(
        count(catena({"bench", "solve", "--sizes", "20", "--repeat", "1", "--backend", "segments"})
                  .out,
              " VALID\n"),
        3U);
    for (auto const& [loads, words] :
         {std::pair{"none", "gravity only"}, {"torques", "gravity and joint torques."}}) {
        Ended const light = catena({"bench", "solve", "--sizes", "300", "--joints", "revolute",
                                    "--repeat", "1", "--backend", "segments", "--loads", loads});
        EXPECT_EQ(count(light.out, " VALID\n"), 1U) << light.out;
        EXPECT_NE(light.out.find(words), std::string::npos) << light.out;
    }
}

TEST(Bench, EvaluationsAreValidAndAsked) {
    Ended const e = catena({"bench", "evaluation", "--sizes", "20,300", "--repeat", "2",
                            "--backend", "segments", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json.at("results").size(), 4U);  // links and spherical joints
    for (Json const& row : json.at("results")) {
        EXPECT_GT(row.at("microseconds").at("median").get<double>(), 0);
        EXPECT_LE(row.at("residual").get<double>(), row.at("residual_bound").get<double>());
        EXPECT_EQ(row.at("valid"), true);
    }
    Ended const alike = catena({"bench", "evaluation", "--sizes", "600", "--repeat", "1",
                                "--backend", "segments", "--alike", "--json", "-"});
    expect_good(alike);
    EXPECT_EQ(alike.json().at("alike"), true);
    EXPECT_EQ(json.at("alike"), false);
    expect_refused(catena({"bench", "peers", "--alike"}), 2,
                   "catena bench peers does not take --alike");
    expect_refused(catena({"bench", "solve", "--joints", "link,mixed", "--alike"}), 2,
                   "mixed joints cannot be alike (--alike): leave out --alike or `mixed`");
    Ended const joints =
        catena({"bench", "evaluation", "--sizes", "300", "--joints", "planar,revolute,mixed",
                "--loads", "torques", "--repeat", "1", "--backend", "segments", "--json", "-"});
    expect_good(joints);
    Json const of_joints =
        joints.json();  // kept: a temporary would be gone before its first row is read
    EXPECT_EQ(of_joints.at("results").size(), 3U);
    for (Json const& row : of_joints.at("results")) {
        EXPECT_GT(row.at("microseconds").at("median").get<double>(), 0);
        EXPECT_TRUE(row.at("gigabytes_per_second").is_null());
        EXPECT_EQ(row.at("valid"), true);
    }
    for (auto const& [option, value] : {std::pair{"--backend", "serial"}, {"--handles", "full"}})
        EXPECT_EQ(catena({"bench", "evaluation", "--sizes", "20", option, value}).status, 2)
            << option;
}

TEST(Report, ErrorsAndTimesOfEveryBackendAndHandleKind) {
    TemporaryFolder const folder;
    Ended const e = catena({"report", input("arm.yaml"), input("random-link.yaml"), "--repeat", "2",
                            "--output", folder / "report"});
    expect_good(e);
    EXPECT_TRUE(e.out.ends_with("VALID\n")) << e.out;
    Json const json = Json::parse(std::ifstream(folder / "report/report.json"));
    ASSERT_EQ(json.at("studies").size(), 2U);
    for (Json const& study : json.at("studies")) {
        EXPECT_GE(study.at("points").size(), 4U);  // serial and segments, and openmp where it is
        std::map<std::string, int> kinds;
        for (Json const& point : study.at("points"))
            ++kinds[point.at("handles").get<std::string>()];
        EXPECT_EQ(kinds["projected"], kinds["full"]);
        EXPECT_EQ(kinds["articulated"], study.at("kind") == "link" ? 0 : kinds["full"]);
        for (Json const& point : study.at("points")) {
            EXPECT_LE(point.at("residual").get<double>(), point.at("residual_bound").get<double>());
            EXPECT_LT(point.at("forward_error").get<double>(), 1e-12);
            EXPECT_GT(point.at("seconds").at("median").get<double>(), 0);
        }
    }
    EXPECT_GT(json["studies"][0]["condition"].get<double>(), 1);  // 4 bodies
    EXPECT_TRUE(json["studies"][1]["condition"].is_null());       // 1,000
    EXPECT_EQ(json.at("left_out").size(), json.at("build").at("openmm") == "none"
                                              ? 3U
                                              : 2U);  // integrators of both scenes, by name
    EXPECT_NE(json["left_out"][0].get<std::string>().find("arm.yaml: its joint damping"),
              std::string::npos)
        << json["left_out"][0];
    EXPECT_TRUE(std::filesystem::exists(folder / "report/report.html"));
    bool const drawn =
        e.out.find("drew ") !=
        std::string::npos;  // a Python with matplotlib may be absent; then a line says what to do
    EXPECT_EQ(std::filesystem::exists(folder / "report/solver.png"), drawn);
    EXPECT_TRUE(drawn || e.out.find("no picture: ") != std::string::npos) << e.out;
}

TEST(Report, QuickComparesSolversIntegratorsAndForces) {
    TemporaryFolder const folder;
    Ended const e = catena({"report", "--quick", "--repeat", "1", "--output", folder / "r"});
    expect_good(e);
    Json const json = Json::parse(std::ifstream(folder / "r/report.json"));
    EXPECT_EQ(json.at("valid"), true);
    EXPECT_GE(json.at("studies").size(), 7U);
    ASSERT_EQ(json.at("integrators").at("scenes").size(), 5U);
    int implicit = 0;
    for (Json const& scene : json["integrators"]["scenes"])
        for (Json const& curve : scene.at("curves")) {
            EXPECT_EQ(curve.at("valid"), true) << curve.dump();
            if (curve.at("scheme") == "adaptive") {
                EXPECT_GT(curve.at("points").back().at("taken"),
                          curve["points"].front().at("taken"));
                continue;
            }
            EXPECT_NEAR(curve.at("slope").get<double>(), curve.at("order").get<double>(), 0.1);
            if (curve.at("scheme") == "implicit springs") ++implicit;
        }
    EXPECT_EQ(implicit, 2);
    for (Json const& curve : json["integrators"]["scenes"].back().at("curves"))
        EXPECT_EQ(curve.at("unstable_from").get<double>() > 0, curve.at("scheme") == "explicit")
            << curve.dump();
    bool const openmm = json.at("build").at("openmm") != "none";
    EXPECT_EQ(json.contains("forces"), openmm);
    for (Json const& study : json.value("forces", Json::array()))
        for (Json const& point : study.at("points")) {
            EXPECT_EQ(point.at("valid"), true) << point.dump();
            EXPECT_LT(point.at("error_bound").get<double>(), 1e-3);
        }
    EXPECT_EQ(json.at("left_out").empty(), openmm);
    std::ifstream file(folder / "r/report.html");
    std::string const page{std::istreambuf_iterator<char>(file), {}};
    EXPECT_GE(count(page, "<svg"), 11U);  // two of each kind of solver and of each integrators'
                                          // scene, errors over steps with springs
    EXPECT_EQ(count(page, "<svg"), count(page, "</svg>"));
    EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg"));  // nothing is loaded
    EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST(Report, AUsersSceneIsComparedWithItsOwnIntegrators) {
    TemporaryFolder const folder;
    auto const json = catena({"report", input("pendulum.yaml"), "--repeat", "1", "--quick",
                              "--output", folder / "r", "--json", "-"})
                          .json();
    EXPECT_EQ(json.at("studies").size(), 1U);
    EXPECT_EQ(json.at("integrators").at("scenes").at(0).at("curves").size(),
              3U);  // dormand-prince, rk4, velocity-verlet
}

TEST(Report, RefinementIsNamedWhereItCountsAndWhereNot) {
    TemporaryFolder const folder;
    Ended const e = catena({"report", input("pendulum.yaml"), "--set", "solver.refine=1",
                            "--repeat", "1", "--quick", "--output", folder / "r"});
    Json const json = Json::parse(std::ifstream(folder / "r/report.json"));
    EXPECT_EQ(json.at("integrators").at("scenes").at(0).at("refine"), 1);
    EXPECT_NE(e.out.find("dormand-prince and velocity-verlet refined 1 time (solver.refine)"),
              std::string::npos)
        << e.out;
    EXPECT_TRUE(json.at("left_out")
                    .at(0)
                    .get<std::string>()
                    .starts_with("refinement (solver.refine) of the solver's errors"));
}

TEST(Report, TheStabilitySuiteGivesAVerdictForEveryCase) {
    TemporaryFolder const folder;
    Ended const e = catena({"report", "--suite", "stability", "--quick", "--backend", "segments",
                            "--handles", "projected", "--output", folder / "r"});
    Json const json = Json::parse(std::ifstream(folder / "r/report.json"));
    EXPECT_EQ(e.status, json.at("valid").get<bool>() ? 0 : 1);
    EXPECT_GT(json.at("stability").size(), 40U);
    for (Json const& each : json.at("stability")) {
        std::string const verdict = each.at("verdict");
        // Inverses of thin bodies' inertias keep the digits of their largest entries alone.
        bool const thin = each.at("family").get<std::string>().starts_with("thin bodies") &&
                          each.at("name") == "1e8";
        bool const hard = each.at("growth").get<double>() * 0x1p-53 >
                          1e-3;  // more than two steps bring some of these back
        EXPECT_TRUE(hard || (verdict == "REFINED") == thin) << each.dump();
        EXPECT_NE(verdict, "INVALID") << each.dump();
        EXPECT_GE(each.at("growth").get<double>(), 1);
        if (verdict != "BEYOND" && verdict != "LOST") {
            EXPECT_LE(each.at("against_peers").get<double>(), 1)
                << each.dump();  // of articulated bodies alone
        }
        EXPECT_TRUE(each.at("peers").empty());
    }
    EXPECT_EQ(json.at("left_out").back(), "peers: Simbody and Pinocchio (--quick)");
    EXPECT_EQ(catena({"report", "--suite", "stability", input("arm.yaml")}).status, 2);
    expect_refused(catena({"report", "--sizes", "64"}), 2,
                   "--sizes without --suite (command line): write --suite stability");
    auto const dill = catena({"report", "--suite", "stability", "--sizes", "64", "--cases", "dill",
                              "--quick", "--output", folder / "d", "--json", "-"})
                          .json();
    ASSERT_EQ(dill.at("stability").size(), 1U);
    EXPECT_EQ(dill.at("stability")[0].at("family"), "dill");
    expect_refused(
        catena({"report", "--suite", "stability", "--sizes", "64", "--cases", "knot"}), 2,
        "no family of cases contains 'knot' (--cases): use parts of these names: coil; dill");
    expect_refused(catena({"report", "--suite", "stability", "--quick", "--cases", "beads",
                           "--handles", "articulated", "--output", folder / "n"}),
                   2, "nothing to solve: ");
    expect_refused(catena({"report", "--cases", "dill"}), 2,
                   "--cases without --suite (command line)");
}

TEST(Report, BackendAndHandlesCanBeChosen) {
    TemporaryFolder const folder;
    auto const json =
        catena({"report", input("random-spherical.yaml"), "--set",
                "chains[0].generator.random.bodies=20", "--repeat", "1", "--backend", "serial",
                "--handles", "full", "--output", folder / "r", "--json", "-"})
            .json();
    ASSERT_EQ(json.at("studies").at(0).at("points").size(), 1U);
    EXPECT_EQ(json["studies"][0]["points"][0]["backend"], "serial");
    EXPECT_EQ(json["studies"][0]["points"][0]["handles"], "full");
}

}  // namespace
}  // namespace catena::test
