// Implements loading of scenes, output of outcomes, and the handling of errors on all ranks.
#include "command/session.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "clock.hpp"
#include "command/command_line.hpp"
#include "console/long_task.hpp"
#include "console/option_values.hpp"
#include "console/process.hpp"
#include "console/terminal.hpp"
#include "error.hpp"
#include "io/output.hpp"
#include "io/printable.hpp"
#include "mpi/first_rank.hpp"
#include "mpi/gather_way.hpp"
#include "mpi/gpu_exchange.hpp"
#include "mpi/launcher.hpp"
#include "plan/host_memory.hpp"
#include "reader/load_scene.hpp"

namespace catena::command {
namespace {

/// Exit status of a run that was stopped by a signal.
constexpr int stopped_status = 3;

/// Waiting time that is longer than launchers let other ranks live once one rank has ended
/// (jobs/common.sh).
constexpr std::chrono::seconds patience(4);

/// Reports an error and returns status 1. With several ranks, an error that the others may not know
/// of ends all of them. Rank 0, which may have met the same error, speaks first.
int fail(Communicator const& communicator, std::string const& line) {
    bool const alone = communicator.size() == 1;
    if (!alone && communicator.rank() != 0) std::this_thread::sleep_for(patience);
    say_error(line);
    if (!alone) communicator.abort(1);
    return 1;
}

/// Checks variables of the environment at the start, not only where they are used hours later or
/// never.
void check_environment(Communicator const& communicator) {
    gather_choice(variable_of_first_rank(communicator, "CATENA_GATHER"));
    gpu_exchange_choice(variable_of_first_rank(communicator, "CATENA_GPU_EXCHANGE"));
}

/// Parses the command line, runs the command and converts exceptions to an exit status.
int run_request(Communicator const& communicator, int argc, char** argv,
                std::function<int(Communicator const&, Request const&)> const& execute) {
    bool const speaks = communicator.rank() == 0;
    try {
        Request const request = parse_command_line(argc, argv);
        if (!std::holds_alternative<Answer>(request)) check_environment(communicator);
        return execute(communicator, request);
    } catch (InputError const& error) {
        if (speaks) say_error(error.what());
        return 2;
    } catch (SharedError const& error) {
        if (speaks) say_error(error.what());
        return 1;
    } catch (std::bad_alloc const&) {
        return fail(communicator, out_of_memory());
    } catch (std::exception const& error) {
        return fail(communicator, error.what());
    } catch (...) {
        return fail(communicator, "unknown error");
    }
}

}  // namespace

Session::Session(Communicator const& communicator, CommonOptions const& options)
    : communicator_(communicator), options_(options) {
    start_log(communicator.rank() != 0 ? "off" : options.log_level);
    if (options.quiet && spdlog::get_level() < spdlog::level::err)
        spdlog::set_level(spdlog::level::err);
    on_first_rank(communicator, [&] { require_writable("--json", options.json); });
}

Scene Session::load(std::string const& file) const {
    double const start = seconds_now();
    std::optional<Scene> scene;
    LongTask const task(communicator_.rank() == 0 && !is_quiet(), "reading " + file);
    // Files that one rank alone cannot read must not leave the others waiting.
    auto const look = [ranks = communicator_.size(),
                       here = communicator_.ranks_on_host()](Scene const& first) {
        refuse_replicas_beyond_memory(first, ranks, here);
    };
    on_every_rank(communicator_, [&] { scene = load_scene(file, overrides_of(options_), look); });
    spdlog::debug("{} read in {:.3f} s: {} chains, {} bodies", file, seconds_now() - start,
                  scene->chains.size(), scene->bodies());
    return *std::move(scene);
}

int Session::conclude(Outcome const& outcome) const {
    on_first_rank(communicator_, [&] {
        if (options_.json == "-")
            print(json_text(outcome.json));
        else if (!options_.quiet)
            print(printable(outcome.text));
        if (!outcome.valid && (options_.quiet || options_.json == "-"))
            spdlog::error("INVALID: {}", outcome.complaint);
        if (outcome.valid && !outcome.whole) say_error(outcome.complaint);
        if (options_.json.empty() || options_.json == "-" || outcome.json.is_null()) return;
        write_text_file(options_.json, json_text(outcome.json));
        spdlog::info("wrote {}", options_.json);
    });
    if (communicator_.max(outcome.valid ? 0 : 1) > 0) return 1;
    return outcome.whole ? 0 : stopped_status;
}

int guarded(int argc, char** argv,
            std::function<int(Communicator const&, Request const&)> const& execute) {
    prepare_process();
    try {
        start_hdf5();
        std::unique_ptr<Communicator> const world = world_communicator(&argc, &argv);
        return run_request(*world, argc, argv, execute);
    } catch (InputError const&
                 error) {  // no ranks, no communicator: the launcher's numbers say who speaks
        if (launch_environment().rank == 0) say_error(error.what());
        return 2;
    } catch (std::exception const& error) {
        say_error(error.what());
        return 1;
    }
}

}  // namespace catena::command
