#include "command/generated.hpp"

#include <fmt/format.h>

namespace catena::command {

Scene random_scene(std::string const& joint, std::int64_t bodies, std::vector<std::string> const& overrides) {
    std::string const name = fmt::format("random-{}-{}", joint, bodies);
    std::string const text = fmt::format(
        "title: random chain, {0}, {1} bodies\n"
        "units: si\n"
        "chains: [{{name: random, base: {2}, generator: {{random: {{bodies: {1}, joint: {0}, seed: 1}}}}}}]\n"
        "forces: {{gravity: [0, 0, -9.81]}}\n",
        joint, bodies, joint == "link" ? "free" : "fixed");
    return parse_scene(text, name, overrides);
}

}  // namespace catena::command
