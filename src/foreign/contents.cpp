// Implements the look into a folder.
#include "foreign/contents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "error.hpp"
#include "scene/files.hpp"
#include "scene/node.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

/// True for a file named KIND.xml, or with that word in its name, if its root element is none of
/// OpenMM's objects. `kind` is in lower case.
bool is_promised(fs::path const& file, std::string const& kind, std::string const& root) {
    std::string name = file.stem().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    bool const is_other = root == "System" || root == "State" || root == "Integrator";
    return name == kind || (name.find(kind) != std::string::npos && !is_other);
}

/// A kind of object with the files that hold one, and those that hold none in spite of their name.
struct Kind {
    char const *root, *word;
    std::vector<std::string> Contents::*holding, Contents::*lacking;
};

/// Sorts an XML file into the lists.
void add_xml(fs::path const& file, Contents& contents) {
    std::string const root = root_of(file);
    for (Kind const& kind :
         {Kind{"System", "system", &Contents::systems, &Contents::no_systems},
          {"State", "state", &Contents::states, &Contents::no_states},
          {"Integrator", "integrator", &Contents::integrators, &Contents::no_integrators}}) {
        if (root == kind.root)
            (contents.*kind.holding).push_back(file.string());
        else if (is_promised(file, kind.word, root))
            (contents.*kind.lacking).push_back(file.string());
    }
}

}  // namespace

bool is_topology(fs::path const& file) {
    std::string const ending = scene::ending_of(file.string(), true);
    return ending == ".pdb" || ending == ".cif" || ending == ".mmcif" || ending == ".ent";
}

std::string root_of(fs::path const& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text(65536, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    auto at = text.find('<');
    while (at != std::string::npos && at + 1 < text.size() &&
           std::isalpha(static_cast<unsigned char>(text[at + 1])) == 0)
        at = text.find('<', at + 1);
    if (at == std::string::npos) return "";
    return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at) - at - 1);
}

Contents contents_of(fs::path const& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored)) files.push_back(entry->path());
    }
    if (error)
        throw InputError("the folder cannot be read: " + error.message(),
                         scene::shown_path(folder.string()), "check the path and its permissions");
    std::sort(files.begin(), files.end());
    Contents contents;
    for (fs::path const& file : files) {
        contents.all.push_back(file.string());
        if (is_topology(file)) contents.topologies.push_back(file.string());
        if (scene::ending_of(file.string()) == ".xml") add_xml(file, contents);
    }
    return contents;
}

std::string bare_names(std::vector<std::string> const& files) {
    std::vector<std::string> bare;
    for (std::string const& file : files)
        bare.push_back(scene::shown_path(fs::path(file).filename().string()));
    return fmt::format("{}", fmt::join(bare, ", "));
}

}  // namespace catena::foreign
