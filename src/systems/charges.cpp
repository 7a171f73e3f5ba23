// Implements the text on net charges.
#include "systems/charges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/node.hpp"

namespace catena {

namespace {

double constexpr same_charge = 5e-4;  // e; three decimals are printed
/// Largest number of groups of chains in the text.
std::size_t constexpr most_groups = 12;

/// Prints three decimals, without "-0.000".
std::string charge_in_e(double charge) {
    return fmt::format("{:.3f} e", std::abs(charge) < same_charge ? 0.0 : charge);
}

/// Consecutive chains of the same charge.
struct Group {
    /// Indices of the first and the last chain.
    std::size_t first, last;
    double charge;
};

}  // namespace

std::string charge_text(std::span<double const> of_bead, BeadSystem const& beads) {
    std::vector<Group> groups;
    double sum = 0;
    for (std::size_t c = 0; c < beads.chain_name.size(); ++c) {
        double charge = 0;
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k)
            charge += of_bead[static_cast<std::size_t>(k)];
        sum += charge;
        if (groups.empty() || std::abs(groups.back().charge - charge) >= same_charge)
            groups.push_back({c, c, charge});
        else
            groups.back().last = c;
    }
    std::string text = "net charge:";
    for (std::size_t i = 0; i < std::min(groups.size(), most_groups); ++i) {
        Group const& g = groups[i];
        text += i == 0 ? " " : ", ";
        text += scene::shown(beads.chain_name[g.first]);
        if (g.last > g.first)
            text +=
                (g.last == g.first + 1 ? " and " : " to ") + scene::shown(beads.chain_name[g.last]);
        text += " " + charge_in_e(g.charge) + (g.last > g.first ? " each" : "");
    }
    if (groups.size() > most_groups) text += ", ...";
    return beads.chain_name.size() == 1 ? text : text + "; together " + charge_in_e(sum);
}

}  // namespace catena
