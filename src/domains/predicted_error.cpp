// Implements the reader of predicted aligned errors.
#include "domains/predicted_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/files.hpp"

namespace catena::scene {

namespace {

using Json = nlohmann::json;

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

Json parsed(std::string const& path, Node const& at) {
    try {
        return Json::parse(read_text_file(path, at));
    } catch (Json::exception const& error) {
        fail(at, fmt::format("`{}` is not JSON ({})", shown_path(path), shown(error.what(), 120)),
             ways_out);
    }
}

}  // namespace

PredictedError read_predicted_error(std::string const& path, Node const& at) {
    Json const file = parsed(path, at);
    Json const* const rows = matrix_in(file);
    if (!rows || rows->empty())
        fail(at,
             fmt::format("`{}` has no list `predicted_aligned_error` or `pae`", shown_path(path)),
             ways_out);
    PredictedError made;
    made.residues = rows->size();
    made.value.assign(made.residues * made.residues, 0);
    for (std::size_t i = 0; i < made.residues; ++i) {
        Json const& row = (*rows)[i];
        if (!row.is_array() || row.size() != made.residues)
            fail(at,
                 fmt::format("row {} of `{}` does not have {} numbers, as many as there are rows",
                             i + 1, shown_path(path), made.residues),
                 ways_out);
        for (std::size_t j = 0; j < made.residues; ++j) {
            double const value = row[j].is_number() ? row[j].get<double>() : NAN;
            if (!(value >= 0 && std::isfinite(value)))
                fail(at,
                     fmt::format("row {}, column {} of `{}` is not an error in angstrom", i + 1,
                                 j + 1, shown_path(path)),
                     ways_out);
            made.value[i * made.residues + j] += static_cast<float>(value / 2);
            made.value[j * made.residues + i] += static_cast<float>(value / 2);
        }
    }
    return made;
}

}  // namespace catena::scene
