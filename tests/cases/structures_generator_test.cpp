// Structures made at random, with random damage: each opens as exactly the chain that is meant, or
// is refused.
#include "tests/cases/structures_generator.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "reader/load_scene.hpp"
#include "tests/cases/opened.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

Opened open(Structure const& structure) {
    TemporaryFolder const folder;
    std::ofstream(folder / "a.pdb", std::ios::binary) << text_of(structure);
    return open_scene("chains: [{name: p, pdb: a.pdb, model: calvados2}]" + structure.box,
                      folder / "s.yaml");
}

/// Links are fitted to 0.38 nm, which moves beads a little, and the chain as a whole may stand in
/// another image.
void expect_right(BeadArrays const& beads, Structure const& truth, double away) {
    EXPECT_EQ(beads.residue, truth.names);
    ASSERT_EQ(beads.size(), truth.positions.size());
    Vec3 const by = truth.positions[0] - beads.position[0];
    for (std::size_t k = 0; k < beads.size(); ++k)
        EXPECT_LT(norm(beads.position[k] + by - truth.positions[k]), away) << k;
}

void expect_outcome(Structure const& structure, Must must, double away = 0.08) {
    Opened const opened = open(structure);
    if (must == Must::be_refused) {
        EXPECT_TRUE(opened.refused) << text_of(structure);
        return;
    }
    ASSERT_FALSE(opened.refused) << opened.message << "\n" << text_of(structure);
    expect_right(opened.scene.chains.at(0).beads, structure, away);
    if (must == Must::open_somehow) return;
    EXPECT_EQ(!opened.scene.notes.empty(), must == Must::open_with_note)
        << testing::PrintToString(opened.scene.notes);
}

TEST(StructuresAtRandom, EachDamageAlone) {
    for (unsigned seed = 0; seed < 8; ++seed)
        for (Damage const& damage : damages) {
            SCOPED_TRACE(std::string(damage.name) + ", seed " + std::to_string(seed));
            Generator generator(seed);
            Structure structure = generator.structure();
            damage.apply(structure, generator);
            expect_outcome(structure, damage.must);
        }
}

/// Two of them: what must be refused stays so, whatever else happens to the file.
TEST(StructuresAtRandom, DamagesInPairs) {
    for (unsigned seed = 100; seed < 300; ++seed) {
        Generator generator(seed);
        Structure structure = generator.structure();
        std::size_t const first = generator.index(0, damages.size()),
                          second = generator.index(0, damages.size());
        Damage const& a = damages[std::min(first, second)];
        Damage const& b = damages[std::max(first, second)];
        if (first == second || a.must == Must::be_refused) continue;  // one may undo the other
        SCOPED_TRACE(std::string(a.name) + " and " + b.name + ", seed " + std::to_string(seed));
        a.apply(structure, generator);
        b.apply(structure, generator);
        bool const note = a.must == Must::open_with_note || b.must == Must::open_with_note;
        bool const refused = a.must == Must::be_refused || b.must == Must::be_refused;
        bool const either = a.must == Must::open_somehow || b.must == Must::open_somehow;
        expect_outcome(structure, refused  ? Must::be_refused
                                  : note   ? Must::open_with_note
                                  : either ? Must::open_somehow
                                           : Must::open);
    }
}

TEST(StructuresAtRandom, AFileThatIsCutOrShiftedIsRefused) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        TemporaryFolder const folder;
        Generator generator(seed);
        std::string text = text_of(generator.structure());
        std::size_t const line = 79 * generator.index(0, text.size() / 79 - 2),
                          column = generator.index(20, 50);
        if (generator.coin()) {
            text.resize(line + column);
        } else {
            text.insert(line + column, 1, ' ');
        }
        std::ofstream(folder / "a.pdb") << text;
        try {
            Scene const scene =
                parse_scene("chains: [{pdb: a.pdb, model: calvados2}]", folder / "s.yaml");
            Generator again(seed);
            expect_right(scene.chains[0].beads, again.structure(), 0.08);
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find("a.pdb"), std::string::npos) << error.what();
        }
    }
}

TEST(StructuresAtRandom, WrappedChainsAreMadeWholeInTheirBox) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        Generator generator(seed);
        Structure structure = generator.structure();
        wrap(structure, generator);
        structure.box = "\nbox: {periodic: [5.2, 5.2, 5.2]}";
        expect_outcome(structure, is_wrapped(structure) ? Must::open_with_note : Must::open);
    }
}

/// However large the noise: what opens has its beads where the file has them, as nearly as links of
/// 0.38 nm allow.
TEST(StructuresAtRandom, NoiseIsFollowedOrRefused) {
    int opened = 0, refused = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(seed);
        Generator generator(seed);
        Structure structure = generator.structure();
        add_noise(structure, generator, 0.002 * (seed % 20));
        Opened const outcome = open(structure);
        ++(outcome.refused ? refused : opened);
        if (!outcome.refused) expect_right(outcome.scene.chains.at(0).beads, structure, 0.12);
    }
    EXPECT_GT(opened, 10);
    EXPECT_GT(refused, 10);
}

/// Wrapped into a box that the scene does not have, the chain has gaps.
TEST(StructuresAtRandom, WrappedChainsAreRefusedWithoutTheirBox) {
    int wrapped = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        Generator generator(seed);
        Structure structure = generator.structure();
        wrap(structure, generator);
        if (!is_wrapped(structure)) continue;
        ++wrapped;
        expect_outcome(structure, Must::be_refused);
    }
    EXPECT_GT(wrapped, 0);
}

}  // namespace
}  // namespace catena::test
