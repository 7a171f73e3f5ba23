#include "scene/sequences.hpp"

#include <fmt/format.h>

#include "force/calvados2.hpp"
#include "scene/conformation.hpp"
#include "scene/files.hpp"
#include "scene/generators.hpp"

namespace catena::scene {

namespace {

using Residues = std::vector<Calvados2Residue const*>;

Residues residues_of(std::string const& letters, Node const& source) {
    Residues residues;
    for (char const letter : letters) {
        if (letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r') continue;
        residues.push_back(find_calvados2(letter));
        if (residues.back()) continue;
        fail(source,
             fmt::format("`{}` at position {} of the sequence is no residue of calvados2", shown(std::string(1, letter)), residues.size()),
             "use the one-letter codes ARNDCQEGHILKMFPSTWYV");
    }
    if (residues.empty()) fail(source, "the sequence is empty", "give one-letter codes");
    return residues;
}

Residues residues_named(std::vector<std::string> const& names, Node const& source) {
    Residues residues;
    for (std::string const& name : names) {
        residues.push_back(find_calvados2(name));
        if (residues.back()) continue;
        fail_at(source, "bead", static_cast<std::int64_t>(residues.size()), fmt::format("`{}` is no residue of calvados2", shown(name)),
                "rename or remove it in the file");
    }
    return residues;
}

void set_residues(BeadArrays& beads, Residues const& residues) {
    auto const n = static_cast<std::int64_t>(residues.size());
    for (std::int64_t k = 0; k < n; ++k) {
        auto const at = static_cast<std::size_t>(k);
        beads.mass[at] = calvados2::bead_mass(*residues[at], k, n);
        beads.residue[at] = residues[at]->name;
    }
}

/// Mass and residue of each bead are still to be set.
BeadArrays at_start(ChainRequest const& request, std::int64_t beads, std::int64_t copy) {
    Node const* const positions = request.fields.find("positions");
    Node const* const conformation = request.fields.find("conformation");
    if (positions && conformation) fail(*conformation, "the chain has both `positions` and `conformation`", "keep one of them");
    bool const file = conformation && conformation->kind == Node::Kind::map;
    bool const self_avoiding = conformation && !file && choice<bool>(*conformation, {{"extended", false}, {"self_avoiding", true}});
    double const length = calvados2::bond_length;
    std::int64_t const points = beads + (request.base == Base::fixed ? 1 : 0);
    std::vector<Vec3> const start = self_avoiding ? self_avoiding_conformation(points, length, excluded_distance, request.seed(copy))
                                                  : extended_conformation(points, length);
    BeadArrays made = beads_at(start, length, 1, request.base, request.anchor());
    Node const* const from = file ? &Fields(*conformation, {"pdb"}).need("pdb", "pdb: start.pdb") : positions;
    if (from) request.place(made, request.positions_from(*from, made.size()), *from);
    return made;
}

}  // namespace

BeadArrays read_sequence(ChainRequest& request, std::int64_t copy) {
    Fields const& fields = request.fields;
    bool const pdb = fields.find("pdb");
    request.allow(
        pdb ? "a chain from a PDB file" : "a sequence",
        pdb ? Names{"model", "links", "anchor", "rigid"} : Names{"model", "positions", "links", "anchor", "conformation", "rigid"});
    if (request.scene.si) fail(request.node, "model calvados2 in SI units", "write `units: md`: its parameters are in nm, amu and kJ/mol");
    choice<int>(fields.need("model", "model: calvados2"), {{"calvados2", 0}});
    Residues residues;
    PdbSites sites;
    if (Node const* const file = fields.find("pdb")) {
        sites = read_pdb(resolved(text(*file), request.scene.file), *file, true);
        residues = residues_named(sites.residue, *file);
    } else if (Node const* const fasta = fields.find("fasta")) {
        residues = residues_of(read_fasta(resolved(text(*fasta), request.scene.file), *fasta), *fasta);
    } else {
        Node const& sequence = fields.need("sequence", "sequence: MDVFMKGLSK");
        residues = residues_of(text(sequence), sequence);
    }
    if (Node const* const rigid = fields.find("rigid")) {
        Node const* const conformation = fields.find("conformation");
        if (!pdb && !fields.find("positions") && !(conformation && conformation->kind == Node::Kind::map))
            fail(*rigid, "rigid domains in a chain without positions", "give `pdb` or `positions`: they say what shape the domains have");
        request.rigid = read_domains(*rigid, residues.size());
    }
    BeadArrays beads = at_start(request, static_cast<std::int64_t>(residues.size()), copy);
    set_residues(beads, residues);
    if (pdb) request.place(beads, sites.position, *fields.find("pdb"));
    return beads;
}

}  // namespace catena::scene
