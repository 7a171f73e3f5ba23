// Implements the reader of chains of nucleotides. A nucleotide becomes two beads, backbone and
// base, and the base hangs on the backbone, which goes on.
#include <fmt/format.h>

#include <algorithm>

#include "generate/branched.hpp"
#include "generate/conformation.hpp"
#include "reader/models.hpp"
#include "reader/sequences.hpp"
#include "reader/system_links.hpp"
#include "structure/calvados_rna.hpp"
#include "structure/fasta.hpp"

namespace catena::scene {

namespace {

void check_keys(ChainRequest& request) {
    if (Node const* const rigid = request.fields.find("rigid"))
        fail(*rigid, "rigid domains in a chain of nucleotides, whose model is of disordered RNA",
             "leave `rigid` out, or import the CALVADOS package's System of a structured RNA");
    request.allow("a chain of nucleotides, whose ends are as its other nucleotides",
                  {"record", "model", "positions", "links", "anchor", "conformation"});
    if (request.scene.si)
        fail(request.node, fmt::format("model {} in SI units", calvados_rna::model),
             "write `units: md`: its parameters are in nm, amu and kJ/mol");
}

/// The bases of the model's table, which alone stand in sequences.
ResidueTable const& bases() {
    static ResidueTable const table = [] {
        ResidueTable const& whole = *built_in_table(calvados_rna::model);
        std::vector<ResidueType> types = whole.types();
        std::erase_if(types, [](ResidueType const& t) { return t.name == calvados_rna::backbone; });
        return ResidueTable(whole.name(), std::move(types));
    }();
    return table;
}

/// Residues of the beads of a sequence.
Residues beads_of(ChainRequest& request) {
    WrittenSequence const written = written_sequence(request);
    ResidueType const* const backbone = table_of(request).find(calvados_rna::backbone);
    Residues residues;
    for (char const letter : one_letter_codes(written.text, written.source, bases(), request.scene))
        residues.insert(residues.end(), {backbone, bases().find(letter)});
    return residues;
}

/// Bead on which each bead hangs, counted from 0: -1, 0, 0, 2, 2, 4, 4, ...
std::vector<std::int64_t> comb(std::size_t beads) {
    std::vector<std::int64_t> inboard;
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(beads); ++k)
        inboard.push_back(k == 0 ? -1 : k % 2 == 0 ? k - 2 : k - 1);
    return inboard;
}

/// Beads without positions. Links have the model's lengths, or those of the scene's System.
BeadArrays sized(ChainRequest const& request, Residues const& residues,
                 std::vector<std::int64_t> const& inboard) {
    BeadArrays beads;
    for (std::size_t k = 0; k < residues.size(); ++k) {
        bool const linked = k > 0 || request.base == Base::fixed;
        double length = linked ? residues[k]->bond : 0;
        if (request.system && k > 0 && !request.links_as_given())
            if (double const bond = request.system->length(
                    request.particle + inboard[k], request.particle + static_cast<std::int64_t>(k));
                bond > 0)
                length = bond;
        beads.mass.push_back(residues[k]->mass);
        beads.length.push_back(length);
        beads.residue.push_back(residues[k]->name);
    }
    beads.velocity.assign(residues.size(), Vec3::zero());
    beads.anchor = request.anchor();
    return beads;
}

/// Places the backbone as a plane zig-zag and the bases side by side, across its plane.
void extend(BeadArrays& beads, Base base) {
    std::size_t const anchors = base == Base::fixed ? 1 : 0, n = beads.mass.size();
    std::vector<Vec3> const zigzag =
        extended_conformation(static_cast<std::int64_t>(n / 2 + anchors), 1);
    Vec3 at = beads.anchor;
    for (std::size_t k = 0; k < n; k += 2) {
        if (std::size_t const point = k / 2 + anchors; point > 0)
            at = plus_scaled(at, beads.length[k], zigzag[point] - zigzag[point - 1]);
        beads.position.push_back(at);
        beads.position.push_back(at + Vec3{{0, 0, beads.length[k + 1]}});
    }
}

/// Grows a start without overlaps, and notes those that are left.
void grow(BeadArrays& beads, ChainRequest const& request, std::vector<std::int64_t> const& inboard,
          std::int64_t copy) {
    Overlaps const left = grow_tree(beads, {request.base, beads.anchor, request.seed(copy)},
                                    inboard, excluded_of_nucleotides);
    if (left.count > 0)
        request.scene.note(fmt::format(
            "chain `{}` starts with {} overlaps of beads closer than {} nm, the nearest {:.3g} nm "
            "apart: choose another `seed` in `dynamics`, or write `relax: true`",
            shown(request.name()), left.count, excluded_of_nucleotides, left.nearest));
}

}  // namespace

bool is_rna(ChainRequest const& request) {
    Node const* const model = request.fields.find("model");
    return model && model->kind == Node::Kind::scalar && model->text == calvados_rna::model;
}

void read_nucleotides(ChainRequest& request, std::int64_t copy, ChainSpec& chain) {
    check_keys(request);
    Residues const residues = beads_of(request);
    request.residues.clear();
    for (ResidueType const* const residue : residues) request.residues.push_back(residue->name);
    hand_to_forces(request, residues);
    request.protein_ends = {false, false};
    std::vector<std::int64_t> inboard = comb(residues.size());
    BeadArrays& beads = chain.beads = sized(request, residues, inboard);
    WrittenStart const from = written_start(request);
    from.self_avoiding ? grow(beads, request, inboard, copy) : extend(beads, request.base);
    chain.parent = as_parents(std::move(inboard));
    if (from.file)
        request.place(beads, request.positions_from(*from.file, beads.size()), *from.file,
                      chain.parent);
}

}  // namespace catena::scene
