// Implements `bench openmm` and `bench overlap`. The first compares Catena's steps with OpenMM's
// own on the same beads in the same run; the second measures what overlap with the forces saves.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "bench/benchmarks.hpp"
#include "bench/generated.hpp"
#include "bench/step_makers.hpp"
#include "console/text.hpp"
#include "io/output_file.hpp"
#include "measure/hardware.hpp"
#include "measure/timing.hpp"
#include "page/html.hpp"
#include "page/timeline_picture.hpp"
#include "report/version.hpp"
#include "run/rank_exchange.hpp"

namespace catena::command {
namespace {

/// Largest number of constraints that is tried in this process. OpenMM's set-up of more has taken
/// over a minute without an end, so these run in a process that can be stopped.
constexpr std::int64_t most_constraints_unguarded = 200000;
constexpr std::chrono::seconds patience{30};
constexpr double openmm_block_seconds = 0.1, longest_block = 4;
/// Seconds per step from which two steps are enough to warm up.
constexpr double slow_seconds = 1;
/// Number of steps whose phases are recorded; the median one is drawn.
constexpr int timed_steps = 3;

/// A function that makes steps, and its seconds per step, block by block.
struct Runner {
    std::function<void(int)> step;
    int of_block = 1;
    /// Number of steps after which all periodic work has been done once. A block contains a period
    /// if that does not take too long.
    int period = 1;
    std::vector<double> seconds = {};

    void warm_up() {
        // The first step builds what is built on demand.
        step(1);
        double const begin = seconds_now();
        step(1);
        if (seconds_now() - begin > slow_seconds) return;
        step(1);
        double const start = seconds_now();
        step(3);
        double const one = (seconds_now() - start) / 3;
        of_block = static_cast<int>(std::clamp(openmm_block_seconds / one, 1.0, 1000.0));
        if (period * one < longest_block) of_block = std::max(of_block, period);
        step(std::min(of_block, 40));
    }
    void block() {
        double const start = seconds_now();
        step(of_block);
        seconds.push_back((seconds_now() - start) / of_block);
    }
};

/// Returns the number of steps after which the order of the particles on a GPU is renewed.
int period_of(ChainSystem const& system) { return system.openmm()->path() == "device" ? 1000 : 1; }

/// Runs the blocks of all runners in turn.
void take_turns(std::vector<Runner*> const& runners, int blocks) {
    for (int b = 0; b < blocks; ++b)
        for (Runner* runner : runners) runner->block();
}

/// Returns a condensate of about this many beads with the requested options.
Scene scene_for(std::int64_t beads, BenchRequest const& request, Backend backend) {
    Scene scene = condensate_scene(beads, overrides_of(request));
    scene.solver.backend = backend;
    return scene;
}

/// Result of a run of OpenMM's own integrator.
struct OwnFound {
    double seconds = NAN, energy = NAN, link_error = NAN;
    /// Reason of a failure; empty if there was none.
    char failure[200] = {};
    void fail(std::string const& text) { text.copy(failure, sizeof(failure) - 1); }
};

/// Tries steps with this many constraints in a process of its own. It must be called before this
/// process uses a GPU. Returns the result or the failure.
OwnFound try_constraints(std::int64_t beads, BenchRequest const& request,
                         Communicator const& communicator) {
    OwnFound found;
    int ends[2];
    if (::pipe(ends) != 0) return found;
    pid_t const child = ::fork();
    if (child == 0) {
        try {
            Scene scene = scene_for(beads, request, Backend::segments);
            scene.forces.openmm->platform = "CPU";
            ChainSystem system(scene, Axes::world, communicator);
            scene.forces.openmm->platform = "CUDA";
            auto own = make_openmm_integrator(*scene.forces.openmm, system.beads(), communicator,
                                              OwnLinks::constraints, own_run(scene, Backend::cuda),
                                              system.snapshot().position);
            own->step(2);
            double const start = seconds_now();
            own->step(10);
            found = {(seconds_now() - start) / 10, own->energy(), own->link_error(), {}};
        } catch (std::exception const& e) {
            found.fail(e.what());
        }
        bool const written = ::write(ends[1], &found, sizeof(found)) == sizeof(found);
        ::_exit(written ? 0 : 1);
    }
    ::close(ends[1]);
    auto const deadline = std::chrono::steady_clock::now() + patience;
    int status = 0;
    pid_t ended = 0;
    while (child > 0 && (ended = ::waitpid(child, &status, WNOHANG)) == 0 &&
           std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (child > 0 && ended == 0) {
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
        found.fail(fmt::format("no step within {} s, packing included", patience.count()));
    } else if (::read(ends[0], &found, sizeof(found)) != sizeof(found)) {
        found.fail("the process ended without a result");
    }
    ::close(ends[0]);
    return found;
}

/// Converts seconds of blocks to JSON.
Json json_of(std::vector<double> const& seconds) {
    Spread const s = spread_of(seconds);
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"blocks", s.count}};
}

double median(std::vector<double> const& seconds) { return spread_of(seconds).median; }

/// Measures the share of the matrix sweeps that ran while forces were computed.
class Hidden {
  public:
    explicit Hidden(ChainSystem const& system)
        : system_(system),
          matrix_(system.matrix_seconds()),
          hidden_(system.hidden_seconds()),
          forces_(forces_of(system)) {}
    double share() const {
        double const matrix = system_.matrix_seconds() - matrix_;
        return matrix > 0 ? (system_.hidden_seconds() - hidden_) / matrix : 0.0;
    }

    double matrix() const { return system_.matrix_seconds() - matrix_; }
    double forces() const { return forces_of(system_) - forces_; }

  private:
    static double forces_of(ChainSystem const& system) {
        auto const found = system.seconds().find("forces");
        return found == system.seconds().end() ? 0.0 : found->second;
    }
    ChainSystem const& system_;
    double matrix_, hidden_, forces_;
};

/// Formats a share in percent.
std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }
std::string step_text(double seconds) {
    return std::isfinite(seconds) ? duration_text(seconds) : "-";
}
std::string ratio_text(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.2f}", ratio) : "-";
}

/// OpenMM with one kind of links, run in turn with Catena. A failure is a result, not an error.
struct Rival {
    OwnLinks links;
    std::unique_ptr<OpenMmIntegrator> own = nullptr;
    Runner runner = {};
    OwnFound found = {};

    void make(CatenaSteps& catena, Communicator const& communicator, Backend backend,
              std::vector<Vec3> const& positions) {
        try {
            own = make_openmm_integrator(*catena.scene().forces.openmm, catena.system().beads(),
                                         communicator, links, own_run(catena.scene(), backend),
                                         positions);
            runner.step = [this](int count) { own->step(count); };
            runner.period = period_of(catena.system());
            runner.warm_up();
        } catch (std::exception const& e) {
            found.fail(e.what());
            own.reset();
        }
    }
    void block() {
        if (!own) return;
        try {
            runner.block();
        } catch (std::exception const& e) {
            found.fail(e.what());
            own.reset();
        }
    }
    void conclude() {
        if (!own) return;
        found.seconds = median(runner.seconds);
        found.energy = own->energy();
        found.link_error = own->link_error();
    }
};

/// Result of one comparison as JSON and as a row of the table.
struct SideBySide {
    Json json;
    std::vector<std::string> row;
    bool valid = false;
};

/// Runs Catena and OpenMM in turn on the same beads.
SideBySide compare(std::int64_t beads, BenchRequest const& request,
                   Communicator const& communicator, Backend backend,
                   std::optional<OwnFound> const& constrained_before) {
    CatenaSteps catena(scene_for(beads, request, backend), communicator);
    ChainSystem& system = catena.system();
    std::vector<Vec3> const start = system.snapshot().position;
    Runner own{[&](int count) { catena.step(count); }};
    own.period = period_of(system);
    own.warm_up();
    catena.adapt();
    Rival bonds{OwnLinks::bonds}, constraints{OwnLinks::constraints};
    bonds.make(catena, communicator, backend, start);
    if (!constrained_before) constraints.make(catena, communicator, backend, start);
    Hidden const hidden(system);
    for (int b = 0; b < request.repeat; ++b) {
        own.block();
        bonds.block();
        constraints.block();
    }
    bonds.conclude();
    constraints.conclude();
    if (constrained_before) constraints.found = *constrained_before;
    double const steps = static_cast<double>(own.of_block) * request.repeat;
    double const step = median(own.seconds), energy = catena.energy();
    double const to_bonds = step / bonds.found.seconds,
                 to_constraints = constraints.found.seconds / step;

    SideBySide r;
    auto const finite = [](OwnFound const& found) {
        return found.failure[0] != 0 || std::isfinite(found.energy);
    };
    r.valid = catena.constraint_error() <= catena.tolerance() && std::isfinite(energy) &&
              finite(bonds.found) && finite(constraints.found);
    auto const rival_json = [](Rival const& rival) {
        Json json{{"seconds_per_step", json_of(rival.runner.seconds)},
                  {"energy", rival.found.energy},
                  {"link_error", rival.found.link_error}};
        if (rival.runner.seconds.empty())
            json["seconds_per_step"] = {{"median", rival.found.seconds}};
        if (rival.found.failure[0] != 0) json["failure"] = std::string(rival.found.failure);
        return json;
    };
    r.json = {{"beads", beads},
              {"chains", catena.scene().chains.size()},
              {"backend", name_of(system.backend())},
              {"platform", system.openmm()->platform()},
              {"path", system.openmm()->path()},
              {"contexts", system.openmm()->contexts()},
              {"catena",
               {{"seconds_per_step", json_of(own.seconds)},
                {"energy", energy},
                {"constraint_error", catena.constraint_error()},
                {"constraint_tolerance", catena.tolerance()},
                {"forces_seconds_per_step", hidden.forces() / steps},
                {"matrix_sweep_seconds_per_step", hidden.matrix() / steps},
                {"matrix_sweep_hidden", hidden.share()}}},
              {"openmm_harmonic", rival_json(bonds)},
              {"openmm_constrained", rival_json(constraints)},
              {"catena_over_harmonic", to_bonds},
              {"constrained_over_catena", to_constraints},
              {"valid", r.valid}};
    r.row = {std::to_string(beads),
             system.openmm()->path(),
             step_text(step),
             step_text(bonds.found.seconds),
             ratio_text(to_bonds),
             step_text(constraints.found.seconds),
             ratio_text(to_constraints),
             percent(hidden.share()),
             fmt::format("{:.1e}", catena.constraint_error()),
             r.valid ? "VALID" : "INVALID"};
    if (bonds.found.failure[0] != 0)
        spdlog::warn("{} beads, OpenMM with bonds: {}", beads, bonds.found.failure);
    if (constraints.found.failure[0] != 0)
        spdlog::warn("{} beads, OpenMM with constraints: {}", beads, constraints.found.failure);
    return r;
}

/// Returns the head of a benchmark's JSON.
Json head(char const* name) {
    return {{"bench", name},
            {"build", version_json()},
            {"hardware", hardware_json()},
            {"results", Json::array()}};
}

/// Returns the numbers of beads in whole chains.
std::vector<std::int64_t> sizes_of(BenchRequest const& request,
                                   std::vector<std::int64_t> const& usual) {
    std::vector<std::int64_t> sizes;
    for (std::int64_t const size : request.sizes.empty() ? usual : request.sizes)
        sizes.push_back(beads_of_condensate(size));
    return sizes;
}

/// Writes the phases of steps as a page, in the manner of the DCA chapter's Fig. 2.7.
void write_pictures(std::string const& folder, std::string const& pictures) {
    std::string const intro =
        "<h1>Work that runs during the forces</h1>\n<p>" + escaped(hardware_text()) + "</p>\n";
    write_text_file(folder + "/overlap.html", html_page("Catena: overlap", intro + pictures));
}

}  // namespace

Outcome bench_openmm(Communicator const& communicator, BenchRequest const& request) {
    need_one_rank(communicator, "openmm");
    auto const sizes = sizes_of(request, {140, 9940, 99960, 1000020});
    std::vector<std::optional<OwnFound>> guarded;
    // This must come before anything here uses the GPU.
    for (std::int64_t const beads : sizes)
        guarded.push_back(beads > most_constraints_unguarded
                              ? std::optional(try_constraints(beads, request, communicator))
                              : std::nullopt);
    Table table({"beads", "path", "Catena", "bonds", "ratio", "constraints", "speed-up",
                 "sweep hidden", "constraint error", ""},
                {1, 9});
    Outcome outcome;
    outcome.json = head("openmm");
    std::string failures;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        SideBySide const r =
            compare(sizes[i], request, communicator, backend_of(request), guarded[i]);
        outcome.valid = outcome.valid && r.valid;
        outcome.json["results"].push_back(r.json);
        table.add(r.row);
        for (char const* const rival : {"openmm_harmonic", "openmm_constrained"})
            if (r.json[rival].contains("failure"))
                failures += fmt::format("  {} beads, {}: {}\n", sizes[i], rival,
                                        r.json[rival]["failure"].get<std::string>());
    }
    outcome.json["valid"] = outcome.valid;
    outcome.text = fmt::format(
        "One step of 10 fs, alpha-synuclein at 330 mg/ml, median of {} blocks in turn: Catena's "
        "g-BAOAB on rigid links, {}'s own "
        "LangevinMiddle with harmonic bonds and with constraints. ratio: Catena to bonds; "
        "speed-up: constraints to Catena. {}\n",
        request.repeat, openmm_version(), hardware_text());
    outcome.text += table.text() + failures;
    outcome.complaint =
        "a constraint error above its tolerance, or an energy that is not finite: see the results";
    return outcome;
}

Outcome bench_overlap(Communicator const& communicator, BenchRequest const& request) {
    need_one_rank(communicator, "overlap");
    if (!request.output.empty()) make_output_folder(request.output);
    Table table({"beads", "backend", "platform", "path", "overlap off", "on", "matrix sweep",
                 "hidden", "gain", "at most", "constraint error", ""},
                {1, 2, 3, 11});
    Outcome outcome;
    std::string pictures;
    outcome.json = head("overlap");
    for (std::int64_t const beads : sizes_of(request, {9940, 99960, 1000020})) {
        Scene scene = scene_for(beads, request, backend_of(request));
        OpenMmSpec& openmm = *scene.forces.openmm;
        if (openmm.path == "auto") openmm.path = "host";
        if (openmm.path == "host" && openmm.platform.empty()) openmm.platform = "CPU";
        openmm.overlap = false;
        CatenaSteps off(scene, communicator);
        openmm.overlap = true;
        CatenaSteps on(std::move(scene), communicator);
        Runner without{[&](int count) { off.step(count); }},
            with{[&](int count) { on.step(count); }};
        without.warm_up();
        with.warm_up();
        off.adapt();
        on.adapt();
        Hidden const hidden(on.system());
        take_turns({&without, &with}, request.repeat);
        double const error = larger(off.constraint_error(), on.constraint_error());
        bool const valid =
            error <= on.tolerance() && std::isfinite(off.energy()) && std::isfinite(on.energy());
        double const a = median(without.seconds), b = median(with.seconds);
        outcome.valid = outcome.valid && valid;
        double const sweep =
            hidden.matrix() / (static_cast<double>(with.of_block) * request.repeat);
        if (!request.output.empty())
            for (CatenaSteps* steps : {&off, &on}) {
                Json const timeline(gather_timelines(communicator, steps->timelines(timed_steps)));
                pictures += fmt::format("<h2>{} beads, overlap {}</h2>\n", beads,
                                        steps == &off ? "off" : "on") +
                            timeline_picture(timeline);
            }
        outcome.json["results"].push_back(
            {{"beads", beads},
             {"backend", name_of(on.system().backend())},
             {"platform", on.system().openmm()->platform()},
             {"path", on.system().openmm()->path()},
             {"seconds_per_step",
              {{"overlap_off", json_of(without.seconds)}, {"overlap_on", json_of(with.seconds)}}},
             {"gain", 1 - b / a},
             {"largest_gain", sweep / a},
             {"matrix_sweep_seconds_per_step", sweep},
             {"matrix_sweep_hidden", hidden.share()},
             {"constraint_error", error},
             {"valid", valid}});
        table.add({std::to_string(beads), name_of(on.system().backend()),
                   on.system().openmm()->platform(), on.system().openmm()->path(), step_text(a),
                   step_text(b), step_text(sweep), percent(hidden.share()), percent(1 - b / a),
                   fmt::format("{:.2g} %", 100 * sweep / a), fmt::format("{:.1e}", error),
                   valid ? "VALID" : "INVALID"});
    }
    outcome.json["valid"] = outcome.valid;
    if (!request.output.empty()) write_pictures(request.output, pictures);
    outcome.text = fmt::format(
        "One step of 10 fs, forces by {}, median of {} blocks in turn; a gain above \"at most\" "
        "(the matrix sweep's share of a step) is noise of the forces' times. {}\n",
        openmm_version(), request.repeat, hardware_text());
    outcome.text += table.text();
    outcome.complaint =
        "a constraint error above its tolerance, or an energy that is not finite: see the results";
    return outcome;
}

}  // namespace catena::command
