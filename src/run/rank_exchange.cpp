// Implements the exchange of checkpoints and timelines.
#include "run/rank_exchange.hpp"

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
    auto const ranks = static_cast<std::size_t>(communicator.size());
    std::int64_t const length = static_cast<std::int64_t>(own.size());
    std::vector<std::int64_t> lengths(ranks);
    communicator.all_gather(std::as_bytes(std::span(&length, 1)),
                            std::as_writable_bytes(std::span(lengths)),
                            std::vector<std::int64_t>(ranks, sizeof(length)));
    std::int64_t total = 0;
    for (std::int64_t const l : lengths) total += l;
    std::string all(communicator.rank() == 0 ? static_cast<std::size_t>(total) : 0, ' ');
    communicator.gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)),
                        lengths);
    std::vector<std::string> texts;
    std::size_t at = 0;
    for (std::size_t r = 0; communicator.rank() == 0 && r < ranks;
         at += static_cast<std::size_t>(lengths[r++]))
        texts.push_back(all.substr(at, static_cast<std::size_t>(lengths[r])));
    return texts;
}

}  // namespace

void share(Communicator const& communicator, Checkpoint& c) {
    if (communicator.size() == 1) return;
    auto const value = [&](auto& v) {
        communicator.broadcast(std::as_writable_bytes(std::span(&v, 1)));
    };
    auto const text = [&](std::string& s) {
        auto size = static_cast<std::int64_t>(s.size());
        value(size);
        s.resize(static_cast<std::size_t>(size));
        communicator.broadcast(std::as_writable_bytes(std::span(s)));
    };
    value(c.step);
    value(c.time);
    json names = {{"integers", c.integers}, {"arrays", json::object()}};
    for (auto const& [name, array] : c.arrays)
        if (array.size() <= largest_shared_array) names["arrays"][name] = array.size();
    std::string packed = names.dump();
    text(packed);
    names = json::parse(packed);
    c.integers = names["integers"].get<std::map<std::string, std::int64_t>>();
    for (auto const& [name, size] : names["arrays"].items()) {
        c.arrays[name].resize(size.get<std::size_t>());
        communicator.broadcast(std::as_writable_bytes(std::span(c.arrays[name])));
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
