// Sorts the chains of a topology into kinds.
#include "analysis/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace catena::analysis {
namespace {

/// Bytes in which equal chains agree and other chains differ.
std::string signature(Topology const& topology, Topology::Chain const& chain) {
    auto const first = static_cast<std::size_t>(chain.first),
               count = static_cast<std::size_t>(chain.count);
    std::string key(chain.ring ? "ring " : "open ");
    std::string masses(count * sizeof(double), '\0');
    std::memcpy(masses.data(), topology.mass.data() + first, masses.size());
    key += masses;
    for (std::size_t k = first; k < first + count; ++k) key += topology.residue[k] + ' ';
    for (std::int64_t const parent : chain.parent) key += std::to_string(parent) + ' ';
    for (auto const& [a, b] : chain.crosslinks) key += fmt::format("{}-{} ", a, b);
    return key;
}

/// Number of replicas that have the chains; 1 unless all have the same number of them.
std::size_t replicas_of(Topology const& topology, std::vector<std::size_t> const& chains) {
    std::map<std::int64_t, std::size_t> number;
    for (std::size_t const c : chains) ++number[topology.chains[c].replica];
    bool const alike = std::all_of(number.begin(), number.end(), [&](auto const& each) {
        return each.second == number.begin()->second;
    });
    return alike ? number.size() : 1;
}

/// Returns the beginning that all names share, without the digits and separators at its end.
std::string shared_name(Topology const& topology, std::vector<std::size_t> const& chains) {
    std::string name = topology.chains[chains.front()].name;
    if (chains.size() == 1) return name;
    for (std::size_t const chain : chains) {
        std::string const& other = topology.chains[chain].name;
        name.resize(static_cast<std::size_t>(
            std::mismatch(name.begin(), name.end(), other.begin(), other.end()).first -
            name.begin()));
    }
    std::size_t const end = name.find_last_not_of("0123456789 _-.:#[(");
    return end == std::string::npos ? topology.chains[chains.front()].name
                                    : name.substr(0, end + 1);
}

/// Returns the complexes' shared name with the members of the kind: "A+B:A and B". Chains that are
/// no members have their shared name.
std::string name_of_members(Topology const& topology, std::vector<std::size_t> const& chains) {
    std::vector<std::string> members;
    for (std::size_t const chain : chains) {
        std::string const& name = topology.chains[chain].name;
        std::size_t const colon = name.rfind(':');
        if (colon == std::string::npos) return shared_name(topology, chains);
        std::string const member = name.substr(colon + 1);
        if (std::find(members.begin(), members.end(), member) == members.end())
            members.push_back(member);
    }
    std::string const shared = shared_name(topology, chains);
    if (chains.size() == 1) return shared;
    std::string name = shared.substr(0, shared.find(':')) + ":" + members[0];
    if (members.size() == 2) name += " and " + members[1];
    if (members.size() > 2) name += fmt::format(" and {} more", members.size() - 1);
    return name;
}

}  // namespace

std::vector<Kind> kinds_of(Topology const& topology, bool by_members) {
    std::vector<Kind> kinds;
    std::map<std::string, std::size_t> known;
    for (std::size_t c = 0; c < topology.chains.size(); ++c) {
        Topology::Chain const& chain = topology.chains[c];
        if (chain.count == 0) continue;
        auto const [found, is_new] = known.emplace(signature(topology, chain), kinds.size());
        if (is_new) kinds.push_back({"", chain.count, chain.ring, {}, 1, chain.parent});
        kinds[found->second].chains.push_back(c);
    }
    std::set<std::string> taken;
    for (Kind& kind : kinds) {
        kind.replicas = replicas_of(topology, kind.chains);
        std::string const name = by_members ? name_of_members(topology, kind.chains)
                                            : shared_name(topology, kind.chains);
        kind.name = name;
        for (int number = 2; !taken.insert(kind.name).second; ++number)
            kind.name = name + " (" + std::to_string(number) + ")";
    }
    return kinds;
}

}  // namespace catena::analysis
