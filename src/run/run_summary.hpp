// The summary of a run, summary.json: science first, then solver, ranks and files.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "observe/verdict.hpp"
#include "run/balance.hpp"
#include "run/frame_writer.hpp"
#include "run/message_count.hpp"
#include "start/start_report.hpp"

namespace catena {

/// Measurements that a run made of itself.
struct RunRecord {
    double seconds = 0;              // duration of all steps
    double first_step_after = 0;     // seconds since the program's start; 0: no step yet
    double rate_of_second_half = 0;  // steps per second; 0: unknown
    std::int64_t reached = 0;        // last step taken
    std::int64_t rounds = 0;         // rounds of messages
    int stopped_by = 0;              // reason to stop before the last step; 0: none
    std::vector<std::string> notes;
    StartReport start;
};

/// Parts of a run that its summary tells of.
struct SummarySource {
    Scene const& scene;
    Communicator const& communicator;
    RunOptions const& options;
    RunOrigin const& origin;
    ChainSystem const& system;
    Stepper const& stepper;
    FrameWriter& frames;
    RunVerdict const& verdict;
    RankShares const& shares;
    MessageCount const& messages;
    RunRecord const& record;
};

/// Returns the summary, whose names and units inputs/keys/output.md lists. `checks` count on rank
/// 0, `valid` is the same on every rank. Collective.
nlohmann::ordered_json summary_of_run(SummarySource const&, bool valid,
                                      std::vector<RunCheck> const& checks);

}  // namespace catena
