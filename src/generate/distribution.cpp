// Implements the drawing and reading of distributions; normal numbers by the Box-Muller method.
#include "generate/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "keys/maps.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

double Distribution::draw(Draws& draws) const {
    switch (kind_) {
        case Kind::fixed:
            break;
        case Kind::uniform:
            return draws.between(values_[0], values_[1]);
        case Kind::log_uniform:
            return std::exp2(draws.between(std::log2(values_[0]), std::log2(values_[1])));
        case Kind::normal:
            for (;;) {
                double const radius = std::sqrt(-2 * std::log(draws.uniform())),
                             angle = 2 * Draws::pi * draws.uniform();
                double const value = values_[0] + values_[1] * radius * std::cos(angle);
                if (value > 0) return value;
            }
        case Kind::choice: {
            auto const index =
                static_cast<std::size_t>(draws.uniform() * static_cast<double>(values_.size()));
            return values_[std::min(index, values_.size() - 1)];
        }
    }
    return values_[0];
}

Distribution read_distribution(Node const& node) {
    if (node.kind != Node::Kind::map) return positive(node);
    Fields const kinds(node, keys::distribution);
    if (node.items.size() != 1)
        fail(node, fmt::format("the distribution has {} kinds", node.items.size()),
             "give a number or one of `uniform`, `log_uniform`, `normal`, `choice`");
    Node const& values = *kinds.find(node.items[0].key);
    if (values.key == "choice") {
        std::vector<double> all;
        for (Node const& value : list(values).items) all.push_back(positive(value));
        if (all.empty()) fail(values, "the list of choices is empty", "give at least one number");
        return {Distribution::Kind::choice, all};
    }
    std::vector<double> const two = numbers(values, 2);
    if (values.key == "normal") {
        if (!(two[0] > 0 && two[1] >= 0))
            fail(values,
                 fmt::format("a normal distribution with mean {} and standard deviation {}", two[0],
                             two[1]),
                 "give a mean above 0 and a standard deviation of 0 or more: values are redrawn "
                 "until they are above 0");
        return {Distribution::Kind::normal, two};
    }
    if (!(two[0] > 0 && two[1] >= two[0]))
        fail(values,
             fmt::format("the bounds {} and {} are not positive and ascending", two[0], two[1]),
             "give [least, most] above 0");
    return {values.key == "uniform" ? Distribution::Kind::uniform : Distribution::Kind::log_uniform,
            two};
}

}  // namespace catena::scene
