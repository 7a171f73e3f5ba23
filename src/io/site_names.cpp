// Implements the names of sites.
#include "io/site_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <unordered_map>

namespace catena {
namespace {

constexpr std::string_view pool = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
constexpr std::size_t longest_identifier = 8;

/// True for an identifier that a field of each format can hold.
bool is_usable(std::string const& identifier) {
    return !identifier.empty() && identifier.size() <= longest_identifier &&
           std::all_of(identifier.begin(), identifier.end(), [](unsigned char c) {
               return c < 128 && (std::isalnum(c) || c == '-' || c == '_' || c == '+' || c == '.');
           });
}

/// True if the residue continues the run in its direction. A run of one residue has none yet.
bool continues(ResidueRun const& run, ResidueRun const& next) {
    std::int64_t const step = run.count > 1 ? run.step : (next.place > run.place ? 1 : -1);
    return next.member == run.member && next.insertion == run.insertion &&
           next.place == run.place + step * run.count &&
           next.number == run.number + step * run.count;
}

}  // namespace

void append(Members& members, ResidueRun next) {
    if (!members.runs.empty()) {
        ResidueRun& run = members.runs.back();
        if (continues(run, next)) {
            if (run.count == 1) run.step = next.place > run.place ? 1 : -1;
            ++run.count;
            return;
        }
        next.first = run.first + run.count;
    }
    members.runs.push_back(next);
}

std::string chain_name(std::size_t number) {
    std::string name;
    for (++number; number > 0; number = (number - 1) / 26)
        name.insert(name.begin(), static_cast<char>('A' + (number - 1) % 26));
    return name;
}

std::string residue_of(Topology const& topology, std::size_t site) {
    std::string name = site < topology.residue.size() && !topology.residue[site].empty()
                           ? topology.residue[site]
                           : "UNK";
    for (char& c : name)
        if (c < ' ' || c > '~') c = '?';
    return name.substr(0, 3);
}

SiteNames::SiteNames(Topology const& topology) : topology_(topology) {
    std::size_t next = 0;
    for (std::size_t c = 0; c < topology.chains.size(); ++c) add_chain(c, next);
    last_run_.resize(identifiers_.size());
    for (std::size_t run = 0; run < runs_.size(); ++run) last_run_[runs_[run].member] = run;
    choose_identifiers();
    choose_letters();
}

void SiteNames::add_chain(std::size_t chain, std::size_t& next) {
    Topology::Chain const& of = topology_.chains[chain];
    std::vector<ResidueRun> const& all = topology_.members.runs;
    if (next == all.size() || all[next].first >= of.first + of.count) return add_own_member(chain);
    std::unordered_map<std::size_t, std::size_t> known;
    for (; next < all.size() && all[next].first < of.first + of.count; ++next) {
        ResidueRun run = all[next];
        auto const [found, is_new] = known.emplace(run.member, identifiers_.size());
        if (is_new) {
            identifiers_.push_back(topology_.members.identifiers[run.member]);
            chains_.push_back(chain);
        }
        run.member = found->second;
        runs_.push_back(run);
    }
}

void SiteNames::add_own_member(std::size_t chain) {
    Topology::Chain const& of = topology_.chains[chain];
    if (of.count > 0) runs_.push_back({of.first, of.count, identifiers_.size()});
    identifiers_.emplace_back();
    chains_.push_back(chain);
}

void SiteNames::choose_identifiers() {
    std::unordered_map<std::string, int> claims;
    for (std::string const& each : identifiers_)
        if (is_usable(each)) ++claims[each];
    std::size_t counter = 0;
    for (std::string& each : identifiers_) {
        auto const claim = claims.find(each);
        if (claim != claims.end() && claim->second == 1) continue;
        auto const is_kept = [&](std::string const& name) {
            auto const other = claims.find(name);
            return other != claims.end() && other->second == 1;
        };
        while (is_kept(chain_name(counter))) ++counter;
        each = chain_name(counter++);
    }
}

void SiteNames::choose_letters() {
    std::set<char> used;
    for (std::string const& each : identifiers_)
        if (each.size() == 1) used.insert(each[0]);
    for (std::size_t member = 0; member < identifiers_.size(); ++member) {
        std::string const& own = identifiers_[member];
        char letter = own.size() == 1 ? own[0] : pool[member % pool.size()];
        if (own.size() > 1 && used.contains(letter)) {
            auto const is_free = [&](char c) { return !used.contains(c); };
            auto const other = std::find_if(pool.begin(), pool.end(), is_free);
            if (other != pool.end()) letter = *other;
        }
        used.insert(letter);
        letters_ += letter;
    }
}

std::size_t SiteNames::run_of(std::int64_t site) const {
    auto const after =
        std::upper_bound(runs_.begin(), runs_.end(), site,
                         [](std::int64_t s, ResidueRun const& run) { return s < run.first; });
    return static_cast<std::size_t>(after - runs_.begin()) - 1;
}

std::vector<SiteNames::Bond> SiteNames::bonds() const {
    std::vector<Bond> bonds;
    for (std::size_t begin = 0, end = 0; begin < runs_.size(); begin = end) {
        std::size_t const chain = chains_[runs_[begin].member];
        while (end < runs_.size() && chains_[runs_[end].member] == chain) ++end;
        Topology::Chain const& of = topology_.chains[chain];
        if (of.parent.empty()) add_bonds(begin, end, bonds);
        for (std::size_t k = 1; k < of.parent.size(); ++k)
            bonds.emplace_back(of.first + of.parent[k], of.first + static_cast<std::int64_t>(k));
        for (auto const& [a, b] : of.crosslinks) bonds.emplace_back(of.first + a, of.first + b);
        if (of.ring && of.count > 2) bonds.emplace_back(of.first + of.count - 1, of.first);
    }
    return bonds;
}

void SiteNames::add_bonds(std::size_t begin, std::size_t end, std::vector<Bond>& bonds) const {
    // Sites by member and place: the order of a member may differ from that of the sites.
    std::map<std::size_t, std::vector<std::pair<std::int64_t, std::int64_t>>> sites;
    for (std::size_t r = begin; r < end; ++r) {
        ResidueRun const& run = runs_[r];
        for (std::int64_t k = 0; k < run.count; ++k)
            sites[run.member].emplace_back(run.place + run.step * k, run.first + k);
    }
    for (auto& [member, of_member] : sites) {
        std::sort(of_member.begin(), of_member.end());
        for (std::size_t k = 1; k < of_member.size(); ++k)
            if (of_member[k].first == of_member[k - 1].first + 1)
                bonds.emplace_back(of_member[k - 1].second, of_member[k].second);
    }
}

}  // namespace catena
