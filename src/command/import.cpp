// `catena import`: a scene from the folder of another tool. The scene is read and checked like any
// other before it is written.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <list>

#include "command/commands.hpp"
#include "console/long_task.hpp"
#include "console/option_values.hpp"
#include "console/terminal.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "foreign/files.hpp"
#include "foreign/origins.hpp"
#include "foreign/scene_text.hpp"
#include "foreign/settings.hpp"
#include "foreign/start_topology.hpp"
#include "io/output.hpp"
#include "mpi/first_rank.hpp"
#include "reader/load_scene.hpp"
#include "scene/force_changes.hpp"
#include "scene/node.hpp"

namespace catena::command {
namespace {

namespace fs = std::filesystem;

/// A scene with its text and what `check` found.
struct Written {
    std::string file, text;
    std::vector<std::string> notes;
    Json check;
};

/// Reads the scene, and says so while that takes long.
Scene read_with_words(std::string const& text, foreign::SceneDraft const& draft) {
    LongTask const task(!is_quiet(), "reading " + draft.system);
    return parse_scene(text, draft.file);
}

/// Reads and checks the text of a scene. Throws InputError, which names the file and key that a
/// wrong value came from: the scene is not there yet.
Written checked(foreign::SceneDraft const& draft) {
    Written written{draft.file, text_of(draft), {}, {}};
    try {
        Scene const scene = read_with_words(written.text, draft);
        written.check = check_scene(scene, *serial_communicator(), true).json;
        written.notes = scene.notes;
    } catch (InputError const& error) {
        throw InputError(foreign::with_origins(error.what(), draft));
    }
    return written;
}

/// Checks the scene. A start that is refused as it is may be relaxed, which is noted. Where
/// relaxation does not help the first refusal is thrown.
Written settled(foreign::SceneDraft draft) {
    draft.relax = draft.settings.minimises;
    if (draft.relax) return checked(draft);
    std::string refusal;
    try {
        return checked(draft);
    } catch (InputError const& error) {
        refusal = error.what();
    }
    draft.relax = true;
    try {
        Written written = checked(draft);
        written.notes.push_back("`relax: true`, because the start is refused as it is: " + refusal);
        return written;
    } catch (InputError const&) {
        throw InputError(refusal);
    }
}

/// Throws InputError for an existing file unless it may be replaced.
void refuse_existing(std::string const& file, bool overwrite) {
    std::error_code ignored;
    if (!overwrite && fs::exists(file, ignored))
        throw InputError("the scene exists", scene::shown_path(file),
                         "name another one with --output, or add --overwrite");
}

/// Name of the scene of the equilibration that comes before the scene `file`.
std::string equilibration_of(std::string const& file) {
    fs::path path = file;
    path.replace_filename(path.stem().string() + "-equilibration" + path.extension().string());
    return path.string();
}

/// Name of the scene that the import writes.
std::string scene_file(foreign::Files const& files, ImportRequest const& request) {
    return request.output.empty() ? name_of(files) + ".yaml" : request.output;
}

/// Folder of the start of a scene.
std::string start_folder(std::string const& scene) {
    return fs::path(scene).replace_extension().string() + "-start";
}

/// A file or folder that vanishes with its contents unless it is kept or was there before.
class NewPath {
  public:
    explicit NewPath(std::string path) : path_(std::move(path)) {
        std::error_code ignored;
        kept_ = fs::exists(fs::symlink_status(path_, ignored));
    }
    NewPath(NewPath const&) = delete;
    NewPath& operator=(NewPath const&) = delete;
    ~NewPath() {
        std::error_code ignored;
        if (!kept_) fs::remove_all(path_, ignored);
    }
    void keep() { kept_ = true; }
    bool is_kept() const { return kept_; }

  private:
    std::string path_;
    bool kept_;
};

/// Writes the topology of a State. Throws InputError, which names the options and files of the
/// import.
foreign::WrittenStart start_of(foreign::Files const& files, foreign::SceneDraft draft) {
    OpenMmSpec spec;
    spec.system = files.system;
    add_changes({{}, draft.leave_out, draft.links}, spec);
    std::string const folder = start_folder(draft.file);
    try {
        return write_start(files, spec, folder);
    } catch (InputError const& error) {
        draft.file = draft.source = files.system;  // the name in these messages
        throw InputError(foreign::with_origins(error.what(), draft));
    }
}

/// Parts that the scenes of an import have in common. Writes the topology of a State.
foreign::SceneDraft draft_of(foreign::Files const& files, foreign::Settings const& settings,
                             ImportRequest const& request) {
    foreign::SceneDraft draft;
    draft.title = name_of(files);
    draft.file = scene_file(files, request);
    if (draft.file == "-")
        throw InputError("the scene cannot go to standard output", "--output -", "name a file");
    require_writable("--output", draft.file);
    refuse_existing(draft.file, request.overwrite);
    draft.source = scene::shown_path(request.source);
    draft.system = files.system;
    draft.topology = files.topology;
    draft.start = files.state.empty() ? files.topology : files.state;
    draft.leave_out = request.leave_out;
    draft.links = request.links;
    draft.settings = settings;
    draft.steps = settings.steps;
    if (files.state.empty()) return draft;
    foreign::WrittenStart const written = start_of(files, draft);
    draft.topology = written.topology;
    draft.settings.notes.insert(draft.settings.notes.end(), written.notes.begin(),
                                written.notes.end());
    return draft;
}

/// Drafts of the scenes to write, the equilibration first.
std::vector<foreign::SceneDraft> drafts_of(foreign::Files const& files,
                                           foreign::Settings const& settings,
                                           ImportRequest const& request) {
    foreign::SceneDraft main = draft_of(files, settings, request);
    std::vector<foreign::SceneDraft> drafts;
    if (settings.equilibration_steps) {
        drafts.push_back(main);
        drafts.back().file = equilibration_of(main.file);
        refuse_existing(drafts.back().file, request.overwrite);
        drafts.back().title += " equilibration";
        drafts.back().steps = *settings.equilibration_steps;
    }
    for (std::string const& force : settings.equilibration_forces)
        if (std::find(main.leave_out.begin(), main.leave_out.end(), force) == main.leave_out.end())
            main.leave_out.push_back(force);
    drafts.push_back(std::move(main));
    return drafts;
}

/// Writes all scenes, or none and no start if one fails. A start stays if a scene was replaced that
/// needs it.
void write_all(std::vector<Written> const& scenes, NewPath& start) {
    std::list<NewPath> files;
    for (Written const& scene : scenes) {
        NewPath& file = files.emplace_back(scene.file);
        write_text_file(scene.file, scene.text);
        if (file.is_kept()) start.keep();
    }
    for (NewPath& file : files) file.keep();
    start.keep();
}

/// Writes a word of a command as a shell reads it: quoted unless it is plain, control characters
/// escaped.
std::string shell_word(std::string const& text) {
    auto const is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || c >= 0x80 || std::strchr("_-./+=@%:,", c) != nullptr;
    };
    auto const is_control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
    if (std::all_of(text.begin(), text.end(), is_plain)) return text;
    std::string word = std::any_of(text.begin(), text.end(), is_control) ? "$'" : "'";
    bool const escapes = word[0] == '$';
    for (char const c : text) {
        if (is_control(static_cast<unsigned char>(c)))
            word += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        else if (c == '\'')
            word += escapes ? "\\'" : "'\\''";
        else
            word += escapes && c == '\\' ? "\\\\" : std::string(1, c);
    }
    return word + "'";
}

/// The commands that run the scenes one after the other.
std::vector<std::string> next_steps(std::vector<Written> const& scenes) {
    auto const folder = [](std::string const& scene, char const* file = "") {
        return shell_word(fs::path(scene).stem().string() + "-run" + file);
    };
    std::string const &last = scenes.back().file, first = scenes.front().file;
    if (scenes.size() == 1) return {fmt::format("catena run {}", shell_word(last))};
    return {fmt::format("catena run {} --output {}", shell_word(first), folder(first)),
            fmt::format("catena run {} --restart {} --branch --output {}", shell_word(last),
                        folder(first, "/checkpoint.h5"), folder(last))};
}

/// Text of what was written.
std::string text_of(foreign::Files const& files, foreign::SceneDraft const& draft,
                    std::vector<Written> const& scenes, std::vector<std::string> const& notes) {
    foreign::Settings const& run = draft.settings;
    Json const& check = scenes.back().check;
    Text text;
    text.heading(scene::shown_path(draft.title));
    for (Written const& scene : scenes)
        text.entry(&scene == &scenes.front() ? "written" : "", scene::shown_path(scene.file));
    if (!run.tool.empty()) text.entry("tool", run.tool);
    text.entry("System", scene::shown_path(files.system));
    text.entry("topology", scene::shown_path(draft.topology));
    text.entry("chains", fmt::format("{}, {} bodies", check["chains"].size(),
                                     check["bodies"].get<std::int64_t>()));
    text.entry("dynamics", fmt::format("{} steps of {:.6g} ps, {:.6g} K, friction {:.6g}/ps",
                                       draft.steps, run.step, run.temperature, run.friction));
    bool first = true;
    for (std::string const& command : next_steps(scenes)) {
        text.entry(first ? "next" : "", command);
        first = false;
    }
    for (std::string const& note : notes) text.note(note);
    return text.str();
}

}  // namespace

Outcome import_folder(Communicator const& communicator, ImportRequest const& request) {
    Outcome outcome;
    on_first_rank(communicator, [&] {
        foreign::Files const files = foreign::find_files(request.source, request.topology);
        foreign::Settings const settings = settings_of(files);
        NewPath start(start_folder(scene_file(files, request)));
        std::vector<foreign::SceneDraft> const drafts = drafts_of(files, settings, request);
        std::vector<Written> scenes;
        for (foreign::SceneDraft const& draft : drafts) scenes.push_back(settled(draft));
        std::vector<std::string> notes = files.notes, written;
        std::vector<std::string> const& told = drafts.back().settings.notes;
        notes.insert(notes.end(), told.begin(), told.end());
        for (Written const& scene : scenes)
            for (std::string const& note : scene.notes)
                if (std::find(notes.begin(), notes.end(), note) == notes.end())
                    notes.push_back(note);
        write_all(scenes, start);
        for (Written const& scene : scenes) written.push_back(scene.file);
        outcome.text = text_of(files, drafts.back(), scenes, notes);
        outcome.json = {{"scenes", written},
                        {"tool", settings.tool.empty() ? Json() : Json(settings.tool)},
                        {"system", files.system},
                        {"topology", drafts.back().topology},
                        {"next", next_steps(scenes)},
                        {"check", scenes.back().check},
                        {"notes", notes}};
    });
    return outcome;
}

}  // namespace catena::command
