// Implements the part of `catena plan` on messages between ranks.
#include "plan/plan_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>

#include "error.hpp"
#include "plan/plan_network.hpp"
#include "plan/plan_steps.hpp"
#include "run/step_messages.hpp"

namespace catena::command {
namespace {

/// Number of timed repetitions of a step's messages.
constexpr int measurements = 21;

/// Converts the counts of messages to JSON.
Json json_of(Traffic const& t) {
    Json json;
    t.for_each([&](char const* name, std::int64_t count) { json[name] = count; });
    return json;
}

/// Converts a link of the network to JSON: latency in s, inverse bandwidth in s per byte.
Json json_of(Link const& link) {
    return {{"latency", link.latency}, {"seconds_a_byte", link.seconds_a_byte}};
}

/// Messages of a step, summed over the groups: those without projection sweeps of drifts (or
/// corrections of jointed tips), and those that each such sweep adds.
struct Messages {
    Traffic fixed, each;
    /// Returns the messages of a step with this number of sweeps.
    Traffic with(int sweeps) const {
        Traffic sum = fixed;
        for (int i = 0; i < sweeps; ++i) sum += each;
        return sum;
    }
};

/// Returns how a group would be cut on way.ranks ranks, as seen by a rank in the middle that leads
/// its host.
Cut cut_on(ChainGroup const& group, bool pairwise, GatherWay const& way) {
    dca::Partition const& here = group.partition;
    std::vector<std::int64_t> lengths;
    for (dca::ChainTree const& tree : here.trees) lengths.push_back(tree.bodies);
    Cut cut;
    cut.way = way;
    if (here.whole_chains) return cut;
    dca::Partition const there(lengths, pairwise, static_cast<int>(way.ranks), here.tip);
    for (int chain = 0; chain < there.chains(); ++chain)
        if (there.is_split(chain))
            cut.shared_units += there.trees[static_cast<std::size_t>(chain)].units;
    cut.inboard = cut.outboard = cut.shared_units > 0;
    return cut;
}

/// Messages of a step of all groups of a system.
class Groups {
  public:
    explicit Groups(ChainSystem const& system) : system_(system) {
        for (auto const& group : system.groups()) of_step_.emplace_back(*group, system.scene());
    }
    /// Returns the messages for a cut. `cut` maps a group to its cut as seen by one rank.
    template <class CutOf>
        requires std::invocable<CutOf, ChainGroup const&>
    Messages messages(CutOf const& cut) const {
        Messages sum;
        for (std::size_t i = 0; i < of_step_.size(); ++i) {
            Cut const at = cut(*system_.groups()[i]);
            Traffic const fixed = of_step_[i].a_step(0, at);
            sum.fixed += fixed;
            sum.each += of_step_[i].a_step(1, at) - fixed;
        }
        return sum;
    }
    /// Returns the messages as seen by a rank in the middle of way.ranks ranks.
    Messages messages(GatherWay const& way) const {
        bool const pairwise = system_.scene().solver.pairwise();
        return messages([&](ChainGroup const& group) { return cut_on(group, pairwise, way); });
    }
    /// Returns the messages of a step with the usual number of sweeps.
    Traffic traffic(GatherWay const& way) const {
        return messages(way).with(usual_sweeps(system_.scene().dynamics));
    }

  private:
    ChainSystem const& system_;
    std::vector<StepMessages> of_step_;
};

/// Describes the network: the file, and the link between hosts if it was given on the command line.
std::string network_text(PlanRequest const& request, Network const& network) {
    std::string text = request.network;
    if (!request.latency) return text;
    Link const &near = *network.near, &far = *network.far;
    bool const same = near.latency == far.latency && near.seconds_a_byte == far.seconds_a_byte;
    return text +
           fmt::format("{}{} and {:.3g} GB/s between hosts{}{}", text.empty() ? "" : ", with ",
                       duration_text(far.latency), 1e-9 / far.seconds_a_byte,
                       same ? "; the same within a host" : "",
                       text.empty() ? ", and gathers by the model: nothing was measured" : "");
}

/// Returns the predicted seconds of these messages.
double seconds_of(Traffic const& t, Network const& network, GatherWay const& way,
                  std::int64_t hosts) {
    double seconds = 0;
    if (t.gathers > 0)
        seconds += static_cast<double>(t.gathers) *
                   network.gather_seconds(t.gathered_bytes / t.gathers, way);
    if (t.exchanges > 0)
        seconds += static_cast<double>(t.exchanges) *
                   network.exchange_seconds(t.sent_bytes / t.exchanges, hosts);
    return seconds;
}

/// Adds the measured time of a step's messages on the present ranks, compared with the prediction
/// of the network model. Nothing is computed between the messages.
void add_measured(Text& text, Json& json, ChainSystem const& system, Groups const& groups,
                  Network const& network) {
    Communicator const& communicator = system.communicator();
    std::int64_t const ranks = communicator.size(), hosts = count_hosts(communicator);
    json["network"] = {{"measured", nullptr}};
    if (ranks == 1 || !network.near || (hosts > 1 && !network.far)) return;
    GatherWay const& way = communicator.gather_way();
    Traffic const t = groups.traffic(way);
    double const measured = time_messages(communicator, t, measurements),
                 predicted = seconds_of(t, network, way, hosts);
    text.entry("measured", fmt::format("messages take {} per step on these {} ranks, predicted {}",
                                       duration_text(measured), ranks, duration_text(predicted)));
    json["network"]["measured"] = {
        {"ranks", ranks}, {"hosts", hosts}, {"seconds", measured}, {"predicted", predicted}};
}

/// Returns the messages of a step on 1, 2, 4, ... and request.ranks ranks.
std::vector<MessagesOnRanks> messages_on(Groups const& groups, Network const& network,
                                         PlanRequest const& request) {
    std::vector<MessagesOnRanks> rows;
    for (std::int64_t const ranks : numbers_of_ranks(request.ranks)) {
        std::int64_t const hosts = std::max<std::int64_t>(1, request.hosts * ranks / request.ranks);
        GatherWay const way = GatherWay::of({}, ranks, hosts);
        Traffic const t = groups.traffic(way);
        rows.push_back({ranks, hosts, way.stages, t, seconds_of(t, network, way, hosts)});
    }
    return rows;
}

/// Adds the numbers and sizes of messages on the present ranks.
void add_counts(Text& text, Json& json, ChainSystem const& system, Groups const& groups) {
    GatherWay const& way = system.communicator().gather_way();
    Messages const here =
        groups.messages([&](ChainGroup const& group) { return cut_of(group, way); });
    text.heading("messages");
    text.entry("per step",
               fmt::format("{} gathers of {} bytes in all, {} exchanges in which rank 0 sends {} "
                           "bytes; each projection sweep or correction of tips adds {} gathers, {} "
                           "bytes, {} exchanges, {} bytes",
                           here.fixed.gathers, here.fixed.gathered_bytes, here.fixed.exchanges,
                           here.fixed.sent_bytes, here.each.gathers, here.each.gathered_bytes,
                           here.each.exchanges, here.each.sent_bytes));
    if (way.stages == 2)
        text.entry(
            "in two stages",
            fmt::format("{} waits within a host and {} gathers of {} bytes in all between hosts; "
                        "each sweep adds {}, {}, {} bytes",
                        here.fixed.host_waits, here.fixed.leader_gathers, here.fixed.leader_bytes,
                        here.each.host_waits, here.each.leader_gathers, here.each.leader_bytes));
    json["messages"] = {{"fixed", json_of(here.fixed)}, {"each_sweep", json_of(here.each)}};
}

}  // namespace

void add_messages(Text& text, Json& json, ChainSystem const& system, PlanRequest const& request,
                  Predictions const& predictions) {
    Scene const& scene = system.scene();
    json["messages"] = nullptr;
    if (!scene.dynamics.given) {
        if (request.ranks > 0)
            throw InputError("the scene has no dynamics section", scene.file,
                             "add one: --ranks predicts its steps");
        return;
    }
    Groups const groups(system);
    add_counts(text, json, system, groups);
    if (request.ranks == 0) return;
    Network const network = network_of(request);
    add_measured(text, json, system, groups, network);
    json["network"].update({{"near", network.near ? json_of(*network.near) : Json(nullptr)},
                            {"far", network.far ? json_of(*network.far) : Json(nullptr)}});
    text.entry("network", network_text(request, network));
    if (system.communicator().rank() == 0)
        add_steps(text, json, scene, messages_on(groups, network, request), predictions);
}

}  // namespace catena::command
