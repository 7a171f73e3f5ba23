// Implements the choice between the readers of PDB and mmCIF files.
#include "structure/structure_file.hpp"

#include <utility>

#include "structure/mmcif_file.hpp"

namespace catena::scene {

namespace {

/// True if a line of the text begins with `start`.
bool has_line(std::string_view text, std::string_view start) {
    for (std::size_t at = text.find(start); at != std::string_view::npos;
         at = text.find(start, at + 1))
        if (at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r') return true;
    return false;
}

/// True for a CIF file. Comments may precede its first data block. No record of a PDB file has
/// these names.
bool is_mmcif(std::string_view text) {
    return has_line(text.substr(0, 65536), "data_") || has_line(text, "_atom_site.");
}

}  // namespace

StructureFile::StructureFile(std::string bytes, std::string path)
    : text_(std::move(bytes)), path_(std::move(path)) {
    if (text_.starts_with("\x1F\x8B")) text_ = unpacked(text_, path_);
    if (text_.find('\0') == std::string::npos && is_mmcif(text_))
        tables_ = parse_mmcif(text_, path_);
}

PdbSummary StructureFile::for_each_atom(std::optional<std::int64_t> model,
                                        TakeAtom const& take) const {
    return tables_ ? for_each_mmcif_atom(tables_, path_, model, take)
                   : for_each_pdb_atom(text_, path_, model, take);
}

}  // namespace catena::scene
