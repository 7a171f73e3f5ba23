#include "command/analyse_options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "console/option_values.hpp"
#include "error.hpp"

namespace catena::command {
namespace {

constexpr double longest = 1e12;  // cutoffs and separations
constexpr std::string_view axis_names[] = {"x", "y", "z", "none"};
constexpr std::string_view wrap_names[] = {"none", "chains", "sites"};

void add_frames(CLI::App& command, AnalyseOptionTexts& words) {
    command.add_option("FOLDER", words.folder, "folder of a run, or its trajectory.h5md")
        ->type_name("");
    command.add_option("--first", words.first, "first frame, counted from 0 (default 0)")
        ->type_name("FRAME");
    command.add_option("--last", words.last, "last frame (default: the trajectory's)")
        ->type_name("FRAME");
}

CLI::App* add_analyse(CLI::App& app, AnalyseOptionTexts& words) {
    CLI::App* const command = app.add_subcommand(
        "analyse", "sizes, scaling, contacts, densities and diffusion of a run, with errors");
    add_frames(*command, words);
    command
        ->add_option("--discard", words.discard,
                     "part of the frames to leave out at the start, from 0 to below 1 (default 0)")
        ->type_name("FRACTION");
    command
        ->add_option("--output", words.output,
                     "folder for tables, maps and picture (default: FOLDER/analysis)")
        ->type_name("DIR");
    command
        ->add_option("--cutoff", words.cutoff,
                     "longest distance of a contact (default 1 nm; units si: none; 0: no contacts)")
        ->type_name("R");
    command
        ->add_option("--fit", words.fit,
                     "separations |i - j| that the scaling exponent is fitted to (default: 6 to "
                     "half the sites of a chain, a quarter of a ring's)")
        ->type_name("MIN,MAX");
    command
        ->add_option("--slab", words.slab,
                     "axis of the density profile: x | y | z | none (default: the longest edge of "
                     "a box with several chains, if it is 1.5 times the others)")
        ->type_name("AXIS");
    command->add_option("--bins", words.bins, "bins of the density profile, even (default 200)")
        ->type_name("N");
    command->footer(
        "Examples:\n  catena analyse asyn --discard 0.2\n"
        "  catena analyse slab --slab z --cutoff 0.8 --json slab.json --output slab-analysis");
    return command;
}

CLI::App* add_convert(CLI::App& app, AnalyseOptionTexts& words) {
    CLI::App* const command =
        app.add_subcommand("convert", "write a run's trajectory as DCD, for VMD and other tools");
    add_frames(*command, words);
    command->add_option("FILE.dcd", words.file, "file to write; an existing one is replaced")
        ->type_name("");
    command
        ->add_option("--wrap", words.wrap,
                     "none (default): as simulated, chains whole | chains: each whole, its middle "
                     "in the box | sites: every site in the box")
        ->type_name("HOW");
    command->footer(
        "Examples:\n  catena convert asyn asyn.dcd\n"
        "  catena convert slab slab.dcd --wrap chains --first 100\n"
        "Open it with the run's topology: vmd asyn/topology.psf asyn.dcd");
    return command;
}

std::size_t frame_number(std::string const& option, std::string const& text,
                         std::size_t otherwise) {
    return text.empty() ? otherwise : static_cast<std::size_t>(whole_number(option, text, 0));
}

void require_folder(AnalyseOptionTexts const& words, std::string const& command) {
    if (words.folder.empty())
        throw InputError("no folder is named", "command line",
                         "write catena " + command + " with the folder of a run");
}

analysis::Range fit_range(std::string const& text) {
    std::vector<std::string> const parts = comma_list("--fit", text);
    if (parts.size() != 2)
        throw InputError("`" + text + "` is not two numbers", "--fit", "write MIN,MAX, as in 6,70");
    analysis::Range const range{number_between("--fit", parts[0], 1, longest),
                                number_between("--fit", parts[1], 1, longest)};
    if (!(range.least < range.most))
        throw InputError("`" + text + "` is no range", "--fit", "give the smaller number first");
    return range;
}

analysis::Options options_of(AnalyseOptionTexts const& words) {
    analysis::Options options;
    options.first = frame_number("--first", words.first, options.first);
    options.last = frame_number("--last", words.last, options.last);
    if (!words.discard.empty() && !words.first.empty())
        throw InputError("both --first and --discard", "command line", "leave one of them out");
    if (!words.discard.empty())
        options.discard = number_between("--discard", words.discard, 0, 0.999999);
    if (!words.cutoff.empty())
        options.cutoff = number_between("--cutoff", words.cutoff, 0, longest);
    if (!words.fit.empty()) options.fit = fit_range(words.fit);
    if (!words.bins.empty())
        options.bins = static_cast<std::size_t>(whole_number("--bins", words.bins, 10, 100000));
    if (options.bins % 2 != 0)
        throw InputError(words.bins + " is odd", "--bins", "give an even number");
    if (words.slab.empty()) return options;
    known_value("--slab", words.slab, axis_names);
    options.find_slab = false;
    if (words.slab != "none") options.slab = words.slab[0] - 'x';
    return options;
}

}  // namespace

std::vector<CLI::App*> add_trajectory_commands(CLI::App& app, AnalyseOptionTexts& words) {
    return {add_analyse(app, words), add_convert(app, words)};
}

AnalyseRequest analyse_request(AnalyseOptionTexts const& words, CommonOptions const& common) {
    require_folder(words, "analyse");
    AnalyseRequest request;
    static_cast<CommonOptions&>(request) = common;
    request.folder = words.folder;
    request.output = words.output;
    request.options = options_of(words);
    return request;
}

ConvertRequest convert_request(AnalyseOptionTexts const& words, CommonOptions const& common) {
    require_folder(words, "convert");
    ConvertRequest request;
    static_cast<CommonOptions&>(request) = common;
    request.folder = words.folder;
    request.dcd.file = words.file;
    if (std::filesystem::path(words.file).extension() != ".dcd")
        throw InputError(words.file.empty() ? "no file is named"
                                            : "`" + words.file + "` is no name of a DCD file",
                         "command line", "name one that ends in .dcd");
    request.dcd.first = frame_number("--first", words.first, request.dcd.first);
    request.dcd.last = frame_number("--last", words.last, request.dcd.last);
    if (words.wrap.empty()) return request;
    known_value("--wrap", words.wrap, wrap_names);
    if (words.wrap == "chains") request.dcd.wrap = analysis::Wrap::chains;
    if (words.wrap == "sites") request.dcd.wrap = analysis::Wrap::sites;
    return request;
}

}  // namespace catena::command
