// Names of a trajectory's sites in topology files: chain identifiers, residue numbers, bonds.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/output.hpp"

namespace catena {

/// Returns the chain name A, B, ..., Z, AA, AB, ..., of any length.
std::string chain_name(std::size_t number);

/// Residue name of a site in the form that the formats hold: at most three characters of printable
/// ASCII. UNK if the site has no name.
std::string residue_of(Topology const&, std::size_t site);

/// Appends a residue, the run `next` of one, to the last run if it continues that, else as a run
/// of its own. Sets `first` of `next` to the number of residues so far.
void append(Members&, ResidueRun next);

/// Names of all sites. A chain of the topology without members is a member of its own, whose sites
/// are numbered from 1. A member keeps the identifier of its structure file if no other member has
/// it and if it is at most 8 letters, digits or signs; all others count A, B, ..., Z, AA, ....
class SiteNames {
  public:
    /// Pair of bonded sites, numbered from 0.
    using Bond = std::pair<std::int64_t, std::int64_t>;

    explicit SiteNames(Topology const&);

    /// Runs of all sites, in their order.
    std::vector<ResidueRun> const& runs() const { return runs_; }
    /// Index of the run that holds a site.
    std::size_t run_of(std::int64_t site) const;
    /// Number of members of all chains.
    std::size_t members() const { return identifiers_.size(); }
    /// Identifier of a member, different from all others.
    std::string const& identifier(std::size_t member) const { return identifiers_[member]; }
    /// Identifier of one character; the 62 letters and digits repeat if there are more members.
    char letter(std::size_t member) const { return letters_[member]; }
    /// Index of the member's chain in the topology.
    std::size_t chain(std::size_t member) const { return chains_[member]; }
    /// True if no site after the run belongs to its member.
    bool ends_member(std::size_t run) const { return last_run_[runs_[run].member] == run; }
    /// Bonds between neighbours along members or along branches, and between the ends of rings. A
    /// bond of a branched chain begins at the site on which the other hangs.
    std::vector<Bond> bonds() const;

  private:
    /// Adds the members of a chain. `next`: first run of the topology that is not yet added.
    void add_chain(std::size_t chain, std::size_t& next);
    void add_own_member(std::size_t chain);
    void choose_identifiers();
    void choose_letters();
    /// Appends the bonds along the members of the runs [begin, end) of one chain.
    void add_bonds(std::size_t begin, std::size_t end, std::vector<Bond>& bonds) const;

    Topology const& topology_;
    std::vector<ResidueRun> runs_;
    std::vector<std::string> identifiers_;
    std::string letters_;
    std::vector<std::size_t> chains_, last_run_;  // per member
};

}  // namespace catena
