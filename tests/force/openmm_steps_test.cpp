// Hundreds of evaluations with lists that are made anew now and then: forces are those of the
// replicated System, no pair is missed, and they do not remember when the lists were made.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

/// Sums of the same doubles in another order: relative to the largest force.
double constexpr same = 1e-12;
int constexpr steps = 200, compared_every = 10;

/// The chain goes to and fro along x, so that beads far apart along it, which other ranks own, lie
/// side by side.
std::vector<Vec3> folded(BeadSystem const& beads, std::uint64_t seed) {
    std::int64_t constexpr leg = 34;
    std::vector<Vec3> positions;
    for (std::int64_t k = 0; k < beads.size(); ++k) {
        std::int64_t const row = k / leg, along = row % 2 == 0 ? k % leg : leg - 1 - k % leg;
        positions.push_back({{0.9 * static_cast<double>(along), 0.8 * static_cast<double>(row % 4),
                              0.8 * static_cast<double>(row / 4)}});
    }
    shake(positions, 0.05, seed);
    return positions;
}

/// Beads swing about where they started, each at its own pace, and the chains drift apart and
/// together: ghosts come and go.
std::vector<Vec3> moved(std::vector<Vec3> const& start, BeadSystem const& beads, int step) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> pace(0.01, 0.03), phase(0, 6.28);
    std::vector<Vec3> positions = start;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c)
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k) {
            for (double& x : positions[k].data)
                x += 0.12 * std::sin(pace(random) * step + phase(random));
            positions[k][0] += static_cast<double>(c) * std::sin(0.01 * step);
        }
    return positions;
}

void walk(OpenMmSpec const& spec, BeadSystem const& all_beads) {
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        std::int64_t const first = beads.first_of_rank[communicator.rank()];
        OpenMmSpec audited = spec, replicated = spec;
        audited.audit = true;
        replicated.replicate = true;
        auto const force = make_openmm_force(audited, beads, communicator);
        auto const oracle = make_openmm_force(replicated, beads, communicator);
        std::vector<Vec3> const start = folded(beads, 3);
        std::vector<Vec3> last;
        for (int step = 0; step <= steps; ++step) {
            std::vector<Vec3> const positions = moved(start, beads, step);
            last = evaluate(*force, beads, communicator.rank(), positions);
            if (step % compared_every != 0) continue;
            auto const expected = evaluate(*oracle, beads, communicator.rank(), positions);
            EXPECT_LE(difference(last, expected), same * communicator.max(largest(expected)))
                << "step " << step << " on " << communicator.size() << " ranks, " << first;
        }
        // What begins here, as after a restart, goes on with the same bits.
        auto const fresh = make_openmm_force(spec, beads, communicator);
        auto const again = evaluate(*fresh, beads, communicator.rank(), moved(start, beads, steps));
        EXPECT_EQ(difference(last, again), 0) << communicator.size() << " ranks";

        if (communicator.size() == 1) return;
        GhostTraffic const traffic = force->traffic();
        EXPECT_GT(traffic.rebuilds, 3);
        EXPECT_LT(traffic.rebuilds, steps / 4);
        EXPECT_EQ(traffic.updates, steps + 1);
        if (communicator.size() < 4) return;  // with few ranks every bead is near each rank's
        EXPECT_EQ(communicator.max(traffic.ghosts < beads.size() - std::ssize(last) ? 1 : 0), 1);
    });
}

BeadSystem three_chains(std::optional<Vec3> const& box = std::nullopt) {
    return proteins({random_sequence(60, 1), random_sequence(25, 2), random_sequence(15, 3)}, 1,
                    box);
}

TEST(Steps, FoldedChains) { walk(on_reference(), three_chains()); }
TEST(Steps, FoldedChainsInABox) { walk(on_reference(), three_chains(Vec3{{36, 8.2, 8.2}})); }
TEST(Steps, OneFoldedChain) { walk(on_reference(), proteins({random_sequence(100, 4)})); }

TEST(Steps, EveryForce) {
    BeadSystem const beads = proteins({random_sequence(40, 5), random_sequence(20, 6)});
    OpenMmSpec spec = on_reference("");
    spec.system = scratch_file("steps.xml", xml_of(*every_force(beads)));
    walk(spec, beads);
}

TEST(Steps, EveryForceInABoxOnAWorkerThread) {
    BeadSystem const beads =
        proteins({random_sequence(40, 7), random_sequence(20, 8)}, 1, Vec3{{34, 6, 6}});
    OpenMmSpec spec = on_reference("");
    spec.system = scratch_file("steps-box.xml", xml_of(*every_force(beads)));
    spec.path = "host";
    walk(spec, beads);
}

/// Pair forces whose particles can be exchanged, unlike those of interaction groups: few Contexts
/// for many lists.
TEST(Steps, ContextsLastLongerThanLists) {
    BeadSystem const all_beads = three_chains(Vec3{{30, 9, 9}});
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        auto const force = make_openmm_force(on_reference(), beads, communicator);
        std::vector<Vec3> const start = folded(beads, 3);
        for (int step = 0; step < 100; ++step) {
            if (step % 2 == 0) force->renew_ghosts();
            evaluate(*force, beads, communicator.rank(), moved(start, beads, step));
        }
        if (communicator.size() == 1) return;
        EXPECT_GE(force->traffic().rebuilds, 50);
        EXPECT_LE(force->contexts(), 8);
    });
}

}  // namespace
}  // namespace catena::testing
