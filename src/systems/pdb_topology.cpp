// Implements the reader of topologies in PDB and mmCIF files.
#include "systems/pdb_topology.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "error.hpp"
#include "scene/node.hpp"
#include "scene/unique_names.hpp"
#include "structure/structure_file.hpp"

namespace catena {

namespace {

/// Reads the file; throws InputError if it cannot be opened.
std::string whole_text(std::string const& file, std::string const& where) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError(fmt::format("cannot open {}", scene::shown_path(file)), where,
                         "name a PDB or mmCIF file that can be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

}  // namespace

std::vector<PdbChain> read_pdb_topology(std::string const& file, std::string const& where,
                                        std::vector<std::string>* notes,
                                        std::optional<Vec3>* cell) {
    scene::StructureFile const structure(whole_text(file, where), scene::shown_path(file));
    std::vector<PdbChain> chains;
    scene::PdbAtom last;
    auto const summary = structure.for_each_atom({}, [&](scene::PdbAtom const& atom) {
        bool const begins = chains.empty() || !atom.same_chain(last);
        if (begins) chains.emplace_back().name = scene::shown(chain_of(atom));
        bool const goes_on = !begins && atom.same_residue(last);
        chains.back().place.push_back(goes_on ? chains.back().place.back() + 1 : 0);
        last = atom;
        chains.back().residue.push_back(atom.residue.empty() ? "UNK" : scene::shown(atom.residue));
        chains.back().position.push_back(
            {{atom.position[0] / 10, atom.position[1] / 10, atom.position[2] / 10}});
    });
    if (summary.atoms == 0)
        throw InputError(fmt::format("{} holds no ATOM record", scene::shown_path(file)), where,
                         "name a PDB or mmCIF file with one atom per particle");
    if (cell && summary.cell) *cell = (1 / 10.0) * *summary.cell;
    if (notes && summary.models.size() > 1)
        notes->push_back(fmt::format("`{}`: {} models, the first is taken", scene::shown_path(file),
                                     summary.models.size()));
    // Chains without letter and segment are named by their number.
    scene::UniqueNames names;
    for (std::size_t c = 0; c < chains.size(); ++c)
        chains[c].name =
            names.make(chains[c].name.empty() ? std::to_string(c + 1) : chains[c].name);
    return chains;
}

}  // namespace catena
