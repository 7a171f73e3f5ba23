// What single-precision sweeps with refinement in double would gain: time a body and errors of both
// precisions, the same operators on the same chains, in turns in one run on one core. See --help.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "console/text.hpp"
#include "error.hpp"
#include "generate/generators.hpp"
#include "measure/hardware.hpp"
#include "measure/stability_cases.hpp"
#include "tests/bench/precision/study.hpp"

namespace catena::precision {
namespace {

using Json = nlohmann::ordered_json;
using command::Table;

constexpr std::uint64_t seed = 1;  // of all chains

struct Request {
    std::vector<std::string> joints{"link", "spherical", "revolute"};
    std::vector<double> sizes{256, 2048, 8192, 16384, 32768, 131072};
    int repeat = 11;
    std::int64_t longest = 4096;  // of hard chains
    bool quick = false;
    std::string json;
};

Scene scene_of(std::string const& joint, std::int64_t bodies) {
    scene::RandomChain kind;
    kind.bodies = bodies;
    kind.seed = seed;
    ChainSpec chain;
    chain.name = "random";
    if (joint == "link") {
        kind.joint = scene::RandomJoint::link;
        kind.base = chain.base = Base::free;
        chain.beads = scene::random_beads(kind);
    } else {
        kind.joint =
            joint == "spherical" ? scene::RandomJoint::spherical : scene::RandomJoint::revolute;
        kind.base = chain.base = Base::fixed;
        chain.bodies = scene::random_bodies(kind);
    }
    Scene scene;
    scene.si = true;
    scene.forces.gravity = {{0, 0, -9.81}};
    scene.chains.push_back(std::move(chain));
    return scene;
}

KernelTable table_of(SimdLevel level) {
    return level == SimdLevel::avx512 ? avx512_kernels()
           : level == SimdLevel::avx2 ? avx2_kernels()
                                      : scalar_kernels();
}

std::string exponent(double x) { return fmt::format("{:.0e}", x); }
std::string nanoseconds(double x) {
    return x < 100 ? fmt::format("{:.1f}", x) : fmt::format("{:.0f}", x);
}

constexpr char const* meaning =
    "  Over one evaluation in double. mixed: both sweeps in single precision and, a step of "
    "refinement, the residual in double and the "
    "bias\n"
    "  sweep in single; in half: were its sweeps to take half of double's time; bytes: were memory "
    "all that counts. steps, as needed: "
    "until\n"
    "  the error is at most twice that of double. over best: over the faster one of double and of "
    "the library's own evaluation, which "
    "keeps\n"
    "  no joints. States and loads in single precision are there: to write them is not counted.\n";

/// Over one evaluation in double.
struct Totals {
    std::vector<double> measured, halved, by_bytes;  // after 0, 1, ... steps
    std::vector<double> of_best;  // measured, over the faster one of double's and the library's
};
/// `halved`: were single-precision sweeps to take half of double precision's time; `by_bytes`: were
/// memory all that counts.
Totals totals_of(AllTimes const& t, ChainInArrays const& in_double,
                 ChainInArrays const& in_single) {
    Totals totals;
    double const sweeps = t.in_double.matrix + t.in_double.bias,
                 defect = std::min(t.in_double.defect, t.in_single.defect);
    for (int k = 0; k <= most_steps; ++k) {
        totals.measured.push_back(t.in_single.evaluation[static_cast<std::size_t>(k)] /
                                  t.in_double.evaluation[0]);
        totals.of_best.push_back(t.in_single.evaluation[static_cast<std::size_t>(k)] /
                                 std::min(t.in_double.evaluation[0], t.library));
        totals.halved.push_back((0.5 * sweeps + k * (defect + 0.5 * t.in_double.bias)) / sweeps);
        totals.by_bytes.push_back(
            (in_single.bytes_of_evaluation() + k * in_single.bytes_of_refinement()) /
            in_double.bytes_of_evaluation());
    }
    return totals;
}

/// To four digits.
double rounded(double x) { return std::strtod(fmt::format("{:.3e}", x).c_str(), nullptr); }
template <class Numbers>
Json rounded(Numbers const& numbers, double factor = 1) {
    Json list = Json::array();
    for (double const x : numbers) list.push_back(rounded(factor * x));
    return list;
}
Json json_of(Times const& t, std::int64_t bodies) {
    double const each = 1e9 / static_cast<double>(bodies);
    return {{"matrix_sweep_ns", rounded(each * t.matrix)},
            {"bias_sweep_ns", rounded(each * t.bias)},
            {"double_residual_ns", rounded(each * t.defect)},
            {"evaluation_ns_after_steps", rounded(t.evaluation, each)}};
}
Json json_of(Errors const& e) {
    if (!e.definite) return {{"definite", false}};
    return {{"definite", true},
            {"forward_error_after_steps", rounded(e.error)},
            {"residual_after_steps", rounded(e.residual)}};
}
Json json_of(std::optional<int> const& steps) { return steps ? Json(*steps) : Json(); }

class Study {
  public:
    explicit Study(Request const& request) : request_(request) {}
    /// Whether on all random chains double precision kept its bounds, and single precision came to
    /// its error within most_steps.
    bool valid() const { return valid_; }

    Json random_chains() {
        Json rows = Json::array();
        for (std::string const& joint : request_.joints)
            for (double const size : request_.sizes) {
                auto const bodies = static_cast<std::int64_t>(size);
                Problem const problem(scene_of(joint, bodies), 1);
                for (SimdLevel const level : simd_levels())
                    rows.push_back(random_chain(problem, joint, bodies, level));
                std::cout << "." << std::flush;
            }
        std::cout << "\n"
                  << times_.text() << "\n"
                  << totals_.text() << meaning << "\n"
                  << errors_.text() << std::endl;
        return rows;
    }
    Json hard_chains() {
        Json rows = Json::array();
        for (StabilityCase const& hard : stability_cases(request_.longest, request_.quick)) {
            Problem const problem(hard.scene(seed), 3);
            if (!problem.joint() || !problem.fits(1)) {
                ++left_out_;
                continue;
            }
            rows.push_back(hard_chain(problem, hard));
        }
        std::cout << hard_.text()
                  << fmt::format(
                         "  ({} cases of the suite are left out: planar chains and jointed tips)\n",
                         left_out_)
                  << std::endl;
        return rows;
    }
    int left_out() const { return left_out_; }

  private:
    Kernels kernels(KernelTable const& table, Problem const& problem, bool single) const {
        auto const joint = static_cast<int>(*problem.joint());
        return single ? table.in_single[joint] : table.in_double[joint];
    }
    /// Within the residual's bound, and the bound of the error that follows from it.
    static bool holds(Errors const& e, Problem const& problem) {
        return e.definite && e.residual[0] <= problem.residual_bound() &&
               e.error[0] <= problem.residual_bound() * problem.exact().growth;
    }

    Json random_chain(Problem const& problem, std::string const& joint, std::int64_t bodies,
                      SimdLevel level) {
        KernelTable const table = table_of(level);
        ChainInArrays in_double = problem.arrays(kernels(table, problem, false)),
                      in_single = problem.arrays(kernels(table, problem, true));
        Errors const wide = problem.errors(in_double), narrow = problem.errors(in_single);
        AllTimes const times =
            times_of(in_double, in_single, problem.library_evaluation(level), request_.repeat);
        Totals const totals = totals_of(times, in_double, in_single);
        auto const steps = steps_needed(wide, narrow);
        bool const good = holds(wide, problem) && steps;
        valid_ = valid_ && good;

        double const each = 1e9 / static_cast<double>(bodies);
        Times const &d = times.in_double, &s = times.in_single;
        std::vector<std::string> const name{joint, std::to_string(bodies), name_of(level)};
        auto const row = [&name](std::vector<std::string> const& values) {
            std::vector<std::string> all = name;
            all.insert(all.end(), values.begin(), values.end());
            return all;
        };
        times_.add(row(
            {nanoseconds(each * d.matrix), nanoseconds(each * s.matrix), nanoseconds(each * d.bias),
             nanoseconds(each * s.bias), nanoseconds(each * d.defect),
             nanoseconds(each * d.evaluation[0]), nanoseconds(each * s.evaluation[0]),
             fmt::format("{:.2f}", totals.measured[0]), nanoseconds(each * times.library)}));
        auto const at = [&](std::vector<double> const& ratios, int k) {
            return fmt::format("{:.2f}", ratios[static_cast<std::size_t>(k)]);
        };
        int const needed = steps.value_or(most_steps);
        totals_.add(row({steps ? std::to_string(*steps) : "> 3", at(totals.measured, 1),
                         at(totals.measured, 2), at(totals.halved, 1), at(totals.halved, 2),
                         at(totals.by_bytes, 1), at(totals.by_bytes, 2),
                         at(totals.measured, needed), at(totals.halved, needed),
                         at(totals.by_bytes, needed), at(totals.of_best, needed)}));
        errors_.add(row(errors_of(wide, narrow, good ? "VALID" : "INVALID")));
        return {{"joint", joint},
                {"bodies", bodies},
                {"vectors", name_of(level)},
                {"lanes_double", kernels(table, problem, false).lanes},
                {"lanes_single", kernels(table, problem, true).lanes},
                {"growth", rounded(problem.exact().growth)},
                {"residual_bound", problem.residual_bound()},
                {"double", {{"time", json_of(d, bodies)}, {"error", json_of(wide)}}},
                {"single", {{"time", json_of(s, bodies)}, {"error", json_of(narrow)}}},
                {"library_evaluation_ns", rounded(each * times.library)},
                {"steps_needed", json_of(steps)},
                {"over_double",
                 {{"measured_after_steps", rounded(totals.measured)},
                  {"measured_over_best_after_steps", rounded(totals.of_best)},
                  {"sweeps_in_half_the_time_after_steps", rounded(totals.halved)},
                  {"bytes_after_steps", rounded(totals.by_bytes)}}},
                {"valid", good}};
    }

    Json hard_chain(Problem const& problem, StabilityCase const& hard) {
        KernelTable const table = scalar_kernels();
        ChainInArrays in_double = problem.arrays(kernels(table, problem, false)),
                      in_single = problem.arrays(kernels(table, problem, true));
        Errors const wide = problem.errors(in_double), narrow = problem.errors(in_single);
        std::vector<std::string> row{hard.family, hard.name, exponent(problem.exact().growth)};
        auto const errors = errors_of(wide, narrow, outcome(wide, narrow));
        row.insert(row.end(), errors.begin(), errors.end());
        hard_.add(row);
        return {{"family", hard.family},           {"name", hard.name},
                {"bodies", hard.bodies},           {"growth", rounded(problem.exact().growth)},
                {"double", json_of(wide)},         {"single", json_of(narrow)},
                {"outcome", outcome(wide, narrow)}};
    }
    static std::vector<std::string> errors_of(Errors const& wide, Errors const& narrow,
                                              std::string const& last) {
        std::vector<std::string> row{wide.definite ? exponent(wide.error[0]) : "-",
                                     wide.definite ? exponent(wide.error[1]) : "-"};
        for (double const error : narrow.error)
            row.push_back(narrow.definite ? exponent(error) : "-");
        row.push_back(last);
        return row;
    }

    Request const& request_;
    bool valid_ = true;
    int left_out_ = 0;
    Table times_{{"joints", "bodies", "vectors", "matrix: double", "single", "bias: double",
                  "single", "residual", "both: double", "single", "ratio", "library"},
                 {0, 2}};
    Table totals_{{"joints", "bodies", "vectors", "steps", "mixed, 1 step", "2 steps", "in half, 1",
                   "2", "bytes, 1", "2", "as needed: mixed", "in half", "bytes", "over best"},
                  {0, 2}};
    Table errors_{{"joints", "bodies", "vectors", "double", "refined", "single", "1 step",
                   "2 steps", "3 steps", ""},
                  {0, 2, 9}};
    Table hard_{{"hard chains", "", "growth", "double", "refined", "single", "1 step", "2 steps",
                 "3 steps", ""},
                {0, 1, 9}};
};

void check(Request const& request) {
    for (std::string const& joint : request.joints)
        if (joint != "link" && joint != "spherical" && joint != "revolute")
            throw InputError("`" + joint + "` is not compared", "--joints",
                             "use link, spherical or revolute");
    for (double const size : request.sizes)
        if (!(size >= 256 && size <= 0x1p22) || std::exp2(std::ilogb(size)) != size)
            throw InputError(fmt::format("{} bodies", size), "--sizes",
                             "take powers of two from 256 to 4194304");
}

/// Rows of tables one a line.
void write(std::ostream& out, Json const& result) {
    char const* before = "{\n ";
    for (auto const& [key, value] : result.items()) {
        out << before << Json(key) << ": ";
        before = ",\n ";
        if (!value.is_array()) {
            out << value;
            continue;
        }
        for (std::size_t i = 0; i < value.size(); ++i)
            out << (i == 0 ? "[\n  " : ",\n  ") << value[i];
        out << "\n ]";
    }
    out << "\n}\n";
}

int run(Request const& request) {
    check(request);
    std::ofstream file;
    if (!request.json.empty()) {
        file.open(request.json);
        if (!file)
            throw InputError("this file cannot be written", "--json " + request.json,
                             "name another one");
    }
    std::cout << fmt::format(
        "{}, {}, {}; one core; seed {}; ns a body; errors of accelerations, relative to the "
        "largest\n",
        processor_name(), compiler_name(), instruction_set(), seed);
    Study study(request);
    Json const random = study.random_chains(), hard = study.hard_chains();
    Json const result{
        {"benchmark", "mixed precision"},
        {"hardware", {{"processor", processor_name()}, {"threads", processor_threads()}}},
        {"build", {{"compiler", compiler_name()}, {"instruction_set", instruction_set()}}},
        {"seed", seed},
        {"repeat", request.repeat},
        {"clock",
         "processor time, medians, nanoseconds a body; before each sample one that is not timed"},
        {"random_chains", random},
        {"hard_chains", hard},
        {"hard_chains_left_out", study.left_out()},
        {"valid", study.valid()}};
    if (file.is_open()) {
        write(file, result);
        if (!file.flush())
            throw ComputationError("the results cannot be written (" + request.json +
                                   "): is there room?");
    }
    std::cout << (study.valid() ? "VALID" : "INVALID") << "\n";
    return study.valid() ? 0 : 1;
}

}  // namespace
}  // namespace catena::precision

int main(int argc, char** argv) {
    catena::precision::Request request;
    CLI::App app{
        "Single-precision sweeps with refinement in double beside double precision: times and "
        "errors, in turns on one core"};
    app.add_option("--joints", request.joints, "link,spherical,revolute (default: all)")
        ->delimiter(',');
    app.add_option(
           "--sizes", request.sizes,
           "bodies of random chains, powers of two (default 256,2048,8192,16384,32768,131072)")
        ->delimiter(',');
    app.add_option("--repeat", request.repeat, "timed rounds (default 11)")
        ->check(CLI::Range(1, 10000));
    app.add_option("--longest", request.longest, "bodies of the longest hard chain (default 4096)")
        ->check(CLI::Range(16, 1 << 20));
    app.add_flag("--quick", request.quick, "every other hard chain");
    app.add_option("--json", request.json, "file to write");
    try {
        app.parse(argc, argv);
        return catena::precision::run(request);
    } catch (CLI::ParseError const& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (catena::InputError const& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 2;
    } catch (std::exception const& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
