// Counters of messages.
#pragma once

#include <cstdint>

namespace catena {

/// Messages between neighbouring ranks' bodies and units of the tree, as counted by one rank.
struct Traffic {
    std::int64_t gathers = 0, gathered_bytes = 0;  // all_gather calls; bytes of all ranks
    std::int64_t exchanges = 0, sent_bytes = 0;    // exchange calls; bytes sent by this rank
    /// Gathers in two stages: number of times that the ranks of the host waited for each other.
    std::int64_t host_waits = 0;
    /// Gathers in two stages, counted on a host's first rank: gathers between hosts, and the bytes
    /// of all hosts.
    std::int64_t leader_gathers = 0, leader_bytes = 0;

    Traffic& operator+=(Traffic const& other);
    Traffic operator-(Traffic const& other) const;
    Traffic operator*(std::int64_t times) const;
    bool operator==(Traffic const&) const = default;
    /// Calls action(name, count) for each counter.
    template <class Action>
    void for_each(Action const& action) const {
        action("gathers", gathers);
        action("gathered_bytes", gathered_bytes);
        action("exchanges", exchanges);
        action("sent_bytes", sent_bytes);
        action("host_waits", host_waits);
        action("leader_gathers", leader_gathers);
        action("leader_bytes", leader_bytes);
    }
};

inline Traffic& Traffic::operator+=(Traffic const& other) {
    gathers += other.gathers;
    gathered_bytes += other.gathered_bytes;
    exchanges += other.exchanges;
    sent_bytes += other.sent_bytes;
    host_waits += other.host_waits;
    leader_gathers += other.leader_gathers;
    leader_bytes += other.leader_bytes;
    return *this;
}

inline Traffic Traffic::operator-(Traffic const& other) const {
    return {gathers - other.gathers,          gathered_bytes - other.gathered_bytes,
            exchanges - other.exchanges,      sent_bytes - other.sent_bytes,
            host_waits - other.host_waits,    leader_gathers - other.leader_gathers,
            leader_bytes - other.leader_bytes};
}

inline Traffic Traffic::operator*(std::int64_t times) const {
    return {times * gathers,    times * gathered_bytes, times * exchanges,   times * sent_bytes,
            times * host_waits, times * leader_gathers, times * leader_bytes};
}

}  // namespace catena
