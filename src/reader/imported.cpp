// Implements the import of chains. Names, residues and positions are those of the topology; masses
// and lengths are those of the System.
#include "reader/imported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "generate/conformation.hpp"
#include "generate/crosslinks.hpp"
#include "generate/start_fit.hpp"
#include "reader/force_notes.hpp"
#include "scene/fields.hpp"
#include "structure/residue_names.hpp"
#include "systems/import.hpp"

namespace catena::scene {

namespace {

double constexpr same_mass = 1e-3;  // relative; covers masses of few digits
/// Masses that ends of chains add to a residue, and the differences between ends, amu.
std::array<double, 4> constexpr masses_of_ends{2, 14, 16, 18};
double constexpr same_end = 1e-3;  // amu

/// Makes a draft of an imported chain and fits its positions to the lengths of its links.
Draft draft_of(ImportedChain&& from, Node const& openmm, bool warm, StartFit& fit) {
    Draft draft;
    draft.node = &openmm;
    draft.chain.name = std::move(from.name);
    draft.chain.velocities = warm ? StartVelocities::thermal : StartVelocities::zero;
    BeadArrays& beads = draft.chain.beads;
    beads.mass = std::move(from.mass);
    beads.position = std::move(from.position);
    beads.velocity.assign(beads.mass.size(), Vec3::zero());
    beads.length = std::move(from.length);
    beads.residue = std::move(from.residue);
    std::vector<std::int64_t> const& parent = draft.chain.parent = std::move(from.parent);
    StartFit::Chain const chain{draft.chain.name, beads, Base::free, {}, nullptr, parent};
    fit.make_whole(chain, false);
    if (std::int64_t const k = coincident_bead(beads, Base::free, parent); k >= 0)
        fail_at(openmm, "bead", k + 1,
                fmt::format("bead {} of chain `{}` coincides with bead {}", k + 1,
                            shown(draft.chain.name),
                            inboard_of(parent, static_cast<std::size_t>(k)) + 1),
                "move one of them in the topology");
    fit.fit(chain);
    draft.chain.crosslinks = std::move(from.crosslinks);
    return draft;
}

/// Fits the positions to the cross-links. Chains with the same links are noted once.
void close_crosslinks(std::vector<Draft>& drafts, Node const& topology, Scene& scene) {
    using Links = std::pair<std::vector<std::int64_t>, std::vector<std::array<std::int64_t, 2>>>;
    std::set<Links> known;
    for (Draft& draft : drafts) {
        ChainSpec& chain = draft.chain;
        if (!chain.is_cross_linked()) continue;
        bool const is_new = known.emplace(chain.parent, ends_of_crosslinks(chain)).second;
        fit_crosslinks(chain, {.scene = scene, .from = topology, .is_known = !is_new});
    }
}

/// True for masses of one residue, at an end of a chain or elsewhere.
bool are_alike(double a, double b) {
    double const difference = std::abs(a - b);
    return difference <= same_mass * a ||
           std::any_of(masses_of_ends.begin(), masses_of_ends.end(),
                       [&](double end) { return std::abs(difference - end) <= same_end; });
}

/// Notes amino acids whose masses in the System differ from each other: atoms and particles may
/// have different orders. Compared are beads with the same place in their residues. Ends of chains
/// are left out.
void note_mixed_masses(ImportedSystem const& imported, Node const& topology, Scene& scene) {
    std::map<std::pair<std::string, int>, double> mass;
    std::int64_t particle = 0;
    for (ImportedChain const& chain : imported.chains)
        for (std::size_t k = 0; k < chain.mass.size(); ++k, ++particle) {
            std::string const& residue = chain.residue[k];
            if (k == 0 || k + 1 == chain.mass.size() || !is_amino_acid(residue)) continue;
            double const known =
                mass.try_emplace({residue, chain.place[k]}, chain.mass[k]).first->second;
            if (are_alike(known, chain.mass[k])) continue;
            return scene.note(fmt::format(
                "{} has the masses {:.6g} and {:.6g} amu in the System (the latter is particle {}, "
                "from 0): does `{}` have its atoms in the order of the particles?",
                residue, known, chain.mass[k], particle, shown_path(topology.text)));
        }
}

}  // namespace

std::vector<Draft> import_chains(Node const& openmm, Scene& scene, bool warm) {
    OpenMmSpec const& spec = *scene.forces.openmm;
    if (spec.topology.empty())
        fail(openmm, "the scene has no `chains` and the system has no topology",
             "add `topology: topology.pdb`, or `chains`");
    if (Node const* const map = openmm.find("map"))
        fail(*map, "a map of chains in a scene that takes them from the topology",
             "leave it out or write `chains`");
    ImportedSystem imported = import_openmm_system(spec, scene.file);
    for (std::string const& note : imported.notes) scene.note(note);
    if (!scene.box && imported.periodic) scene.box = imported.box;
    note_box_that_no_force_knows(scene, imported.periodic);
    note_mixed_masses(imported, *openmm.find("topology"), scene);
    note_screening(scene, imported.screening);
    std::vector<Draft> drafts;
    // Frames of a run with soft springs stretch them as far as their thermal motion does.
    StartFit fit(scene, *openmm.find("topology"),
                 "give the topology positions that fit the System's bonds",
                 largest_change_of(imported.largest_spread), largest_relaxed_change);
    for (ImportedChain& chain : imported.chains)
        drafts.push_back(draft_of(std::move(chain), openmm, warm, fit));
    fit.note();
    close_crosslinks(drafts, *openmm.find("topology"), scene);
    return drafts;
}

}  // namespace catena::scene
