// Replaces mmcif_file.cpp and unpack.cpp in a build without gemmi and zlib.
#include "error.hpp"
#include "structure/mmcif_file.hpp"

namespace catena::scene {

namespace {

[[noreturn]] void refuse(char const* what, std::string const& path, char const* instead) {
    throw built_without(
        "gemmi", std::string(what) + " " + path,
        std::string("install gemmi (gemmi-dev, zlib1g-dev) and build again, or ") + instead);
}

}  // namespace

std::shared_ptr<void const> parse_mmcif(std::string_view, std::string const& path) {
    refuse("mmCIF file", path, "write a PDB file: gemmi convert in.cif out.pdb");
}

PdbSummary for_each_mmcif_atom(std::shared_ptr<void const> const&, std::string const& path,
                               std::optional<std::int64_t>, TakeAtom const&) {
    refuse("mmCIF file", path, "write a PDB file: gemmi convert in.cif out.pdb");
}

std::string unpacked(std::string_view, std::string const& path) {
    refuse("compressed file", path, "unpack it: gunzip");
}

std::string gemmi_version() { return "none"; }

}  // namespace catena::scene
