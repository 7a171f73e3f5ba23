// Entry point of the command line: catena check | plan | solve | run | report | bench | keys |
// analyse | convert | import. The
// commands are implemented in command/.
#include "bench/benchmarks.hpp"
#include "command/commands.hpp"
#include "command/report_scenes.hpp"
#include "command/session.hpp"
#include "plan/plan_network.hpp"

namespace {

using namespace catena;
using namespace catena::command;

/// Each overload of execute() runs one command on all ranks and returns the exit status. This one
/// prints the answer to --help or --version.
int execute(Session const& session, Answer const& answer) {
    return session.conclude({answer.text, nullptr, true});
}

int execute(Session const& session, CheckRequest const& request) {
    draw_domains(request, session.communicator());
    return session.conclude(
        check_scene(session.load(request.scene), session.communicator(), !request.json.empty()));
}

int execute(Session const& session, PlanRequest const& request) {
    Communicator const& ranks = session.communicator();
    if (request.scene.empty()) return session.conclude(calibrate(ranks, request));
    // Errors in --network are reported before the bodies of the scene are made.
    if (request.ranks > 0) network_of(request);
    Scene const scene = session.load(request.scene);
    if (request.calibrate) calibrate(ranks, request);
    return session.conclude(plan_scene(scene, ranks, request));
}

int execute(Session const& session, SolveRequest const& request) {
    return session.conclude(
        solve_scene(session.load(request.scene), session.communicator(), request));
}

int execute(Session const& session, RunRequest const& request) {
    return session.conclude(
        run_scene(session.load(request.scene), session.communicator(), request));
}

int execute(Session const& session, ReportRequest const& request) {
    if (!request.suite.empty())
        return session.conclude(report_stability(session.communicator(), request));
    std::vector<Scene> scenes;
    for (std::string const& file : request.scenes) scenes.push_back(session.load(file));
    return session.conclude(report_scenes(
        scenes.empty() ? generated_report(request) : sorted_for_report(std::move(scenes)),
        session.communicator(), request));
}

int execute(Session const& session, BenchRequest const& request) {
    return session.conclude(run_bench(session.communicator(), request));
}

int execute(Session const& session, KeysRequest const& request) {
    return session.conclude(declared_keys(request));
}

int execute(Session const& session, AnalyseRequest const& request) {
    return session.conclude(analyse_run(session.communicator(), request));
}

int execute(Session const& session, ConvertRequest const& request) {
    return session.conclude(convert_run(session.communicator(), request));
}

int execute(Session const& session, ImportRequest const& request) {
    return session.conclude(import_folder(session.communicator(), request));
}

}  // namespace

int main(int argc, char** argv) {
    return guarded(argc, argv, [](Communicator const& ranks, Request const& asked) {
        return std::visit(
            [&](auto const& request) { return execute(Session(ranks, request), request); }, asked);
    });
}
