#include "tests/command/program.hpp"

namespace catena::test {
namespace {

TEST(NoOpenMm, SaysSo) {
    for (std::string const command : {"check", "plan", "solve"})
        expect_refused(catena({command, input("alpha-synuclein.yaml")}), 2, "built without OpenMM");
    expect_refused(catena({"bench", "sampling"}), 2, "built without OpenMM");
    EXPECT_NE(catena({"--version"}).out.find("OpenMM  none"), std::string::npos);
}

}  // namespace
}  // namespace catena::test
