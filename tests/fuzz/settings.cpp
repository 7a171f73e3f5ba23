// Settings of another tool: a serialised Integrator, or config.yaml with components.yaml of the
// CALVADOS package after a line `---8<---`. What is written of them is one readable scene.
#include "foreign/settings.hpp"

#include <cmath>

#include "foreign/calvados_folder.hpp"
#include "foreign/scene_text.hpp"
#include "scene/node.hpp"
#include "systems/import.hpp"
#include "tests/fuzz/target.hpp"

/// Systems are read by another target: here none has screened charges.
std::optional<catena::ScreenedChains> catena::read_screened_chains(std::string const&,
                                                                   std::string const&) {
    return std::nullopt;
}

namespace {

constexpr std::string_view cut = "\n---8<---\n";

void require_readable(catena::foreign::Settings const& settings) {
    using catena::fuzz::require;
    require(std::isfinite(settings.temperature) && std::isfinite(settings.friction));
    require(std::isfinite(settings.step) && settings.steps >= 0 && settings.every > 0);
    catena::foreign::SceneDraft draft;
    draft.file = draft.title = draft.source = draft.system = draft.topology = "x";
    draft.settings = settings, draft.steps = settings.steps;
    auto const written = catena::scene::parse_document(text_of(draft), "scene.yaml");
    require(written->items.size() == 5);  // a note that is more than its comment would add a key
}

}  // namespace

void catena::fuzz::read(std::string_view bytes) {
    foreign::Files files;
    if (bytes.starts_with('<')) {
        MemoryFile const integrator(bytes);
        files.integrator = integrator.path();
        return require_readable(settings_of(files));
    }
    std::size_t const at = bytes.find(cut);
    bool const both = at != std::string_view::npos;
    MemoryFile const config(bytes.substr(0, at)),
        components(both ? bytes.substr(at + cut.size()) : "");
    files.config = files.system = config.path();  // the System is searched for the slab's force
    if (both) files.components = components.path();
    foreign::calvados_name(files.config);
    require_readable(settings_of(files));
}
