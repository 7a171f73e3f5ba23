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

TEST(OpenMm, SolveGivesForcesAndAccelerationsThatBelongTogether) {
    Ended const e = catena({"solve", input("several-chains.yaml"), "--set", "forces.openmm.platform=Reference", "--set",
                            "forces.gravity=[0, 0, -3]", "--repeat", "1", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json["bead_forces"].size(), 118U);
    EXPECT_TRUE(json["potential_energy"].contains("yukawa"));
    EXPECT_LT(json["rnea_residual"].get<double>(), 1e-12);  // by the oracle, with these very forces
    double sum[3] = {}, largest = 0;
    for (Json const& force : json["bead_forces"])
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += force[i].get<double>();
            largest = std::max(largest, std::abs(force[i].get<double>()));
        }
    EXPECT_GT(largest, 1);
    for (double const s : sum) EXPECT_NEAR(s, 0, 1e-12 * largest);  // forces between pairs, and gravity is not among them
}

TEST(OpenMm, AMissingPlatformIsRefused) {
    expect_refused(catena({"solve", input("alpha-synuclein.yaml"), "--set", "forces.openmm.platform=Quantum"}), 2, "Quantum");
}

}  // namespace
}  // namespace catena::test
