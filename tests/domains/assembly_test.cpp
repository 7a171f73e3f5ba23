// Serial chains of residues and rigid bodies: their order, and what no serial chain can hold.
#include "domains/assembly.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "error.hpp"

namespace catena::test {
namespace {

using scene::Assembly;
using scene::Domain;
using scene::RigidSet;
using Places = std::vector<std::size_t>;

/// Chain A of ten residues, B of eight, C of five.
scene::ResidueNumbers three_chains() {
    scene::ResidueNumbers numbers;
    for (auto const& [chain, residues] : {std::pair{"A", 10}, {"B", 8}, {"C", 5}}) {
        numbers.begins.push_back(numbers.residues);
        for (int k = 1; k <= residues; ++k, ++numbers.residues) {
            numbers.labels.push_back(std::to_string(k));
            numbers.chains.push_back({chain, chain});
        }
    }
    return numbers;
}

class Assemblies : public testing::Test {
  protected:
    /// A body of ranges [first, last] of residues, from 0.
    RigidSet body(std::vector<std::array<std::size_t, 2>> const& ranges) const {
        RigidSet set{{}, &at_};
        for (auto const& [first, last] : ranges)
            set.ranges.push_back({first, last, numbers_.span(first, last)});
        return set;
    }
    std::vector<Assembly> of(std::vector<RigidSet> const& sets) const {
        return scene::assemble(sets, numbers_);
    }
    std::string refusal(std::vector<RigidSet> const& sets) const {
        try {
            of(sets);
        } catch (InputError const& error) {
            return error.what();
        }
        return "accepted";
    }
    static Places counted(std::size_t first, std::size_t end) {
        Places all(end - first);
        std::iota(all.begin(), all.end(), first);
        return all;
    }

    scene::ResidueNumbers numbers_ = three_chains();
    scene::Node at_;
};

TEST_F(Assemblies, chains_without_shared_bodies_keep_their_order) {
    auto const all = of({body({{2, 5}}), body({{12, 15}}), body({{6, 8}})});
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].residues, counted(0, 10));
    EXPECT_EQ(all[1].residues, counted(10, 18));
    EXPECT_EQ(all[2].residues, counted(18, 23));
    ASSERT_EQ(all[0].rigid.size(), 2u);
    EXPECT_EQ(all[0].rigid[1].first, 6u);
    EXPECT_EQ(all[1].rigid[0].first, 2u);  // places of the chain itself
    EXPECT_EQ(all[1].rigid[0].last, 5u);
    EXPECT_TRUE(all[2].rigid.empty());
}

TEST_F(Assemblies, one_tail_of_either_chain_makes_a_path_in_the_order_of_the_file) {
    auto const all = of({body({{3, 9}, {10, 14}})});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].residues, counted(0, 18));
    EXPECT_EQ(all[0].chains, (Places{0, 1}));
    ASSERT_EQ(all[0].rigid.size(), 1u);
    EXPECT_EQ(all[0].rigid[0].first, 3u);
    EXPECT_EQ(all[0].rigid[0].last, 14u);
    EXPECT_EQ(all[0].rigid[0].name, "residues 4 to 10 of chain A and residues 1 to 5 of chain B");
    EXPECT_EQ(all[1].residues, counted(18, 23));
}

TEST_F(Assemblies, a_partner_without_tails_stands_between_the_ends_of_the_other) {
    auto const all = of({body({{3, 6}, {10, 17}})});
    Places expected = counted(0, 6);
    for (std::size_t k = 10; k < 18; ++k) expected.push_back(k);
    // The residue with the outboard link is the body's last.
    for (std::size_t k = 6; k < 10; ++k) expected.push_back(k);
    EXPECT_EQ(all[0].residues, expected);
    EXPECT_EQ(all[0].rigid[0].first, 3u);
    EXPECT_EQ(all[0].rigid[0].last, 14u);
}

TEST_F(Assemblies, two_tails_of_the_same_end_run_into_and_out_of_the_body) {
    auto const all = of({body({{3, 9}, {13, 17}})});
    Places expected = counted(0, 10);
    for (std::size_t const k : {14u, 15u, 16u, 17u, 13u, 12u, 11u, 10u}) expected.push_back(k);
    EXPECT_EQ(all[0].residues, expected);
    EXPECT_EQ(all[0].rigid[0].last, 14u);
}

TEST_F(Assemblies, bodies_joined_by_linkers_of_several_chains_make_a_path) {
    // Domain 1 of A, a linker, domain 2 of A with domain 1 of B, a linker, domain 2 of B with C.
    auto const all = of({body({{0, 2}}), body({{6, 9}, {10, 12}}), body({{15, 17}, {18, 22}})});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].residues, counted(0, 23));
    ASSERT_EQ(all[0].rigid.size(), 3u);
    EXPECT_EQ(all[0].rigid[2].first, 15u);
    EXPECT_EQ(all[0].rigid[2].last, 22u);
}

TEST_F(Assemblies, more_than_two_flexible_ends_are_refused_by_their_residues) {
    EXPECT_EQ(
        refusal({body({{3, 6}, {12, 17}})}),
        "3 flexible parts would hang on the rigid body of residues 4 to 7 of chain A and "
        "residues 3 to 8 of chain B, and a serial chain has two: residues 1 to 3 of chain A, "
        "residues 8 to 10 of chain A, residues 1 to 2 of chain B (): include flexible ends in "
        "the body's ranges until two are left, or give each chain bodies of its own");
}

TEST_F(Assemblies, a_loop_within_one_body_is_refused) {
    EXPECT_EQ(refusal({body({{0, 3}, {7, 9}})}),
              "residues 5 to 7 of chain A would be a flexible loop between two parts of one rigid "
              "body, which a serial chain cannot hold (): write \"A:1-10\" to make the loop rigid, "
              "too (with `domains` or `pae`: `longest_loop: 3`), or make two bodies of the parts: "
              "rigid: [\"A:1-4\", \"A:8-10\"]");
}

TEST_F(Assemblies, two_paths_between_bodies_are_refused) {
    std::string const closed = refusal({body({{0, 3}, {10, 12}}), body({{6, 9}, {15, 17}})});
    EXPECT_NE(closed.find("a closed loop, which a serial chain cannot hold"), std::string::npos)
        << closed;
    EXPECT_NE(closed.find("residues 1 to 4 of chain A and residues 1 to 3 of chain B"),
              std::string::npos)
        << closed;
    // The same through the bodies of one chain.
    EXPECT_NE(refusal({body({{0, 2}, {7, 9}}), body({{4, 5}})}).find("closed loop"),
              std::string::npos);
}

TEST_F(Assemblies, ends_at_one_residue_are_refused) {
    EXPECT_NE(refusal({body({{3, 3}, {10, 17}})}).find("both flexible ends of the rigid body"),
              std::string::npos);
}

}  // namespace
}  // namespace catena::test
