// Implements the collection of members and its compression to runs.
#include "structure/member_names.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "io/site_names.hpp"

namespace catena::scene {
namespace {

/// Insertion code of a label such as "52A"; blank if the label is only a number.
char insertion_of(PdbSite const& site) {
    if (!site.number || site.label.empty()) return ' ';
    std::string const number = std::to_string(*site.number);
    bool const one_more = site.label.size() == number.size() + 1 && site.label.starts_with(number);
    return one_more ? site.label.back() : ' ';
}

}  // namespace

std::size_t MemberNames::announce(PdbSiteChain const& chain, std::size_t residues) {
    std::array<std::string, 2> const key{chain.name, chain.label};
    auto const found = std::find(members_.begin(), members_.end(), key);
    auto const member = static_cast<std::size_t>(found - members_.begin());
    if (found == members_.end()) {
        members_.push_back(key);
        places_.push_back(0);
    } else {
        ++places_[member];
    }
    pieces_.push_back({member, places_[member]});
    places_[member] += static_cast<std::int64_t>(residues);
    return pieces_.size() - 1;
}

void MemberNames::add(std::size_t piece, std::size_t residue, PdbSite const& site) {
    residues_.push_back({pieces_[piece].member,
                         pieces_[piece].place + static_cast<std::int64_t>(residue),
                         site.number.value_or(0), insertion_of(site), site.number.has_value()});
}

std::vector<bool> MemberNames::numbered_members() const {
    std::vector<bool> numbered(members_.size(), true);
    std::set<std::tuple<std::size_t, std::int64_t, char>> known;
    for (Residue const& each : residues_)
        if (!each.numbered || !known.emplace(each.member, each.number, each.insertion).second)
            numbered[each.member] = false;
    return numbered;
}

Members MemberNames::take() const {
    Members made;
    for (auto const& [name, label] : members_) made.identifiers.push_back(name);
    std::vector<bool> const numbered = numbered_members();
    for (Residue const& each : residues_) {
        bool const own = numbered[each.member];
        append(made, {0, 1, each.member, each.place, own ? each.number : each.place + 1, 1,
                      own ? each.insertion : ' '});
    }
    return made;
}

Members members_of(PdbSites const& one_chain) {
    MemberNames names;
    std::size_t const piece = names.announce(one_chain.chains[0], one_chain.sites.size());
    for (std::size_t k = 0; k < one_chain.sites.size(); ++k)
        names.add(piece, k, one_chain.sites[k]);
    return names.take();
}

}  // namespace catena::scene
