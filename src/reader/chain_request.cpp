// Implements the keys that all kinds of chains share: name, anchor, positions and lengths of links.
// Positions are fitted by StartFit, which notes or refuses large changes.
#include "reader/chain_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "generate/conformation.hpp"
#include "generate/random.hpp"
#include "generate/start_fit.hpp"
#include "reader/sections.hpp"
#include "reader/structure_entry.hpp"
#include "reader/system_links.hpp"
#include "scene/files.hpp"
#include "structure/pdb_sites.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

/// True for the extensions of structure files, compressed or not.
bool is_structure(std::string const& path) {
    std::string const kind = ending_of(path, true);
    return kind == ".pdb" || kind == ".ent" || kind == ".cif" || kind == ".mmcif";
}

/// Number of amino acids in the file whose parent differs from the chain's residue. Returns 0 if
/// the numbers of residues differ, which is refused elsewhere.
std::size_t other_residues(PdbSites const& from, std::vector<std::string> const& residues) {
    std::size_t others = 0;
    for (std::size_t k = 0; from.sites.size() == residues.size() && k < residues.size(); ++k) {
        ResidueMeaning const meaning = meaning_of(from.sites[k].residue);
        others += meaning.kind == ResidueKind::amino_acid && meaning.parent != residues[k];
    }
    return others;
}

/// The termini that the chain's entry charges, else the whole scene among those of `protein`.
calvados2::ChargedTermini written_termini(ChainRequest const& request,
                                          calvados2::ChargedTermini const& protein) {
    if (Node const* const here = request.fields.find("charge_termini"))
        return read_charged_termini(*here);
    // The entry for all chains is the first one. Entries of preceding chains need no search.
    auto const& openmm = request.scene.forces.openmm;
    bool const said = openmm && !openmm->map.empty() && openmm->map.front().first.empty();
    if (!said) return protein;
    auto const& ends = openmm->map.front().second;
    return {ends.first != 0 && protein.n, ends.second != 0 && protein.c};
}

/// Gives the links at the ends of rigid domains their lengths in the positions, as the bonds of the
/// CALVADOS package have: centres of mass are not as far apart as alpha carbons.
void keep_links_at_domains(BeadArrays& beads, std::vector<Domain> const& rigid) {
    auto const keep = [&](std::size_t k) {
        beads.length[k] = norm(beads.position[k] - beads.position[k - 1]);
    };
    for (Domain const& domain : rigid) {
        if (domain.first > 0) keep(domain.first);
        if (domain.last + 1 < beads.size()) keep(domain.last + 1);
    }
}

/// True if the file numbers its residues from 1 on, or not at all.
bool counts_from_one(PdbSites const& from) {
    for (std::size_t k = 0; k < from.sites.size(); ++k)
        if (from.sites[k].number && from.sites[k].label != std::to_string(k + 1)) return false;
    return true;
}

}  // namespace

void ChainRequest::allow(char const* kind, Names keys) const {
    for (char const* const key :
         {"record", "model", "positions", "links", "anchor", "conformation", "rigid",
          "charge_termini", "chain", "conformer", "gaps", "sites"}) {
        Node const* const here = fields.find(key);
        if (here && std::find(keys.begin(), keys.end(), key) == keys.end())
            fail(*here, fmt::format("key `{}` does not apply to {}", key, kind), "leave it out");
    }
    links_as_given();  // checks the value even if no positions are given
    Node const* const ground = fields.find("anchor");
    if (ground && base == Base::free)
        fail(*ground, "an anchor without a fixed base",
             "write `base: fixed` or leave `anchor` out");
}

Vec3 ChainRequest::anchor() const {
    Node const* const ground = fields.find("anchor");
    return ground ? vector3(*ground) : Vec3::zero();
}

bool ChainRequest::links_as_given() const {
    Node const* const links = fields.find("links");
    return links && choice<bool>(*links, {{"model", false}, {"as_given", true}});
}

bool ChainRequest::is_cut() const { return part != nullptr && (part->cut_front || part->cut_back); }

calvados2::ChargedTermini ChainRequest::termini() const {
    calvados2::ChargedTermini ends = written_termini(*this, protein_ends);
    if (part != nullptr) {
        ends.n = ends.n && !part->cut_front;
        ends.c = ends.c && !part->cut_back;
    }
    return ends;
}

std::vector<calvados2::InnerTerminus> ChainRequest::inner_termini() const {
    std::vector<calvados2::InnerTerminus> found;
    if (part == nullptr) return found;
    for (ComplexEnd const& end : part->ends) {
        bool const protein = is_amino_acid(residues[end.bead]);
        calvados2::ChargedTermini const charged = written_termini(*this, {protein, protein});
        if (end.n ? charged.n : charged.c)
            found.push_back({static_cast<std::int64_t>(end.bead), {end.n, !end.n}});
    }
    return found;
}

void ChainRequest::set_lengths(BeadArrays& beads, std::vector<double> lengths) const {
    bool const by_system = system && !links_as_given();
    std::size_t const first = base == Base::fixed ? 0 : 1;
    for (std::size_t k = 1; by_system && k < beads.size(); ++k)
        if (double const bond = system->length(particle + static_cast<std::int64_t>(k)); bond > 0)
            lengths[k] = bond;
    bool const same =
        std::equal(lengths.begin() + static_cast<std::ptrdiff_t>(first), lengths.end(),
                   beads.length.begin() + static_cast<std::ptrdiff_t>(first));
    if (!by_system && same) return;
    // Each longer or shorter link shifts all beads after it.
    Vec3 shift = Vec3::zero();
    for (std::size_t k = first; k < beads.size(); ++k) {
        double const length = lengths[k], before = beads.length[k];
        if (length != before) {
            Vec3 const inboard =  // position before its shift
                k == 0 ? beads.anchor : beads.position[k - 1] - shift;
            shift = plus_scaled(shift, length / before - 1, beads.position[k] - inboard);
            beads.length[k] = length;
        }
        beads.position[k] = beads.position[k] + shift;
    }
}

std::uint64_t ChainRequest::seed(std::int64_t copy) const {
    return seed_of_stream(scene.dynamics.seed, (static_cast<std::uint64_t>(index) << 40) +
                                                   static_cast<std::uint64_t>(copy));
}

std::vector<Vec3> ChainRequest::positions_from(Node const& file, std::size_t beads) const {
    std::string const path = resolved(text(file), scene.file);
    bool const pdb = is_structure(path) || file.key == "pdb";
    if (pdb && scene.si)
        fail(file, "positions in a structure file are in angstrom, the scene is in SI units",
             "give a table x,y,z in metres");
    std::vector<Vec3> positions =
        pdb ? from_structure(path, file) : read_position_table(path, file);
    if (positions.size() != beads)
        fail(file,
             fmt::format("`{}` contains {} positions, the chain has {} beads",
                         shown_path(file.text), positions.size(), beads),
             "give one position per bead");
    return positions;
}

std::vector<Vec3> ChainRequest::from_structure(std::string const& path, Node const& file) const {
    PdbSites const sites = read_pdb(path, file);
    for (std::string const& note : sites.notes) scene.note(note);
    if (std::size_t const others = other_residues(sites, residues); others > 0)
        scene.note(
            fmt::format("`{}` names other residues than the sequence in {} of {} places: its "
                        "positions are used all the same",
                        sites.file, others, residues.size()));
    if (!rigid.empty() && !counts_from_one(sites))
        scene.note(
            fmt::format("`rigid` counts the residues of the sequence from 1, not by their numbers "
                        "in `{}` ({} to {})",
                        sites.file, sites.sites.front().label, sites.sites.back().label));
    return sites.positions();
}

std::string ChainRequest::name() const {
    Node const* const named = fields.find("name");
    return named ? text(*named) : fmt::format("chain-{}", index + 1);
}

void ChainRequest::place(BeadArrays& beads, std::vector<Vec3> const& positions, Node const& from,
                         Parents parents) const {
    beads.position = positions;
    double const spread =
        system ? system->largest_spread(particle, static_cast<std::int64_t>(beads.size()), parents)
               : 0;
    double const most =
        part != nullptr && part->mass_centres ? largest_soft_change : largest_change_of(spread);
    StartFit fit(scene, from, "give positions of this model, or write `links: as_given`", most,
                 system ? largest_relaxed_change : 0);
    StartFit::Chain const chain{
        part != nullptr ? part->name : name(), beads, base, rigid, nullptr, parents};
    // The chain is made whole first, so that distances of neighbours are those along its links.
    fit.make_whole(chain, links_as_given());
    refuse_coincident(beads, from, parents);
    if (links_as_given()) {
        take_lengths(beads, base, parents);
    } else {
        // Links within rigid domains keep the distances of the file.
        for (Domain const& domain : rigid)
            for (std::size_t k = domain.first + 1; k <= domain.last; ++k)
                beads.length[k] = norm(beads.position[k] - beads.position[k - 1]);
        if (part != nullptr && part->mass_centres) keep_links_at_domains(beads, rigid);
        fit.fit(chain);
    }
    fit.note();
}

void ChainRequest::refuse_coincident(BeadArrays const& beads, Node const& from,
                                     Parents parents) const {
    std::int64_t const k = coincident_bead(beads, base, parents);
    if (k < 0) return;
    std::string const other =
        k == 0 ? "the anchor"
               : fmt::format("bead {}", inboard_of(parents, static_cast<std::size_t>(k)) + 1);
    fail_at(from, "bead", k + 1,
            fmt::format("bead {} coincides with {}: their link has no direction", k + 1, other),
            "move one of them");
}

}  // namespace catena::scene
