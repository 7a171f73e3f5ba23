// Implements `bench solve`, `bench evaluation`, `bench list` and the choice of a benchmark.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "bench/benchmarks.hpp"
#include "bench/generated.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "measure/hardware.hpp"
#include "measure/solver_errors.hpp"
#include "measure/timing.hpp"
#include "oracle/oracle.hpp"
#include "report/figures.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Lists the benchmarks.
Outcome list() {
    Outcome outcome;
    outcome.text =
        "solve       matrix sweep, bias sweep and whole evaluation of random chains, time per\n"
        "            body, for every backend of the processor (--backend cuda: of the GPU)\n"
        "evaluation  many evaluations of random chains in a row with inputs and outputs in\n"
        "            place (cuda on one rank: as one graph); links and spherical joints: the\n"
        "            solver alone in absolute coordinates, its memory traffic and the resulting\n"
        "            lower bound of the time; other joints: with kinematics, loads and rates\n"
        "peers       forward dynamics of random chains compared with Pinocchio, Simbody and\n"
        "            MuJoCo, and where each of them stops\n"
        "openmm      time per step of proteins at 330 mg/ml compared with OpenMM's own\n"
        "            integrator, with harmonic bonds and with constraints\n"
        "sampling    what alpha-synuclein, or the chain of a scene, samples on rigid links,\n"
        "            harmonic bonds and constraints at several time steps: size,\n"
        "            configurational temperature, the largest usable step of each and its\n"
        "            ns/day\n"
        "overlap     time per step with forces through the host, with and without the matrix\n"
        "            sweep running meanwhile\n"
        "figures     Table 2.1 and Figures 2.3, 2.5, 2.6 and 2.7 of the DCA chapter\n"
        "            (src/dca/README.md) on this machine, compared with the chapter's numbers\n"
        "            (--figure, --output)\n"
        "network     latency and bandwidth between ranks, and the solver's own gathers; catena\n"
        "            plan --network reads the JSON of --json\n"
        "plan        predictions of the planner compared with measured evaluations, and its\n"
        "            choices compared with the best ones\n";
    outcome.json = {{"benchmarks",
                     {"evaluation", "solve", "peers", "openmm", "sampling", "overlap", "figures",
                      "network", "plan"}}};
    return outcome;
}

/// Largest number of bodies for the oracle, whose memory is many times the solver's.
constexpr std::int64_t most_bodies_of_oracle = 1000000;

/// Returns the seconds of the articulated-body oracle in double precision on rank 0.
Spread time_oracle(Scene const& scene, int repeat) {
    std::vector<double> seconds;
    for (int i = 0; i <= repeat; ++i) {
        double const start = seconds_now();
        oracle::aba<double>(scene.chains.front(), {scene.forces.gravity, {}});
        // The first evaluation warms up and is not counted.
        if (i > 0) seconds.push_back(seconds_now() - start);
    }
    return spread_of(seconds);
}

/// Times and residual of one backend on one chain.
struct Measured {
    std::string joint;
    std::int64_t bodies = 0;
    std::string backend;
    int threads = 1;
    SimdLevel simd = SimdLevel::off;
    Timing timing;
    double residual = 0, bound = 0;
    bool valid() const { return residual <= bound; }
    /// Median time in ns per body.
    double a_body(Spread const& s) const { return 1e9 * s.median / static_cast<double>(bodies); }
};

/// Measures one backend. Collective.
Measured measure(Scene& scene, std::string const& joint, Backend backend,
                 Communicator const& communicator, int repeat) {
    scene.solver.backend = backend;
    ChainSystem system(scene, Axes::joint, communicator);
    Executor const& executor = system.executor();
    Measured m{joint,
               scene.bodies(),
               name_of(backend),
               executor.threads(),
               executor.simd(),
               time_evaluations(system, repeat),
               0,
               0};
    m.residual = system.residual();
    m.bound = system.residual_bound();
    spdlog::info("{} {} {}: {:.3g} ns per body", joint, m.bodies, m.backend,
                 m.a_body(m.timing.evaluation));
    return m;
}

/// Converts a measurement to JSON.
Json json_of(Measured const& m, Scene const& scene, Spread const& oracle) {
    auto const nanoseconds = [&](Spread const& s) {
        double const scale = 1e9 / static_cast<double>(m.bodies);
        return Json{{"median", scale * s.median}, {"min", scale * s.min}, {"max", scale * s.max}};
    };
    return {{"joint", m.joint},
            {"bodies", m.bodies},
            {"backend", m.backend},
            {"handles", name_of(scene.solver.handles)},
            {"threads", m.threads},
            {"simd", name_of(m.simd)},
            {"repeat", m.timing.evaluation.count},
            {"ns_per_body",
             {{"matrix_sweep", nanoseconds(m.timing.matrix_sweep)},
              {"bias_sweep", nanoseconds(m.timing.bias_sweep)},
              {"evaluation", nanoseconds(m.timing.evaluation)},
              {"aba_oracle", oracle.count > 0 ? nanoseconds(oracle) : Json(nullptr)}}},
            {"sweeps_an_evaluation",
             {{"matrix", m.timing.matrix_sweeps}, {"bias", m.timing.bias_sweeps}}},
            {"residual", m.residual},
            {"residual_bound", m.bound},
            {"valid", m.valid()}};
}

/// Returns an outcome with build, hardware and an empty list of results.
Outcome begun(std::string const& name, Communicator const& communicator) {
    Outcome outcome;
    outcome.json = {{"bench", name},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", communicator.size()},
                    {"results", Json::array()}};
    return outcome;
}
/// Completes an outcome with its text. `what` explains the numbers of the table.
Outcome ended(Outcome outcome, std::string const& what, Table const& table,
              Communicator const& communicator) {
    outcome.json["valid"] = outcome.valid;
    outcome.text =
        fmt::format("{}. {}, {}; {}, {}\n", what, counted(communicator.size(), "rank", "ranks"),
                    hardware_text(), compiler_name(), instruction_set());
    outcome.text += table.text();
    outcome.complaint = "a residual above its bound: see the results";
    return outcome;
}

/// Describes the loads of a benchmark.
std::string words_of(std::string const& loads) {
    if (loads == "none") return "; gravity only";
    return loads == "torques" ? "; gravity and joint torques"
                              : "; gravity, joint torques and a wrench on every body";
}

/// Measures sweeps and evaluations for all backends, joints and sizes.
Outcome solve(Communicator const& communicator, BenchRequest const& request) {
    std::vector<Backend> const backends =
        request.backends.empty() ? cpu_backends() : request.backends;
    Table table({"joint", "bodies", "backend", "threads", "matrix sweep", "bias sweep",
                 "evaluation", "ABA oracle", "residual", "bound", ""},
                {0, 2, 10});
    Outcome outcome = begun("solve", communicator);
    outcome.json["loads"] = request.loads;
    outcome.json["alike"] = request.alike;
    for (std::string const& joint : request.joints)
        for (std::int64_t const bodies : request.sizes) {
            Scene scene = random_scene(joint, bodies, overrides_of(request), request.loads);
            if (request.alike) make_alike(scene);
            bool const with_oracle =
                communicator.rank() == 0 && scene.bodies() <= most_bodies_of_oracle;
            Spread const oracle =
                with_oracle ? time_oracle(scene, std::min(request.repeat, 5)) : Spread{};
            for (Backend const backend : backends) {
                Measured const m = measure(scene, joint, backend, communicator, request.repeat);
                outcome.valid = outcome.valid && m.valid();
                auto const ns = [&](Spread const& s) {
                    return s.count > 0 ? fmt::format("{:.3g}", m.a_body(s)) : "-";
                };
                table.add({joint, std::to_string(bodies), m.backend, std::to_string(m.threads),
                           ns(m.timing.matrix_sweep), ns(m.timing.bias_sweep),
                           ns(m.timing.evaluation), ns(oracle), fmt::format("{:.1e}", m.residual),
                           fmt::format("{:.1e}", m.bound), m.valid() ? "VALID" : "INVALID"});
                outcome.json["results"].push_back(json_of(m, scene, oracle));
            }
        }
    std::string const what =
        fmt::format("ns per body, median of {}; an evaluation includes kinematics and loads{}",
                    request.repeat, words_of(request.loads));
    return ended(std::move(outcome), what, table, communicator);
}

/// Bytes per body that an evaluation must read and write, whatever the algorithm; 0 if unknown.
/// Links: mass, position, velocity, force; acceleration. Bodies on spherical joints: mass, inertia,
/// two handles, orientation, angular velocity, force, torque; two accelerations.
struct Traffic {
    double read = 0, write = 0;
};
/// Returns the traffic of a joint; constant data of alike bodies is not counted.
Traffic traffic_of(std::string const& joint, bool alike) {
    if (joint == "link") return {alike ? 72.0 : 80.0, 24};
    if (joint == "spherical") return {alike ? 104.0 : 208.0, 48};
    return {};
}
/// Returns the number of evaluations that are timed together, so that short disturbances average
/// out.
int chained_for(std::int64_t bodies) { return bodies < 100000 ? 50 : bodies < 2000000 ? 10 : 2; }

/// Time of a whole evaluation, and its residual.
struct AtOnce {
    Spread seconds;
    double residual = 0, bound = 0;
    int threads = 1;
    SimdLevel simd = SimdLevel::off;
    bool direct_exchange = false;
};
/// True if the solver is measured alone, in absolute coordinates. Otherwise kinematics, loads and
/// the joints' rates are measured too.
bool is_absolute(std::string const& joint) { return joint == "link" || joint == "spherical"; }
/// Measures whole evaluations with inputs and outputs in place.
AtOnce time_at_once(Scene& scene, std::string const& joint, Backend backend,
                    Communicator const& communicator, int repeat) {
    scene.solver.backend = backend;
    ChainSystem system(scene, is_absolute(joint) ? Axes::world : Axes::joint, communicator);
    system.evaluate();
    system.evaluate(false);
    AtOnce found;
    found.residual = system.residual();
    found.bound = system.residual_bound();
    found.threads = system.executor().threads();
    found.simd = system.executor().simd();
    found.direct_exchange = system.solver_reports().front().direct_exchange;
    int const chained = chained_for(scene.bodies());
    found.seconds =
        spread_of(is_absolute(joint) ? system.absolute().front()->time_at_once(chained, repeat)
                                     : system.joint().front()->time_at_once(chained, repeat));
    return found;
}

/// Returns the backends that compute matrices and biases in one sweep. Throws InputError for
/// others.
std::vector<Backend> backends_at_once(BenchRequest const& request) {
    if (!request.handles.empty() && request.handles != name_of(Handles::projected))
        throw InputError(request.handles + " handles need separate matrix and bias sweeps",
                         "--handles", "use projected handles");
    std::vector<Backend> chosen = request.backends;
    if (chosen.empty()) {
        chosen = cpu_backends();
        std::erase(chosen, Backend::serial);
    }
    for (Backend const backend : chosen) {
        if (backend == Backend::serial || backend == Backend::cuda_levels)
            throw InputError(
                std::string(name_of(backend)) + " computes separate matrix and bias sweeps",
                "--backend", "use segments, openmp or cuda");
    }
    return chosen;
}

/// Measures whole evaluations for all backends, joints and sizes.
Outcome evaluation(Communicator const& communicator, BenchRequest const& request) {
    std::vector<Backend> const backends = backends_at_once(request);
    Table table({"joint", "bodies", "backend", "threads", "us", "ns per body", "GB/s", "floor/time",
                 "residual", "bound", ""},
                {0, 2, 10});
    Outcome outcome = begun("evaluation", communicator);
    outcome.json["loads"] = request.loads;
    outcome.json["alike"] = request.alike;
    for (std::string const& joint : request.joints)
        for (std::int64_t const bodies : request.sizes) {
            Scene scene = random_scene(joint, bodies, overrides_of(request), request.loads);
            if (request.alike) make_alike(scene);
            for (Backend const backend : backends) {
                AtOnce const found =
                    time_at_once(scene, joint, backend, communicator, request.repeat);
                bool const valid = found.residual <= found.bound;
                outcome.valid = outcome.valid && valid;
                auto const n = static_cast<double>(scene.bodies());
                Traffic const traffic = traffic_of(joint, request.alike);
                double const rate =
                    n * (traffic.read + traffic.write) / found.seconds.median * 1e-9;
                // The floor is two sweeps over the data at the bandwidth of an H200's memory, per
                // rank.
                double const floor = n / communicator.size() * (2 * traffic.read + traffic.write) /
                                     4.2e12 / found.seconds.median;
                bool const gpu = backend == Backend::cuda;
                table.add({joint, std::to_string(bodies), name_of(backend),
                           std::to_string(found.threads),
                           fmt::format("{:.4g}", 1e6 * found.seconds.median),
                           fmt::format("{:.3g}", 1e9 * found.seconds.median / n),
                           rate > 0 ? fmt::format("{:.0f}", rate) : "-",
                           gpu && rate > 0 ? fmt::format("{:.2f}", floor) : "-",
                           fmt::format("{:.1e}", found.residual),
                           fmt::format("{:.1e}", found.bound), valid ? "VALID" : "INVALID"});
                outcome.json["results"].push_back(
                    {{"joint", joint},
                     {"bodies", bodies},
                     {"backend", name_of(backend)},
                     {"threads", found.threads},
                     {"simd", name_of(found.simd)},
                     {"direct_exchange", found.direct_exchange},
                     {"chained", chained_for(bodies)},
                     {"repeat", found.seconds.count},
                     {"microseconds",
                      {{"median", 1e6 * found.seconds.median},
                       {"min", 1e6 * found.seconds.min},
                       {"max", 1e6 * found.seconds.max}}},
                     {"gigabytes_per_second", rate > 0 ? Json(rate) : Json(nullptr)},
                     {"floor_over_time", gpu && rate > 0 ? Json(floor) : Json(nullptr)},
                     {"residual", found.residual},
                     {"residual_bound", found.bound},
                     {"valid", valid}});
            }
        }
    std::string const what = fmt::format(
        "time of an evaluation with inputs and outputs in place, median of {}; links and spherical "
        "joints: the solver only, others: with kinematics, loads and rates{}; GB/s counts every "
        "input and output once; floor: two passes over the inputs at 4.2 TB/s",
        request.repeat, words_of(request.loads));
    return ended(std::move(outcome), what, table, communicator);
}

}  // namespace

Outcome run_bench(Communicator const& communicator, BenchRequest const& request) {
    if (request.handles == name_of(Handles::articulated) && request.name != "list")
        throw InputError("articulated handles are not measured by catena bench " + request.name,
                         "--handles", "use projected or full; `catena report` compares all three");
    if (request.name == "list") return list();
    if (request.name == "figures") return bench_figures(communicator, request);
    if (request.name == "network") return bench_network(communicator, request);
    if (request.name == "evaluation") return evaluation(communicator, request);
    if (request.name == "plan") return bench_plan(communicator, request);
    if (request.name == "peers") return bench_peers(communicator, request);
    if (request.name == "openmm") return bench_openmm(communicator, request);
    if (request.name == "sampling") return bench_sampling(communicator, request);
    return request.name == "overlap" ? bench_overlap(communicator, request)
                                     : solve(communicator, request);
}

}  // namespace catena::command
