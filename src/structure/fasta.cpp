// Implements the FASTA reader and the checks of sequences.
#include "structure/fasta.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "scene/text_lines.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

/// Letters that are nucleotides as well as amino acids.
std::string_view constexpr nucleotide_letters = "ACGTU";
/// Number of letters from which on a sequence of nucleotides' letters is noted.
std::size_t constexpr least_ambiguous = 4;

/// One record of a FASTA file.
struct Record {
    std::string header;  // the `>` is removed
    std::string sequence;

    std::string name() const { return header.substr(0, header.find_first_of(" \t")); }
    /// True if `wanted` is the name, the header, or a part of the name between bars:
    /// `sp|P37840|SYUA_HUMAN`.
    bool bears(std::string const& wanted) const {
        std::string const whole = name();
        if (wanted.empty() || whole == wanted || header == wanted) return !wanted.empty();
        std::istringstream parts(whole);
        for (std::string part; std::getline(parts, part, '|');)
            if (part == wanted) return true;
        return false;
    }
};

/// Converts line ends (LF, CR LF or CR) to line feeds and removes a byte order mark.
std::string with_line_feeds(std::string text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    std::replace(text.begin(), text.end(), '\r', '\n');
    return text;
}

std::vector<Record> records_of(std::string const& path, Node const& at) {
    std::string const bytes = read_text_file(path, at);
    if (bytes.find('\0') != std::string::npos || bytes.starts_with("\x1F\x8B"))
        fail(at, "`" + shown_path(path) + "` is not a text file",
             "give a FASTA file: `>name`, then one-letter codes");
    std::istringstream stream(with_line_feeds(bytes));
    std::vector<Record> records;
    for (std::string line; std::getline(stream, line);) {
        if (line = std::string(trimmed(line)); line.empty()) continue;
        if (line[0] == '>') {
            records.push_back({std::string(trimmed(line.substr(1))), ""});
        } else if (records.empty()) {
            auto const n =
                1 + std::count(bytes.begin(),
                               bytes.begin() + static_cast<std::ptrdiff_t>(bytes.find(line)), '\n');
            throw InputError("sequence before the first record",
                             fmt::format("{}: line {}", shown_path(path), n),
                             "start the record with a line `>name`");
        } else {
            records.back().sequence += line + "\n";
        }
    }
    return records;
}

std::string first_names(std::vector<Record> const& records) {
    std::string list;
    for (std::size_t k = 0; k < std::min<std::size_t>(records.size(), 4); ++k)
        list += fmt::format("{}`{}`", k == 0 ? "" : ", ", shown(records[k].name()));
    return list + (records.size() > 4 ? ", ..." : "");
}

std::vector<Record const*> bearers(std::vector<Record> const& records, std::string const& name) {
    std::vector<Record const*> found;
    for (Record const& record : records)
        if (record.bears(name)) found.push_back(&record);
    return found;
}

Record const& the_only(std::vector<Record const*> const& found, Node const& at,
                       std::string const& name) {
    if (found.size() > 1)
        fail(at, fmt::format("{} records have the name `{}`", found.size(), shown(name)),
             "choose one by its number: `record: 1`");
    return *found[0];
}

/// Finds the record that the key `record` names or numbers.
Record const& recorded(std::vector<Record> const& records, Node const& record,
                       std::string const& path) {
    std::string const wanted = text(record);
    if (auto const found = bearers(records, wanted); !found.empty())
        return the_only(found, record, wanted);
    double number = 0;
    if (parse_number(wanted, number) == NumberFault::none && number >= 1 &&
        number <= static_cast<double>(records.size()) &&
        number == static_cast<double>(static_cast<std::size_t>(number)))
        return records[static_cast<std::size_t>(number) - 1];
    fail(record,
         fmt::format("`{}` has no record `{}`: it contains {}", shown_path(path), shown(wanted),
                     first_names(records)),
         fmt::format("give a name, or a number from 1 to {}", records.size()));
}

/// Applies the precedence of RecordChoice.
Record const& chosen(std::vector<Record> const& records, Node const& at, RecordChoice const& choice,
                     std::string const& path) {
    if (choice.record) return recorded(records, *choice.record, path);
    if (records.size() == 1) return records[0];
    if (choice.name)
        if (auto const found = bearers(records, text(*choice.name)); !found.empty())
            return the_only(found, *choice.name, choice.name->text);
    fail(at,
         fmt::format("`{}` contains {} records: {}", shown_path(path), records.size(),
                     first_names(records)),
         "name the chain after one of them, or add `record: NAME` or its number");
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

[[noreturn]] void refuse_letter(char letter, std::size_t position, Node const& source,
                                ResidueTable const& table) {
    std::string what = fmt::format("`{}` at position {} of the sequence is not a residue of {}",
                                   shown(std::string(1, letter)), position, table.name());
    std::string remedy = "use the one-letter codes " + table.letters();
    if (letter == 'B' || letter == 'J' || letter == 'O' || letter == 'Z')
        remedy += ", or name a table with this code: `model: {residues: FILE.csv}`";
    if (letter == '*') what += ": a stop within the sequence", remedy = "end the sequence there";
    if (letter == '-' || letter == '.')
        what += ": a gap of an alignment", remedy = "give the sequence without gaps";
    if (std::isdigit(static_cast<unsigned char>(letter)))
        what += ": a number", remedy = "leave the numbers of positions out";
    if (letter == 'U')
        what += ": selenocysteine, or RNA",
            remedy = "write C for selenocysteine, or `model: calvados_rna` for RNA";
    if (letter == 'T' && table.find('U')) what += ": thymine of DNA", remedy = "write U for RNA";
    fail(source, what, remedy);
}

/// True if blanks separate the text into two or more words of three letters each.
bool is_cut_into_threes(std::string const& text) {
    std::istringstream stream(text);
    std::size_t words = 0;
    for (std::string word; stream >> word; ++words)
        if (word.size() != 3) return false;
    return words >= 2;
}

/// Notes texts such as `MET ASP VAL` and `METASPVAL`, which are most likely three-letter codes.
void note_three_letters(std::string const& text, std::string const& letters, Node const& source,
                        Scene& scene) {
    std::size_t const threes = letters.size() / 3;
    if (letters.size() % 3 != 0 || threes < 2) return;
    std::size_t named = 0;
    for (std::size_t k = 0; k < threes; ++k)
        named += meaning_of(letters.substr(3 * k, 3)).kind == ResidueKind::amino_acid;
    if (is_cut_into_threes(text) ? 2 * named < threes : threes < 3 || named < threes) return;
    scene.note(
        fmt::format("`{}` looks like three-letter codes and is read as {} one-letter codes ({}, "
                    "{}, {}, ...): write one letter per residue",
                    source.path(), letters.size(), letters[0], letters[1], letters[2]));
}

/// The letters of nucleotides that a text has, listed: "letter A", "letters A, C and G".
std::string nucleotides_of(std::string const& letters) {
    std::vector<char> found;
    for (char const base : nucleotide_letters)
        if (letters.find(base) != std::string::npos) found.push_back(base);
    std::string list = found.size() > 1 ? "letters " : "letter ";
    for (std::size_t k = 0; k < found.size(); ++k) {
        if (k > 0) list += k + 1 < found.size() ? ", " : " and ";
        list += found[k];
    }
    return list;
}

/// Notes sequences of proteins that may be RNA or DNA, because all their letters are nucleotides.
void note_nucleotides(std::string const& letters, Node const& source, ResidueTable const& table,
                      Scene& scene) {
    ResidueType const* const first = table.find('A');
    if (!first || first->name != "ALA" || letters.size() < least_ambiguous ||
        letters.find_first_not_of(nucleotide_letters) != std::string::npos)
        return;
    scene.note(fmt::format("`{}` has the {} alone and is read as a protein: {}", source.path(),
                           nucleotides_of(letters),
                           "RNA takes `model: calvados_rna` and the letter U, DNA has no model"));
}

}  // namespace

std::string read_fasta(std::string const& path, Node const& at, RecordChoice const& choice) {
    std::vector<Record> const records = records_of(path, at);
    std::string sequence;
    if (!records.empty()) sequence = trimmed(chosen(records, at, choice, path).sequence);
    while (!sequence.empty() && is_blank(sequence.back())) sequence.pop_back();
    if (!sequence.empty() && sequence.back() == '*') sequence.pop_back();
    if (sequence.empty())
        fail(at, "no sequence in `" + shown_path(path) + "`",
             "give a record: `>name`, then one-letter codes");
    return sequence;
}

std::string one_letter_codes(std::string const& text, Node const& source, ResidueTable const& table,
                             Scene& scene) {
    std::string letters;
    std::size_t small = 0;
    for (char const c : text) {
        if (is_blank(c)) continue;
        char const capital = static_cast<char>(std::toupper(static_cast<unsigned char>(c))),
                   letter = table.find(c) ? c : capital;
        small += letter != c;
        letters += letter;
        if (!table.find(letter)) refuse_letter(c, letters.size(), source, table);
    }
    if (letters.empty()) fail(source, "the sequence is empty", "give one-letter codes");
    if (small > 0)
        scene.note(fmt::format("`{}`: {} of {} letters are lower case and are read as capitals",
                               source.path(), small, letters.size()));
    note_three_letters(text, letters, source, scene);
    note_nucleotides(letters, source, table, scene);
    return letters;
}

}  // namespace catena::scene
