// How all_gather goes: at once between all ranks, or within hosts and between them.
#pragma once

#include <cstdint>
#include <string>

#include "mpi/traffic.hpp"

namespace catena {

/// What the environment variable CATENA_GATHER asks for; the same bytes come out of all of them.
struct GatherChoice {
    enum class Stages { automatic, one, two };
    Stages stages = Stages::automatic;
    int ranks_a_host = 0;  // so many ranks of a host count as a host: two stages on one machine; 0:
                           // hosts are as they are
};
/// "auto", "one-stage", "two-stage", "two-stage:G". Throws InputError.
GatherChoice gather_choice(std::string const& text);

/// How a communicator gathers, as one of its ranks sees it.
struct GatherWay {
    int stages = 1;
    std::int64_t ranks = 1, hosts = 1;
    bool leads =
        false;  // first rank of its host, which speaks to other hosts for all of it; of two stages
    std::int64_t piece = 0;  // of two stages: bytes at a time
    bool asked_for = false;  // by CATENA_GATHER
    bool no_memory = false;  // two stages were wanted, and some host has no memory to share

    /// The rule: every round of a gather at once waits for a message between hosts, of one in two
    /// stages only those between the hosts' first ranks do. Below some tens of ranks the rounds are
    /// few either way.
    static bool two_stages_pay(std::int64_t ranks, std::int64_t hosts);
    /// What is chosen for so many ranks, seen by a host's first.
    static GatherWay of(GatherChoice const&, std::int64_t ranks, std::int64_t hosts);
    GatherWay without_memory() const { return {1, ranks, hosts, false, 0, asked_for, true}; }

    std::string text() const;
    /// What a gather of so many bytes in all takes beside itself; nothing in one stage.
    Traffic within_and_between_hosts(std::int64_t bytes) const;
};

}  // namespace catena
