// Measurement of messages and gathers, and the model fitted to them.
#include "mpi/network.hpp"
#include "mpi/collectives.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <limits>
#include <set>
#include <span>

namespace catena {
namespace {

/// Sizes of measured messages, bytes.
constexpr std::int64_t message_bytes[] = {8, 64, 512, 4096, 32768, 262144, 2097152};
/// Number of units of a shared chain (see tree.hpp), and measured numbers of directions per handle.
constexpr std::int64_t units = 64;
constexpr int kinds[] = {1, 2, 3, 4, 5, 6};

/// Time of a monotonic clock, s.
double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Returns the slowest rank's time in the fastest of `repeat` calls, s, after one warm-up call. The
/// fastest call is least affected by other work on the cores. Collective.
template <class Action>
double timed(Communicator const& communicator, int repeat, Action&& action) {
    double fastest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= repeat; ++i) {
        communicator.barrier();
        double const start = now();
        action();
        double const slowest = communicator.max(now() - start);
        if (i > 0) fastest = std::min(fastest, slowest);
    }
    return fastest;
}

/// Host name, zero-terminated.
using HostName = std::array<char, 64>;

/// Returns the host name of every rank. Collective.
std::vector<std::string> hosts_of_ranks(Communicator const& communicator) {
    HostName own{};
    ::gethostname(own.data(), own.size() - 1);
    std::vector<std::string> names;
    for (HostName const& name : all_gathered(communicator, own)) names.emplace_back(name.data());
    return names;
}

/// Number of different names.
std::int64_t different(std::vector<std::string> const& names) {
    return std::ssize(std::set<std::string>(names.begin(), names.end()));
}

/// Returns half the round-trip time between rank 0 and `partner`. One measurement covers many round
/// trips, because the resolution of a clock is as coarse as a short message.
double there_and_back(Communicator const& communicator, int partner, std::int64_t bytes,
                      int repeat) {
    int const trips = static_cast<int>(std::clamp<std::int64_t>(2097152 / bytes, 4, 100));
    std::vector<std::byte> data(static_cast<std::size_t>(bytes));
    int const rank = communicator.rank(), other = rank == 0 ? partner : 0;
    double const seconds = timed(communicator, repeat, [&] {
        for (int trip = 0; trip < trips && (rank == 0 || rank == partner); ++trip) {
            if (rank == 0) communicator.exchange(data, other, {}, -1);
            communicator.exchange({}, -1, data, other);
            if (rank != 0) communicator.exchange(data, other, {}, -1);
        }
    });
    return 0.5 * seconds / trips;
}

/// Returns the link fitted to messages named `what`: latency from the shortest, bandwidth from the
/// longest.
Link link_of(std::vector<TimedMessage> const& messages, std::string const& what) {
    std::vector<TimedMessage> mine;
    std::copy_if(messages.begin(), messages.end(), std::back_inserter(mine),
                 [&](TimedMessage const& m) { return m.what == what; });
    TimedMessage const &shortest = mine.front(), &longest = mine.back();
    double const a_byte =
        (longest.seconds - shortest.seconds) / static_cast<double>(longest.bytes - shortest.bytes);
    return {shortest.seconds, std::max(a_byte, 0.0)};
}

/// All-gather of `count` records, distributed over the ranks as evenly as possible.
class Gather {
  public:
    Gather(Communicator const& communicator, std::int64_t count, std::int64_t bytes_of_one)
        : communicator_(communicator), all_(static_cast<std::size_t>(count * bytes_of_one)) {
        std::int64_t const ranks = communicator.size();
        for (std::int64_t r = 0; r < ranks; ++r)
            bytes_.push_back((count * (r + 1) / ranks - count * r / ranks) * bytes_of_one);
        own_.resize(
            static_cast<std::size_t>(bytes_[static_cast<std::size_t>(communicator.rank())]));
    }
    /// Performs one gather.
    void operator()() { communicator_.all_gather(own_, all_, bytes_); }

  private:
    Communicator const& communicator_;
    std::vector<std::int64_t> bytes_;
    std::vector<std::byte> own_, all_;
};

/// Measures gathers of the solver's records; their median over the model is the overhead.
void time_gathers(NetworkTimes& times, Communicator const& communicator, int repeat) {
    auto const add = [&](std::string const& what, std::int64_t numbers) {
        std::int64_t const bytes = numbers * static_cast<std::int64_t>(sizeof(double));
        Gather gather(communicator, units, bytes);
        times.gathers.push_back({what, units * bytes, timed(communicator, repeat, gather)});
    };
    for (int const k : kinds) {
        add("biases, " + std::to_string(k) + (k == 1 ? " direction" : " directions"), 2 * k);
        add("matrices, " + std::to_string(k) + (k == 1 ? " direction" : " directions"),
            2 * k * k + k);
    }
    add("kinematics", 13);
    std::vector<double> ratios;
    for (TimedMessage const& gather : times.gathers)
        ratios.push_back(gather.seconds / times.network.gather_seconds(gather.bytes, times.way));
    std::nth_element(ratios.begin(), ratios.begin() + std::ssize(ratios) / 2, ratios.end());
    times.network.gather_overhead = ratios[ratios.size() / 2];
}

/// Number of rounds of a logarithmic collective among `count` ranks.
double rounds_among(std::int64_t count) {
    return static_cast<double>(std::bit_width(static_cast<std::uint64_t>(count - 1)));
}

}  // namespace

double Network::gather_seconds(std::int64_t bytes, GatherWay const& way) const {
    if (way.ranks == 1) return 0;
    Link const& within = near.value();
    Link const& between = way.hosts > 1 && far ? *far : within;
    auto const but_own = [&](std::int64_t count) {
        return static_cast<double>(bytes) * (1.0 - 1.0 / static_cast<double>(count));
    };
    if (way.stages == 1)
        return gather_overhead * (but_own(way.ranks) * between.seconds_a_byte +
                                  rounds_among(way.ranks) * between.latency);
    std::int64_t const on_host = (way.ranks + way.hosts - 1) / way.hosts;
    double const inside = 2 * rounds_among(on_host) * within.latency +
                          static_cast<double>(bytes) * within.seconds_a_byte;
    return gather_overhead * (inside + rounds_among(way.hosts) * between.latency +
                              but_own(way.hosts) * between.seconds_a_byte);
}

NetworkTimes time_network(Communicator const& communicator, int repeat) {
    std::vector<std::string> const host = hosts_of_ranks(communicator);
    NetworkTimes times;
    times.ranks = communicator.size();
    times.hosts = different(host);
    times.way = communicator.gather_way();
    for (bool const far : {false, true}) {
        auto const partner =
            std::find_if(host.begin() + 1, host.end(),
                         [&](std::string const& name) { return (name != host[0]) == far; });
        if (partner == host.end()) continue;
        std::string const what = far ? "far" : "near";
        for (std::int64_t const bytes : message_bytes)
            times.messages.push_back(
                {what, bytes,
                 there_and_back(communicator, static_cast<int>(partner - host.begin()), bytes,
                                repeat)});
        (far ? times.network.far : times.network.near) = link_of(times.messages, what);
    }
    if (times.ranks == 1) return times;
    if (!times.network.near) times.network.near = times.network.far;  // each host has one rank
    time_gathers(times, communicator, repeat);
    return times;
}

double time_messages(Communicator const& communicator, Traffic const& a_step, int repeat) {
    Gather gather(communicator, a_step.gathers > 0 ? a_step.gathered_bytes / a_step.gathers : 0, 1);
    std::vector<std::byte> send(
        static_cast<std::size_t>(a_step.exchanges > 0 ? a_step.sent_bytes / a_step.exchanges : 0)),
        receive = send;
    int const before = communicator.rank() - 1,
              after = communicator.rank() + 1 < communicator.size() ? communicator.rank() + 1 : -1;
    return timed(communicator, repeat, [&] {
        for (std::int64_t i = 0; i < a_step.gathers; ++i) gather();
        for (std::int64_t i = 0; i < a_step.exchanges; ++i)
            communicator.exchange(send, after, receive, before);
    });
}

std::int64_t count_hosts(Communicator const& communicator) {
    return different(hosts_of_ranks(communicator));
}

}  // namespace catena
