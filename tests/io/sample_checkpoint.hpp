// A checkpoint of awkward numbers, and what tests do with its file.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "error.hpp"
#include "io/output.hpp"
#include "temporary_folder.hpp"

namespace catena::test {

inline Checkpoint sample(std::int64_t step = 123456789012) {
    Checkpoint checkpoint;
    checkpoint.step = step;
    checkpoint.time = 0.1 + 0.2;
    checkpoint.scene_hash = "9f86d081884c7d65";
    checkpoint.notes = {{"backend", "segments"}, {"empty", ""}, {"version", "0.1.0, größer"}};
    checkpoint.integers = {{"sweeps", 6}, {"negative", std::numeric_limits<std::int64_t>::min()}};
    double const odd_nan = std::bit_cast<double>(0x7ff80000deadbeefULL);
    checkpoint.arrays = {{"positions", {0.1, -0.0, 1e-320, odd_nan, 1e308}},
                         {"nothing", {}},
                         {"velocities", std::vector<double>(300, 1 / 3.0)}};
    return checkpoint;
}

inline void expect_same(Checkpoint const& a, Checkpoint const& b) {
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.time), std::bit_cast<std::uint64_t>(b.time));
    EXPECT_EQ(a.scene_hash, b.scene_hash);
    EXPECT_EQ(a.notes, b.notes);
    EXPECT_EQ(a.integers, b.integers);
    ASSERT_EQ(a.arrays.size(), b.arrays.size());
    for (auto const& [key, values] : a.arrays) {
        ASSERT_TRUE(b.arrays.contains(key)) << key;
        auto const& others = b.arrays.at(key);
        ASSERT_EQ(values.size(), others.size()) << key;
        EXPECT_TRUE(values.empty() ||
                    std::memcmp(values.data(), others.data(), values.size() * sizeof(double)) == 0)
            << key;
    }
}

inline std::string bytes_of(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put_bytes(std::string const& file, std::string const& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

inline std::string refusal(std::string const& file) {
    try {
        read_checkpoint(file);
    } catch (InputError const& error) {
        return error.what();
    }
    return "read without complaint";
}

}  // namespace catena::test
