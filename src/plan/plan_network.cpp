// Implements the reading of the network model from the JSON of `catena bench network`.
#include "plan/plan_network.hpp"

#include <fmt/format.h>

#include <cmath>

#include "console/outcome.hpp"
#include "error.hpp"
#include "io/output_file.hpp"

namespace catena::command {
namespace {

/// Returns the number at `key`, in seconds or bytes. Throws InputError unless it is finite and at
/// least zero.
double quantity(Json const& json, char const* key) {
    double const value = json.at(key).get<double>();
    if (!std::isfinite(value) || value < 0)
        throw InputError(fmt::format("{} is {}", key, value), "--network",
                         "give 0 or a positive number");
    return value;
}

/// Reads a link: `latency` in s with `bandwidth` in bytes per s or `seconds_a_byte`.
Link link_of(Json const& json) {
    if (!json.contains("bandwidth"))
        return {quantity(json, "latency"), quantity(json, "seconds_a_byte")};
    double const bandwidth = quantity(json, "bandwidth");
    if (bandwidth == 0) throw InputError("bandwidth is 0", "--network", "give bytes per second");
    return {quantity(json, "latency"), 1 / bandwidth};
}

/// Reads the whole file. A network of one host may have one link only, which then holds for all.
Network read_network(std::string const& file) {
    Network network;
    try {
        Json const json = Json::parse(read_text_file(file)).at("network");
        for (auto const& [key, link] : {std::pair{"near", &network.near}, {"far", &network.far}})
            if (json.contains(key) && !json.at(key).is_null()) *link = link_of(json.at(key));
        if (json.contains("gather_overhead"))
            network.gather_overhead = quantity(json, "gather_overhead");
    } catch (Json::exception const&) {
        throw InputError("not the JSON of a network", "--network " + file,
                         "write it with mpirun -np 2 catena bench network --json " + file);
    }
    if (!network.near) network.near = network.far;
    return network;
}

}  // namespace

Network network_of(PlanRequest const& request) {
    Network network;
    if (!request.network.empty()) network = read_network(request.network);
    if (request.latency) network.far = Link{*request.latency, *request.seconds_a_byte};
    // A file that was written on one rank contains no link at all.
    if (!network.near) network.near = network.far;
    if (request.ranks > 1 && !network.near)
        throw InputError("the network was measured on one rank", "--network " + request.network,
                         "add --latency and --bandwidth (1.5us, 12.5GB/s), or measure on at least "
                         "two ranks: mpirun -np 2 catena bench network");
    if (request.hosts > 1 && !network.far)
        throw InputError("the network was measured on one host and has no link between hosts",
                         "--network " + request.network,
                         "add --latency and --bandwidth of that link (1.5us, 12.5GB/s), measure "
                         "over two hosts, or leave --hosts out");
    return network;
}

}  // namespace catena::command
