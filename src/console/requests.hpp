// Requests of the user: one struct per command, filled from the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/analysis.hpp"
#include "analysis/xtc.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Options that every command has.
struct CommonOptions {
    /// Assignments of --set: key.path=value.
    std::vector<std::string> set;
    /// Values of the options for keys of `solver`; empty if the scene's values hold.
    std::string backend, gpu_levels, handles, simd, threads, refine;
    /// File of --json; empty for none, "-" for standard output instead of the text.
    std::string json;
    std::string log_level = "warn";
    bool quiet = false;
    std::string command_line;
};
/// Returns --set and the options for keys of `solver` as overrides for the scene's reader. The
/// options come last and win.
std::vector<std::string> overrides_of(CommonOptions const&);

/// Options of commands on one scene.
struct SceneOptions : CommonOptions {
    std::string scene;
};
/// Request of `catena check`.
struct CheckRequest : SceneOptions {
    /// SVG file of the domains that predictions decide; empty for none.
    std::string picture;
};
/// Request of `catena plan`. The scene may be missing if the machine is calibrated.
struct PlanRequest : SceneOptions {
    bool explain = false, measure = false, calibrate = false;
    /// Number of ranks to predict; 0 for no prediction.
    std::int64_t ranks = 0, hosts = 1;
    /// File with the JSON of `bench network`; empty for none.
    std::string network;
    /// Latency in s and s per byte of the link between hosts. They replace the file's values;
    /// either both are given or neither.
    std::optional<double> latency, seconds_a_byte;
};
/// Request of `catena solve`.
struct SolveRequest : SceneOptions {
    int repeat = 11;
    /// HDF5 file; empty for none.
    std::string accelerations;
};
/// Request of `catena run`.
struct RunRequest : SceneOptions {
    std::optional<std::int64_t> steps;
    /// Output folder; empty for the default (output_folder()).
    std::string output;
    std::string restart;
    bool overwrite = false;
    /// True if the run branches at the checkpoint into a folder of its own.
    bool branch = false;
};
/// Request of `catena report`.
struct ReportRequest : CommonOptions {
    /// Scene files; empty for generated scenes.
    std::vector<std::string> scenes;
    /// Name of the suite, "stability"; empty for error against run time.
    std::string suite;
    /// Sizes of coils and dills; the suite is restricted to these if not empty.
    std::vector<std::int64_t> sizes;
    /// Words of --cases: the suite is restricted to families with one of these words; empty for
    /// all.
    std::vector<std::string> cases;
    /// Output folder.
    std::string output = "catena-report";
    int repeat = 11;
    bool quick = false;
};
/// Options of `bench sampling`. Times are in ps and hold for each copy.
struct SamplingOptions {
    /// Scene file; empty for alpha-synuclein.
    std::string scene;
    std::int64_t copies = 71;
    /// True to sample all chains of the scene in their box instead of copies that never meet.
    bool dense = false;
    std::vector<std::string> methods{"rigid", "bonds", "constraints"};
    std::vector<double> steps{0.01};
    double duration = 1000, discard = 200, every = 1;
    /// Time before all rows.
    double equilibration = 1000;
    /// Limit in s for each row; 0 for no limit.
    double seconds = 0;
};
/// Request of `catena bench`.
struct BenchRequest : CommonOptions {
    std::string name;
    /// Numbers of bodies; empty if the benchmark chooses them.
    std::vector<std::int64_t> sizes;
    std::vector<std::string> joints{"link", "spherical", "revolute"};
    /// Loads of solve, evaluation and peers, as for random_scene().
    std::string loads = "wrenches";
    /// True if solve and evaluation make all bodies alike (make_alike()).
    bool alike = false;
    /// Backends to measure; empty for all of this build.
    std::vector<Backend> backends;
    std::vector<std::string> figures;
    /// Folder for figures, and for the pictures of overlap.
    std::string output;
    int repeat = 21;
    SamplingOptions sampling;
};
/// A request of `analyse`.
struct AnalyseRequest : CommonOptions {
    std::string folder;  // of a run, or its trajectory
    std::string output;  // folder; empty: `analysis` in the run's folder
    analysis::Options options;
    /// True if the members of complexes are chains of their own.
    bool members = false;
};
/// A request of `convert`.
struct ConvertRequest : CommonOptions {
    std::string folder;  // of a run, or its trajectory
    analysis::ChosenFrames frames;
    /// True for an XTC file, false for a DCD file.
    bool xtc = false;
    /// Positions per nm of an XTC file.
    double precision = analysis::usual_precision;
};
/// A request of `import`.
struct ImportRequest : CommonOptions {
    std::string source;    // folder or serialised System
    std::string topology;  // PDB, mmCIF or State; empty: that of the folder
    std::string output;    // scene; empty: the System's name in the working folder
    /// Forces of the System to leave out, and links in the place of custom bonds (nm).
    std::vector<std::string> leave_out;
    std::vector<std::pair<std::string, double>> links;
    bool overwrite = false;
};
/// Returns the default numbers of bodies of a benchmark; empty if it chooses them itself.
std::vector<std::int64_t> bench_sizes(std::string const& name);
/// True if the benchmark has the option --figure, --output, --joints, --alike, --loads, --sizes or
/// --repeat.
bool bench_takes(std::string const& name, std::string const& option);
/// Options of `keys`, which prints the keys that a scene may have.
struct KeysRequest : CommonOptions {
    std::string name;  // name of a map or a key; empty: all maps
};
/// The text that answers --help or --version.
struct Answer : CommonOptions {
    std::string text;
};

using Request =
    std::variant<Answer, CheckRequest, PlanRequest, SolveRequest, RunRequest, ReportRequest,
                 BenchRequest, KeysRequest, AnalyseRequest, ConvertRequest, ImportRequest>;

}  // namespace catena::command
