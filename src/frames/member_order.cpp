// Implements the order of sites by members.
#include "frames/member_order.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "io/site_names.hpp"

namespace catena {
namespace {

constexpr std::int64_t largest = std::int64_t{1} << 40;  // place and residue number to believe

/// A site of a member.
struct Residue {
    std::size_t member;
    std::int64_t place;
    std::size_t site;

    bool operator<(Residue const& other) const {
        return std::pair(member, place) < std::pair(other.member, other.place);
    }
};

/// Sites in the order of members, each along its residues.
std::vector<Residue> sorted_residues(SiteNames const& names) {
    std::vector<Residue> all;
    for (ResidueRun const& run : names.runs())
        for (std::int64_t k = 0; k < run.count; ++k)
            all.push_back(
                {run.member, run.place + run.step * k, static_cast<std::size_t>(run.first + k)});
    std::sort(all.begin(), all.end());
    return all;
}

/// Number of members of each chain.
std::vector<std::size_t> members_per_chain(SiteNames const& names, std::size_t chains) {
    std::vector<std::size_t> number(chains, 0);
    for (std::size_t m = 0; m < names.members(); ++m) ++number[names.chain(m)];
    return number;
}

}  // namespace

MemberOrder by_members(Topology const& from) {
    SiteNames const names(from);
    std::vector<std::size_t> const members = members_per_chain(names, from.chains.size());
    MemberOrder made{from, {}};
    Topology& to = made.topology;
    to.chains.clear();
    to.members = {};
    for (std::size_t m = 0; m < names.members(); ++m) {
        Topology::Chain chain = from.chains[names.chain(m)];
        if (members[names.chain(m)] > 1) chain.name += ":" + names.identifier(m);
        chain.first = chain.count = 0;
        to.chains.push_back(chain);
    }
    std::vector<Residue> const residues = sorted_residues(names);
    for (Residue const& each : residues) {
        std::size_t const k = made.site.size();
        to.mass[k] = from.mass[each.site];
        to.residue[k] = from.residue[each.site];
        ++to.chains[each.member].count;
        made.site.push_back(each.site);
    }
    std::int64_t first = 0;
    for (Topology::Chain& chain : to.chains)
        chain.first = std::exchange(first, first + chain.count);
    return made;
}

bool is_complex(Topology const& topology, std::size_t chain) {
    Topology::Chain const& of = topology.chains[chain];
    std::set<std::size_t> members;
    auto const first =
        std::lower_bound(topology.members.runs.begin(), topology.members.runs.end(), of.first,
                         [](ResidueRun const& run, std::int64_t site) { return run.first < site; });
    for (auto run = first; run != topology.members.runs.end() && run->first < of.first + of.count;
         ++run)
        members.insert(run->member);
    return members.size() > 1;
}

std::optional<Members> members_of_sites(Topology const& topology,
                                        std::vector<std::string> const& identifiers,
                                        std::vector<std::int64_t> const& member,
                                        std::vector<std::int64_t> const& place,
                                        std::vector<std::int64_t> const& number) {
    std::size_t const sites = topology.mass.size();
    if (member.size() != sites || place.size() != sites || number.size() != sites)
        return std::nullopt;
    Members made{identifiers, {}};
    std::vector<std::size_t> chain_of(identifiers.size(), std::numeric_limits<std::size_t>::max());
    std::vector<std::pair<std::int64_t, std::int64_t>> places;
    for (std::size_t c = 0, k = 0; c < topology.chains.size(); ++c)
        for (std::int64_t i = 0; i < topology.chains[c].count; ++i, ++k) {
            if (member[k] < 0 || member[k] >= std::ssize(identifiers) || place[k] < 0 ||
                place[k] > largest || number[k] > largest || number[k] < -largest)
                return std::nullopt;
            auto const m = static_cast<std::size_t>(member[k]);
            if (chain_of[m] < c) return std::nullopt;
            chain_of[m] = c;
            places.emplace_back(member[k], place[k]);
            append(made, {0, 1, m, place[k], number[k]});
        }
    std::sort(places.begin(), places.end());
    if (std::adjacent_find(places.begin(), places.end()) != places.end()) return std::nullopt;
    return made;
}

}  // namespace catena
