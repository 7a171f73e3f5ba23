// Implements what is known of OpenMiChroM 1.1 and polychrom 0.1.
#include "foreign/known_tools.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

constexpr char const *openmichrom = "OpenMiChroM", *polychrom = "polychrom";
/// Mean distance of neighbours, nm, between the tools' 1 nm and its tenth.
constexpr double longest_tenth = 0.3;

/// True for the names PREFIX...h5.
bool is_named(fs::path const& file, char const* prefix) {
    return file.extension() == ".h5" && file.filename().string().starts_with(prefix);
}

bool is_of_openmichrom(fs::path const& file) {
    fs::path const ending = file.extension();
    return ending == ".ndb" || ending == ".cndb" || ending == ".swb" ||
           file.filename() == "initialStats.txt";
}

/// Number in the name of initArgs_N.h5, so that 10 follows 9.
std::pair<std::size_t, std::string> rank_of(std::string const& file) { return {file.size(), file}; }

}  // namespace

void find_known_tool(std::vector<std::string> const& names, Files& files) {
    for (std::string const& name : names) {
        if (is_of_openmichrom(name) && files.tool.empty()) files.tool = openmichrom;
        for (char const* const prefix : {"initArgs_", "applied_forces_", "blocks_"})
            if (is_named(name, prefix)) files.tool = polychrom;
        if (is_named(name, "initArgs_") &&
            (files.init_args.empty() || rank_of(files.init_args) < rank_of(name)))
            files.init_args = name;
    }
}

std::string how_to_write(std::string const& tool) {
    std::string const object = tool.empty() ? "simulation" : "sim";
    return "write it in " + (tool.empty() ? "your" : tool + "'s") +
           " script, once its Context exists: from openmm import XmlSerializer as X; "
           "open('system.xml', 'w').write(X.serialize(" +
           object + ".system)); open('state.xml', 'w').write(X.serialize(" + object +
           ".context.getState(getPositions=True)))";
}

bool is_in_nanometres(std::string const& tool, std::vector<PdbChain> const& chains) {
    if (tool != openmichrom && tool != polychrom) return false;
    double sum = 0;
    std::size_t pairs = 0;
    for (PdbChain const& chain : chains)
        for (std::size_t k = 1; k < chain.size(); ++k, ++pairs)
            sum += norm(chain.position[k] - chain.position[k - 1]);
    return pairs > 0 && sum < longest_tenth * static_cast<double>(pairs);
}

}  // namespace catena::foreign
