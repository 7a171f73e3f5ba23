// Implements the reader of residue tables. The tables of the program are files of inputs/, embedded
// as text when the build is configured, and pass through the same reader.
#include "structure/residue_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <sstream>

#include "error.hpp"
#include "scene/fields.hpp"
#include "scene/files.hpp"
#include "structure/calvados_rna.hpp"

// Generated: embedded_calvados2, embedded_calvados3 and embedded_calvados_rna, the texts of the
// tables.
#include "residue_tables.inc"
#include "scene/text_lines.hpp"

namespace catena {

namespace {

using Cells = std::vector<std::string>;

/// Columns of a table; the numbers follow the two codes.
constexpr std::array<std::string_view, 7> columns = {"one",    "three", "MW",        "lambdas",
                                                     "sigmas", "q",     "bondlength"};
constexpr std::size_t first_number = 2;
char const* const all_columns = "one,three,MW,lambdas,sigmas,q,bondlength";

/// Largest size of a residue, nm: the diameter whose potential minimum is at the cutoff of 2 nm.
/// Larger values are most likely in angstrom.
double constexpr largest_size = 1.78;
/// Least mass of a bead, amu; smaller values are most likely in kg/mol.
double constexpr least_mass = 1;
/// Largest stickiness; published values are 0 to 1.2, a diameter in angstrom or a mass is larger.
double constexpr largest_lambda = 3;
/// Largest charge of a bead, e.
double constexpr largest_charge = 10;

/// Reads one table and knows the line for messages.
class Reader {
  public:
    explicit Reader(std::string const& name) : name_(name) {}

    /// Reads the lines of the table. Throws InputError.
    std::vector<ResidueType> read(std::string const& text) {
        bool const marked = text.starts_with("\xEF\xBB\xBF");
        for (auto const& [n, line] : scene::lines_of(marked ? text.substr(3) : text, '#')) {
            line_ = n;
            if (place_.empty())
                read_header(scene::cells_of(line));
            else
                types_.push_back(read_type(scene::cells_of(line)));
        }
        if (types_.empty())
            throw InputError(
                "the table has no residues", name_,
                fmt::format("give a line `{}`, then one residue per line", all_columns));
        return std::move(types_);
    }

  private:
    [[noreturn]] void refuse(std::string const& what, std::string const& remedy) const {
        throw InputError(what, fmt::format("{}: line {}", name_, line_), remedy);
    }

    void read_header(Cells const& cells) {
        for (std::string const& cell : cells) {
            auto const known = std::find(columns.begin(), columns.end(), cell);
            std::string const remedy =
                fmt::format("name the columns `{}`, in any order", all_columns);
            if (known == columns.end())
                refuse(fmt::format("`{}` is not a column of a residue table", scene::shown(cell)),
                       remedy);
            if (!place_.emplace(cell, place_.size()).second)
                refuse(fmt::format("column `{}` is there twice", cell), remedy);
        }
        for (std::string_view const column : columns)
            if (!place_.contains(std::string(column)))
                refuse(fmt::format("the table has no column `{}`", column),
                       column == "bondlength"
                           ? "add it: the bond length in nm, 0.38 for amino acids"
                           : fmt::format("name the columns `{}`, in any order", all_columns));
    }

    ResidueType read_type(Cells const& cells) {
        if (cells.size() != columns.size())
            refuse(fmt::format("the line has {} values, not {}", cells.size(), columns.size()),
                   fmt::format("give {} values, as the first line names them", columns.size()));
        std::array<double, columns.size()> value{};
        for (std::size_t i = first_number; i < columns.size(); ++i)
            value[i] = number(cells, columns[i]);
        ResidueType const type{letter(cell(cells, "one")),
                               code(cell(cells, "three")),
                               value[2],
                               value[3],
                               value[4],
                               value[5],
                               value[6]};
        check(type);
        refuse_repeated(fmt::format("one-letter code `{}`", type.letter));
        refuse_repeated(fmt::format("residue `{}`", type.name));
        return type;
    }

    std::string const& cell(Cells const& cells, std::string_view column) const {
        return cells[place_.at(std::string(column))];
    }

    char letter(std::string const& text) const {
        if (text.size() != 1 || !std::isalpha(static_cast<unsigned char>(text[0])))
            refuse(fmt::format("`{}` is not a one-letter code", scene::shown(text)),
                   "give one letter in column `one`");
        return text[0];
    }

    std::string code(std::string text) const {
        bool good = !text.empty() && text.size() <= 3;
        for (char& c : text) {
            good = good && std::isalnum(static_cast<unsigned char>(c));
            c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
        if (!good)
            refuse(fmt::format("`{}` is not a three-letter code", scene::shown(text)),
                   "give one to three letters or digits in column `three`");
        return text;
    }

    double number(Cells const& cells, std::string_view column) const {
        std::string const& text = cell(cells, column);
        if (text.empty())
            refuse(fmt::format("residue `{}` has no value in column `{}`",
                               scene::shown(cell(cells, "three")), column),
                   "give a number");
        double value = 0;
        if (scene::parse_number(text, value) != scene::NumberFault::none)
            refuse(fmt::format("`{}` in column `{}` is not a finite number", scene::shown(text),
                               column),
                   "give a decimal number such as 0.38");
        return value;
    }

    void check(ResidueType const& type) const {
        auto const size = [&](char const* column, double nm) {
            if (!(nm > 0 && nm <= largest_size))
                refuse(fmt::format("`{}` of residue `{}` is {} nm", column, type.name, nm),
                       fmt::format("give nanometres above 0, at most {}", largest_size));
        };
        size("sigmas", type.sigma);
        size("bondlength", type.bond);
        if (!(type.mass >= least_mass))
            refuse(fmt::format("`MW` of residue `{}` is {} amu", type.name, type.mass),
                   fmt::format("give amu (g/mol), at least {}", least_mass));
        if (!(type.lambda >= 0 && type.lambda <= largest_lambda))
            refuse(fmt::format("`lambdas` of residue `{}` is {}", type.name, type.lambda),
                   fmt::format("give the stickiness, 0 to {}", largest_lambda));
        if (!(type.charge >= -largest_charge && type.charge <= largest_charge))
            refuse(fmt::format("`q` of residue `{}` is {} e", type.name, type.charge),
                   fmt::format("give elementary charges, {0} to {1}", -largest_charge,
                               largest_charge));
    }

    void refuse_repeated(std::string const& what) {
        auto const [first, added] = line_of_.emplace(what, line_);
        if (!added)
            refuse(fmt::format("{} is also in line {}", what, first->second),
                   "keep one of the two lines");
    }

    std::string const& name_;
    int line_ = 0;
    /// Place of each column.
    std::map<std::string, std::size_t> place_;
    /// Line of each code.
    std::map<std::string, int> line_of_;
    std::vector<ResidueType> types_;
};

}  // namespace

ResidueType const* ResidueTable::find(char letter) const {
    auto const found = std::find_if(types_.begin(), types_.end(),
                                    [&](ResidueType const& type) { return type.letter == letter; });
    return found == types_.end() ? nullptr : &*found;
}

ResidueType const* ResidueTable::find(std::string_view name) const {
    auto const found = std::find_if(types_.begin(), types_.end(),
                                    [&](ResidueType const& type) { return type.name == name; });
    return found == types_.end() ? nullptr : &*found;
}

std::string ResidueTable::letters() const {
    std::string letters;
    for (ResidueType const& type : types_) letters += type.letter;
    return letters;
}

ResidueTable const* built_in_table(std::string_view name) {
    static std::array<ResidueTable, 3> const tables = {
        parse_residue_table(embedded_calvados2, "calvados2"),
        parse_residue_table(embedded_calvados3, "calvados3"),
        parse_residue_table(embedded_calvados_rna, std::string(calvados_rna::model))};
    for (ResidueTable const& table : tables)
        if (table.name() == name) return &table;
    return nullptr;
}

ResidueTable parse_residue_table(std::string const& text, std::string const& name) {
    return {name, Reader(name).read(text)};
}

ResidueTable read_residue_table(std::string const& path, scene::Node const& at) {
    return parse_residue_table(scene::read_text_file(path, at), scene::shown_path(path));
}

}  // namespace catena
