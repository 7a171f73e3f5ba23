// Implements the reader of predicted aligned errors.
#include "domains/predicted_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "json_fault.hpp"
#include "scene/files.hpp"

namespace catena::scene {

namespace {

using Json = nlohmann::json;

/// Largest error that is read, angstrom. The networks that predict errors end at 32.
constexpr double largest_error = 1000;

char const* const ways_out =
    "give the file of predicted aligned errors that belongs to the structure (AlphaFold database: "
    "AF-...-predicted_aligned_error_v4.json)";

/// The matrix in the file, or nullptr.
Json const* matrix_in(Json const& file) {
    Json const& map = file.is_array() && file.size() == 1 ? file[0] : file;
    if (!map.is_object()) return nullptr;
    for (char const* const key : {"predicted_aligned_error", "pae"})
        if (auto const found = map.find(key); found != map.end() && found->is_array())
            return &*found;
    return nullptr;
}

/// True for the keys of a matrix.
bool names_matrix(Json const& key) { return key == "predicted_aligned_error" || key == "pae"; }

/// Throws InputError if the parser stopped, at `byte` from 1, at NaN or an infinity. Python writes
/// them although JSON has no such numbers.
void refuse_nan(std::string const& text, std::size_t byte, std::string const& path,
                Node const& at) {
    auto const is_part = [&](std::size_t k) {
        return std::isalpha(static_cast<unsigned char>(text[k])) != 0 || text[k] == '-';
    };
    std::size_t begin = std::min(byte == 0 ? 0 : byte - 1, text.size());
    while (begin > 0 && is_part(begin - 1)) --begin;
    std::size_t end = begin;
    while (end < text.size() && is_part(end)) ++end;
    std::string const word = text.substr(begin, end - begin);
    for (char const* const number : {"NaN", "nan", "-NaN", "Infinity", "-Infinity", "inf", "-inf"})
        if (word == number)
            fail(at, fmt::format("`{}` has {} in place of an error", shown_path(path), word),
                 "JSON has no such number, and without that error no domains can be told: predict "
                 "the errors again");
}

/// Throws InputError for text that is not JSON, and for more than one matrix.
Json parsed(std::string const& path, Node const& at) {
    int matrices = 0, depth_of_keys = 1;
    bool is_named = false;
    auto const count = [&](int depth, Json::parse_event_t event, Json const& value) {
        bool const begins = event == Json::parse_event_t::array_start;
        if (begins && depth == 0) depth_of_keys = 2;  // a list that holds the map
        matrices += begins && is_named;
        is_named =
            event == Json::parse_event_t::key && depth == depth_of_keys && names_matrix(value);
        return true;
    };
    std::string const text = read_text_file(path, at);
    try {
        Json file = Json::parse(text, count);
        if (matrices > 1)
            fail(at, fmt::format("`{}` has {} matrices of errors", shown_path(path), matrices),
                 "keep the one that belongs to the structure");
        return file;
    } catch (Json::parse_error const& error) {
        refuse_nan(text, error.byte, path, at);
        fail(at, fmt::format("`{}` is {}", shown_path(path), json_fault(text, error.byte)),
             ways_out);
    } catch (Json::exception const&) {  // the only one that parsing throws besides
        fail(at, fmt::format("`{}` holds a number beyond double precision", shown_path(path)),
             ways_out);
    }
}

/// Throws InputError unless the matrix is square. This precedes any memory for it: a list of a
/// million zeros is a short file.
void refuse_unequal_rows(Json const& rows, std::string const& path, Node const& at) {
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!rows[i].is_array() || rows[i].size() != rows.size())
            fail(at,
                 fmt::format("row {} of `{}` does not have {} numbers, as many as there are rows",
                             i + 1, shown_path(path), rows.size()),
                 ways_out);
}

}  // namespace

PredictedError read_predicted_error(std::string const& path, Node const& at) {
    Json const file = parsed(path, at);
    Json const* const rows = matrix_in(file);
    if (!rows || rows->empty())
        fail(at,
             fmt::format("`{}` has no list `predicted_aligned_error` or `pae`", shown_path(path)),
             ways_out);
    refuse_unequal_rows(*rows, path, at);
    PredictedError made;
    made.residues = rows->size();
    made.value.assign(made.residues * made.residues, 0);
    for (std::size_t i = 0; i < made.residues; ++i) {
        Json const& row = (*rows)[i];
        for (std::size_t j = 0; j < made.residues; ++j) {
            double const value = row[j].is_number() ? row[j].get<double>() : NAN;
            if (!(value >= 0 && value <= largest_error))
                fail(at,
                     fmt::format("row {}, column {} of `{}`, `{}`, is not an error in angstrom",
                                 i + 1, j + 1, shown_path(path), shown(row[j].dump())),
                     ways_out);
            made.value[i * made.residues + j] += static_cast<float>(value / 2);
            made.value[j * made.residues + i] += static_cast<float>(value / 2);
        }
    }
    return made;
}

}  // namespace catena::scene
