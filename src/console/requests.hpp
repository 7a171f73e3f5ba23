// What the user asked for, a struct a command.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

struct CommonOptions {
    std::vector<std::string> set;                                     // key.path=value
    std::string backend, gpu_levels, handles, simd, threads, refine;  // empty: the scene's
    std::string json;  // file; empty: none; "-": standard output, in the place of the text
    std::string log_level = "warn";
    bool quiet = false;
    std::string command_line;
};
/// --set and the options that stand for keys of `solver`, as the scene's reader takes them; the
/// options win.
std::vector<std::string> overrides_of(CommonOptions const&);

struct SceneOptions : CommonOptions {
    std::string scene;
};
struct CheckRequest : SceneOptions {};
struct PlanRequest : SceneOptions {  // the scene may be missing where the machine is calibrated
    bool explain = false, measure = false, calibrate = false;
    std::int64_t ranks = 0, hosts = 1;  // 0: no prediction
    std::string network;                // JSON of `bench network`; empty: none
    /// Of the link between hosts, in the place of the file's: both or neither.
    std::optional<double> latency, seconds_a_byte;
};
struct SolveRequest : SceneOptions {
    int repeat = 11;
    std::string accelerations;  // HDF5 file
};
struct RunRequest : SceneOptions {
    std::optional<std::int64_t> steps;
    std::string output;  // folder; empty: see output_folder()
    std::string restart;
    bool overwrite = false;
    bool branch = false;  // at the checkpoint, into a folder of its own
};
struct ReportRequest : CommonOptions {
    std::vector<std::string> scenes;  // empty: generated ones
    std::string suite;                // "stability"; empty: error against run time
    std::vector<std::int64_t> sizes;  // of the suite: coils and dills of these alone
    std::vector<std::string>
        cases;  // of the suite: those whose family holds one of these words; empty: all
    std::string output = "catena-report";
    int repeat = 11;
    bool quick = false;
};
/// Of `bench sampling`. Times in ps, of each copy.
struct SamplingOptions {
    std::string scene;  // empty: alpha-synuclein
    std::int64_t copies = 71;
    std::vector<std::string> methods{"rigid", "bonds", "constraints"};
    std::vector<double> steps{0.01};
    double duration = 1000, discard = 200, every = 1;
    double equilibration = 1000;  // before all rows
    double seconds = 0;           // at most, a row; 0: as many as it takes
};
struct BenchRequest : CommonOptions {
    std::string name;
    std::vector<std::int64_t> sizes;  // empty: the benchmark's own
    std::vector<std::string> joints{"link", "spherical", "revolute"};
    std::string loads = "wrenches";  // of solve, evaluation and peers, as random_scene()
    bool alike = false;              // of solve and evaluation: make_alike()
    std::vector<Backend> backends;   // empty: all of this build
    std::vector<std::string> figures;
    std::string output;  // folder, of figures and of overlap's pictures
    int repeat = 21;
    SamplingOptions sampling;
};
/// Bodies that a benchmark takes unless told otherwise; none: its own choice.
std::vector<std::int64_t> bench_sizes(std::string const& name);
/// Whether --figure, --output, --joints, --sizes or --repeat is anything to it.
bool bench_takes(std::string const& name, std::string const& option);
/// --help and --version.
struct Answer : CommonOptions {
    std::string text;
};

using Request = std::variant<Answer, CheckRequest, PlanRequest, SolveRequest, RunRequest,
                             ReportRequest, BenchRequest>;

}  // namespace catena::command
