// Tables of residue types: parameters of one bead per residue, in the columns of the CALVADOS
// package. Three tables are part of the program; chains may bring tables of their own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catena {

namespace scene {
struct Node;
}

/// Parameters of one residue type.
struct ResidueType {
    char letter;       // one-letter code
    std::string name;  // three-letter code, upper case
    double mass;       // amu
    double lambda;     // stickiness
    double sigma;      // bead diameter, nm
    double charge;     // e, inside a chain; histidine: without a pH
    double bond;       // nm; a link is as long as the mean of its two residues' bonds
    bool operator==(ResidueType const&) const = default;
};

/// Residue types with their codes, all different.
class ResidueTable {
  public:
    /// Takes the table's name in messages, e.g. "calvados2" or the path of a file.
    ResidueTable(std::string name, std::vector<ResidueType> types)
        : name_(std::move(name)), types_(std::move(types)) {}

    std::string const& name() const { return name_; }
    /// Residue types in the order of the table.
    std::vector<ResidueType> const& types() const { return types_; }
    /// Returns nullptr for a code that is not in the table. Codes are compared as they are written.
    ResidueType const* find(char letter) const;
    ResidueType const* find(std::string_view name) const;
    /// All one-letter codes, in the order of the table.
    std::string letters() const;

  private:
    std::string name_;
    std::vector<ResidueType> types_;
};

/// Returns the table of the program with that name, "calvados2", "calvados3" or "calvados_rna", or
/// nullptr.
ResidueTable const* built_in_table(std::string_view name);

/// Reads a table: a line of column names in any order (one, three, MW, lambdas, sigmas, q,
/// bondlength), then one residue per line. Blank lines and text from `#` on are skipped. Throws
/// InputError with the line for other columns, a code that occurs twice, a value that is missing or
/// no number, and sizes and masses that are not positive or not in nm and amu. `name` is the
/// table's name in messages.
ResidueTable parse_residue_table(std::string const& text, std::string const& name);

/// Reads the table in a file. `at` names the requesting key in messages.
ResidueTable read_residue_table(std::string const& path, scene::Node const& at);

}  // namespace catena
