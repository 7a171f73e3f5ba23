// DCD files as other programs write them, made by plain bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"

namespace catena::test {

template <class Value>
void append_bytes(std::string& bytes, Value const& value) {
    bytes.append(reinterpret_cast<char const*>(&value), sizeof value);
}

inline std::string dcd_record(std::string const& content) {
    std::string bytes;
    auto const length = static_cast<std::int32_t>(content.size());
    append_bytes(bytes, length);
    bytes += content;
    append_bytes(bytes, length);
    return bytes;
}

/// Properties of a DCD file that its readers must respect.
struct DcdKind {
    std::string word = "CORD";
    std::int32_t fixed_atoms = 0;
    double angle = 90;  // of the cell
};

/// Frames of positions in nm, with a cell if there is a box.
inline std::string dcd_bytes(std::vector<std::vector<Vec3>> const& frames,
                             std::optional<Vec3> const& box, DcdKind const& kind = {}) {
    std::array<std::int32_t, 20> control{};
    control[0] = static_cast<std::int32_t>(frames.size());
    control[8] = kind.fixed_atoms, control[10] = box ? 1 : 0, control[19] = 24;
    std::string head = kind.word, titles, count;
    append_bytes(head, control);
    append_bytes(titles, std::int32_t{1});
    titles += std::string(80, ' ');
    append_bytes(count, static_cast<std::int32_t>(frames.front().size()));
    std::string bytes = dcd_record(head) + dcd_record(titles) + dcd_record(count);
    for (std::vector<Vec3> const& frame : frames) {
        std::string cell;
        if (box)
            for (double const value : {10 * (*box)[0], kind.angle, 10 * (*box)[1], kind.angle,
                                       kind.angle, 10 * (*box)[2]})
                append_bytes(cell, value);
        if (box) bytes += dcd_record(cell);
        for (int i = 0; i < 3; ++i) {
            std::string coordinates;
            for (Vec3 const& x : frame) append_bytes(coordinates, static_cast<float>(10 * x[i]));
            bytes += dcd_record(coordinates);
        }
    }
    return bytes;
}

}  // namespace catena::test
