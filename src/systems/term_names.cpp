// Implements the names of a System's terms.
#include <algorithm>
#include <string_view>

#include "scene/node.hpp"
#include "systems/model.hpp"
#include "terms/force_terms.hpp"

namespace catena {

namespace {

/// Returns the name in printable ASCII. Characters with a meaning in tables, pages and terminals
/// become `_`.
std::string harmless(std::string const& name) {
    std::string text = scene::shown(name);
    for (char& c : text)
        if (c < ' ' || c > '~' ||
            std::string_view(",;\"'`<>&\\|").find(c) != std::string_view::npos)
            c = '_';
    auto const first = text.find_first_not_of(' ');
    return first == std::string::npos ? ""
                                      : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// True if the text contains the part.
bool has(std::string const& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

/// True if the expression contains exp(-kappa*r)/r, for any spelling of kappa.
bool is_screened(std::string const& energy) {
    for (auto at = energy.find("exp(-"); at != std::string::npos;
         at = energy.find("exp(-", at + 1)) {
        auto const end = energy.find(')', at);
        std::string const exponent =
            end == std::string::npos ? "" : energy.substr(at + 5, end - at - 5);
        bool const distance = exponent == "r" || exponent.starts_with("r/") ||
                              exponent.starts_with("r*") || exponent.ends_with("*r");
        if (distance && energy.compare(end + 1, 2, "/r") == 0) return true;
    }
    return false;
}

/// True for a Lennard-Jones potential that is split at its minimum and scaled by a stickiness
/// beyond it.
bool is_ashbaugh_hatch(std::string const& energy) {
    return has(energy, "2^(1/6)*") && has(energy, "^12") && has(energy, "^6") &&
           has(energy, "step(") && has(energy, "(1-l");
}

}  // namespace

std::string shown_name(OpenMM::Force const& force) {
    std::string const kind = kind_of(force), given = harmless(force.getName());
    if (!given.empty() && given != kind) return given;
    auto const* pairs = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force);
    if (pairs == nullptr) return kind;
    std::string energy = pairs->getEnergyFunction();
    std::erase_if(energy, [](unsigned char c) { return c <= ' '; });
    if (is_ashbaugh_hatch(energy)) return "ashbaugh-hatch";
    return is_screened(energy) ? "yukawa" : kind;
}

std::vector<std::string> term_names(OpenMM::System const& system, std::vector<int> const& forces) {
    std::vector<std::string> names;
    std::vector<std::string> taken = terms::names_of_energies();  // columns of the run itself
    taken.insert(taken.end(), {"potential", "kinetic", "total"});
    for (int const i : forces) {
        std::string const name = shown_name(system.getForce(i));
        std::string unique = name;
        for (int n = 2; std::find(taken.begin(), taken.end(), unique) != taken.end(); ++n)
            unique = name + ' ' + std::to_string(n);
        taken.push_back(unique);
        names.push_back(unique);
    }
    return names;
}

}  // namespace catena
