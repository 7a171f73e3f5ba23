// Implements `bench peers`: forward dynamics by other programs and by Catena on the same chains, in
// turns.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>

#include "bench/benchmarks.hpp"
#include "bench/generated.hpp"
#include "bench/peer_benchmark.hpp"
#include "bench/peers.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "measure/hardware.hpp"
#include "measure/solver_errors.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Limits for the other programs.
constexpr std::chrono::seconds most_set_up{120};
constexpr std::chrono::seconds most_evaluation{2};
constexpr std::int64_t most_bodies = 1000000;

/// Throws InputError for options that this benchmark does not take.
void check(BenchRequest const& request, Communicator const& communicator) {
    if (communicator.size() > 1)
        throw InputError("peers run on one rank", "catena bench peers", "run it without mpirun");
    for (std::string const& joint : request.joints)
        if (joint != "link" && joint != "spherical" && joint != "revolute" && joint != "planar")
            throw InputError("`" + joint + "` joints are not supported by the peers", "--joints",
                             "use link, spherical, revolute or planar");
    for (std::int64_t const bodies : request.sizes)
        if (bodies > most_bodies)
            throw InputError(fmt::format("{} bodies", bodies), "--sizes",
                             "use at most 1e6, the limit of the reference solution");
    if (!request.set.empty())
        throw InputError("the chains of this benchmark are fixed", "--set",
                         "choose --sizes and --joints");
}

/// Converts the limits to JSON.
Json json_of(Peer::Limits const& l) {
    return {{"set_up_seconds", l.set_up.count()},
            {"evaluation_seconds", l.evaluation.count()},
            {"memory_bytes", l.memory_bytes}};
}

/// Starts the peers for each chain and records where they stopped.
class Runners {
  public:
    void add_to(PeerBenchmark& contest, PeerStop const& here) {
        peers_.write(contest.table());
        for (PeerProgram const& program : peers_.programs()) {
            if (!program.missing.empty() || has_stopped(program.name, here.joint)) continue;
            std::unique_ptr<Peer> peer = peers_.start(program);
            if (peer->is_ready()) {
                peers_.note(program, *peer);
                contest.add(program.name, std::move(peer));
            } else {
                stops_.push_back({program.name, here.joint, peer->stopped(), here.bodies});
            }
        }
    }
    void add(std::vector<PeerStop> const& stops) {
        stops_.insert(stops_.end(), stops.begin(), stops.end());
    }
    void describe(Outcome& outcome) const {
        outcome.json["limits"] = json_of(peers_.limits());
        outcome.json["peers"] = peers_.json();
        for (std::string const& line : peers_.not_run()) outcome.text += line + "\n";
        for (PeerStop const& stop : stops_) {
            outcome.json["stops"].push_back({{"peer", stop.peer},
                                             {"joint", stop.joint},
                                             {"bodies", stop.bodies},
                                             {"why", stop.why}});
            outcome.text += fmt::format("{} stops at {} bodies, {}: {}\n", stop.peer, stop.bodies,
                                        stop.joint, stop.why);
        }
    }

  private:
    bool has_stopped(std::string const& peer, std::string const& joint) const {
        return std::any_of(stops_.begin(), stops_.end(),
                           [&](PeerStop const& s) { return s.peer == peer && s.joint == joint; });
    }
    Peers peers_{peer_programs(), {most_set_up, most_evaluation, memory_for_peers()}};
    std::vector<PeerStop> stops_;
};

}  // namespace

Outcome bench_peers(Communicator const& communicator, BenchRequest request) {
    check(request, communicator);
    std::sort(request.sizes.begin(), request.sizes.end());
    Runners peers;
    Table table({"joint", "bodies", "by", "threads", "ns per body", "over Catena", "error", "bound",
                 "residual", ""},
                {0, 2, 9});
    Outcome outcome;
    outcome.json = {{"bench", "peers"},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", 1},
                    {"limits", Json()},
                    {"peers", Json()},
                    {"results", Json::array()},
                    {"stops", Json::array()}};
    outcome.json["loads"] = request.loads;
    for (std::string const& joint : request.joints)
        for (std::int64_t const bodies : request.sizes) {
            PeerBenchmark contest(random_scene(joint, bodies, overrides_of(request), request.loads),
                                  joint);
            contest.add(request.backends.empty() ? cpu_backends() : request.backends, communicator);
            peers.add_to(contest, {"", joint, "", bodies});
            peers.add(contest.take_turns(request.repeat));
            contest.conclude(outcome, table);
            spdlog::info("{} bodies on {} joints: measured", bodies, joint);
        }
    outcome.text = fmt::format(
        "Forward dynamics from positions to accelerations, ns per body; loads: {}; blocks of {} in "
        "turn, medians of {}. Over Catena: relative to its quickest whole evaluation on one core. "
        "Error: the largest error of a joint acceleration, relative to the largest acceleration. "
        "Its bound: 32 depth 2^-53 times the growth of rounding errors; the depth is that of the "
        "tree or, for a peer, the number of bodies. {}; Catena: {}, {}\n",
        request.loads, duration_text(block_seconds), request.repeat, hardware_text(),
        compiler_name(), instruction_set());
    outcome.text += table.text();
    peers.describe(outcome);
    outcome.json["valid"] = outcome.valid;
    outcome.complaint = "an error or a residual over Catena above its bound: see the results";
    return outcome;
}

}  // namespace catena::command
