// What the founding chapter measured and counted (tests/data/reference/chapter-figures.csv;
// Table 2.1).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace catena {

inline constexpr char const* chapter_hardware =
    "Xeon W3565 (4 cores), Quadro 600, double precision";
/// In the order of its columns; gpu1: the lowest level on the GPU.
inline std::vector<std::string> const chapter_columns{"serial", "openmp", "gpu1",
                                                      "gpu3",   "gpu6",   "gpu_all"};

/// Milliseconds, in the order of the columns.
using ChapterRow = std::array<double, 6>;
/// "full_step", "solve", "transfer" (Figures 2.5 to 2.7) by number of bodies.
std::map<std::string, std::map<std::int64_t, ChapterRow>> const& chapter_figures();

/// Table 2.1, 2048 bodies: what the lowest levels together do.
struct ChapterLevel {
    char const* level;
    std::int64_t operations;  // of kernels
    int percent;
};
inline constexpr std::array<ChapterLevel, 4> chapter_levels{
    {{"Leaf", 1024, 50}, {"Leaf+1", 1536, 75}, {"Leaf+2", 1792, 88}, {"Leaf+3", 1920, 94}}};

}  // namespace catena
