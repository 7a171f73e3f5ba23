#include "cuda/device/gpu.hpp"
#include "tests/command/program.hpp"

namespace catena::test {
namespace {

TEST(Help, EveryCommandExplainsItselfWithExamples) {
    Ended const all = catena({"--help"});
    expect_good(all);
    for (std::string const command : {"check", "plan", "solve", "run", "report", "bench"}) {
        EXPECT_NE(all.out.find("\n  " + command + " "), std::string::npos) << all.out;
        Ended const one = catena({command, "--help"});
        expect_good(one);
        EXPECT_NE(one.out.find("Usage: catena " + command), std::string::npos) << one.out;
        EXPECT_NE(one.out.find("Examples:\n  "), std::string::npos) << one.out;
        for (std::string const option :
             {"--backend", "--handles", "--threads", "--simd", "--gpu-levels", "--set", "--json",
              "--quiet", "--log-level"})
            EXPECT_NE(one.out.find(option), std::string::npos) << command << " " << option;
    }
}

TEST(Help, CommandsOnTrajectoriesExplainThemselvesWithExamples) {
    for (std::string const command : {"analyse", "convert"}) {
        EXPECT_NE(catena({"--help"}).out.find("\n  " + command + " "), std::string::npos);
        Ended const one = catena({command, "--help"});
        expect_good(one);
        EXPECT_NE(one.out.find("Examples:\n  catena " + command), std::string::npos) << one.out;
        for (std::string const option : {"--first", "--json", "--quiet", "--log-level"})
            EXPECT_NE(one.out.find(option), std::string::npos) << command << " " << option;
        EXPECT_EQ(one.out.find("--backend"), std::string::npos) << one.out;
    }
}

TEST(Help, ImportExplainsItselfWithExamples) {
    EXPECT_NE(catena({"--help"}).out.find("\n  import "), std::string::npos);
    Ended const one = catena({"import", "--help"});
    expect_good(one);
    EXPECT_NE(one.out.find("Examples:\n  catena import "), std::string::npos) << one.out;
    for (std::string const option : {"--output", "--leave-out", "--links", "--overwrite", "--json"})
        EXPECT_NE(one.out.find(option), std::string::npos) << option;
}

TEST(Help, VersionSaysWhatIsInTheBuild) {
    Ended const e = catena({"--version"});
    expect_good(e);
    EXPECT_TRUE(e.out.starts_with("catena ")) << e.out;
    for (std::string const& part :
         {std::string("MPI"), std::string("OpenMP"), std::string("OpenMM"), std::string("HDF5"),
          "CUDA    " + cuda::version()})
        EXPECT_NE(e.out.find("  " + part), std::string::npos) << e.out;
}

}  // namespace
}  // namespace catena::test
