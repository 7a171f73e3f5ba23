// Tables of bead destinations that the host computes for a GPU (neighbours/device_beads.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "neighbours/device_beads.hpp"

namespace catena {

/// Returns the entry of a bead at position x whose particle is at `place`. With `box`, it contains
/// the periodic cell of x.
inline DeviceBead bead_at(std::int32_t place, Vec3 const& x, std::optional<Vec3> const& box) {
    DeviceBead bead;
    bead.place = place;
    for (int c = 0; box && c < 3; ++c)
        bead.cell[c] = static_cast<std::int32_t>(std::floor(x[c] / (*box)[c]));
    return bead;
}

/// Tables ShownBeads::first and ShownBeads::place.
struct ShownTable {
    std::vector<std::int32_t> first, place;
};

/// Inverts `sent`, which maps each place to one of `beads` beads.
inline ShownTable shown_table(std::span<std::int64_t const> sent, std::size_t beads) {
    ShownTable table{std::vector<std::int32_t>(beads + 1, 0),
                     std::vector<std::int32_t>(sent.size())};
    for (std::int64_t const k : sent) ++table.first[static_cast<std::size_t>(k) + 1];
    for (std::size_t k = 0; k < beads; ++k) table.first[k + 1] += table.first[k];
    std::vector<std::int32_t> next(table.first.begin(), table.first.end() - 1);
    for (std::size_t i = 0; i < sent.size(); ++i)
        table.place[static_cast<std::size_t>(next[static_cast<std::size_t>(sent[i])]++)] =
            static_cast<std::int32_t>(i);
    return table;
}

}  // namespace catena
