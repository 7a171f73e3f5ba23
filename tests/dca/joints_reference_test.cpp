// Chains with cylindrical and planar3 joints against Pinocchio (tests/data/reference/README.md):
// the oracles, and every backend and kind of handles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/oracle_accelerations.hpp"
#include "measure/solution.hpp"
#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/variants.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

Json const& data() {
    static Json const all = [] {
        std::ifstream file(std::string(CATENA_TEST_DATA) +
                           "/reference/pinocchio-cylindrical-planar3.json");
        return Json::parse(file);
    }();
    return all;
}
/// Scene of one chain; JSON is YAML.
Scene scene_of(Json const& entry) {
    Json const scene{{"units", data().at("units")},
                     {"forces", {{"gravity", data().at("gravity")}}},
                     {"chains", Json::array({entry.at("chain")})}};
    return parse_scene(scene.dump(), "pinocchio.yaml");
}
/// Pinocchio's accelerations in the layout of Solution::acceleration.
std::vector<double> expected(Json const& entry) {
    std::vector<double> all;
    for (Json const& of_joint : entry.at("accelerations"))
        for (Json const& number : of_joint) all.push_back(number.get<double>());
    return all;
}
double error(std::vector<double> const& found, std::vector<double> const& exact) {
    if (found.size() != exact.size()) return HUGE_VAL;
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        worst = std::max(worst, std::abs(found[i] - exact[i]));
        largest = std::max(largest, std::abs(exact[i]));
    }
    return worst / largest;
}
/// Error that Pinocchio's dense solution in double may have.
double bound(Json const& entry) {
    return std::max(1e-12, 16 * 0x1p-53 * entry.at("condition").get<double>());
}

class JointsReference : public WithVariant {};

TEST_P(JointsReference, SolversReachPinocchio) {
    double worst = 0;
    for (Json const& entry : data().at("chains")) {
        Scene const scene = with_backend(scene_of(entry));
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.evaluate();
        double const of_it = error(solution_of(system).acceleration, expected(entry));
        EXPECT_LE(of_it, bound(entry)) << entry.at("chain").at("name");
        worst = std::max(worst, of_it);
    }
    std::printf("largest error %.1e\n", worst);
}
INSTANTIATE_TEST_SUITE_P(Variants, JointsReference,
                         testing::Values(Variant{Backend::serial, Handles::projected},
                                         Variant{Backend::serial, Handles::full},
                                         Variant{Backend::segments, Handles::projected},
                                         Variant{Backend::segments, Handles::full},
                                         Variant{Backend::segments, Handles::articulated},
                                         Variant{Backend::openmp, Handles::projected},
                                         Variant{Backend::cuda, Handles::projected},
                                         Variant{Backend::cuda, Handles::full},
                                         Variant{Backend::cuda, Handles::articulated}),
                         name_of_variant);

TEST(JointsReferenceOfOracles, OraclesReachPinocchio) {
    ASSERT_GE(data().at("chains").size(), 16U);
    for (Json const& entry : data().at("chains")) {
        Scene const scene = scene_of(entry);
        std::vector<double> const exact = expected(entry);
        oracle::Loads const loads = oracle_loads(scene, 0, {});
        EXPECT_LE(error(oracle_accelerations<long double>(scene, {}), exact), bound(entry));
        EXPECT_LE(error(joint_accelerations(scene.chains[0],
                                            oracle::dense<long double>(scene.chains[0], loads)),
                        exact),
                  bound(entry));
    }
}

}  // namespace
}  // namespace catena::test
