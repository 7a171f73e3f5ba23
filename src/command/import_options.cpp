#include "command/import_options.hpp"

#include <CLI/CLI.hpp>

#include "console/option_values.hpp"
#include "error.hpp"

namespace catena::command {
namespace {

constexpr double longest_link = 1e6, shortest_link = 1e-9;  // nm

/// Reads FORCE=LENGTH.
std::pair<std::string, double> link_of(std::string const& text) {
    auto const equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError("`" + text + "` names no force and length", "--links",
                         "write FORCE=LENGTH, as in CustomBondForce=0.97");
    return {text.substr(0, equals),
            number_between("--links", text.substr(equals + 1), shortest_link, longest_link)};
}

}  // namespace

CLI::App* add_import(CLI::App& app, ImportOptionTexts& words) {
    CLI::App* const command = app.add_subcommand(
        "import", "write a scene from the folder of another tool: OpenMM System and topology");
    command
        ->add_option("SOURCE", words.source,
                     "folder (of the CALVADOS package, or any with one serialised System), or a "
                     "serialised System (XML)")
        ->type_name("");
    command
        ->add_option("TOPOLOGY", words.topology,
                     "PDB or mmCIF file with one atom per particle, or a serialised State with "
                     "positions (default: the folder's)")
        ->type_name("");
    command
        ->add_option("--output", words.output,
                     "scene to write (default: the System's name with .yaml, in this folder)")
        ->type_name("SCENE");
    command
        ->add_option("--leave-out", words.leave_out,
                     "forces of the System that shall not count, by name or kind")
        ->type_name("FORCE,...");
    command
        ->add_option("--links", words.links,
                     "make the bonds of a CustomBondForce (FENE) rigid links of this length in nm "
                     "(may be repeated)")
        ->type_name("FORCE=LENGTH")
        ->allow_extra_args(false);
    command->add_flag("--overwrite", words.overwrite, "replace an existing scene");
    command->footer(
        "Examples:\n  catena import calvados-folder\n"
        "  catena import system.xml start.pdb --output mine.yaml\n"
        "  catena import system.xml state.xml --links FENE=0.97 --leave-out MonteCarloBarostat\n"
        "Temperature, friction and step are those of config.yaml (CALVADOS) or of a serialised "
        "Integrator in the folder, else defaults, which are noted. The scene is checked before it "
        "is written.");
    return command;
}

ImportRequest import_request(ImportOptionTexts const& words, CommonOptions const& common) {
    if (words.source.empty())
        throw InputError("no folder or System is named", "command line",
                         "write catena import FOLDER, or catena import SYSTEM.xml TOPOLOGY");
    ImportRequest request;
    static_cast<CommonOptions&>(request) = common;
    request.source = words.source;
    request.topology = words.topology;
    request.output = words.output;
    request.overwrite = words.overwrite;
    if (!words.leave_out.empty()) request.leave_out = comma_list("--leave-out", words.leave_out);
    for (std::string const& link : words.links) request.links.push_back(link_of(link));
    return request;
}

}  // namespace catena::command
