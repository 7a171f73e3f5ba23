// Implements the table of accelerations.
#include "command/acceleration_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "joints/joint_models.hpp"
#include "measure/accelerations_file.hpp"

namespace catena::command {
namespace {

constexpr std::int64_t most_rows = 6;
constexpr char const* way_to_all =
    "--accelerations FILE.csv (.h5, .json) writes them with the joint forces";

/// Unit of a body's numbers: angular for joints that turn, linear for those that slide and beads,
/// both for free and linked bodies.
std::string unit_of(Scene const& scene, ChainSpec const& chain, std::size_t k, std::size_t count) {
    std::string const per = scene.si ? "/s^2" : "/ps^2", length = scene.si ? "m" : "nm";
    if (count == 0) return "";
    if (count == 6) return "rad" + per + ", " + length + per;
    auto const unit = [&](bool linear) { return (linear ? length : "rad") + per; };
    if (chain.is_beads() || chain.is_linked()) return unit(true);
    JointType const joint = chain.bodies.joint[k];
    if (!mixes_units(joint)) return unit(is_length(joint, 0));
    std::string units;
    for (std::size_t i = 0; i < count; ++i)
        units += (i > 0 ? ", " : "") + unit(is_length(joint, static_cast<int>(i)));
    return units;
}

std::string numbers_text(double const* numbers, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += fmt::format("{}{:.6g}", i == 0 ? "" : (i == 3 ? "; " : ", "), numbers[i]);
    return text.empty() ? "none" : text;
}

}  // namespace

void add_accelerations(Text& text, Scene const& scene, Solution const& s) {
    if (s.acceleration_offset.empty())
        return text.entry("accelerations",
                          fmt::format("of {} bodies; {}", scene.bodies(), way_to_all));
    text.entry("accelerations", "of joints, beads and bodies on links");
    Table table({"chain", "body", "joint", "acceleration", "unit"}, {0, 2, 3, 4});
    std::int64_t body = 0;
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size() && body < most_rows; ++k, ++body) {
            auto const b = static_cast<std::size_t>(body);
            std::int64_t const first = s.acceleration_offset[b];
            auto const count = static_cast<std::size_t>(s.acceleration_offset[b + 1] - first);
            table.add({chain.name, std::to_string(k + 1), joint_name(chain, k),
                       numbers_text(s.acceleration.data() + first, count),
                       unit_of(scene, chain, k, count)});
        }
    text.add(table);
    if (scene.bodies() > body)
        text.note(fmt::format("and {}; {}",
                              counted(scene.bodies() - body, "other body", "other bodies"),
                              way_to_all));
}

}  // namespace catena::command
