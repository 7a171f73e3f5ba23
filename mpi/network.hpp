// Model of message times by latency and bandwidth, and its measurement between the ranks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

/// Connection of two ranks: a message of n bytes takes latency + n seconds_a_byte, in seconds.
struct Link {
    double latency = 0, seconds_a_byte = 0;
    double seconds(std::int64_t bytes) const {
        return latency + static_cast<double>(bytes) * seconds_a_byte;
    }
};

/// Model of all connections between ranks.
struct Network {
    /// Links between ranks of one host, and of different hosts; absent if they could not be
    /// measured.
    std::optional<Link> near, far;
    double gather_overhead = 1;  // measured time of a gather over modelled time

    /// Time of an all-gather of `bytes` in all, in seconds. One stage has log2(ranks) rounds, each
    /// with a message between hosts if there are several. Every byte except a rank's own is
    /// received once. Two stages: ranks of a host wait for each other twice, with log2 rounds each;
    /// log2(hosts) rounds connect hosts. Every byte except a host's own is sent once between hosts,
    /// and once more to each rank. Preconditions: 1 <= hosts <= ranks; `near` is set and replaces
    /// an absent `far`.
    double gather_seconds(std::int64_t bytes, GatherWay const&) const;
    /// Time of an exchange of `bytes` between neighbours over the slowest link, in seconds.
    double exchange_seconds(std::int64_t bytes, std::int64_t hosts) const {
        return (hosts > 1 ? far : near).value().seconds(bytes);
    }
};

/// Measured time of a message or a gather.
struct TimedMessage {
    std::string what;  // "near" or "far"; for gathers, the data gathered
    std::int64_t bytes = 0;
    /// Time of the fastest repetition, s.
    double seconds = 0;
};
/// Result of time_network().
struct NetworkTimes {
    std::int64_t ranks = 1, hosts = 1;
    GatherWay way;
    /// Half of the round-trip times between rank 0 and the first rank of the same host and of
    /// another host.
    std::vector<TimedMessage> messages;
    std::vector<TimedMessage> gathers;  // all_gather of the solver's records
    Network network;
};
/// Measures messages and gathers. Collective. A single rank has nothing to measure.
NetworkTimes time_network(Communicator const&, int repeat);

/// Measures the time of a step's messages between the ranks, in seconds. The messages have their
/// average sizes, and nothing is computed meanwhile. The result is the fastest of `repeat`
/// repetitions. Collective.
double time_messages(Communicator const&, Traffic const& a_step, int repeat);
/// Number of hosts of different names. Collective.
std::int64_t count_hosts(Communicator const&);

}  // namespace catena
