// Implements the command line: options with their help, and requests from their values.
#include "command/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "bench/sampling_options.hpp"
#include "command/analyse_options.hpp"
#include "command/import_options.hpp"
#include "console/option_values.hpp"
#include "error.hpp"
#include "report/figures.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Values that options accept.
constexpr std::string_view log_levels[] = {"trace", "debug", "info", "warn", "error", "off"};
constexpr std::string_view handle_names[] = {"projected", "full", "articulated"};
constexpr std::string_view joint_names[] = {"link",      "planar",   "spherical",
                                            "universal", "revolute", "prismatic",
                                            "helical",   "weld",     "mixed"};
constexpr std::string_view load_names[] = {"none", "torques", "wrenches"};
constexpr std::string_view suite_names[] = {"stability"};
constexpr std::string_view bench_names[] = {"list",    "evaluation", "solve",   "peers",
                                            "openmm",  "sampling",   "overlap", "figures",
                                            "network", "plan"};

/// Names that are reserved for later versions.
constexpr std::string_view later_option = "--precision", later_bench = "sweeps";

/// All texts of the command line, before any value is read.
struct Words {
    CommonOptions common;
    std::string scene, key, repeat, accelerations, steps, output, restart, name, sizes, joints,
        loads, backends, figures, ranks, hosts, network, latency, bandwidth, suite, cases;
    std::vector<std::string> scenes;
    SamplingOptionTexts sampling;
    AnalyseOptionTexts analyse;
    ImportOptionTexts import_;
    bool quick = false, overwrite = false, branch = false, explain = false, measure = false,
         calibrate = false, alike = false;
};

/// Adds the options that every command has: --json, --quiet and --log-level.
void add_answer(CLI::App& command, CommonOptions& c) {
    command
        .add_option(
            "--json", c.json,
            "also write the results as JSON; - writes them to standard output instead of the text")
        ->type_name("FILE");
    command.add_flag("--quiet", c.quiet, "print errors only");
    command
        .add_option(
            "--log-level", c.log_level,
            "log lines on standard error: trace | debug | info | warn (default) | error | off")
        ->type_name("LEVEL");
}

/// Adds the options that every command with a scene or a benchmark has.
void add_common(CLI::App& command, Words& words) {
    CommonOptions& c = words.common;
    command
        .add_option("--set", c.set,
                    "override a key of the scene, as in --set chains[0].count=10 (may be repeated)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    command
        .add_option("--handles", c.handles,
                    "directions that the solver's blocks carry: projected (default) | full (6x6, "
                    "beads 3x3) | articulated (for ill-conditioned open chains on joints)")
        ->type_name("KIND");
    command
        .add_option("--threads", c.threads,
                    "threads per rank, for openmp and for work that GPUs leave to the host (0: "
                    "cores of the host divided by its ranks)")
        ->type_name("N");
    command
        .add_option("--simd", c.simd,
                    "vector instructions for runs of bodies: auto (default: the widest) | avx512 | "
                    "avx2 | off")
        ->type_name("LEVEL");
    command
        .add_option("--gpu-levels", c.gpu_levels,
                    "for cuda-levels: number of lowest tree levels that the GPU assembles (UP) and "
                    "disassembles (DOWN), 0 to all; from 1 on also the bodies (auto: as predicted)")
        ->type_name("UP[,DOWN]");
    add_answer(command, c);
}
/// Adds --backend for one backend.
void add_backend(CLI::App& command, Words& words) {
    command
        .add_option("--backend", words.common.backend,
                    "auto (default) | serial | segments | openmp | cuda | cuda-levels (GPU and CPU "
                    "together, see --gpu-levels)")
        ->type_name("NAME");
}
/// Adds the argument SCENE.
void add_scene(CLI::App& command, Words& words) {
    command.add_option("SCENE", words.scene, "scene file (YAML)")->type_name("");
}
/// Adds --repeat with the given default in its help.
void add_repeat(CLI::App& command, Words& words, char const* otherwise) {
    command
        .add_option("--repeat", words.repeat,
                    std::string("number of timed evaluations (default ") + otherwise + ")")
        ->type_name("R");
}

/// Adds --refine.
void add_refine(CLI::App& command, Words& words) {
    command
        .add_option("--refine", words.common.refine,
                    "steps of iterative refinement of solutions in joint coordinates (default: the "
                    "scene's solver.refine, 0): 1 or 2 restore the digits lost to nearly parallel "
                    "revolute joints, light bodies between heavy ones and thin bodies")
        ->type_name("K");
}

/// Adds `keys`, which takes no scene and none of the options that change one.
void add_keys(CLI::App& app, Words& words) {
    CLI::App* const command = app.add_subcommand(
        "keys", "print the keys that a scene may have: type, default, unit, meaning");
    command
        ->add_option("NAME", words.key,
                     "a map, such as dynamics or forces.openmm, or a key, such as friction "
                     "(default: all maps)")
        ->type_name("");
    add_answer(*command, words.common);
    command->footer(
        "Examples:\n  catena keys dynamics\n  catena keys friction\n  catena keys --json "
        "keys.json");
}

/// Adds all commands with their options and examples.
void add_commands(CLI::App& app, Words& words) {
    CLI::App* command = app.add_subcommand("check", "validate a scene and describe it");
    add_scene(*command, words);
    command->footer(
        "Examples:\n  catena check inputs/arm.yaml\n  catena check inputs/several-chains.yaml "
        "--set chains[0].count=10 --json -");

    command = app.add_subcommand(
        "plan", "print what will run, how long an evaluation takes, what is left out, and why");
    add_scene(*command, words);
    command->add_flag("--explain", words.explain,
                      "also measure the time that is saved by what is left out");
    command->add_flag("--measure", words.measure,
                      "also measure an evaluation and compare it with the prediction");
    command->add_flag("--calibrate", words.calibrate,
                      "measure every kind of chain on this machine, for all later predictions "
                      "(SCENE may be left out)");
    command
        ->add_option("--ranks", words.ranks,
                     "predict the time per step, computing and messages, on up to P ranks")
        ->type_name("P");
    command->add_option("--hosts", words.hosts, "number of hosts of these ranks (default 1)")
        ->type_name("H");
    command
        ->add_option("--network", words.network,
                     "network for --ranks, written by mpirun ... catena bench network --json FILE")
        ->type_name("FILE");
    command
        ->add_option("--latency", words.latency,
                     "latency of a message between hosts, instead of the file's (s, ms, us, ns)")
        ->type_name("T");
    command
        ->add_option("--bandwidth", words.bandwidth,
                     "bandwidth between hosts, instead of the file's (B/s to GB/s, Mbit/s, Gbit/s)")
        ->type_name("B");
    command->footer(
        "Examples:\n  catena plan inputs/alpha-synuclein.yaml --explain\n  catena plan "
        "--calibrate\n"
        "  mpirun -np 4 catena plan inputs/random-revolute.yaml --backend segments\n"
        "  catena plan inputs/spherical-chain.yaml --ranks 4096 --hosts 512 --network "
        "network.json");

    command = app.add_subcommand(
        "solve", "compute accelerations and joint forces of the start, with times and residual");
    add_scene(*command, words);
    add_repeat(*command, words, "11");
    add_refine(*command, words);
    command
        ->add_option("--accelerations", words.accelerations,
                     "write accelerations and the forces of joints and tips, for any number of "
                     "bodies: .csv, .json or .h5 (HDF5)")
        ->type_name("FILE");
    command->footer(
        "Examples:\n  catena solve inputs/arm.yaml --json arm.json\n"
        "  catena solve inputs/random-revolute.yaml --set chains[0].generator.random.bodies=100000 "
        "--backend openmp --accelerations a.csv");

    command = app.add_subcommand("run", "simulate and write a folder of results");
    add_scene(*command, words);
    command
        ->add_option("--steps", words.steps,
                     "last step, counted from the scene's start, instead of dynamics.steps")
        ->type_name("N");
    command
        ->add_option("--output", words.output,
                     "output folder (default: the scene's name with -run; with --restart the "
                     "checkpoint's folder)")
        ->type_name("DIR");
    command->add_option("--restart", words.restart, "continue from a checkpoint")
        ->type_name("FILE");
    command->add_flag(
        "--branch", words.branch,
        "with --restart and --output: start a new run from the checkpoint, with another "
        "temperature, friction, seed, step, box, forces or integrator (in the same coordinates); "
        "without --steps it runs dynamics.steps further steps");
    command->add_flag("--overwrite", words.overwrite, "replace the results of a run in the folder");
    add_refine(*command, words);
    command->footer(
        "Examples:\n  mpirun -np 2 catena run inputs/alpha-synuclein.yaml --output asyn\n  catena "
        "run inputs/alpha-synuclein.yaml --restart asyn/checkpoint.h5 --steps 20000\n  catena run "
        "inputs/alpha-synuclein.yaml --restart asyn/checkpoint.h5 --branch --set "
        "dynamics.temperature=310 --output warm\nAfter SIGINT, SIGTERM, SIGUSR1, SIGHUP or SIGXCPU "
        "on any rank, all ranks finish their step, write a checkpoint and exit with status 3.");

    command = app.add_subcommand("report",
                                 "measure errors against run time of solver, integrators and "
                                 "forces; write a page, tables, JSON and pictures");
    command
        ->add_option("SCENE", words.scenes,
                     "scene files (default: generated chains); integrators are compared if a scene "
                     "has `dynamics` without OpenMM, forces if it has OpenMM")
        ->type_name("");
    command
        ->add_option("--suite", words.suite,
                     "stability: measure chains that are hard to solve instead, up to 2^20 bodies: "
                     "growth of rounding errors, errors, bounds, verdicts; without --quick also "
                     "Simbody and Pinocchio if installed (tests/bench/peers/README.md)")
        ->type_name("NAME");
    command
        ->add_option("--sizes", words.sizes,
                     "for --suite: only coils and dills with these numbers of bodies")
        ->type_name("N,...");
    command
        ->add_option("--cases", words.cases,
                     "for --suite: only families whose names contain one of these words")
        ->type_name("WORD,...");
    command->add_flag("--quick", words.quick, "fewer and smaller cases, less than a minute");
    command
        ->add_option("--output", words.output,
                     "folder for report.html, report.json and pictures (default catena-report)")
        ->type_name("DIR");
    add_repeat(*command, words, "11, with --quick 3");
    command->footer(
        "Examples:\n  catena report --quick\n  catena report inputs/arm.yaml "
        "inputs/random-link.yaml --repeat 51 --output errors\n"
        "  catena report --suite stability --output stability");

    command = app.add_subcommand("bench", "run reproducible benchmarks, with residuals");
    command->add_option("NAME", words.name, "benchmark; `list` describes all")->type_name("");
    add_sampling(*command, words.sampling);
    command
        ->add_option("--sizes", words.sizes,
                     "numbers of bodies (default of solve and evaluation: 1e3,1e4,1e5, the oracle "
                     "is left out above 1e6; peers: 100,200,500,1e3,1e4,1e5; openmm: "
                     "140,9940,99960,1000020; overlap: the last three, in whole chains of 140 "
                     "beads; figures: 2,4,8 to 2048; plan: 16,32 to 1048576)")
        ->type_name("N,...");
    command
        ->add_option("--joints", words.joints,
                     "link, planar, spherical, universal, revolute, prismatic, helical, weld, "
                     "mixed (default: link,spherical,revolute; "
                     "evaluation: link,spherical; peers accepts these and planar)")
        ->type_name("J,...");
    command
        ->add_option(
            "--loads", words.loads,
            "for solve, evaluation and peers, in addition to gravity: none | torques (of joints) | "
            "wrenches (default: joint torques and wrenches in ground axes on every body)")
        ->type_name("LOADS");
    command->add_flag("--alike", words.alike,
                      "for solve and evaluation: all bodies have the same mass, inertia and joints "
                      "(default: random ones)");
    add_repeat(*command, words, "21");
    command
        ->add_option("--backend", words.backends,
                     "serial, segments, openmp, cuda, cuda-levels (default: all of this build for "
                     "processors; openmm, overlap and sampling take one, cuda if there is a GPU)")
        ->type_name("B,...");
    command
        ->add_option("--figure", words.figures,
                     "for figures: table-2.1, 2.3, 2.5, 2.6, 2.7 of the DCA chapter (default: all)")
        ->type_name("F,...");
    command
        ->add_option("--output", words.output,
                     "folder for figures.json and pictures (default catena-figures); for overlap: "
                     "folder for pictures")
        ->type_name("DIR");
    command->footer(
        "Examples:\n  catena bench list\n  catena bench solve --sizes 1e3,1e6 --joints link "
        "--backend segments,openmp --json bench.json\n"
        "  catena bench figures --figure 2.5,2.6 --output figures\n"
        "  catena bench sampling --methods rigid,bonds --steps 0.01,0.02,0.04 --duration 2000 "
        "--json sampling.json");

    for (CLI::App* each : app.get_subcommands({})) {
        if (each->get_name() != "bench") add_backend(*each, words);
        add_common(*each, words);
    }
    add_keys(app, words);
    for (CLI::App* each : add_trajectory_commands(app, words.analyse))
        add_answer(*each, words.common);
    add_answer(*add_import(app, words.import_), words.common);
}

/// Returns views of the texts.
std::vector<std::string_view> views(std::vector<std::string> const& texts) {
    return {texts.begin(), texts.end()};
}

/// Throws InputError for an unknown command.
[[noreturn]] void refuse_command(CLI::App const& app, std::string const& word) {
    std::vector<std::string> names;
    for (CLI::App const* command : app.get_subcommands({})) names.push_back(command->get_name());
    throw InputError("`" + word + "` is not a command", "command line",
                     remedy_for(word, views(names)));
}

/// Throws InputError for an unknown option, with the nearest known one as remedy.
[[noreturn]] void refuse_option(CLI::App const& command, std::string const& word) {
    std::string const option = word.substr(0, word.find('='));
    std::vector<std::string> known;
    for (CLI::Option const* each : command.get_options())
        for (std::string const& name : each->get_lnames()) known.push_back("--" + name);
    if (option == later_option)
        throw not_in_this_version(option + " of catena " + command.get_name());
    std::string const see = "catena " + (command.get_parent() ? command.get_name() + " " : "") +
                            "--help lists the options";
    std::string const remedy = remedy_for(option, views(known));
    throw InputError("`" + option + "` is not an option", "command line",
                     remedy.starts_with("did") ? remedy : see);
}

/// Throws InputError if words are left that CLI11 could not assign.
void refuse_extras(CLI::App const& app, CLI::App const* command) {
    std::vector<std::string> const left = app.remaining(true);
    if (left.empty()) return;
    auto const option = std::find_if(left.begin(), left.end(), [](std::string const& word) {
        return word.size() > 1 && word[0] == '-';
    });
    if (option != left.end()) refuse_option(command ? *command : app, *option);
    if (!command) refuse_command(app, left.front());
    throw InputError("`" + left.front() + "` is one argument too many", "command line",
                     "see catena " + command->get_name() + " --help");
}

/// Throws InputError if an option has an empty value.
void refuse_empty(CLI::App const& command) {
    for (CLI::Option const* option : command.get_options())
        for (std::string const& value : option->results())
            if (value.empty())
                throw InputError(option->get_name() + " is empty", "command line",
                                 "give a value, or leave it out");
}

/// Replaces line breaks by spaces and removes trailing ones.
std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

/// Returns the common options with all values checked.
CommonOptions checked(CommonOptions c) {
    if (!c.backend.empty()) backend_named("--backend", c.backend);
    if (!c.handles.empty()) known_value("--handles", c.handles, handle_names);
    if (!c.threads.empty())
        c.threads = std::to_string(whole_number("--threads", c.threads, 0, 4096));
    if (!c.refine.empty()) c.refine = std::to_string(whole_number("--refine", c.refine, 0, 10));
    known_value("--log-level", c.log_level, log_levels);
    return c;
}

/// Returns the value of --repeat, or its default.
int repeat_of(Words const& words, int otherwise) {
    return words.repeat.empty()
               ? otherwise
               : static_cast<int>(whole_number("--repeat", words.repeat, 1, 1000000));
}

/// Returns a request on one scene with the common options checked.
template <class R>
R scene_request(Words const& words, std::string const& command) {
    if (words.scene.empty())
        throw InputError("no scene is named", "command line", "write catena " + command + " SCENE");
    R request;
    static_cast<CommonOptions&>(request) = checked(words.common);
    request.scene = words.scene;
    require_files_apart(words.scene, words.common.json, words.accelerations);
    return request;
}

/// Reads --latency and --bandwidth, which must be given together.
void read_link(Words const& words, PlanRequest& request) {
    static constexpr Unit seconds[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
    static constexpr Unit bytes[] = {{"B/s", 1},    {"kB/s", 1e3},      {"MB/s", 1e6},
                                     {"GB/s", 1e9}, {"Mbit/s", 1.25e5}, {"Gbit/s", 1.25e8}};
    if (words.latency.empty() != words.bandwidth.empty())
        throw InputError("--latency and --bandwidth must be given together", "command line",
                         "give both, as in --latency 1.5us --bandwidth 12.5GB/s");
    if (words.latency.empty()) return;
    request.latency = number_with_unit("--latency", words.latency, seconds);
    request.seconds_a_byte = 1 / number_with_unit("--bandwidth", words.bandwidth, bytes);
}

/// Returns the request of `catena plan`.
PlanRequest plan_request(Words const& words) {
    PlanRequest request;
    if (words.calibrate && words.scene.empty())
        static_cast<CommonOptions&>(request) = checked(words.common);
    else
        request = scene_request<PlanRequest>(words, "plan");
    request.explain = words.explain;
    request.measure = words.measure;
    request.calibrate = words.calibrate;
    if (!words.ranks.empty()) request.ranks = whole_number("--ranks", words.ranks, 1, 1000000);
    if (!words.hosts.empty()) request.hosts = whole_number("--hosts", words.hosts, 1, 1000000);
    request.network = words.network;
    read_link(words, request);
    if (request.ranks == 0 && (!words.hosts.empty() || !words.network.empty() || request.latency))
        throw InputError("--hosts, --network or --latency without --ranks", "command line",
                         "give the number of ranks: --ranks P");
    if (request.ranks > 0 && request.hosts > request.ranks)
        throw InputError("more hosts than ranks", "command line",
                         "give each host at least one rank");
    if (request.ranks > 0 && request.network.empty() && !request.latency)
        throw InputError("--ranks without --network", "command line",
                         "measure it with mpirun -np 2 catena bench network --json network.json, "
                         "then add --network network.json; or give --latency and --bandwidth");
    return request;
}

/// Returns the request of `catena run`.
RunRequest run_request(Words const& words) {
    auto request = scene_request<RunRequest>(words, "run");
    if (!words.steps.empty()) request.steps = whole_number("--steps", words.steps, 0);
    request.output = words.output;
    request.restart = words.restart;
    request.overwrite = words.overwrite;
    request.branch = words.branch;
    if (request.branch && (request.restart.empty() || request.output.empty()))
        throw InputError(
            "--branch without --restart or --output", "command line",
            "name the checkpoint with --restart and a folder of the branch's own with --output");
    if (request.overwrite && !request.restart.empty())
        throw InputError("both --overwrite and --restart", "command line",
                         "a restart continues the existing run: leave --overwrite out");
    return request;
}

/// Throws InputError for options that contradict --suite, which has its own chains and measures no
/// times.
void refuse_with_suite(Words const& words) {
    for (auto const& [option, given] : {std::pair{"--set", !words.common.set.empty()},
                                        {"--repeat", !words.repeat.empty()},
                                        {"--threads", !words.common.threads.empty()},
                                        {"--gpu-levels", !words.common.gpu_levels.empty()}})
        if (given)
            throw InputError("both --suite and " + std::string(option), "command line",
                             "the suite has its own chains, and its errors depend neither on "
                             "threads nor on repetition: leave it out");
}

/// Reads the list of --sizes.
std::vector<std::int64_t> sizes_of(Words const& words) {
    std::vector<std::int64_t> sizes;
    if (!words.sizes.empty())
        for (std::string const& size : comma_list("--sizes", words.sizes))
            sizes.push_back(whole_number("--sizes", size, 1, 1000000000));
    return sizes;
}

/// Returns the request of `catena report`.
ReportRequest report_request(Words const& words) {
    ReportRequest request;
    static_cast<CommonOptions&>(request) = checked(words.common);
    request.scenes = words.scenes;
    request.quick = words.quick;
    if (!words.suite.empty()) request.suite = known_value("--suite", words.suite, suite_names);
    if (!request.suite.empty() && !request.scenes.empty())
        throw InputError("both --suite and a scene", "command line",
                         "the suite has its own chains: leave the scene out");
    if (!request.suite.empty()) refuse_with_suite(words);
    for (auto const& [option, given] :
         {std::pair{"--sizes", words.sizes}, {"--cases", words.cases}})
        if (request.suite.empty() && !given.empty())
            throw InputError(option + std::string(" without --suite"), "command line",
                             "write --suite stability, or leave it out");
    if (!words.cases.empty()) request.cases = comma_list("--cases", words.cases);
    request.sizes = sizes_of(words);
    if (!words.output.empty()) request.output = words.output;
    request.repeat = repeat_of(words, request.quick ? 3 : request.repeat);
    return request;
}

/// Returns the request of `catena bench`.
BenchRequest bench_request(Words const& words) {
    BenchRequest request;
    static_cast<CommonOptions&>(request) = checked(words.common);
    if (words.name.empty())
        throw InputError("no benchmark is named", "command line", "write catena bench list");
    if (words.name == later_bench) throw not_in_this_version("catena bench " + words.name);
    request.name = known_value("catena bench", words.name, bench_names);
    using Given = std::pair<char const*, std::string const&>;
    std::string const alike = words.alike ? "yes" : "";
    for (auto const& [option, given] :
         {Given{"--figure", words.figures}, Given{"--output", words.output},
          Given{"--joints", words.joints}, Given{"--sizes", words.sizes},
          Given{"--repeat", words.repeat}, Given{"--loads", words.loads}, Given{"--alike", alike}})
        if (!given.empty() && !bench_takes(request.name, option))
            throw InputError(
                fmt::format("catena bench {1} does not take {0}", option, request.name),
                "command line", "leave it out");
    request.sizes = bench_sizes(request.name);
    if (request.name == "evaluation") request.joints = {"link", "spherical"};
    if (request.name == "plan")
        request.joints = {"link", "planar", "spherical", "universal", "revolute", "mixed"};
    if (!words.sizes.empty()) request.sizes = sizes_of(words);
    if (!words.joints.empty()) request.joints = comma_list("--joints", words.joints);
    for (std::string const& joint : request.joints) {
        known_value("--joints", joint, joint_names);
        if (words.alike && joint == "mixed")
            throw InputError("mixed joints cannot be alike", "--alike",
                             "leave out --alike or `mixed`");
    }
    if (!words.loads.empty()) request.loads = words.loads;
    request.alike = words.alike;
    known_value("--loads", request.loads, load_names);
    if (!words.backends.empty())
        for (std::string const& backend : comma_list("--backend", words.backends))
            request.backends.push_back(backend_named("--backend", backend));
    request.repeat = repeat_of(words, request.repeat);
    request.figures.assign(std::begin(figure_names), std::end(figure_names));
    if (!words.figures.empty()) request.figures = comma_list("--figure", words.figures);
    for (std::string const& figure : request.figures) known_value("--figure", figure, figure_names);
    request.output = words.output;
    request.sampling = sampling_options(words.sampling, request.name, request.json);
    return request;
}

/// Returns the request of `keys`.
KeysRequest keys_request(Words const& words) {
    KeysRequest request;
    static_cast<CommonOptions&>(request) = checked(words.common);
    request.name = words.key;
    return request;
}

/// Returns the request of a command.
Request request_of(std::string const& command, Words const& words) {
    if (command == "check") return scene_request<CheckRequest>(words, command);
    if (command == "plan") return plan_request(words);
    if (command == "run") return run_request(words);
    if (command == "report") return report_request(words);
    if (command == "bench") return bench_request(words);
    if (command == "keys") return keys_request(words);
    if (command == "analyse") return analyse_request(words.analyse, checked(words.common));
    if (command == "import") return import_request(words.import_, checked(words.common));
    if (command == "convert") return convert_request(words.analyse, checked(words.common));
    auto request = scene_request<SolveRequest>(words, "solve");
    request.accelerations = words.accelerations;
    request.repeat = repeat_of(words, request.repeat);
    return request;
}

/// Returns a request that prints a text.
Answer answer(std::string text) {
    Answer a;
    a.text = std::move(text);
    return a;
}

}  // namespace

Request parse_command_line(int argc, char const* const* argv) {
    CLI::App app{"Catena: motion of very long articulated chains by divide and conquer.", "catena"};
    Words words;
    for (int i = 0; i < argc; ++i)
        words.common.command_line += (i == 0 ? "" : " ") + std::string(argv[i]);
    bool version_asked = false;
    app.add_flag("--version", version_asked, "print version, compiler and what is in the build");
    app.footer(
        "catena COMMAND --help explains a command. Commands run in parallel with mpirun -np P "
        "catena ...\nExit status: 0 success; 1 the computation failed or is INVALID; 2 the input "
        "is wrong; 3 a run was stopped by a signal and can be continued.");
    add_commands(app, words);
    // Only one command is accepted, so that "catena bench solve" does not count as two.
    app.require_subcommand(0, 1);
    app.allow_extras();
    for (CLI::App* each : app.get_subcommands({})) each->allow_extras();
    try {
        app.parse(argc, argv);
    } catch (CLI::CallForHelp const&) {
        return answer(app.help());
    } catch (CLI::ParseError const& error) {
        throw InputError(one_line(error.what()), "command line", "see catena --help");
    }
    auto const chosen = app.get_subcommands();
    refuse_extras(app, chosen.empty() ? nullptr : chosen.front());
    if (!chosen.empty()) refuse_empty(*chosen.front());
    if (version_asked) return answer(version_text());
    if (chosen.empty())
        throw InputError("no command is named", "command line", "see catena --help");
    return request_of(chosen.front()->get_name(), words);
}

}  // namespace catena::command
