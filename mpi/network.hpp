// How long messages take: a model of latency and bandwidth, and its measurement between the ranks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

/// A message of n bytes from one rank to another takes latency + n seconds_a_byte.
struct Link {
    double latency = 0, seconds_a_byte = 0;
    double seconds(std::int64_t bytes) const {
        return latency + static_cast<double>(bytes) * seconds_a_byte;
    }
};

struct Network {
    std::optional<Link> near,
        far;  // between ranks of a host, of different hosts; empty where there were none to measure
    double gather_overhead = 1;  // of a measured gather over its model

    /// Every rank gets `bytes` in all. In one stage: log2 rounds, each with a message between hosts
    /// where there are several; every byte but a rank's own once. In two: ranks of a host wait for
    /// each other twice, log2 rounds each; log2 rounds between hosts; every byte but a host's own
    /// once between hosts and once more to each rank. Preconditions: 1 <= hosts <= ranks; the near
    /// link is there, and stands in for the far one where there is none.
    double gather_seconds(std::int64_t bytes, GatherWay const&) const;
    /// Neighbours exchange `bytes`; the slower link counts.
    double exchange_seconds(std::int64_t bytes, std::int64_t hosts) const {
        return (hosts > 1 ? far : near).value().seconds(bytes);
    }
};

struct TimedMessage {
    std::string what;  // "near", "far"; of gathers what is gathered
    std::int64_t bytes = 0;
    double seconds = 0;  // of the fastest of many
};
struct NetworkTimes {
    std::int64_t ranks = 1, hosts = 1;
    GatherWay way;
    std::vector<TimedMessage>
        messages;  // half of there and back, between rank 0 and the nearest and the farthest rank
    std::vector<TimedMessage> gathers;  // all_gather of the solver's own records
    Network network;
};
/// Collective; on 1 rank there is nothing to measure.
NetworkTimes time_network(Communicator const&, int repeat);

/// Seconds that a step's messages take between the ranks at hand, of average size each, nothing
/// computed meanwhile: the fastest of many. Collective.
double time_messages(Communicator const&, Traffic const& a_step, int repeat);
/// Hosts of different names that the ranks are on. Collective.
std::int64_t count_hosts(Communicator const&);

}  // namespace catena
