// Energies of rigid domains and complexes: all pairs but those within a body and along links.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "integrate/chain_system.hpp"
#include "integrate/scene_beads.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/domains/helix.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/pair_sum.hpp"
#include "tests/systems/energies.hpp"

namespace catena::testing {
namespace {

/// Two chains of charged and other residues, 0.9 nm apart.
std::string structure() {
    using test::operator+;
    std::vector<test::AtomLine> atoms = test::helix(16, "A") + test::helix(12, "B", 1, 9);
    char const* const names[] = {"LYS", "ALA", "GLU", "TYR", "ARG", "GLY", "ASP"};
    for (std::size_t k = 0; k < atoms.size(); ++k) atoms[k].residue = names[k % 7];
    return scratch_file("complex.pdb", test::pdb_text(atoms));
}

Scene scene_of(std::string const& more) {
    return parse_scene(
        fmt::format(
            "chains: [{{pdb: {}, chain: all, model: calvados2, links: as_given{}}}]\n"
            "forces: {{openmm: {{builder: calvados2, platform: Reference, path: inline}}}}\n",
            structure(), more),
        "complex.yaml");
}

/// Sums over the pairs of the free chains, without those within `bodies` (beads of A, then of B).
PairEnergies expected(std::vector<std::vector<std::int64_t>> const& bodies) {
    Scene const scene = scene_of("");
    BeadSystem beads = bead_system_of(scene);
    for (auto const& body : bodies)
        for (std::size_t i = 0; i < body.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) beads.links.push_back({body[j], body[i], 0});
    return pair_sum(beads, *scene.forces.openmm, bead_positions_of(scene));
}

void expect_energies(std::string const& rigid,
                     std::vector<std::vector<std::int64_t>> const& bodies) {
    auto const found = energies_of(scene_of(", rigid: " + rigid));
    PairEnergies const sums = expected(bodies), all = expected({});
    EXPECT_NEAR(found.at("ashbaugh-hatch"), sums.ashbaugh_hatch,
                1e-9 * std::abs(sums.ashbaugh_hatch));
    EXPECT_NEAR(found.at("yukawa"), sums.yukawa, 1e-9 * std::abs(sums.yukawa));
    EXPECT_GT(std::abs(all.ashbaugh_hatch - sums.ashbaugh_hatch), 0.1);
    EXPECT_GT(std::abs(all.yukawa - sums.yukawa), 0.1);
}

std::vector<std::int64_t> beads(std::int64_t first, std::int64_t last) {
    std::vector<std::int64_t> all;
    for (std::int64_t k = first; k <= last; ++k) all.push_back(k);
    return all;
}

TEST(RigidEnergies, LeaveOutPairsWithinADomain) {
    expect_energies("[\"A:3-9\", \"B:2-8\"]", {beads(2, 8), beads(17, 23)});
}

TEST(RigidEnergies, LeaveOutPairsWithinAComplexAndKeepAllTermini) {
    std::vector<std::int64_t> body = beads(4, 15);
    for (std::int64_t const k : beads(16, 22)) body.push_back(k);
    expect_energies("[[\"A:5-16\", \"B:1-7\"]]", {body});
}

/// The path runs backwards along B: A 1-16, B 4-12, B 3-1.
TEST(RigidEnergies, OfAComplexDoNotDependOnTheOrderOfItsBeads) {
    std::vector<std::int64_t> body = beads(4, 15);
    for (std::int64_t const k : beads(19, 27)) body.push_back(k);
    expect_energies("[[\"A:5-16\", \"B:4-12\"]]", {body});
}

}  // namespace
}  // namespace catena::testing
