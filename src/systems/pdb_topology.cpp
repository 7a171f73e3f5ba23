// Implements the reader of PDB topologies.
#include "systems/pdb_topology.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

#include "error.hpp"
#include "scene/node.hpp"
#include "scene/pdb_file.hpp"

namespace catena {

namespace {

/// Reads the file; throws InputError if it cannot be opened.
std::string whole_text(std::string const& file, std::string const& where) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError(fmt::format("cannot open {}", scene::shown_path(file)), where,
                         "name a PDB file that can be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Makes names unique: the first chain keeps its name, the next ones are "A-2", "A-3", ...
class UniqueNames {
  public:
    /// Returns `name`, or the next free variant of it.
    std::string make(std::string const& name) {
        if (taken_.insert(name).second) return name;
        std::string unique;
        do {
            unique = fmt::format("{}-{}", name, 1 + ++copies_[name]);
        } while (!taken_.insert(unique).second);
        return unique;
    }

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, std::size_t> copies_;
};

}  // namespace

std::vector<PdbChain> read_pdb_topology(std::string const& file, std::string const& where,
                                        std::vector<std::string>* notes) {
    std::string const text = whole_text(file, where);
    std::vector<PdbChain> chains;
    scene::PdbAtom last;
    auto const summary =
        scene::for_each_pdb_atom(text, scene::shown_path(file), [&](scene::PdbAtom const& atom) {
            if (chains.empty() || !atom.same_chain(last))
                chains.emplace_back().name = scene::shown(chain_of(atom));
            last = atom;
            chains.back().residue.push_back(atom.residue.empty() ? "UNK"
                                                                 : scene::shown(atom.residue));
            chains.back().position.push_back(
                {{atom.position[0] / 10, atom.position[1] / 10, atom.position[2] / 10}});
        });
    if (summary.atoms == 0)
        throw InputError(fmt::format("{} holds no ATOM record", scene::shown_path(file)), where,
                         "name a PDB file with one atom per particle");
    if (notes && summary.models > 1)
        notes->push_back(fmt::format("`{}`: {} models, the first is taken", scene::shown_path(file),
                                     summary.models));
    // Chains without letter and segment are named by their number.
    UniqueNames names;
    for (std::size_t c = 0; c < chains.size(); ++c)
        chains[c].name =
            names.make(chains[c].name.empty() ? std::to_string(c + 1) : chains[c].name);
    return chains;
}

}  // namespace catena
