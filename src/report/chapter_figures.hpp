// Measurements and counts of the DCA chapter (tests/data/reference/chapter-figures.csv;
// Table 2.1).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace catena {

/// Hardware that the chapter measured on.
inline constexpr char const* chapter_hardware =
    "Xeon W3565 (4 cores), Quadro 600, double precision";
/// Names of the columns, in the order of the file; gpu1 computes the lowest level on the GPU.
inline std::vector<std::string> const chapter_columns{"serial", "openmp", "gpu1",
                                                      "gpu3",   "gpu6",   "gpu_all"};

/// Times in ms, in the order of the columns.
using ChapterRow = std::array<double, 6>;
/// Returns "full_step", "solve" and "transfer" (Figures 2.5 to 2.7), each by number of bodies.
std::map<std::string, std::map<std::int64_t, ChapterRow>> const& chapter_figures();

/// A row of Table 2.1 for 2048 bodies: the share of the lowest levels in all operations.
struct ChapterLevel {
    char const* level;
    /// Number of kernel operations.
    std::int64_t operations;
    int percent;
};
/// The rows of Table 2.1.
inline constexpr std::array<ChapterLevel, 4> chapter_levels{
    {{"Leaf", 1024, 50}, {"Leaf+1", 1536, 75}, {"Leaf+2", 1792, 88}, {"Leaf+3", 1920, 94}}};

}  // namespace catena
