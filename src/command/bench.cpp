#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "command/commands.hpp"
#include "command/generated.hpp"
#include "command/text.hpp"
#include "command/version.hpp"
#include "dca/oracle/oracle.hpp"
#include "report/hardware.hpp"
#include "report/solver_errors.hpp"
#include "report/timing.hpp"

namespace catena::command {
namespace {

Outcome list() {
    Outcome outcome;
    outcome.text =
        "solve    matrix sweep, bias sweep and a whole evaluation of random chains, a body, for every backend of the processor (--backend "
        "cuda: the GPU's)\n";
    outcome.json = {{"benchmarks", {"solve"}}};
    return outcome;
}

/// The oracle's memory is many times the solver's.
constexpr std::int64_t most_bodies_of_oracle = 1000000;

/// Of the articulated-body oracle in double, on rank 0: seconds a body.
Spread time_oracle(Scene const& scene, int repeat) {
    std::vector<double> seconds;
    for (int i = 0; i <= repeat; ++i) {
        double const start = seconds_now();
        oracle::aba<double>(scene.chains.front(), {scene.forces.gravity, {}});
        if (i > 0) seconds.push_back(seconds_now() - start);  // the first one warms up
    }
    return spread_of(seconds);
}

struct Measured {
    std::string joint;
    std::int64_t bodies = 0;
    std::string backend;
    int threads = 1;
    Timing timing;
    double residual = 0, bound = 0;
    bool valid() const { return residual <= bound; }
    double a_body(Spread const& s) const { return 1e9 * s.median / static_cast<double>(bodies); }
};

Measured measure(Scene& scene, std::string const& joint, Backend backend, Communicator const& communicator, int repeat) {
    scene.solver.backend = backend;
    ChainSystem system(scene, Axes::joint, communicator);
    Measured m{joint, scene.bodies(), name_of(backend), system.executor().threads(), time_evaluations(system, repeat), 0, 0};
    m.residual = system.residual();
    m.bound = system.residual_bound();
    spdlog::info("{} {} {}: {:.3g} ns a body", joint, m.bodies, m.backend, m.a_body(m.timing.evaluation));
    return m;
}

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
            {"repeat", m.timing.evaluation.count},
            {"ns_per_body",
             {{"matrix_sweep", nanoseconds(m.timing.matrix_sweep)},
              {"bias_sweep", nanoseconds(m.timing.bias_sweep)},
              {"evaluation", nanoseconds(m.timing.evaluation)},
              {"aba_oracle", oracle.count > 0 ? nanoseconds(oracle) : Json(nullptr)}}},
            {"sweeps_an_evaluation", {{"matrix", m.timing.matrix_sweeps}, {"bias", m.timing.bias_sweeps}}},
            {"residual", m.residual},
            {"residual_bound", m.bound},
            {"valid", m.valid()}};
}

Outcome solve(Communicator const& communicator, BenchRequest const& request) {
    std::vector<Backend> const backends = request.backends.empty() ? cpu_backends() : request.backends;
    Table table(
        {"joint", "bodies", "backend", "threads", "matrix sweep", "bias sweep", "evaluation", "ABA oracle", "residual", "bound", ""},
        {0, 2, 10});
    Outcome outcome;
    outcome.json = {{"bench", "solve"},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", communicator.size()},
                    {"results", Json::array()}};
    for (std::string const& joint : request.joints)
        for (std::int64_t const bodies : request.sizes) {
            Scene scene = random_scene(joint, bodies, overrides_of(request));
            bool const with_oracle = communicator.rank() == 0 && scene.bodies() <= most_bodies_of_oracle;
            Spread const oracle = with_oracle ? time_oracle(scene, std::min(request.repeat, 5)) : Spread{};
            for (Backend const backend : backends) {
                Measured const m = measure(scene, joint, backend, communicator, request.repeat);
                outcome.valid = outcome.valid && m.valid();
                auto const ns = [&](Spread const& s) { return s.count > 0 ? fmt::format("{:.3g}", m.a_body(s)) : "-"; };
                table.add({joint, std::to_string(bodies), m.backend, std::to_string(m.threads), ns(m.timing.matrix_sweep),
                           ns(m.timing.bias_sweep), ns(m.timing.evaluation), ns(oracle), fmt::format("{:.1e}", m.residual),
                           fmt::format("{:.1e}", m.bound), m.valid() ? "VALID" : "INVALID"});
                outcome.json["results"].push_back(json_of(m, scene, oracle));
            }
        }
    outcome.json["valid"] = outcome.valid;
    outcome.text = fmt::format(
        "ns a body, median of {}; a whole evaluation holds kinematics and loads too. {}, {}; {}, "
        "{}\n",
        request.repeat, counted(communicator.size(), "rank", "ranks"), hardware_text(), compiler_name(), instruction_set());
    outcome.text += table.text();
    outcome.complaint = "a residual above its bound: see the results";
    return outcome;
}

}  // namespace

Outcome run_bench(Communicator const& communicator, BenchRequest const& request) {
    return request.name == "list" ? list() : solve(communicator, request);
}

}  // namespace catena::command
