// Implements the comparison of external forces. The package (version 1.0, init_slab_restraints of
// calvados/interactions.py) pulls towards the middle of the box along the axes of `slab_eq_axis`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "error.hpp"
#include "foreign/calvados_forces.hpp"
#include "scene/fields.hpp"

namespace catena::foreign {

namespace {

using scene::Node;
using Axes = std::array<bool, 3>;

constexpr char const* pull_force = "CustomExternalForce";
constexpr double most_middle_difference = 1e-6;  // nm, or relative
constexpr char const* axis_letters = "xyz";

std::string without_spaces(std::string text) {
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '\t'; });
    return text;
}

/// Name of the parameter that holds the middle along an axis: "z0".
std::string middle_of(std::size_t axis) { return {axis_letters[axis], '0'}; }

/// Expression of the pull along these axes.
std::string slab_expression(Axes const& axes) {
    std::string text = "k*abs(periodicdistance(x,y,z";
    for (std::size_t a = 0; a < 3; ++a)
        text += ',' + (axes[a] ? middle_of(a) : std::string(1, axis_letters[a]));
    return text + "))";
}

/// Names of axes: "x and y"; "no axis" without one.
std::string names_of(Axes const& axes) {
    std::string names;
    for (std::size_t a = 0; a < 3; ++a)
        if (axes[a]) names += (names.empty() ? "" : " and ") + std::string(1, axis_letters[a]);
    return names.empty() ? "no axis" : names;
}

/// Axes of a System's pull; nothing for another force.
std::optional<Axes> axes_of(ForceText const& force) {
    std::string const energy = without_spaces(force.energy);
    for (unsigned bits = 0; bits < 8; ++bits) {
        Axes const axes{(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0};
        if (energy == slab_expression(axes)) return axes;
    }
    return std::nullopt;
}

/// Reads `slab_eq_axis`, by default z.
Axes asked_axes(Node const* node) {
    if (node == nullptr) return {false, false, true};
    if (scene::list(*node).items.size() != 3)
        scene::fail(*node, "`slab_eq_axis` has other than three entries",
                    "write three of true and false, such as [false, false, true]");
    Axes axes{};
    for (std::size_t a = 0; a < 3; ++a) axes[a] = truth_of(node->items[a]);
    return axes;
}

/// Throws InputError unless the force pulls as `slab_eq` asks for.
void refuse_another_slab(PackageFile const& config, ForceText const& force,
                         SystemText const& system) {
    std::optional<Axes> const made = axes_of(force);
    if (!made)
        scene::fail(*config.find("slab_eq"),
                    fmt::format("`slab_eq` is true, and the {} of {} pulls towards no slab: `{}`",
                                pull_force, system.name(), scene::shown(force.energy)),
                    "start the package's run.py again, which writes the System, or write "
                    "`slab_eq: false`");
    Node const* const node = config.find("slab_eq_axis");
    if (Axes const asked = asked_axes(node); asked != *made)
        scene::fail(node != nullptr ? *node : *config.find("slab_eq"),
                    fmt::format("`slab_eq_axis` is {}, and the {} of {} pulls along {}",
                                node != nullptr ? names_of(asked) : "absent, which means z",
                                pull_force, system.name(), names_of(*made)),
                    run_again);
    auto const box = system.box();
    for (std::size_t a = 0; a < 3; ++a) {
        auto const middle = force.globals.find(middle_of(a));
        if (!(*made)[a] || middle == force.globals.end() || !box) continue;
        double const half = (*box)[static_cast<int>(a)] / 2;
        if (std::abs(middle->second - half) > most_middle_difference)
            scene::fail(
                *config.find("slab_eq"),
                fmt::format("the middle of the box is at {} = {:.6g} nm, and the {} of {} "
                            "pulls towards {:.6g} nm",
                            axis_letters[a], half, pull_force, system.name(), middle->second),
                run_again);
    }
    if (auto const k = force.globals.find("k"); k != force.globals.end())
        refuse_another(config, "k_eq", k->second, 1, system.name());
}

/// Throws InputError unless the force is the expression of `ext_force`.
void refuse_another_expression(PackageFile const& config, ForceText const& force,
                               SystemText const& system) {
    Node const* const expression = config.find("ext_force_expr");
    if (expression == nullptr ||
        without_spaces(scene::text(*expression)) == without_spaces(force.energy))
        return;
    scene::fail(*expression,
                fmt::format("`ext_force_expr` is not the {} of {}, `{}`", pull_force, system.name(),
                            scene::shown(force.energy)),
                run_again);
}

}  // namespace

void compare_pull(PackageFile const& config, SystemText const& system,
                  std::vector<std::string>& notes) {
    bool const slab = config.truth("slab_eq"), own = config.truth("ext_force");
    if (slab && own)
        scene::fail(*config.find("slab_eq"),
                    "`slab_eq` and `ext_force` are both true, and the package writes one external "
                    "force",
                    "write false for the one that is not meant");
    for (ForceText const& force : system.forces()) {
        if (force.kind != pull_force) continue;
        if (slab) refuse_another_slab(config, force, system);
        if (own) refuse_another_expression(config, force, system);
        if (!slab && !own)
            return notes.push_back(fmt::format(
                "{} has a {} that config.yaml does not ask for (slab_eq, ext_force): it acts "
                "throughout. If it should not, import with --leave-out {}.",
                system.name(), pull_force, pull_force));
    }
}

void refuse_other_pulled(PackageFile const& config, CalvadosComponents const& components,
                         MadeSystem const& made) {
    if (!config.truth("slab_eq") && !config.truth("ext_force")) return;
    auto const owners = components.of_chains(made.chains.size());
    if (owners.empty()) return;
    for (ForceText const& force : made.text.forces()) {
        if (force.kind != pull_force) continue;
        std::vector<bool> pulled(made.text.particles());
        for (std::int64_t const p : force.pulled)
            if (p >= 0 && p < std::ssize(pulled)) pulled[static_cast<std::size_t>(p)] = true;
        std::size_t p = 0;
        for (std::size_t c = 0; c < owners.size(); ++c)
            for (std::size_t k = 0; k < made.chains[c].size() && p < pulled.size(); ++k, ++p)
                if (pulled[p] != owners[c]->pulled)
                    throw InputError(
                        fmt::format("`ext_restraint` of `{}` is {}, and the {} of {} {} on its "
                                    "particle {} (from 0)",
                                    scene::shown(owners[c]->name), owners[c]->pulled, pull_force,
                                    made.name(), pulled[p] ? "acts" : "does not act", p),
                        components.place(*owners[c], "ext_restraint"), run_again);
    }
}

}  // namespace catena::foreign
