// Implements the PDB parser: fixed columns, with the deviations of common programs.
#include "structure/pdb_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "scene/fields.hpp"
#include "scene/text_lines.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

/// Returns `count` columns from `first` (from 1) on, trimmed; empty if the line is shorter.
std::string_view columns(std::string_view line, std::size_t first, std::size_t count) {
    return line.size() < first ? std::string_view() : trimmed(line.substr(first - 1, count));
}

/// Character in column `at` (from 1); a blank beyond the line's end.
char column(std::string_view line, std::size_t at) { return line.size() < at ? ' ' : line[at - 1]; }

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Extracts the next line without its end (LF, CR LF or CR). Returns false at the end of the text.
bool next_line(std::string_view& rest, std::string_view& line) {
    if (rest.empty()) return false;
    std::size_t const end = std::min(rest.find_first_of("\r\n"), rest.size());
    line = rest.substr(0, end);
    bool const pair = rest.substr(end).starts_with("\r\n");
    rest.remove_prefix(std::min(end + (pair ? 2 : 1), rest.size()));
    return true;
}

/// Removes a byte order mark.
std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

/// Refuses files of other formats with an advice for each.
void refuse_other_formats(std::string_view text, std::string const& path) {
    auto const refuse = [&](char const* what, char const* remedy) {
        throw InputError(what, path, remedy);
    };
    if (text.substr(0, 4096).find('\0') != std::string_view::npos)
        refuse("the file is not a text file", "write a PDB or mmCIF file");
    std::string_view const begin = trimmed(text.substr(0, 4096));
    if (begin.empty() && trimmed(text).empty())
        refuse("the file is empty", "write a PDB or mmCIF file");
    if (begin.starts_with("<")) refuse("the file holds HTML or XML", "write a PDB or mmCIF file");
    if (begin.starts_with(">"))
        refuse("the file holds sequences (FASTA)",
               "write a PDB or mmCIF file, or give it as `fasta`");
}

[[noreturn]] void refuse_line(std::string const& what, std::string const& path, int line) {
    throw InputError(
        what, fmt::format("{}: line {}", path, line),
        "give x, y and z in angstrom, with a decimal point, in columns 31-38, 39-46 and 47-54");
}

/// True if a coordinate lies within its columns. A displaced number leaves a digit at the field's
/// edge, or no digit before its point.
bool stands_apart(std::string_view line, std::string_view field, std::size_t first) {
    std::size_t const point = field.find('.');
    char const next = column(line, first + 8);
    if (point == std::string_view::npos)
        return next != '.' && (!is_digit(next) || field.size() >= 7);  // too large for decimals
    if (point == 0 || !is_digit(field[point - 1])) return false;
    bool const cut = is_digit(column(line, first + 7)) && is_digit(next);
    return !cut || field.size() - point - 1 == 3 || field.size() == 8;
}

double coordinate(std::string_view line, std::size_t first, std::string const& path, int n) {
    std::string_view const field = columns(line, first, 8);
    double value = 0;
    if (parse_number(field, value) != NumberFault::none)
        refuse_line(fmt::format("`{}` is not a number", shown(field)), path, n);
    if (!stands_apart(line, field, first))
        refuse_line(fmt::format("`{}` is cut out of its column", shown(field)), path, n);
    return value;
}

/// Reads names and numbers. The residue is in columns 18 to 20, and in column 21 for the four
/// letters of force fields. Otherwise column 21 belongs to the chain's name.
void read_names(std::string_view line, PdbAtom& atom) {
    atom.name = columns(line, 13, 4);
    atom.at_margin = column(line, 13) != ' ' && !is_digit(column(line, 13));
    std::string_view const four = columns(line, 18, 4);
    bool const long_name = column(line, 21) != ' ' &&
                           (column(line, 22) == ' ' || meaning_of(four).kind != ResidueKind::other);
    atom.residue = long_name ? four : columns(line, 18, 3);
    atom.chain = long_name || column(line, 21) == ' ' ? columns(line, 22, 1) : columns(line, 21, 2);
    bool const wide = is_digit(column(line, 27));  // numbers above 9999, written by some programs
    atom.number = columns(line, 23, wide ? 5 : 4);
    atom.insertion = wide ? ' ' : column(line, 27);
    atom.alternate = column(line, 17);
    atom.segment = columns(line, 73, 4);
    if (atom.segment.find('.') != std::string_view::npos) atom.segment = {};  // a charge (PDBQT)
    atom.element = columns(line, 77, 2);
    atom.label = atom.chain;
}

PdbAtom read_atom(std::string_view line, std::string const& path, int n) {
    PdbAtom atom;
    atom.line = n;
    atom.het = line.starts_with("HETATM");
    read_names(line, atom);
    if (line.size() < 54) refuse_line("the atom's line is cut short", path, n);
    if (is_digit(column(line, 30))) refuse_line("the coordinates begin before column 31", path, n);
    for (std::size_t i = 0; i < 3; ++i)
        atom.position[static_cast<int>(i)] = coordinate(line, 31 + 8 * i, path, n);
    if (double occupancy = 1; parse_number(columns(line, 55, 6), occupancy) == NumberFault::none)
        atom.occupancy = occupancy;
    if (double factor = 0; parse_number(columns(line, 61, 6), factor) == NumberFault::none)
        atom.b_factor = factor;
    return atom;
}

bool is_atom(std::string_view line) {
    if (line.starts_with("HETATM")) return true;
    return line.starts_with("ATOM") &&
           (blanks.find(column(line, 5)) != std::string_view::npos || is_digit(column(line, 5)));
}

bool is_record(std::string_view line, std::string_view name) {
    return trimmed(line.substr(0, 6)) == name;
}

/// Reads SEQRES: column 12 (chain), columns 14 to 17 (number of residues), and names from column 20
/// on.
void read_sequence_record(std::string_view line, PdbSummary& summary) {
    double residues = 0;
    if (parse_number(columns(line, 14, 4), residues) != NumberFault::none || residues <= 0 ||
        residues >= 1e4)
        return;
    ListedSequence& listed = summary.sequence[std::string(columns(line, 12, 1))];
    listed.residues = static_cast<std::int64_t>(residues);
    for (std::size_t at = 20; at <= 68; at += 4)
        if (std::string_view const name = columns(line, at, 3); !name.empty())
            listed.names.emplace_back(name);
}

/// Reads CRYST1: edges in columns 7 to 33, angles up to column 54.
void read_cell(std::string_view line, PdbSummary& summary) {
    Vec3 edges{}, angles{};
    for (std::size_t i = 0; i < 3; ++i)
        if (parse_number(columns(line, 7 + 9 * i, 9), edges[static_cast<int>(i)]) !=
                NumberFault::none ||
            parse_number(columns(line, 34 + 7 * i, 7), angles[static_cast<int>(i)]) !=
                NumberFault::none)
            return;
    if (auto const cell = rectangular_cell(edges, angles)) summary.cell = cell;
}

/// Number of a MODEL record, in columns 11 to 14 or, of other programs, anywhere behind the name.
std::optional<std::int64_t> model_number(std::string_view line) {
    double number = 0;
    bool const read = line.size() > 5 &&
                      parse_number(trimmed(line.substr(5)), number) == NumberFault::none &&
                      number == std::floor(number) && std::abs(number) < 1e9;
    return read ? std::optional(static_cast<std::int64_t>(number)) : std::nullopt;
}

/// Finds out whether a file was cut: within its last line, or before the end of its last model.
class EndOfFile {
  public:
    /// Takes each line in turn.
    void take(std::string_view line) {
        std::string_view const written = line.substr(0, line.find_last_not_of(blanks) + 1);
        if (written.empty()) return;
        if (is_record(line, "MODEL")) in_model_ = true;
        if (is_record(line, "ENDMDL") || is_record(line, "END")) in_model_ = false;
        if (last_is_atom_) least_ = std::min(least_, last_.size());
        last_ = written;
        last_is_atom_ = is_atom(line);
    }
    /// What shows that the file was cut; empty if nothing does.
    std::string sign() const {
        if (last_is_atom_ && last_.size() < least_ && least_ != std::string_view::npos)
            return fmt::format(
                "the last line is an atom's of {} columns, all others have {} or more",
                last_.size(), least_);
        for (std::string_view const name : {"ATOM", "HETATM", "TER", "ANISOU", "CONECT", "ENDMDL"})
            if (last_.size() < name.size() && name.starts_with(last_) && last_ != "END")
                return fmt::format("the last line is `{}`, the beginning of {}", last_, name);
        return in_model_ ? "the last model has no ENDMDL" : "";
    }

  private:
    std::string_view last_;  // without blanks at its end
    bool last_is_atom_ = false, in_model_ = false;
    std::size_t least_ =
        std::string_view::npos;  // columns of the shortest atom before the last line
};

}  // namespace

bool ModelChoice::begin(std::int64_t number, PdbSummary& summary) {
    summary.models.push_back(number);
    bool const chosen = !found_ && number == wanted_.value_or(summary.models.front());
    found_ = found_ || chosen;
    return chosen;
}

PdbSummary for_each_pdb_atom(std::string_view text, std::string const& path,
                             std::optional<std::int64_t> model, TakeAtom const& take) {
    text = without_mark(text);
    refuse_other_formats(text, path);
    PdbSummary summary;
    ModelChoice choice(model);
    int part = 0, number = 0;
    bool open = true, begun = false;   // inside the chosen model; atoms of a model have been read
    std::optional<std::int64_t> next;  // number of the next model
    EndOfFile end;
    for (std::string_view line; next_line(text, line);) {
        ++number;
        end.take(line);
        if (is_record(line, "MODEL") || is_record(line, "ENDMDL") || is_record(line, "END")) {
            begun = false;
            if (is_record(line, "MODEL")) next = model_number(line);
        } else if (line.starts_with("TER") &&
                   blanks.find(column(line, 4)) != std::string_view::npos) {
            ++part;
        } else if (is_record(line, "CRYST1")) {
            read_cell(line, summary);
        } else if (is_record(line, "SEQRES")) {
            read_sequence_record(line, summary);
        } else if (is_atom(line)) {
            if (!std::exchange(begun, true))
                open = choice.begin(
                    std::exchange(next, {}).value_or(std::ssize(summary.models) + 1), summary);
            if (!open) continue;
            PdbAtom atom = read_atom(line, path, number);
            atom.part = part;
            ++summary.atoms;
            take(atom);
        }
    }
    summary.cut = end.sign();
    return summary;
}

std::optional<Vec3> rectangular_cell(Vec3 const& edges, Vec3 const& angles) {
    for (int i = 0; i < 3; ++i)
        if (!(edges[i] > 1) || angles[i] != 90) return {};
    return edges;
}

std::optional<std::int64_t> residue_number(std::string_view number) {
    double value = 0;
    if (parse_number(number, value) == NumberFault::none && value == std::floor(value) &&
        std::abs(value) < 1e6)
        return static_cast<std::int64_t>(value);
    if (number.size() != 4 || !std::isalpha(static_cast<unsigned char>(number[0]))) return {};
    bool const lower = std::islower(static_cast<unsigned char>(number[0])) != 0;
    std::int64_t sum = 0;
    for (char const c : number) {
        auto const byte = static_cast<unsigned char>(c);
        if (!std::isalnum(byte) || (std::isalpha(byte) && (std::islower(byte) != 0) != lower))
            return {};
        sum = 36 * sum + (is_digit(c) ? c - '0' : std::toupper(byte) - 'A' + 10);
    }
    std::int64_t constexpr first = 10LL * 36 * 36 * 36, letters = 26LL * 36 * 36 * 36;
    return 10000 + sum - first + (lower ? letters : 0);
}

}  // namespace catena::scene
