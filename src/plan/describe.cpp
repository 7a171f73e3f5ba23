// Implements the descriptions of scenes that `check`, `plan`, `solve` and `run` print.
#include "plan/describe.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/alike_chains.hpp"
#include "scene/branches.hpp"
#include "scene/freedom.hpp"
#include "scene/loops.hpp"

namespace catena::command {
namespace {

/// Returns the name of the chain's kind of handles.
char const* kind_name(ChainSpec const& chain) { return scene::name_of(scene::handle_kind(chain)); }

char const* base_name(ChainSpec const& chain) {
    return chain.base == Base::free ? "free" : "fixed";
}

}  // namespace

Json gpu_levels_json(Scene const& scene) {
    if (scene.solver.backend != Backend::cuda_levels) return nullptr;
    return scene.solver.gpu_levels == "auto" ? "all" : scene.solver.gpu_levels;
}

std::string title_of(Scene const& scene) { return fmt::format("{} ({})", scene.title, scene.file); }

/// Number of cross-links in words, with a blank before them; empty without any.
std::string crosslinks_text(ChainSpec const& chain) {
    std::size_t const count = chain.crosslinks.size();
    if (count == 0) return {};
    return fmt::format(" with {} cross-link{}", count, count == 1 ? "" : "s");
}

/// Number of loops in words, with a blank before them; empty without any.
std::string loops_text(ChainSpec const& chain) {
    std::size_t const count = chain.loops.size();
    if (count == 0) return {};
    return fmt::format(" with {} loop{}", count, count == 1 ? "" : "s");
}

Table chain_table(Scene const& scene) {
    Table table({"chain", "copies", "bodies", "of", "base", "tip", "handles"}, {0, 3, 4, 5, 6});
    std::size_t constexpr most_rows = 20;
    std::size_t rows = 0;
    for (auto const& [i, count] : scene::alike_chains(scene)) {
        ChainSpec const& first = scene.chains[i];
        if (++rows > most_rows) {
            table.add({"others", std::to_string(scene.chains_a_replica() - i), "", "", "", "", ""});
            break;
        }
        std::string const name =
            count == 1 ? scene.name_in_file(i)
                       : scene.name_in_file(i) + " .. " + scene.name_in_file(i + count - 1);
        table.add({name, std::to_string(count), std::to_string(first.size()),
                   (first.is_branched() ? "branched " : "") +
                       std::string(scene::contents_of(first)) + crosslinks_text(first) +
                       loops_text(first),
                   base_name(first), scene::tip_name(first), kind_name(first)});
    }
    return table;
}

Json chains_json(Scene const& scene) {
    Json list = Json::array();
    for (ChainSpec const& chain : scene.chains) {
        list.push_back({{"name", chain.name},
                        {"bodies", chain.size()},
                        {"kind", kind_name(chain)},
                        {"base", base_name(chain)}});
        if (chain.tip != Tip::free) list.back()["tip"] = scene::tip_name(chain);
        if (chain.is_branched())
            list.back()["branches"] = {{"ends", scene::ends_of(chain)},
                                       {"height", scene::height_of(chain)}};
        if (chain.is_cross_linked())
            list.back()["crosslinks"] = {{"count", chain.crosslinks.size()},
                                         {"redundant_links", chain.redundant_links}};
        if (chain.has_loops())
            list.back()["loops"] = {{"count", chain.loops.size()},
                                    {"directions", scene::directions_of_loops(chain)},
                                    {"redundant_directions", chain.redundant_directions}};
    }
    return list;
}

std::vector<terms::TermCount> loads_of(Scene const& scene) {
    std::vector<terms::TermCount> all = terms::counts(scene);
    terms::TermCount driven{"motions", "prescribed motions", "joint", "joints", true, 0};
    for (ChainSpec const& chain : scene.chains) driven.count += std::ssize(chain.bodies.driven);
    all.insert(std::find_if(all.begin(), all.end(),
                            [](terms::TermCount const& each) { return !each.on_joints; }),
               driven);
    return all;
}

std::string loads_text(Scene const& scene) {
    std::string text;
    for (terms::TermCount const& each : loads_of(scene))
        if (each.count > 0)
            text += fmt::format("{}{} on {}", text.empty() ? "" : ", ", each.text,
                                counted(each.count, each.on_one, each.on_many));
    return text.empty() ? "none" : text;
}

char const* time_unit(Scene const& scene) { return scene.si ? "s" : "ps"; }
char const* energy_unit(Scene const& scene) { return scene.si ? "J" : "kJ/mol"; }

std::string dynamics_text(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    if (!d.given) return "none (only `run` needs them)";
    std::string text =
        fmt::format("{}, {} steps of {} {} ({:.6g} {})", name_of(d.integrator), d.steps, d.step,
                    time_unit(scene), static_cast<double>(d.steps) * d.step, time_unit(scene));
    if (is_langevin(d.integrator))
        text += fmt::format(", {} K, friction {}/{}, seed {}", d.temperature, d.friction,
                            time_unit(scene), d.seed);
    if (d.tolerance > 0) text += fmt::format(", inner steps to tolerance {:g}", d.tolerance);
    terms::for_each([&](auto term) { text += decltype(term)::dynamics_text(scene); });
    return text;
}

Directions directions_of(Scene const& scene) {
    bool const full = carries_all(scene.solver.handles);
    Directions d;
    for (ChainSpec const& chain : scene.chains) {
        scene::HandleKind const kind = scene::handle_kind(chain);
        if (kind == scene::HandleKind::link)
            d.beads = full ? 3 : 1;
        else
            d.bodies = full || (scene.dynamics.given && is_implicit(scene.dynamics.integrator) &&
                                scene::resists(chain))
                           ? 6
                           : std::max(d.bodies, scene::directions_of(kind));
    }
    return d;
}

std::string block_text(bool beads, int directions, Handles handles) {
    std::string const size = fmt::format("{0}x{0}", directions);
    if (handles == Handles::articulated)
        return size + ", every direction, of runs held at their inboard side";
    if (handles == Handles::full)
        return size + (beads ? ", every direction of a point" : ", every direction");
    if (beads) return size + ", projected on the links";
    if (directions == 6)
        return size + ", every direction: welds, driven or implicit joints restrict them all";
    auto const kind = static_cast<scene::HandleKind>(directions - 1);
    return size + fmt::format(", projected on the restricted directions of {} joints",
                              scene::name_of(kind));
}

std::vector<std::string> notes_on(Scene const& scene, std::optional<StepLimit> const& limit) {
    std::vector<std::string> notes = scene.notes;
    std::int64_t const every = scene.output.every, steps = scene.dynamics.steps;
    if (scene.dynamics.given && steps > 0 && every > steps)
        notes.push_back(
            fmt::format("output.every = {} exceeds dynamics.steps = {}: only the first and the "
                        "last state become frames",
                        every, steps));
    if (std::string const note = note_of_step(scene, limit); !note.empty()) notes.push_back(note);
    return notes;
}

}  // namespace catena::command
