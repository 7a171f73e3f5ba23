// Implements the exchange of checkpoints and timelines.
#include "run/rank_exchange.hpp"
#include "mpi/collectives.hpp"

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace catena {
namespace {

using nlohmann::json;

json timeline_json(std::vector<StepTimeline> const& steps) {
    json list = json::array();
    for (StepTimeline const& step : steps) {
        json phases = json::array();
        for (Phase const& p : step.phases)
            phases.push_back(
                {{"name", p.name}, {"lane", p.lane}, {"begin", p.begin}, {"end", p.end}});
        list.push_back({{"step", step.step}, {"phases", phases}});
    }
    return list;
}

/// Returns the texts of all ranks, on rank 0 only. Collective.
std::vector<std::string> gather_texts(Communicator const& communicator, std::string const& own) {
    auto const all = gathered_blocks(communicator, own);
    std::vector<std::string> texts;
    if (communicator.rank() == 0)
        all.each([&](std::span<char const> text) { texts.emplace_back(text.begin(), text.end()); });
    return texts;
}

}  // namespace

void share(Communicator const& communicator, Checkpoint& c) {
    if (communicator.size() == 1) return;
    broadcast(communicator, c.step);
    broadcast(communicator, c.time);
    json names = {{"integers", c.integers}, {"arrays", json::object()}};
    for (auto const& [name, array] : c.arrays)
        if (array.size() <= largest_shared_array) names["arrays"][name] = array.size();
    std::string packed = names.dump();
    broadcast(communicator, packed);
    names = json::parse(packed);
    c.integers = names["integers"].get<std::map<std::string, std::int64_t>>();
    for (auto const& [name, size] : names["arrays"].items()) {
        c.arrays[name].resize(size.get<std::size_t>());
        broadcast(communicator, c.arrays[name]);
    }
}

json gather_timelines(Communicator const& communicator, std::vector<StepTimeline> const& own) {
    std::vector<std::string> const texts = gather_texts(
        communicator, timeline_json(own).dump(-1, ' ', false, json::error_handler_t::replace));
    json timeline{{"ranks", json::array()}};
    for (std::size_t rank = 0; rank < texts.size(); ++rank)
        timeline["ranks"].push_back({{"rank", rank}, {"steps", json::parse(texts[rank])}});
    return timeline;
}

}  // namespace catena
