// Implements the table of atomic masses: the elements of proteins and their modifications.
#include "structure/atom_masses.hpp"

#include <array>
#include <cctype>
#include <string>
#include <utility>

namespace catena::scene {

namespace {

/// Standard atomic weights (IUPAC 2021, abridged).
constexpr std::array<std::pair<std::string_view, double>, 12> weights{{{"H", 1.008},
                                                                       {"D", 2.014},
                                                                       {"C", 12.011},
                                                                       {"N", 14.007},
                                                                       {"O", 15.999},
                                                                       {"F", 18.998},
                                                                       {"P", 30.974},
                                                                       {"S", 32.06},
                                                                       {"CL", 35.45},
                                                                       {"SE", 78.971},
                                                                       {"BR", 79.904},
                                                                       {"I", 126.90}}};

/// Element of an atom without an element column: the first letter of its name, or both letters of
/// selenium at the margin.
std::string element_by_name(PdbAtom const& atom) {
    std::size_t at = 0;
    while (at < atom.name.size() && std::isalpha(static_cast<unsigned char>(atom.name[at])) == 0)
        ++at;
    std::string_view const letters = atom.name.substr(at);
    bool const selenium = atom.at_margin && letters.starts_with("SE");
    return std::string(letters.substr(0, selenium ? 2 : 1));
}

}  // namespace

std::optional<double> atom_mass(PdbAtom const& atom) {
    std::string element = atom.element.empty() ? element_by_name(atom) : std::string(atom.element);
    for (char& c : element) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (auto const& [name, weight] : weights)
        if (name == element) return weight;
    return {};
}

}  // namespace catena::scene
