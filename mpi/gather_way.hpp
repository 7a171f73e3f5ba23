// Algorithms of all_gather(): one stage between all ranks, or two stages within hosts and between
// hosts.
#pragma once

#include <cstdint>
#include <string>

#include "mpi/traffic.hpp"

namespace catena {

/// Request of the environment variable CATENA_GATHER. All algorithms gather the same bytes.
struct GatherChoice {
    enum class Stages { automatic, one, two };
    Stages stages = Stages::automatic;
    /// Number of ranks that count as a host, for tests of two stages on one machine; 0: real hosts.
    int ranks_a_host = 0;
};
/// Parses "auto", "one-stage", "two-stage" or "two-stage:G"; empty means auto. Throws InputError.
GatherChoice gather_choice(std::string const& text);

/// Algorithm of a communicator's gather, from the point of view of one rank.
struct GatherWay {
    int stages = 1;
    std::int64_t ranks = 1, hosts = 1;
    /// Two stages: true on the first rank of a host, which communicates with other hosts for all
    /// its ranks.
    bool leads = false;
    std::int64_t piece = 0;  // two stages: bytes per message
    bool asked_for = false;  // true if CATENA_GATHER requested it
    /// True if two stages were selected, but some host cannot allocate shared memory.
    bool no_memory = false;

    /// True if two stages are faster. In one stage every round waits for a message between hosts;
    /// in two stages only the rounds between the hosts' first ranks do. Below some tens of ranks
    /// both need few rounds.
    static bool two_stages_pay(std::int64_t ranks, std::int64_t hosts);
    /// Returns the algorithm for the given numbers, as seen by a host's first rank.
    static GatherWay of(GatherChoice const&, std::int64_t ranks, std::int64_t hosts);
    /// Returns the fallback to one stage for hosts without shared memory.
    GatherWay without_memory() const { return {1, ranks, hosts, false, 0, asked_for, true}; }

    /// Description for reports.
    std::string text() const;
    /// Additional traffic of a gather of `bytes` in all, within and between hosts; zero in one
    /// stage.
    Traffic within_and_between_hosts(std::int64_t bytes) const;
};

}  // namespace catena
