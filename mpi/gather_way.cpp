// Choice between one-stage and two-stage gathers.
#include "mpi/gather_way.hpp"

#include <charconv>

#include "error.hpp"

namespace catena {
namespace {

/// Smallest number of ranks for two stages.
constexpr std::int64_t fewest_ranks = 32;
/// Largest number of bytes per piece of a two-stage gather.
constexpr std::int64_t largest_piece = 4 << 20;

}  // namespace

GatherChoice gather_choice(std::string const& text) {
    using Stages = GatherChoice::Stages;
    if (text.empty() || text == "auto") return {};
    if (text == "one-stage") return {Stages::one, 0};
    if (text == "two-stage") return {Stages::two, 0};
    std::string const prefix = "two-stage:";
    int ranks = 0;
    char const* const end = text.data() + text.size();
    if (text.starts_with(prefix)) {
        auto const parsed = std::from_chars(text.data() + prefix.size(), end, ranks);
        if (parsed.ec == std::errc() && parsed.ptr == end && ranks > 0) return {Stages::two, ranks};
    }
    throw InputError(
        "`" + text + "` is not a way to gather", "CATENA_GATHER",
        "use auto, one-stage, two-stage, or two-stage:G, where G ranks of a host count as a host");
}

bool GatherWay::two_stages_pay(std::int64_t ranks, std::int64_t hosts) {
    return ranks >= fewest_ranks && hosts > 1 && ranks > hosts;
}

GatherWay GatherWay::of(GatherChoice const& choice, std::int64_t ranks, std::int64_t hosts) {
    using Stages = GatherChoice::Stages;
    bool const asked_for = choice.stages != Stages::automatic;
    bool const two = asked_for ? choice.stages == Stages::two : two_stages_pay(ranks, hosts);
    return {two ? 2 : 1, ranks, hosts, two, two ? largest_piece : 0, asked_for, false};
}

std::string GatherWay::text() const {
    auto const counted = [](std::int64_t n, char const* what) {
        return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
    };
    std::string text =
        stages == 1 ? "in one stage" : "in two stages, within each host and between hosts";
    text += ": " + counted(ranks, "rank") + " on " + counted(hosts, "host");
    if (no_memory) return text + ", one without memory to share";
    return text + (asked_for ? ", by CATENA_GATHER"
                             : "; in two from " + std::to_string(fewest_ranks) +
                                   " ranks on several hosts with several ranks on");
}

Traffic GatherWay::within_and_between_hosts(std::int64_t bytes) const {
    Traffic t;
    if (stages == 1) return t;
    std::int64_t const pieces = (bytes + piece - 1) / piece;
    t.host_waits = 2 * pieces;  // one wait before and one after the exchange between hosts
    if (!leads || hosts == 1) return t;
    t.leader_gathers = pieces;
    t.leader_bytes = bytes;
    return t;
}

}  // namespace catena
