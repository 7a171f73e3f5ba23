// Implements the reader of chains of residues. Residues become beads at the positions of a file, or
// at an extended or self-avoiding start conformation.
#include "reader/sequences.hpp"

#include <fmt/format.h>

#include <map>

#include "domains/rigid_entry.hpp"
#include "generate/conformation.hpp"
#include "generate/generators.hpp"
#include "keys/maps.hpp"
#include "reader/models.hpp"
#include "reader/structure_entry.hpp"
#include "scene/files.hpp"
#include "structure/calvados2.hpp"
#include "structure/calvados_rna.hpp"
#include "structure/fasta.hpp"
#include "structure/pdb_sites.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

/// Parameters of each residue of a sequence. Throws InputError for codes that are not in the table.
Residues residues_of(std::string const& text, Node const& source, ChainRequest& request) {
    ResidueTable const& table = table_of(request);
    Residues residues;
    for (char const letter : one_letter_codes(text, source, table, request.scene))
        residues.push_back(table.find(letter));
    return residues;
}

/// Returns the table's residues for a file's names. Names and modifications that are not in the
/// table map to their parents, with a note. Throws InputError for all others.
Residues residues_named(PdbSites const& from, Node const& source, ResidueTable const& table,
                        Scene& scene) {
    Residues residues;
    std::map<std::pair<std::string, std::string>, int> renamed;
    for (PdbSite const& site : from.sites) {
        ResidueMeaning const meaning = meaning_of(site.residue);
        std::string const residue = site.residue + (site.label.empty() ? "" : " " + site.label);
        auto const bead = static_cast<std::int64_t>(residues.size()) + 1;
        if (ResidueType const* const known = table.find(std::string_view(site.residue))) {
            residues.push_back(known);
            continue;
        }
        // A bead would have the charge of the parent: the chain's charge would change silently.
        if (meaning.kind == ResidueKind::charged)
            fail_at(source, "bead", bead,
                    fmt::format("`{}` has another charge than {}, and {} has no parameters for it",
                                residue, meaning.parent, table.name()),
                    fmt::format("write {} in the file if that charge may be lost, or name a table "
                                "that has it: `model: {{residues: FILE.csv}}`",
                                meaning.parent));
        residues.push_back(meaning.kind == ResidueKind::amino_acid
                               ? table.find(std::string_view(meaning.parent))
                               : nullptr);
        if (!residues.back())
            fail_at(source, "bead", bead,
                    fmt::format("`{}` is not a residue of {}", residue, table.name()),
                    is_nucleotide(site.residue) ? nucleotide_remedy
                                                : "rename or remove it in the file");
        if (meaning.parent != site.residue) ++renamed[{site.residue, meaning.parent}];
    }
    std::string list;
    for (auto const& [names, count] : renamed)
        list += fmt::format("{}{} {} as {}", list.empty() ? "" : ", ", count, names.first,
                            names.second);
    if (!list.empty())
        scene.note(
            fmt::format("`{}`: residues take the parameters and charge of their parents ({})",
                        from.file, list));
    return residues;
}

/// Sets masses and names of the beads.
void set_residues(BeadArrays& beads, Residues const& residues, ChainRequest const& request) {
    auto const n = static_cast<std::int64_t>(residues.size());
    bool const complex = request.part != nullptr && !request.part->members.empty();
    calvados2::ChargedTermini const termini =
        complex ? calvados2::ChargedTermini{false, false} : request.termini();
    for (std::int64_t k = 0; k < n; ++k) {
        auto const at = static_cast<std::size_t>(k);
        beads.mass[at] = calvados2::bead_mass(*residues[at], {k, n, termini});
        beads.residue[at] = residues[at]->name;
    }
    for (calvados2::InnerTerminus const& end : request.inner_termini())
        beads.mass[static_cast<std::size_t>(end.bead)] +=
            (end.charged.n ? calvados2::first_bead_mass : 0) +
            (end.charged.c ? calvados2::last_bead_mass : 0);
}

/// Returns beads at their start positions; mass and residue of each bead are set later.
BeadArrays at_start(ChainRequest const& request, std::vector<double> const& lengths,
                    std::int64_t copy) {
    WrittenStart const from = written_start(request);
    double const length = *std::max_element(lengths.begin(), lengths.end()),
                 excluded = std::min(excluded_distance, widest_exclusion * length);
    // A fixed base needs one more point: the anchor.
    std::int64_t const points = std::ssize(lengths) + (request.base == Base::fixed ? 1 : 0);
    std::vector<Vec3> const start =
        from.self_avoiding
            ? self_avoiding_conformation(points, length, excluded, request.seed(copy))
            : extended_conformation(points, length);
    BeadArrays made = beads_at(start, length, 1, request.base, request.anchor());
    request.set_lengths(made, lengths);
    if (from.file) request.place(made, request.positions_from(*from.file, made.size()), *from.file);
    return made;
}

/// Reads the residues from `fasta` or `sequence`, or names those of the structure.
Residues read_residues(ChainRequest& request) {
    if (request.part != nullptr)
        return residues_named(request.part->from, *request.fields.find("pdb"), table_of(request),
                              request.scene);
    WrittenSequence const written = written_sequence(request);
    return residues_of(written.text, written.source, request);
}

/// Notes nucleotides of a residue table, which would have one bead each.
void note_single_beads(ChainRequest const& request, Residues const& residues) {
    if (std::any_of(residues.begin(), residues.end(), [](ResidueType const* residue) {
            return residue->name == calvados_rna::backbone || residue->name == "RNA";
        }))
        request.scene.note(fmt::format(
            "chain `{}` has a bead for each letter in a row, also for RNA of `{}`: nucleotides of "
            "CALVADOS are a backbone with bases beside it, write `model: {}`",
            shown(request.name()), request.table->name(), calvados_rna::model));
}

/// Reads `rigid`, which requires positions. Those of a structure are read with it.
void read_rigid(ChainRequest& request, std::size_t residues) {
    Fields const& fields = request.fields;
    if (request.part != nullptr) {
        request.rigid = request.part->rigid;
        return;
    }
    Node const* const rigid = fields.find("rigid");
    if (!rigid) return;
    Node const* const conformation = fields.find("conformation");
    if (!fields.find("positions") && !(conformation && conformation->kind == Node::Kind::map))
        fail(*rigid, "rigid domains in a chain without positions",
             "give `pdb` or `positions`: they define the shape of the domains");
    RigidSource const source{{residues}, request.name(), request.scene.file};
    RigidBodies const bodies = read_rigid_bodies(*rigid, source);
    for (std::string const& note : bodies.notes) request.scene.note(note);
    request.rigid = assemble(bodies.sets, source.numbers)[0].rigid;
}

}  // namespace

WrittenSequence written_sequence(ChainRequest const& request) {
    Fields const& fields = request.fields;
    Node const* const fasta = fields.find("fasta");
    Node const* const record = fields.find("record");
    if (record && !fasta)
        fail(*record, "key `record` chooses among the sequences of a `fasta` file", "leave it out");
    if (!fasta) {
        Node const& sequence = fields.need("sequence", "sequence: MDVFMKGLSK");
        return {text(sequence), sequence};
    }
    std::string const path = resolved(text(*fasta), request.scene.file);
    return {read_fasta(path, *fasta, {record, fields.find("name")}), *fasta};
}

WrittenStart written_start(ChainRequest const& request) {
    Node const* const positions = request.fields.find("positions");
    Node const* const conformation = request.fields.find("conformation");
    if (positions && conformation)
        fail(*conformation, "the chain has both `positions` and `conformation`",
             "keep one of them");
    if (!conformation) return {positions, false};
    if (conformation->kind == Node::Kind::map)
        return {&Fields(*conformation, keys::conformation).need("pdb", "pdb: start.pdb"), false};
    return {nullptr, choice<bool>(*conformation, {{"extended", false}, {"self_avoiding", true}})};
}

void check_residue_keys(ChainRequest& request) {
    bool const pdb = request.fields.find("pdb");
    if (pdb && is_rna(request))
        fail(*request.fields.find("pdb"), "RNA from a structure file",
             "give its `sequence`, and its beads' places by `positions` (a table x,y,z with "
             "backbone and base by turns)");
    request.allow(pdb ? "a chain from a PDB file" : "a sequence",
                  pdb ? Names{"record", "model", "links", "anchor", "rigid", "charge_termini",
                              "chain", "conformer", "gaps", "sites"}
                      : Names{"record", "model", "positions", "links", "anchor", "conformation",
                              "rigid", "charge_termini"});
    if (request.scene.si)
        fail(request.node, "model calvados2 in SI units",
             "write `units: md`: its parameters are in nm, amu and kJ/mol");
    table_of(request);
}

// The residues come first, because rigid domains and start positions depend on their number.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy) {
    check_residue_keys(request);
    Residues const residues = read_residues(request);
    read_rigid(request, residues.size());
    request.residues.clear();
    for (ResidueType const* const residue : residues) request.residues.push_back(residue->name);
    hand_to_forces(request, residues);
    note_single_beads(request, residues);
    find_ends(request, residues);
    BeadArrays beads = at_start(request, link_lengths(residues), copy);
    set_residues(beads, residues, request);
    if (request.part != nullptr)
        request.place(beads, request.part->from.positions(), *request.fields.find("pdb"));
    return beads;
}

}  // namespace catena::scene
