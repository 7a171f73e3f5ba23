// Implements the reader of mmCIF files. gemmi parses the text into tables of strings; the items of
// `_atom_site` become the same atoms as the records of a PDB file.
#include "structure/mmcif_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <gemmi/cif.hpp>
#include <gemmi/util.hpp>
#include <gemmi/version.hpp>
#include <set>
#include <unordered_map>

#include "scene/fields.hpp"
#include "scene/text_lines.hpp"

namespace catena::scene {

namespace {

namespace cif = gemmi::cif;

/// Value without its quotes; empty for the nulls `.` and `?`. It refers to the table.
std::string_view plain(std::string_view value) {
    if (value == "." || value == "?") return {};
    if (value.size() >= 2 && (value[0] == '\'' || value[0] == '"') && value.back() == value[0])
        return value.substr(1, value.size() - 2);
    bool const block = value.size() > 3 && value[0] == ';' && value.ends_with("\n;");
    return block ? trimmed(value.substr(1, value.size() - 3)) : value;
}

/// A category of a block, as a loop or as single items, with columns in a fixed order.
template <std::size_t Columns>
class Category {
  public:
    Category(cif::Block const& block, std::string const& prefix,
             std::array<char const*, Columns> const& names) {
        for (std::size_t c = 0; c < Columns; ++c) {
            // gemmi 0.5.7 finds loops by tags in lower case only.
            std::string const tag = gemmi::to_lower(prefix + names[c]);
            if (cif::Item const* const item = block.find_loop_item(tag)) {
                loop_ = &item->loop;
                column_[c] = item->loop.find_tag(tag);
            } else if (cif::Pair const* const pair = block.find_pair(tag)) {
                single_[c] = &(*pair)[1];
            }
        }
    }
    std::size_t rows() const {
        if (loop_ != nullptr) return loop_->length();
        return std::any_of(single_.begin(), single_.end(), [](auto* v) { return v != nullptr; });
    }
    bool has(std::size_t c) const { return column_[c] >= 0 || single_[c] != nullptr; }
    /// Value of column c; empty if the category lacks it.
    std::string_view at(std::size_t row, std::size_t c) const {
        if (loop_ == nullptr) return single_[c] ? plain(*single_[c]) : std::string_view();
        return column_[c] < 0 ? std::string_view()
                              : plain(loop_->val(row, static_cast<std::size_t>(column_[c])));
    }

  private:
    static std::array<int, Columns> none() {
        std::array<int, Columns> columns;
        columns.fill(-1);
        return columns;
    }
    cif::Loop const* loop_ = nullptr;
    std::array<int, Columns> column_ = none();
    std::array<std::string const*, Columns> single_{};
};

/// Columns of `_atom_site`, in the order of `item_names`.
enum Item : std::size_t {
    group,
    element,
    label_atom,
    auth_atom,
    alternate,
    label_residue,
    auth_residue,
    label_chain,
    auth_chain,
    entity,
    label_number,
    auth_number,
    insertion,
    x,
    y,
    z,
    occupancy,
    b_factor,
    model_of,
    items
};
constexpr std::array<char const*, items> item_names = {
    "group_PDB",     "type_symbol",  "label_atom_id",     "auth_atom_id",      "label_alt_id",
    "label_comp_id", "auth_comp_id", "label_asym_id",     "auth_asym_id",      "label_entity_id",
    "label_seq_id",  "auth_seq_id",  "pdbx_PDB_ins_code", "Cartn_x",           "Cartn_y",
    "Cartn_z",       "occupancy",    "B_iso_or_equiv",    "pdbx_PDB_model_num"};
using AtomTable = Category<items>;

std::optional<std::int64_t> whole_number(std::string_view text) {
    double value = 0;
    bool const read = parse_number(text, value) == NumberFault::none &&
                      value == std::floor(value) && std::abs(value) < 1e9;
    return read ? std::optional(static_cast<std::int64_t>(value)) : std::nullopt;
}

/// Reads a coordinate; a standard uncertainty in brackets is dropped.
double coordinate(std::string_view text, std::string const& path, std::size_t row) {
    double value = 0;
    std::string_view const number = text.substr(0, text.find('('));
    if (parse_number(number, value) != NumberFault::none)
        throw InputError(fmt::format("`{}` is not a number", shown(text)),
                         fmt::format("{}: row {} of _atom_site", path, row + 1),
                         "give Cartn_x, Cartn_y and Cartn_z in angstrom");
    return value;
}

/// Reads the atoms of one block.
class AtomRows {
  public:
    AtomRows(cif::Block const& block, std::string const& path)
        : table_(block, "_atom_site.", item_names), path_(path) {
        for (Item const needed : {x, y, z})
            if (!table_.has(needed))
                throw InputError(fmt::format("`_atom_site` lacks {}", item_names[needed]), path,
                                 "write an mmCIF file with coordinates");
    }

    /// Reads the rows; `sequence_of` receives the entity of each chain.
    void read(std::optional<std::int64_t> model, PdbSummary& summary, TakeAtom const& take,
              std::map<std::string, std::string>& entity_of) {
        ModelChoice choice(model);
        bool open = false;
        for (std::size_t row = 0; row < table_.rows(); ++row) {
            std::int64_t const number = whole_number(table_.at(row, model_of)).value_or(1);
            if (summary.models.empty() || summary.models.back() != number)
                open = choice.begin(number, summary);
            if (!open) continue;
            PdbAtom const atom = atom_of(row);
            entity_of.try_emplace(std::string(atom.label), table_.at(row, entity));
            ++summary.atoms;
            take(atom);
        }
    }

  private:
    /// The first of two items that has a value.
    std::string_view either(std::size_t row, Item first, Item second) const {
        std::string_view const value = table_.at(row, first);
        return value.empty() ? table_.at(row, second) : value;
    }
    static char letter(std::string_view text) { return text.empty() ? ' ' : text[0]; }

    PdbAtom atom_of(std::size_t row) {
        PdbAtom atom;
        atom.line = static_cast<std::int64_t>(row) + 1;
        atom.row = true;
        atom.het = table_.at(row, group) == "HETATM";
        atom.alternate = letter(table_.at(row, alternate));
        atom.insertion = letter(table_.at(row, insertion));
        atom.element = table_.at(row, element);
        atom.at_margin = atom.element.size() == 2;
        atom.name = either(row, label_atom, auth_atom);
        atom.residue = either(row, auth_residue, label_residue);
        atom.chain = either(row, auth_chain, label_chain);
        atom.label = either(row, label_chain, auth_chain);
        atom.number = either(row, auth_number, label_number);
        atom.sequence_index = whole_number(table_.at(row, label_number));
        atom.part = part_of(atom.label);
        for (int i = 0; i < 3; ++i)
            atom.position[i] =
                coordinate(table_.at(row, x + static_cast<std::size_t>(i)), path_, row);
        if (double value = 1; parse_number(table_.at(row, occupancy), value) == NumberFault::none)
            atom.occupancy = value;
        if (double value = 0; parse_number(table_.at(row, b_factor), value) == NumberFault::none)
            atom.b_factor = value;
        return atom;
    }
    int part_of(std::string_view label) {
        if (label != last_) ++part_;
        last_ = label;
        return part_;
    }

    AtomTable table_;
    std::string const& path_;
    std::string_view last_;
    int part_ = 0;
};

/// Largest number of a residue in `_entity_poly_seq`; rows with larger ones are left out.
constexpr std::int64_t most_numbered = 1'000'000;
/// Largest number of residues of all chains together that `_entity_poly_seq` may list. It stops
/// small files that are made to fill memory; the capsid of HIV has 300,000.
constexpr std::int64_t most_listed = 10'000'000;

/// Reads the sequence of each chain from `_entity_poly_seq`. Throws InputError for too many.
void read_sequences(cif::Block const& block, std::map<std::string, std::string> const& entity_of,
                    std::string const& path, PdbSummary& summary) {
    Category<3> const table(block, "_entity_poly_seq.", {"entity_id", "num", "mon_id"});
    std::map<std::string, std::map<std::int64_t, std::string>, std::less<>> residues;
    for (std::size_t row = 0; row < table.rows(); ++row)
        if (auto const at = whole_number(table.at(row, 1)))
            residues[std::string(table.at(row, 0))].try_emplace(*at, table.at(row, 2));
    std::int64_t all = 0;
    for (auto const& [label, entity] : entity_of) {
        auto const found = residues.find(entity);
        if (found == residues.end()) continue;
        if (!found->second.empty())
            all += std::clamp<std::int64_t>(found->second.rbegin()->first, 0, most_numbered);
        if (all > most_listed)
            throw InputError(
                fmt::format("`_entity_poly_seq` lists more than {} residues for the chains",
                            most_listed),
                path, "correct its numbers, or leave chains out");
        ListedSequence& listed = summary.sequence[label];
        for (auto const& [at, name] : found->second) {
            // A number that the table leaves out stays a residue without a name.
            if (at < 1 || at > most_numbered) continue;
            listed.names.resize(std::max(listed.names.size(), static_cast<std::size_t>(at)));
            listed.names[static_cast<std::size_t>(at) - 1] = name;
        }
        listed.residues = std::ssize(listed.names);
    }
}

void read_cell(cif::Block const& block, PdbSummary& summary) {
    Category<6> const table(
        block, "_cell.",
        {"length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"});
    Vec3 edges{}, angles{};
    for (int i = 0; i < 3 && table.rows() > 0; ++i) {
        auto const read = [&](int column, double& value) {
            std::string_view const text = table.at(0, static_cast<std::size_t>(column));
            return parse_number(text.substr(0, text.find('(')), value) == NumberFault::none;
        };
        if (!read(i, edges[i]) || !read(3 + i, angles[i])) return;
    }
    summary.cell = rectangular_cell(edges, angles);
}

}  // namespace

std::shared_ptr<void const> parse_mmcif(std::string_view text, std::string const& path) try {
    auto document = std::make_shared<cif::Document>();
    tao::pegtl::memory_input<> input(text.data(), text.size(), path);
    cif::parse_input(*document, input);
    document->source = path;
    // Blocks may share a name: the first one with atoms is read.
    std::set<std::string> names;
    for (cif::Block& block : document->blocks)
        while (!names.insert(gemmi::to_lower(block.name)).second) block.name += '\'';
    cif::check_for_missing_values(*document);
    cif::check_for_duplicates(*document);
    return document;
} catch (std::bad_alloc const&) {
    throw;
} catch (std::exception const& error) {
    // gemmi begins its messages with the place in the file.
    std::string reason = error.what();
    if (reason.starts_with(path + ":")) reason = "line " + reason.substr(path.size() + 1);
    throw InputError(fmt::format("the file is not valid mmCIF ({})", shown(reason, 200)), path,
                     "correct that line, or fetch the file again");
}

PdbSummary for_each_mmcif_atom(std::shared_ptr<void const> const& tables, std::string const& path,
                               std::optional<std::int64_t> model, TakeAtom const& take) {
    auto const& document = *static_cast<cif::Document const*>(tables.get());
    PdbSummary summary;
    summary.blocks = 0;
    for (cif::Block const& block : document.blocks) {
        if (AtomTable(block, "_atom_site.", item_names).rows() == 0) continue;
        if (++summary.blocks > 1) continue;
        std::map<std::string, std::string> entity_of;
        AtomRows(block, path).read(model, summary, take, entity_of);
        read_sequences(block, entity_of, path, summary);
        read_cell(block, summary);
    }
    return summary;
}

std::string gemmi_version() { return GEMMI_VERSION; }

}  // namespace catena::scene
