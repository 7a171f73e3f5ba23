// The compression of XTC files against a decoder of its own.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/analysis/sample_trajectory.hpp"
#include "tests/analysis/xtc_decoder.hpp"

namespace catena::test {
namespace {

using analysis::pack_positions;

void expect_same(std::vector<Lattice> const& positions, std::string const& what) {
    PackedPositions const packed = pack_positions(positions);
    EXPECT_EQ(XtcDecoder(packed).decode(positions.size()), positions) << what;
}

std::vector<Lattice> chain_of(std::size_t sites, double bond, std::uint64_t seed) {
    RandomChains draw(seed);
    std::vector<Lattice> positions;
    for (Vec3 const& x : draw.chain(sites, bond, 0.3))
        positions.push_back({static_cast<std::int32_t>(1000 * x[0]),
                             static_cast<std::int32_t>(1000 * x[1]),
                             static_cast<std::int32_t>(1000 * x[2])});
    return positions;
}

TEST(XtcCoding, ChainsComeBackBitForBit) {
    for (std::size_t const sites : {10, 11, 33, 140, 1000})
        for (double const bond : {0.002, 0.05, 0.38, 3.0, 200.0})
            expect_same(chain_of(sites, bond, sites),
                        std::to_string(sites) + " sites, bond " + std::to_string(bond));
}

TEST(XtcCoding, PlacesWithoutOrderComeBackBitForBit) {
    RandomChains draw(3);
    for (double const edge : {1.0, 7.0, 300.0, 1e4, 1.6e7, 1.7e7, 2.1e9}) {
        std::vector<Lattice> positions(200);
        for (Lattice& x : positions)
            for (std::int32_t& value : x)
                value = static_cast<std::int32_t>(edge * (draw.uniform() - 0.5));
        expect_same(positions, "edge " + std::to_string(edge));
    }
}

TEST(XtcCoding, EqualPlacesAndSingleJumpsComeBackBitForBit) {
    expect_same(std::vector<Lattice>(50, Lattice{5, -7, 0}), "one place");
    std::vector<Lattice> jumps;
    for (std::int32_t k = 0; k < 60; ++k) jumps.push_back({k % 7 == 0 ? 16000000 : 0, k, -k});
    expect_same(jumps, "jumps");
    std::vector<Lattice> pairs;
    for (std::int32_t k = 0; k < 61; ++k) pairs.push_back({1000 * (k / 2), k % 2, 0});
    expect_same(pairs, "pairs");
}

TEST(XtcCoding, ChainsTakeLessThanFiveBytesASite) {
    std::vector<Lattice> const positions = chain_of(10000, 0.38, 8);
    EXPECT_LT(pack_positions(positions).bits.size(), 5 * positions.size());
}

}  // namespace
}  // namespace catena::test
