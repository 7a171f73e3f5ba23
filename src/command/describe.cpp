#include "command/describe.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/solution.hpp"

namespace catena::command {
namespace {

bool any(double const* values, int count) {
    return std::any_of(values, values + count, [](double v) { return v != 0; });
}

bool alike(ChainSpec const& a, ChainSpec const& b) {
    return a.size() == b.size() && a.base == b.base && a.is_beads() == b.is_beads() && std::string(kind_of(a)) == kind_of(b);
}

char const* base_name(ChainSpec const& chain) { return chain.base == Base::free ? "free" : "fixed"; }

}  // namespace

std::string title_of(Scene const& scene) { return fmt::format("{} ({})", scene.title, scene.file); }

Table chain_table(Scene const& scene) {
    Table table({"chain", "copies", "bodies", "of", "base", "tip", "handles"}, {0, 3, 4, 5, 6});
    for (std::size_t i = 0; i < scene.chains.size();) {
        ChainSpec const& first = scene.chains[i];
        std::size_t end = i + 1;
        while (end < scene.chains.size() && alike(first, scene.chains[end])) ++end;
        std::string const name = end == i + 1 ? first.name : first.name + " .. " + scene.chains[end - 1].name;
        table.add({name, std::to_string(end - i), std::to_string(first.size()), first.is_beads() ? "beads" : "bodies", base_name(first),
                   "free", kind_of(first)});
        i = end;
    }
    return table;
}

Json chains_json(Scene const& scene) {
    Json list = Json::array();
    for (ChainSpec const& chain : scene.chains)
        list.push_back({{"name", chain.name}, {"bodies", chain.size()}, {"kind", kind_of(chain)}, {"base", base_name(chain)}});
    return list;
}

ForcesOnJoints forces_on_joints(Scene const& scene) {
    ForcesOnJoints found;
    for (ChainSpec const& chain : scene.chains) {
        BodyArrays const& b = chain.bodies;
        for (Vec3 const& v : b.stiffness) found.springs += any(v.data, 3);
        for (Vec3 const& v : b.damping) found.dampers += any(v.data, 3);
        for (Vec3 const& v : b.torque) found.torques += any(v.data, 3);
        for (auto const& [torque, force] : b.wrench) found.wrenches += any(torque.data, 3) || any(force.data, 3);
    }
    return found;
}

std::string forces_text(ForcesOnJoints const& found) {
    std::string text;
    auto const add = [&](std::int64_t count, char const* what, char const* one, char const* many) {
        if (count > 0) text += fmt::format("{}{} on {}", text.empty() ? "" : ", ", what, counted(count, one, many));
    };
    add(found.springs, "springs", "joint", "joints");
    add(found.dampers, "dampers", "joint", "joints");
    add(found.torques, "torques", "joint", "joints");
    add(found.wrenches, "wrenches", "body", "bodies");
    return text.empty() ? "none" : text;
}

std::string vector_text(Vec3 const& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

char const* time_unit(Scene const& scene) { return scene.si ? "s" : "ps"; }
char const* energy_unit(Scene const& scene) { return scene.si ? "J" : "kJ/mol"; }

std::string dynamics_text(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (!d.given) return "none (solve and report need none)";
    std::string text = fmt::format("{}, {} steps of {} {} ({:.6g} {})", name_of(d.integrator), d.steps, d.step, time_unit(scene),
                                   static_cast<double>(d.steps) * d.step, time_unit(scene));
    if (d.integrator == Integrator::g_baoab)
        text += fmt::format(", {} K, friction {}/{}, seed {}", d.temperature, d.friction, time_unit(scene), d.seed);
    return text;
}

Directions directions_of(Scene const& scene) {
    bool const full = scene.solver.handles == Handles::full;
    Directions d;
    for (ChainSpec const& chain : scene.chains) {
        if (chain.is_beads())
            d.beads = full ? 3 : 1;
        else
            d.bodies = full ? 6 : std::max(d.bodies, std::string(kind_of(chain)) == "revolute" ? 5 : 3);
    }
    return d;
}

std::string block_text(bool beads, int directions, Handles handles) {
    std::string const size = fmt::format("{0}x{0}", directions);
    if (handles == Handles::full) return size + (beads ? ", every direction of a point" : ", every direction");
    return size + (beads             ? ", projected on the links"
                   : directions == 5 ? ", projected on the restricted directions of revolute joints"
                                     : ", projected on the restricted directions of spherical joints");
}

}  // namespace catena::command
