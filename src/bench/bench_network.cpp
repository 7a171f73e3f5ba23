// Implements `bench network`.
#include <fmt/format.h>

#include "bench/benchmarks.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "mpi/network.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Converts a link to JSON; null if there is none.
Json json_of(std::optional<Link> const& link) {
    return link ? Json{{"latency", link->latency}, {"seconds_a_byte", link->seconds_a_byte}}
                : Json(nullptr);
}

/// Describes a link: latency and bandwidth.
std::string text_of(std::optional<Link> const& link) {
    if (!link) return "none";
    std::string const rate = link->seconds_a_byte > 0
                                 ? fmt::format("{:.3g} GB/s", 1e-9 / link->seconds_a_byte)
                                 : "too fast to measure";
    return duration_text(link->latency) + ", " + rate;
}

/// Adds messages to a table and returns their JSON, with the model's time of each.
template <class Model>
Json rows_of(std::vector<TimedMessage> const& messages, Table& table, Model const& model) {
    Json rows = Json::array();
    for (TimedMessage const& m : messages) {
        double const modelled = model(m);
        table.add(
            {m.what, std::to_string(m.bytes), duration_text(m.seconds), duration_text(modelled)});
        rows.push_back(
            {{"what", m.what}, {"bytes", m.bytes}, {"seconds", m.seconds}, {"model", modelled}});
    }
    return rows;
}

}  // namespace

Outcome bench_network(Communicator const& communicator, BenchRequest const& request) {
    if (communicator.size() == 1)
        throw InputError("one rank sends no messages", "catena bench network",
                         "start it with mpirun on at least two ranks");
    NetworkTimes const times = time_network(communicator, request.repeat);
    Network const& network = times.network;
    Outcome outcome;
    Table table({"message", "bytes", "measured", "model"});
    auto const of_message = [&](TimedMessage const& m) {
        return (m.what == "far" ? network.far : network.near).value().seconds(m.bytes);
    };
    auto const of_gather = [&](TimedMessage const& m) {
        return network.gather_seconds(m.bytes, times.way);
    };
    outcome.json = {{"bench", "network"},
                    {"build", version_json()},
                    {"ranks", times.ranks},
                    {"hosts", times.hosts},
                    {"stages", times.way.stages},
                    {"message_passing", message_passing_library()},
                    {"repeat", request.repeat},
                    {"messages", rows_of(times.messages, table, of_message)},
                    {"gathers", rows_of(times.gathers, table, of_gather)},
                    {"network",
                     {{"near", json_of(network.near)},
                      {"far", json_of(network.far)},
                      {"gather_overhead", network.gather_overhead}}}};
    Text text;
    text.heading(fmt::format(
        "messages between {} on {}, {}; the fastest of {}", counted(times.ranks, "rank", "ranks"),
        counted(times.hosts, "host", "hosts"), message_passing_library(), request.repeat));
    text.entry("within a host", text_of(network.near));
    text.entry("between hosts", text_of(network.far));
    text.entry("gathers", fmt::format("{:.3g} times the model's time; {}", network.gather_overhead,
                                      times.way.text()));
    text.add(table);
    outcome.text = text.str();
    return outcome;
}

}  // namespace catena::command
