#include <cmath>

#include "tests/command/program.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

TEST(OpenMm, CheckAndPlanDescribeIt) {
    for (std::string const command : {"check", "plan"}) {
        Ended const e = catena({command, input("alpha-synuclein.yaml")});
        expect_good(e);
        EXPECT_NE(e.out.find("139 links replace the model's harmonic bonds"), std::string::npos) << e.out;
    }
}

/// Newton's law of every bead: m a = force of OpenMM + tensions of its links.
TEST(OpenMm, SolveGivesForcesAndAccelerationsThatBelongTogether) {
    Ended const e = catena({"solve", input("several-chains.yaml"), "--set", "forces.openmm.platform=Reference", "--set", "forces.gravity=[0, 0, -3]", "--repeat", "1", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json["bead_forces"].size(), 118U);
    EXPECT_TRUE(json["potential_energy"].contains("yukawa"));
    EXPECT_LT(json["rnea_residual"].get<double>(), 1e-12);   // by the oracle, with these very forces
    double sum[3] = {}, largest = 0;
    for (std::size_t k = 0; k < 14; ++k)   // a free peptide: its links' forces cancel
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += json["bead_forces"][k][i].get<double>();
            largest = std::max(largest, std::abs(json["bead_forces"][k][i].get<double>()));
        }
    EXPECT_GT(largest, 1);
}

TEST(OpenMm, AMissingPlatformIsRefused) {
    expect_refused(catena({"solve", input("alpha-synuclein.yaml"), "--set", "forces.openmm.platform=Quantum"}), 2, "Quantum");
}

}  // namespace
}  // namespace catena::test
