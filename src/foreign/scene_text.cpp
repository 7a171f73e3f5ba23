// Implements the text of an imported scene.
#include "foreign/scene_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <string_view>

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

/// True for words that YAML takes for something else than text.
bool is_reserved(std::string word) {
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    static constexpr std::string_view reserved[] = {"null", "true", "false", "yes", "no",
                                                    "on",   "off",  "y",     "n"};
    return std::find(std::begin(reserved), std::end(reserved), word) != std::end(reserved);
}

/// Writes a text as a YAML scalar; quoted unless it is a plain word or path. Control characters,
/// which file names may have, are escaped.
std::string quoted(std::string const& text) {
    auto const is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
    };
    bool const plain = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
                       std::all_of(text.begin(), text.end(), is_plain);
    if (plain && !is_reserved(text)) return text;
    std::string escaped;
    for (char const c : text) {
        auto const byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F) {
            escaped += fmt::format("\\x{:02x}", byte);
            continue;
        }
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return '"' + escaped + '"';
}

/// Path of a file as the scene's folder sees it.
std::string path_from(std::string const& scene, std::string const& file) {
    std::error_code error;
    fs::path const folder = fs::absolute(scene, error).parent_path();
    fs::path const near = fs::relative(fs::absolute(file, error), folder, error);
    return error || near.empty() ? fs::absolute(file, error).string() : near.string();
}

/// Lines of `forces.openmm`.
std::string forces_of(SceneDraft const& draft) {
    std::string text = fmt::format("forces:\n  openmm:\n    system: {}\n    topology: {}\n",
                                   quoted(path_from(draft.file, draft.system)),
                                   quoted(path_from(draft.file, draft.topology)));
    std::vector<std::string> entries;
    for (std::string const& force : draft.leave_out) entries.push_back(quoted(force));
    if (!entries.empty()) text += fmt::format("    leave_out: [{}]\n", fmt::join(entries, ", "));
    entries.clear();
    for (auto const& [force, length] : draft.links)
        entries.push_back(fmt::format("{}: {}", quoted(force), length));
    if (!entries.empty()) text += fmt::format("    links: {{{}}}\n", fmt::join(entries, ", "));
    return text;
}

}  // namespace

std::string text_of(SceneDraft const& draft) {
    Settings const& run = draft.settings;
    std::string text = fmt::format("# Written by catena import from {}{}.\n", draft.source,
                                   run.tool.empty() ? "" : " (" + run.tool + ")");
    for (std::string const& note : run.notes) text += "# " + note + "\n";
    text += fmt::format("title: {}\nunits: md\n{}", quoted(draft.title), forces_of(draft));
    text += fmt::format(
        "dynamics: {{integrator: g-baoab, step: {}, steps: {}, temperature: {}, friction: {}, "
        "seed: {}}}\noutput: {{every: {}}}\n",
        run.step, draft.steps, run.temperature, run.friction, run.seed,
        std::clamp<std::int64_t>(run.every, 1, std::max<std::int64_t>(draft.steps, 1)));
    if (draft.relax) text += "relax: true\n";
    return text;
}

}  // namespace catena::foreign
