#include "force/pdb_topology.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "error.hpp"

namespace catena {

namespace {

std::string trimmed(std::string const& line, std::size_t from, std::size_t length) {
    if (line.size() <= from) return "";
    std::string const field = line.substr(from, length);
    auto const first = field.find_first_not_of(' ');
    return first == std::string::npos ? "" : field.substr(first, field.find_last_not_of(' ') - first + 1);
}

/// Columns 31-54: x, y, z in angstrom, eight characters each.
Vec3 coordinates(std::string const& line, std::string const& where, std::int64_t number) {
    Vec3 x{};
    for (int i = 0; i < 3; ++i) {
        std::string const field = trimmed(line, 30 + 8 * i, 8);
        char* end = nullptr;
        x[i] = std::strtod(field.c_str(), &end) / 10;
        if (field.empty() || *end != '\0' || !std::isfinite(x[i]))
            throw InputError(fmt::format("\"{}\" is no coordinate", field), fmt::format("{}, line {}", where, number),
                             "columns 31-54 of an ATOM record hold x, y and z in angstrom");
    }
    return x;
}

}  // namespace

std::vector<PdbChain> read_pdb_topology(std::string const& file, std::string const& where) {
    std::ifstream in(file);
    if (!in) throw InputError(fmt::format("cannot open {}", file), where, "name a PDB file that can be read");
    std::vector<PdbChain> chains;
    bool begin = true;
    std::string line, identifier;
    for (std::int64_t number = 1; std::getline(in, line); ++number) {
        if (line.ends_with('\r')) line.pop_back();
        std::string const record = trimmed(line, 0, 6);
        if (record == "TER") begin = true;
        if (record == "ENDMDL") break;
        if (record != "ATOM" && record != "HETATM") continue;
        std::string const id = trimmed(line, 21, 1);
        if (begin || id != identifier) {
            std::string const name = id.empty() ? std::to_string(chains.size() + 1) : id;
            chains.emplace_back().name = name;
            identifier = id;
            begin = false;
        }
        std::string const residue = trimmed(line, 17, 3);
        chains.back().residue.push_back(residue.empty() ? "UNK" : residue);
        chains.back().position.push_back(coordinates(line, file, number));
    }
    if (chains.empty()) throw InputError(fmt::format("{} holds no ATOM record", file), where, "name a PDB file with one atom a particle");
    return chains;
}

}  // namespace catena
