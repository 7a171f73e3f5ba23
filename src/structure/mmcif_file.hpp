// Parser of mmCIF files, the newer format of the Protein Data Bank, on top of gemmi's CIF parser.
// A build without gemmi has no_gemmi.cpp in its place.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "structure/pdb_file.hpp"

namespace catena::scene {

/// Parses the text into tables; for_each_mmcif_atom() reads them. Throws InputError with `path` and
/// the line for text that is not CIF.
std::shared_ptr<void const> parse_mmcif(std::string_view text, std::string const& path);

/// Calls `take` for each atom of a model of the first data block with atoms: that of the number
/// `model`, else the first. Chains are named by `auth_asym_id` and numbered by `auth_seq_id`, or by
/// the `label_` items where a file lacks those. A change of `label_asym_id` ends a chain as TER
/// does in a PDB file. The atoms refer to `tables`. Throws InputError with `path` and the row for
/// bad coordinates.
PdbSummary for_each_mmcif_atom(std::shared_ptr<void const> const& tables, std::string const& path,
                               std::optional<std::int64_t> model, TakeAtom const& take);

/// Returns the content of a gzip file. Throws InputError with `path` for a damaged file.
std::string unpacked(std::string_view packed, std::string const& path);

/// Versions of gemmi and zlib, or "none".
std::string gemmi_version();

}  // namespace catena::scene
