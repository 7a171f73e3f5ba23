// Implements what is asked of all force terms on the host.
#include "terms/force_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scene/branch_limits.hpp"
#include "scene/integrator.hpp"

namespace catena::terms {

std::string vector_text(Vec3 const& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string FixmanTerm::dynamics_text(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    return d.fixman ? fmt::format(", Fixman potential at {} K", d.temperature) : "";
}

std::vector<EnergyColumn> energy_columns(Scene const& scene) {
    std::vector<EnergyColumn> columns;
    for_each([&](auto term) {
        using Term = decltype(term);
        if (Term::energy != nullptr && (Term::always_has_energy || acts_in<Term>(scene)))
            columns.push_back({Term::energy, place_of_energy<Term>()});
    });
    return columns;
}

std::vector<std::string> names_of_energies() {
    std::vector<std::string> names;
    for_each([&](auto term) {
        if (decltype(term)::energy != nullptr) names.emplace_back(decltype(term)::energy);
    });
    return names;
}

bool has_potential(Scene const& scene) {
    return any_of([&](auto term) {
        using Term = decltype(term);
        return Term::energy != nullptr && acts_in<Term>(scene);
    });
}

std::vector<TermCount> counts(Scene const& scene) {
    std::vector<TermCount> all;
    for_each([&](auto term) {
        using Term = decltype(term);
        if (Term::in_check != nullptr)
            all.push_back({Term::name, Term::in_check, Term::on_one, Term::on_many,
                           Term::acts_along_joints, count_in<Term>(scene)});
    });
    return all;
}

std::string forces_text(Scene const& scene) {
    std::string text = OpenMmTerm::text(scene);
    for_each([&](auto term) {
        if constexpr (!std::is_same_v<decltype(term), OpenMmTerm>)
            if (std::string const part = decltype(term)::text(scene); !part.empty())
                text += (text.empty() ? "" : ", ") + part;
    });
    return text;
}

std::string why_host_alone(Scene const& scene) {
    std::string why;
    for_each([&](auto term) {
        if (why.empty()) why = decltype(term)::why_host_alone(scene);
    });
    if (!why.empty()) return why;
    DynamicsSpec const& d = scene.dynamics;
    if (d.given && !traits_of(d.integrator).on_gpu)
        return fmt::format("integrator {} works on the host", name_of(d.integrator));
    bool const cross_linked = std::any_of(scene.chains.begin(), scene.chains.end(),
                                          [](ChainSpec const& c) { return c.is_cross_linked(); });
    if (cross_linked) return "cross-linked chains are computed on the host";
    if (std::any_of(scene.chains.begin(), scene.chains.end(), scene::is_body_tree))
        return "branched chains of rigid bodies are computed on the host";
    bool const loops = std::any_of(scene.chains.begin(), scene.chains.end(),
                                   [](ChainSpec const& c) { return c.has_loops(); });
    return loops ? "chains with `loops` are computed on the host" : "";
}

std::vector<char const*> keys_beside(std::initializer_list<char const*> before,
                                     std::initializer_list<char const*> after) {
    std::vector<char const*> keys = before;
    for_each([&](auto term) {
        if (decltype(term)::body_key && !decltype(term)::on_links)
            keys.push_back(decltype(term)::body_key);
    });
    keys.insert(keys.end(), after);
    return keys;
}

void read(scene::Fields const& forces, ForceSpec& spec) {
    for_each([&](auto term) { decltype(term)::read(forces, spec); });
}

void read_bodies(scene::Node const& list, ForceSpec const& forces, ChainSpec& chain) {
    for (std::size_t k = 0; k < list.items.size(); ++k)
        for_each([&](auto term) { decltype(term)::read_body(list.items[k], k, forces, chain); });
}

}  // namespace catena::terms
