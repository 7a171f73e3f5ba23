// Writer and reader of observables.csv.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "error.hpp"
#include "io/observables_table.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"

namespace catena {
namespace {

std::string header_of(std::vector<std::string> const& columns, std::string const& time_unit) {
    std::string header = "step,time [" + time_unit + "]";
    for (std::string const& column : columns) header += "," + column;
    return header + "\n";
}

/// Step at the start of a line; empty if the line does not begin with one.
std::optional<std::int64_t> step_of(std::string_view line) {
    std::int64_t step = 0;
    auto const [end, error] = std::from_chars(line.data(), line.data() + line.size(), step);
    if (error != std::errc() || end == line.data() + line.size() || *end != ',')
        return std::nullopt;
    return step;
}

/// Returns the number of bytes of an existing table that are kept: its header and the whole lines
/// up to a step.
std::int64_t kept_size(std::string const& file, std::string const& header,
                       Continuation const& go_on) {
    std::string const beside = Continuation::way_beside;
    if (!std::filesystem::exists(file))
        throw InputError("there is no table of observables to continue", file,
                         "restore it, or " + beside);
    std::string const text = read_text_file(file);
    if (!text.starts_with(header))
        throw InputError("the table of observables has other columns than this run", file,
                         "restart with the same observables, or " + beside);
    std::size_t kept = header.size();
    std::int64_t records = 0;
    for (std::size_t line = 2; kept < text.size(); ++line) {
        std::size_t const end = text.find('\n', kept);
        if (end == std::string::npos) break;  // a run was killed while it wrote this line
        auto const step = step_of(std::string_view(text).substr(kept, end - kept));
        if (!step)
            throw InputError("not a record of observables", file + ", line " + std::to_string(line),
                             "correct the line, or " + beside);
        if (*step > go_on.after_step) break;
        kept = end + 1;
        ++records;
    }
    if (records < go_on.records)
        throw InputError(fmt::format("the table of observables has lost lines: {} of the {} before "
                                     "the checkpoint are there",
                                     records, go_on.records),
                         file, "restore the whole file, or " + beside);
    return static_cast<std::int64_t>(kept);
}

/// Cells between the commas of a line.
std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        std::size_t const end = std::min(line.find(',', begin), line.size());
        cells.emplace_back(line.substr(begin, end - begin));
        begin = end + 1;
    }
    return cells;
}

/// Number in a cell. `where` names file and line for the InputError.
double number(std::string const& cell, std::string const& where) {
    double value = 0;
    auto const [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc::result_out_of_range) return std::strtod(cell.c_str(), nullptr);
    if (error != std::errc() || end != cell.data() + cell.size())
        throw InputError("not a number: '" + cell + "'", where, "correct the table");
    return value;
}

}  // namespace

struct ObservablesWriter::File {
    OutputFile out;
    std::size_t columns;
};

ObservablesWriter::ObservablesWriter(std::string const& file,
                                     std::vector<std::string> const& columns,
                                     std::optional<Continuation> const& go_on,
                                     std::string const& time_unit) {
    std::string const header = header_of(columns, time_unit);
    OutputFile out = go_on ? OutputFile::append(file, kept_size(file, header, *go_on))
                           : OutputFile::create(file);
    if (!go_on) out.write(header);
    out.sync();
    file_ = std::make_unique<File>(File{std::move(out), columns.size()});
}

ObservablesWriter::~ObservablesWriter() = default;

void ObservablesWriter::write(std::int64_t step, double time, std::vector<double> const& values) {
    if (values.size() != file_->columns)
        throw ComputationError(
            fmt::format("cannot write the observables ({}, step {}): {} values for {} columns",
                        file_->out.name(), step, values.size(), file_->columns));
    std::string line = fmt::format("{},{:.17g}", step, time);
    for (double const value : values) line += fmt::format(",{:.17g}", value);
    file_->out.write(line + "\n");
    file_->out.flush();
}

void ObservablesWriter::flush() { file_->out.sync(); }

void ObservablesWriter::close() {
    file_->out.sync();
    file_->out.close();
}

ObservablesTable read_observables(std::string const& file) {
    std::string const text = read_text_file(file);
    ObservablesTable table;
    std::size_t line = 0;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        std::size_t const end = text.find('\n', begin);
        if (end == std::string::npos) break;
        auto const cells = split(std::string_view(text).substr(begin, end - begin));
        std::string const where = file + ", line " + std::to_string(line + 1);
        begin = end + 1;
        if (line == 0) {
            if (cells.size() < 2 || cells[0] != "step")
                throw InputError("not a table of observables", file, "name the table of a run");
            table.names = cells;
            table.columns.resize(cells.size());
            continue;
        }
        if (cells.size() != table.names.size())
            throw InputError(
                fmt::format("{} cells for {} columns", cells.size(), table.names.size()), where,
                "correct the table");
        for (std::size_t k = 0; k < cells.size(); ++k)
            table.columns[k].push_back(number(cells[k], where));
    }
    if (table.names.empty())
        throw InputError("an empty table of observables", file, "name the table of a run");
    return table;
}

}  // namespace catena
