// Members of complexes as chains of their own, and lists of members that files claim.
#include "frames/member_order.hpp"

#include <gtest/gtest.h>

#include "io/site_names.hpp"

namespace catena::test {
namespace {

using Numbers = std::vector<std::int64_t>;

/// A complex of 5 sites, H 2 and 1, L 1 and 2, H 3, and a chain of 2 sites.
Topology complex() {
    Topology topology;
    topology.chains = {{"H+L", 0, 5, true, false}, {"p", 5, 2, true, false}};
    topology.mass = {12, 11, 21, 22, 13, 31, 32};
    topology.residue = {"H2", "H1", "L1", "L2", "H3", "P1", "P2"};
    topology.members = {{"H", "L"}, {{0, 2, 0, 1, 2, -1}, {2, 2, 1, 0, 1, 1}, {4, 1, 0, 2, 3, 1}}};
    return topology;
}

TEST(MemberOrder, FollowsTheResiduesOfEachMember) {
    MemberOrder const order = by_members(complex());
    EXPECT_EQ(order.site, (std::vector<std::size_t>{1, 0, 4, 2, 3, 5, 6}));
    EXPECT_EQ(order.topology.residue,
              (std::vector<std::string>{"H1", "H2", "H3", "L1", "L2", "P1", "P2"}));
    EXPECT_EQ(order.topology.mass, (std::vector<double>{11, 12, 13, 21, 22, 31, 32}));
    std::vector<std::string> chains;
    for (Topology::Chain const& chain : order.topology.chains)
        chains.push_back(chain.name + " " + std::to_string(chain.first) + " " +
                         std::to_string(chain.count));
    EXPECT_EQ(chains, (std::vector<std::string>{"H+L:H 0 3", "H+L:L 3 2", "p 5 2"}));
    EXPECT_TRUE(is_complex(complex(), 0));
    EXPECT_FALSE(is_complex(complex(), 1));
    EXPECT_FALSE(is_complex(order.topology, 0));
}

TEST(MemberOrder, ComesBackFromListsOfSites) {
    Topology const topology = complex();
    SiteNames const names(topology);
    auto const members =
        members_of_sites(topology, {names.identifier(0), names.identifier(1), names.identifier(2)},
                         {0, 0, 1, 1, 0, 2, 2}, {1, 0, 0, 1, 2, 0, 1}, {2, 1, 1, 2, 3, 1, 2});
    ASSERT_TRUE(members);
    EXPECT_EQ(members->identifiers, (std::vector<std::string>{"H", "L", "A"}));
    Topology again = topology;
    again.members = *members;
    EXPECT_EQ(by_members(again).site, by_members(topology).site);
    EXPECT_EQ(SiteNames(again).bonds(), names.bonds());
}

TEST(MemberOrder, ListsThatDoNotFitAreNoMembers) {
    Topology const topology = complex();
    std::vector<std::string> const names{"H", "L", "A"};
    Numbers const member{0, 0, 1, 1, 0, 2, 2}, place{1, 0, 0, 1, 2, 0, 1},
        number{2, 1, 1, 2, 3, 1, 2};
    auto const with = [](Numbers list, std::size_t k, std::int64_t value) {
        list[k] = value;
        return list;
    };
    ASSERT_TRUE(members_of_sites(topology, names, member, place, number));
    for (Numbers const& wrong : {Numbers{0, 0}, with(member, 3, 3), with(member, 3, -1),
                                 with(member, 5, 0), with(member, 3, 0)})
        EXPECT_FALSE(members_of_sites(topology, names, wrong, place, number));
    for (std::int64_t const wrong : {std::int64_t{-1}, std::int64_t{0}, INT64_MAX})
        EXPECT_FALSE(members_of_sites(topology, names, member, with(place, 3, wrong), number));
    for (std::int64_t const wrong : {INT64_MAX, INT64_MIN})
        EXPECT_FALSE(members_of_sites(topology, names, member, place, with(number, 3, wrong)));
}

}  // namespace
}  // namespace catena::test
