// Implements the comparison of bonds and networks with the folder's other files. The package
// (version 0.8, calvados/components.py) takes the lengths of networks from structures, which
// top.pdb repeats, and writes restr_NAME.txt and bonds_NAME.txt if `verbose` is true.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "error.hpp"
#include "foreign/calvados_forces.hpp"
#include "io/output_file.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

/// Rounding of numbers that are listed with four decimals.
constexpr double most_listed_difference = 6e-5;

/// Bonds within each molecule, with particles counted from its first one, in ascending order.
std::vector<std::vector<BondText>> bonds_of_molecules(ForceText const& force, Molecules const& of) {
    auto const first = static_cast<std::int64_t>(of.first),
               beads = static_cast<std::int64_t>(of.beads);
    std::vector<std::vector<BondText>> bonds(of.count);
    for (BondText const& bond : force.bonds) {
        auto const [a, b] = std::minmax({bond.first - first, bond.second - first});
        if (a < 0 || beads == 0 || a / beads != b / beads || a / beads >= std::ssize(bonds))
            continue;
        bonds[static_cast<std::size_t>(a / beads)].push_back(
            {bond.length, bond.stiffness, a % beads, b % beads});
    }
    for (std::vector<BondText>& each : bonds)
        std::sort(each.begin(), each.end(), [](BondText const& one, BondText const& other) {
            return std::tie(one.first, one.second, one.length) <
                   std::tie(other.first, other.second, other.length);
        });
    return bonds;
}

bool are_alike(BondText const& a, BondText const& b) {
    return a.first == b.first && a.second == b.second && are_equal(a.length, b.length) &&
           are_equal(a.stiffness, b.stiffness);
}

/// "0.55 nm and 700 between beads 1 and 9".
std::string text_of(BondText const& bond) {
    return fmt::format("{:.6g} and {:.6g} between beads {} and {}", bond.length, bond.stiffness,
                       bond.first + 1, bond.second + 1);
}

/// Compares the bonds and networks of all components.
class NetworkCheck {
  public:
    NetworkCheck(MadeSystem const& made, std::string folder, bool may_be_another_start,
                 std::vector<std::string>& notes)
        : made_(made),
          folder_(std::move(folder)),
          may_be_another_start_(may_be_another_start),
          notes_(notes) {}

    /// `molecules` is nullptr if they are not known.
    void compare(ComponentForces const& of, Molecules const* molecules) const {
        std::vector<ForceText const*> all = of.networks;
        for (ForceText const* const force : {of.bonds, of.stacks}) all.push_back(force);
        for (ForceText const* const force : all) {
            if (force == nullptr) continue;
            note_without_box(*of.component, *force);
            if (molecules != nullptr) refuse_unlike_molecules(*of.component, *force, *molecules);
        }
        if (of.angles != nullptr) note_without_box(*of.component, *of.angles);
        if (of.bonds != nullptr)
            compare_listed(*of.component, *of.bonds, "bonds_" + of.component->name + ".txt", 1);
        if (!of.networks.empty() && of.networks[0] != nullptr) {
            compare_listed(*of.component, *of.networks[0], "restr_" + of.component->name + ".txt",
                           0);
            compare_distances(*of.component, *of.networks[0]);
        }
    }

  private:
    void note_without_box(CalvadosComponent const& component, ForceText const& force) const {
        if (force.periodic) return;
        notes_.push_back(fmt::format(
            "A {} of `{}` in {} does not use the box, where the package's does: it acts on "
            "coordinates as they are. The System is simulated as it is.",
            force.kind, scene::shown(component.name), made_.name()));
    }

    /// Throws InputError unless all molecules of a component have the bonds of the first.
    void refuse_unlike_molecules(CalvadosComponent const& component, ForceText const& force,
                                 Molecules const& of) const {
        auto const bonds = bonds_of_molecules(force, of);
        std::size_t all = 0;
        for (std::size_t m = 0; m < bonds.size(); ++m) {
            std::vector<BondText> const &first = bonds[0], &other = bonds[m];
            all += other.size();
            auto const [a, b] =
                std::mismatch(first.begin(), first.end(), other.begin(), other.end(), are_alike);
            if (a == first.end() && b == other.end()) continue;
            throw InputError(
                fmt::format("a {} of `{}` has {} in molecule 1, and {} in molecule {}", force.kind,
                            scene::shown(component.name), a == first.end() ? "none" : text_of(*a),
                            b == other.end() ? "none" : text_of(*b), m + 1),
                scene::shown_path(made_.text.file()), write_system_again);
        }
        if (all != force.bonds.size())
            throw InputError(fmt::format("a {} of `{}` joins particles of two molecules",
                                         force.kind, scene::shown(component.name)),
                             scene::shown_path(made_.text.file()), write_system_again);
    }

    /// Compares with the list that the package writes, if there is one. Its lines hold two
    /// particles from 1, `further` columns, length and stiffness.
    void compare_listed(CalvadosComponent const& component, ForceText const& force,
                        std::string const& name, int further) const {
        fs::path const file = fs::path(folder_) / name;
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) return;
        std::istringstream lines(read_text_file(file.string()));
        std::string line;
        std::getline(lines, line);
        std::istringstream names(line);
        std::string const form = further == 1 ? "b_idx" : "d[nm]";
        for (int column = 0; column < 3; ++column) names >> line;
        if (line != form) return;  // the columns of another version
        std::size_t next = 0;
        for (; std::getline(lines, line); ++next)
            if (next >= force.bonds.size() || !is_listed(force.bonds[next], line, further))
                refuse_list(component, force, file, fmt::format(", line {}", next + 2));
        if (next != force.bonds.size()) refuse_list(component, force, file, "");
    }
    /// True if a line lists the bond.
    static bool is_listed(BondText const& bond, std::string const& line, int further) {
        std::istringstream words(line);
        double a = 0, b = 0, skipped = 0, length = 0, stiffness = 0;
        words >> a >> b;
        if (further == 1) words >> skipped;
        words >> length >> stiffness;
        auto const alike = [](double made, double listed) {
            return std::abs(made - listed) <= most_listed_difference || are_equal(made, listed);
        };
        return words && a == static_cast<double>(bond.first + 1) &&
               b == static_cast<double>(bond.second + 1) && alike(bond.length, length) &&
               alike(bond.stiffness, stiffness);
    }
    [[noreturn]] void refuse_list(CalvadosComponent const& component, ForceText const& force,
                                  fs::path const& file, std::string const& line) const {
        throw InputError(
            fmt::format("the {} bonds of the {} of `{}` in {} are not those of the list",
                        force.bonds.size(), force.kind, scene::shown(component.name), made_.name()),
            scene::shown_path(file.string()) + line,
            std::string(write_system_again) + ", or move the list out of the folder");
    }

    /// Compares the lengths of a network with distances in top.pdb.
    void compare_distances(CalvadosComponent const& component, ForceText const& network) const {
        if (made_.first_start.empty() || component.periodic)
            return notes_.push_back(fmt::format(
                "Whether the network of `{}` has the lengths of its structure is not checked: {}.",
                scene::shown(component.name),
                component.periodic ? "they are those of nearest images (`periodic`)"
                                   : "there is no top.pdb of that System"));
        for (BondText const& bond : network.bonds) {
            auto const apart = made_.distance(bond.first, bond.second);
            if (!apart || std::abs(*apart - bond.length) <= most_pdb_difference) continue;
            std::string const what = fmt::format(
                "the network of `{}` in {} joins particles {} and {} (from 0) at {:.6g} nm, and in "
                "top.pdb they are {:.6g} nm apart",
                scene::shown(component.name), made_.name(), bond.first, bond.second, bond.length,
                *apart);
            if (may_be_another_start_)
                return notes_.push_back(what + ". The System is simulated as it is.");
            throw InputError(what, scene::shown_path(made_.text.file()), write_system_again);
        }
    }

    MadeSystem const& made_;
    std::string folder_;
    bool may_be_another_start_;
    std::vector<std::string>& notes_;
};

}  // namespace

std::vector<Molecules> molecules_of(CalvadosComponents const& components, MadeSystem const& made) {
    std::size_t const particles = made.text.particles();
    if (components.all.size() == 1) {
        auto const count = static_cast<std::size_t>(components.molecules());
        if (count == 0 || particles % count != 0) return {};
        return {{0, particles / count, count}};
    }
    std::vector<Molecules> found;
    std::size_t first = 0, chain = 0;
    if (components.of_chains(made.chains.size()).empty()) return {};
    for (CalvadosComponent const& component : components.all) {
        auto const count = static_cast<std::size_t>(component.molecules);
        Molecules of{first, count > 0 ? made.chains[chain].size() : 0, count};
        for (std::size_t m = 0; m < count; ++m, ++chain) {
            if (made.chains[chain].size() != of.beads) return {};
            first += of.beads;
        }
        found.push_back(of);
    }
    return first == particles ? found : std::vector<Molecules>();
}

void compare_networks(PackageFile const& config, CalvadosComponents const& components,
                      std::string const& folder, MadeSystem const& made,
                      std::vector<std::string>& notes) {
    std::vector<Molecules> const molecules = molecules_of(components, made);
    // A run that starts from a structure does not write top.pdb anew.
    NetworkCheck const check(made, folder, config.text("restart", "checkpoint") != "checkpoint",
                             notes);
    std::vector<ComponentForces> const forces = forces_of(components, made.text);
    for (std::size_t c = 0; c < forces.size(); ++c)
        check.compare(forces[c], molecules.empty() ? nullptr : &molecules[c]);
}

}  // namespace catena::foreign
