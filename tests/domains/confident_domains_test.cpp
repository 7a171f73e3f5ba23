// Domains of predicted structures: the clusters of residues and their segments.
#include "domains/confident_domains.hpp"

#include <gtest/gtest.h>

namespace catena::test {
namespace {

using scene::ConfidentDomains;
using scene::DomainThresholds;
using scene::PredictedError;
using scene::Segment;

/// Errors of 2 within the same group, of 20 between groups.
PredictedError errors_of(std::vector<int> const& group) {
    PredictedError error{group.size(), std::vector<float>(group.size() * group.size(), 20)};
    for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = 0; j < group.size(); ++j)
            if (i == j || group[i] == group[j]) error.value[i * group.size() + j] = 2;
    return error;
}

/// Groups by their lengths: {{1, 30}, {0, 5}} is 30 residues of group 1 and 5 of group 0.
std::vector<int> groups(std::vector<std::pair<int, int>> const& runs) {
    std::vector<int> all;
    for (auto const& [group, length] : runs)
        for (int k = 0; k < length; ++k) all.push_back(group);
    return all;
}

/// 90 for residues of a group, 40 for those of group 0.
std::vector<double> plddt_of(std::vector<int> const& group) {
    std::vector<double> plddt;
    for (int const g : group) plddt.push_back(g > 0 ? 90 : 40);
    return plddt;
}

ConfidentDomains found_in(std::vector<std::pair<int, int>> const& runs,
                          DomainThresholds const& limits = {}) {
    std::vector<int> const group = groups(runs);
    return scene::confident_domains(plddt_of(group), errors_of(group), limits);
}

using Domains = std::vector<std::vector<Segment>>;

TEST(ConfidentDomains, are_the_groups_of_small_errors) {
    auto const found = found_in({{0, 10}, {1, 30}, {0, 15}, {2, 25}, {3, 40}});
    EXPECT_EQ(found.domains, (Domains{{{10, 39}}, {{55, 79}}, {{80, 119}}}));
    EXPECT_TRUE(found.short_segments.empty());
}

TEST(ConfidentDomains, need_confident_residues) {
    std::vector<int> const group = groups({{1, 60}});
    std::vector<double> plddt(60, 69.9);
    EXPECT_TRUE(scene::confident_domains(plddt, errors_of(group), {}).domains.empty());
    plddt.assign(60, 70);
    EXPECT_EQ(scene::confident_domains(plddt, errors_of(group), {}).domains, (Domains{{{0, 59}}}));
}

TEST(ConfidentDomains, span_short_loops) {
    EXPECT_EQ(found_in({{1, 30}, {0, 10}, {1, 30}}).domains, (Domains{{{0, 69}}}));
    EXPECT_EQ(found_in({{1, 30}, {0, 11}, {1, 30}}).domains, (Domains{{{0, 29}, {41, 70}}}));
    EXPECT_EQ(found_in({{1, 30}, {0, 11}, {1, 30}}, {70, 5, 20, 11}).domains, (Domains{{{0, 70}}}));
}

TEST(ConfidentDomains, leave_short_segments_flexible) {
    auto const found = found_in({{1, 30}, {0, 15}, {2, 19}, {0, 15}, {1, 5}});
    EXPECT_EQ(found.domains, (Domains{{{0, 29}}}));
    EXPECT_EQ(found.short_segments, (std::vector<Segment>{{45, 63}, {79, 83}}));
    EXPECT_EQ(found_in({{1, 30}, {0, 15}, {2, 19}}, {70, 5, 19, 10}).domains.size(), 2u);
}

/// The mean error decides, not the least one: two groups touch at an error of 1 and are 6 apart in
/// the mean.
TEST(ConfidentDomains, are_joined_by_the_mean_error_of_their_parts) {
    std::vector<int> const group = groups({{1, 30}, {2, 30}});
    PredictedError error = errors_of(group);
    auto const between = [&](double mean) {
        for (std::size_t i = 0; i < 30; ++i)
            for (std::size_t j = 30; j < 60; ++j)
                error.value[i * 60 + j] = error.value[j * 60 + i] = static_cast<float>(mean);
        error.value[29 * 60 + 30] = error.value[30 * 60 + 29] = 3;
        return scene::confident_domains(plddt_of(group), error, {}).domains;
    };
    EXPECT_EQ(between(6).size(), 2u);
    EXPECT_EQ(between(4.9), (Domains{{{0, 59}}}));
}

}  // namespace
}  // namespace catena::test
