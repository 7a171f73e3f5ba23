// Residues by the numbers that a scene uses: those of a file, or counted from 1.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bodies/domains.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Names of the residues that `rigid` may use. The residues of several chains follow each other.
struct ResidueNumbers {
    /// Number of residues; without labels they are numbered from 1.
    std::size_t residues = 0;
    /// Number of each residue, such as a file's "52A"; empty without a file.
    std::vector<std::string> labels = {};
    /// Chain of each residue: the authors' name and the label; empty without a file.
    std::vector<std::array<std::string, 2>> chains = {};
    /// Names of the file's chains that the entry does not choose.
    std::vector<std::string> other_chains = {};
    /// First residue of each chain, ascending; empty for a single chain.
    std::vector<std::size_t> begins = {};

    /// Index of the residue's chain, from 0.
    std::size_t chain_of(std::size_t residue) const;
    /// Residues [first, last) of a chain.
    std::array<std::size_t, 2> range_of(std::size_t chain) const;
    std::size_t number_of_chains() const { return begins.empty() ? 1 : begins.size(); }
    /// True if the residues belong to chains of different names.
    bool several_names() const;
    /// True if the labels are 1, 2, 3, ..., or absent.
    bool count_from_one() const;
    /// Number of a residue as the scene writes it.
    std::string label(std::size_t residue) const;
    /// Returns "residues 5 to 30", or "residue 5", with the chain's name if there are several.
    std::string span(std::size_t first, std::size_t last) const;
};

/// One end of a range as written.
struct ResidueName {
    std::string chain;  // empty without a chain
    std::string label;
};

/// Resolves the residue numbers of a scene's `rigid`.
class Numbering {
  public:
    /// `numbers` must outlive the object.
    explicit Numbering(ResidueNumbers const& numbers);

    /// Advice for messages: the valid range of numbers, of one chain if it is named. Where several
    /// chains could use the same numbers, ranges are written with their chain.
    std::string remedy(std::string const& chain = "") const;
    /// Reads [first, last] or "CHAIN:FIRST-LAST", where "CHAIN:" may be left out. Blanks around the
    /// parts do not count. Throws InputError for unknown chains, unknown and ambiguous residues,
    /// other forms, and if the last residue precedes the first.
    Domain range(Node const& node) const;
    /// Residues with the number of the range's last one and an insertion code that the range leaves
    /// out, such as "52A, 52B" after 48 to 52; empty without any.
    std::string left_out_insertions(Domain const& range) const;
    /// Test for the names of the file's chains, which outlives the Numbering but not its numbers.
    std::function<bool(std::string const&)> chain_names() const;
    /// True for a list of ranges, such as ["A:1-95", "B:1-88"] or [[1, 30], [41, 80]].
    static bool is_list_of_ranges(Node const& node);

  private:
    std::array<ResidueName, 2> ends_of(Node const& node) const;
    std::array<ResidueName, 2> ends_in(Node const& node) const;
    bool is_chain(std::string const& name) const;
    void refuse_unknown_chain(Node const& node, std::string const& chain) const;
    void refuse_missing_colon(Node const& node, std::string const& written) const;
    std::string remedy_of_chains(std::string const& chain) const;
    std::string other_codes(ResidueName const& end) const;
    void refuse_backwards(Node const& node, Domain const& range) const;
    bool in_chain(std::size_t residue, std::string const& chain) const;
    std::size_t residue(Node const& node, ResidueName const& end) const;
    std::size_t counted_residue(Node const& node, ResidueName const& end) const;
    std::string label(Node const& end) const;

    ResidueNumbers const& numbers_;
    /// Residues of each label. A file may use a label more than once, which only matters if a range
    /// names it.
    std::map<std::string, std::vector<std::size_t>> residues_;
};

}  // namespace catena::scene
