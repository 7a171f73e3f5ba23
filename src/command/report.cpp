// Implements `catena report`.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "bench/peer_answers.hpp"
#include "command/commands.hpp"
#include "console/option_values.hpp"
#include "console/picture.hpp"
#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "force/openmm_force.hpp"
#include "io/output.hpp"
#include "measure/hardware.hpp"
#include "mpi/first_rank.hpp"
#include "report/report_parts.hpp"
#include "report/version.hpp"
#include "run/run_folder.hpp"

namespace catena::command {
namespace {

/// Number of a scene's own time steps over which its integrators are compared.
constexpr int integrator_steps = 32;
/// Time step and number of steps of the measurement of the energy drift.
constexpr double drift_step = 0.002;
constexpr std::int64_t drift_steps = 1000000;

/// Creates the output folder. Throws InputError if that fails or if the folder holds a run.
/// Collective.
void make_folder(Communicator const& communicator, std::string const& folder) {
    on_first_rank(communicator, [&] {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error || !std::filesystem::is_directory(folder))
            throw InputError("the folder cannot be created: " + error.message(),
                             "--output " + folder, "name another folder");
        if (holds_run(folder))
            throw InputError("the folder contains a run, whose report.html would be replaced",
                             "--output " + folder, "name another folder");
    });
}

/// Returns the backend that --backend names, or all that this build and machine have.
std::vector<Backend> backends_of(ReportRequest const& request) {
    if (!request.backend.empty() && request.backend != "auto")
        return {backend_named("--backend", request.backend)};
    std::vector<Backend> backends = cpu_backends();
    if (cuda::why_not().empty())
        backends.insert(backends.end(), {Backend::cuda, Backend::cuda_levels});
    return backends;
}

/// Returns the kind of handles that --handles names, or all kinds.
std::vector<Handles> handles_of(ReportRequest const& request) {
    std::vector<Handles> all{Handles::projected, Handles::full, Handles::articulated};
    if (!request.handles.empty())
        std::erase_if(all, [&](Handles kind) { return request.handles != name_of(kind); });
    return all;
}

/// Returns the outcome of all parts. Rank 0 also writes the files and draws the pictures.
Outcome conclude(std::string const& title, std::vector<ReportPart> const& parts,
                 std::vector<std::string> const& left_out, Communicator const& communicator,
                 ReportRequest const& request) {
    Outcome outcome;
    std::string const hardware =
        fmt::format("{}, {}; {}", hardware_text(), counted(communicator.size(), "rank", "ranks"),
                    compiler_name());
    outcome.json = {{"report", title},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", communicator.size()},
                    {"left_out", left_out}};
    for (ReportPart const& part : parts) {
        outcome.json[part.key] = part.json;
        outcome.text += text_of(part);
        outcome.valid = outcome.valid && part.valid;
    }
    outcome.json["valid"] = outcome.valid;
    outcome.complaint = "see the report";
    on_first_rank(communicator, [&] {
        std::string const json = request.output + "/report.json",
                          page = request.output + "/report.html";
        write_text_file(json, json_text(outcome.json));
        write_text_file(page, page_of("Catena: " + title, hardware, parts));
        for (std::string const& line : left_out) outcome.text += "left out: " + line + "\n";
        outcome.text += hardware + "\nwrote " + json + ", " + page + "\n";
        std::string const remark = draw_report(json, request.output);
        if (!remark.empty()) outcome.text += remark + "\n";
        for (ReportPart const& part : parts)
            if (remark.empty() && !part.picture.empty())
                outcome.text += "drew " + request.output + "/" + part.picture + ".png\n";
        outcome.text += outcome.valid ? "VALID\n" : "INVALID\n";
    });
    return outcome;
}

/// Measures the integrators on the scenes of a report.
ReportPart integrators_of(ReportScenes const& scenes, Communicator const& communicator,
                          ReportRequest const& request) {
    std::vector<IntegratorStudy> studies;
    for (auto const& [group, slow] : {std::pair{&scenes.integrators, false}, {&scenes.slow, true}})
        for (Scene const& scene : *group) {
            double const time =
                scenes.time > 0 ? scenes.time : integrator_steps * scene.dynamics.step;
            studies.push_back(study_integrator_errors(
                scene, communicator, time, request.quick ? 8 : 10, request.repeat, slow));
            spdlog::info("integrators of {} done", scene.title);
        }
    std::vector<DriftStudy> drifts;
    for (Scene const& scene : scenes.drift)
        for (Integrator const integrator : {Integrator::rattle, Integrator::g_baoab})
            drifts.push_back(study_drift(scene, communicator, integrator, drift_step, drift_steps));
    return integrator_part(studies, drifts);
}

/// Returns the cases of the stability suite that the request selects. Throws InputError for unknown
/// words.
std::vector<StabilityCase> cases_of(ReportRequest const& request) {
    std::vector<StabilityCase> cases =
        request.sizes.empty() ? stability_cases(request.quick ? 1 << 10 : 1 << 20, request.quick)
                              : coils_and_dills(request.sizes);
    std::vector<std::string> const& words = request.cases;
    auto const holds = [](StabilityCase const& each, std::string const& word) {
        return each.family.find(word) != std::string::npos;
    };
    for (std::string const& word : words)
        if (std::none_of(cases.begin(), cases.end(),
                         [&](StabilityCase const& each) { return holds(each, word); })) {
            std::set<std::string> families;
            for (StabilityCase const& each : cases) families.insert(each.family);
            throw InputError(
                "no family of cases contains '" + word + "'", "--cases",
                fmt::format("use parts of these names: {}", fmt::join(families, "; ")));
        }
    if (!words.empty())
        std::erase_if(cases, [&](StabilityCase const& each) {
            return std::none_of(words.begin(), words.end(),
                                [&](std::string const& word) { return holds(each, word); });
        });
    return cases;
}

}  // namespace

Outcome report_scenes(ReportScenes const& scenes, Communicator const& communicator,
                      ReportRequest const& request) {
    make_folder(communicator, request.output);
    std::vector<SolverStudy> solver;
    std::vector<std::string> left_out = scenes.left_out;
    for (Scene const& scene : scenes.solver) {
        SolverStudy study = study_solver_errors(scene, communicator, backends_of(request),
                                                handles_of(request), request.repeat);
        if (study.points.empty())
            left_out.push_back(fmt::format("the solver's errors in {}: no chains for {} handles",
                                           scene.title, request.handles));
        else
            solver.push_back(std::move(study));
        spdlog::info("{} done", scene.title);
    }
    std::vector<ReportPart> parts;
    if (std::any_of(scenes.solver.begin(), scenes.solver.end(),
                    [](Scene const& s) { return s.solver.refine > 0; }))
        left_out.emplace_back(
            "refinement (solver.refine) of the solver's errors and times: see catena solve "
            "--refine");
    if (communicator.rank() == 0) parts.push_back(solver_part(solver));
    if (communicator.size() > 1 && !(scenes.integrators.empty() && scenes.forces.empty()))
        left_out.emplace_back("integrators and forces: they are compared on one rank");
    if (communicator.size() == 1) {
        if (!scenes.integrators.empty())
            parts.push_back(integrators_of(scenes, communicator, request));
        std::vector<ForceStudy> forces;
        for (Scene const& scene : scenes.forces)
            forces.push_back(study_force_errors(scene, communicator, request.repeat));
        if (!forces.empty()) parts.push_back(force_part(forces));
        if (openmm_platforms().empty()) left_out.emplace_back("forces: built without OpenMM");
    }
    return conclude("error against run time", parts, left_out, communicator, request);
}

Outcome report_stability(Communicator const& communicator, ReportRequest const& request) {
    if (communicator.size() > 1)
        throw InputError("the stability suite runs on one rank, not on " +
                             counted(communicator.size(), "rank", "ranks"),
                         "--suite", "run it without mpirun");
    std::vector<Backend> const backends = backends_of(request);
    std::vector<StabilityCase> const cases = cases_of(request);
    std::vector<std::string> left_out;
    make_folder(communicator, request.output);
    std::optional<PeerAnswers> peers;
    if (request.quick)
        left_out.emplace_back("peers: Simbody and Pinocchio (--quick)");
    else
        peers.emplace(peers_of_suite(), limits_of_suite());
    AskPeers const ask = [&](StabilityCase const& each, Scene const& scene) {
        return peers ? (*peers)(each, scene) : std::vector<PeerAnswer>{};
    };
    std::vector<StabilityStudy> studies;
    for (StabilityCase const& each : cases) {
        int const seeds = each.bodies > 100000 ? 1 : 3;
        StabilityStudy study = study_stability(each, backends, handles_of(request), seeds, ask);
        if (study.points.empty()) {
            left_out.push_back(fmt::format("{}, {}: no chain for {} handles", each.family,
                                           each.name, request.handles));
            continue;
        }
        studies.push_back(std::move(study));
        spdlog::info("{}, {}: {}", each.family, each.name, name_of(studies.back().verdict()));
    }
    if (studies.empty())
        throw InputError("nothing to solve: " + left_out.back(), "--handles " + request.handles,
                         "use projected or full handles, or cases of open chains of bodies");
    std::vector<ReportPart> parts{stability_part(studies)};
    if (peers) {
        for (std::string const& line : peers->not_run()) left_out.push_back(line);
        if (!studies.front().peers.empty()) parts.push_back(peers_part(studies, peers->json()));
    }
    return conclude("stability suite", parts, left_out, communicator, request);
}

}  // namespace catena::command
