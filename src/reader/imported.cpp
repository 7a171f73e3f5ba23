// Implements the import of chains. Names, residues and positions are those of the topology; masses
// and lengths are those of the System.
#include "reader/imported.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generate/conformation.hpp"
#include "generate/start_fit.hpp"
#include "reader/force_notes.hpp"
#include "scene/fields.hpp"
#include "systems/import.hpp"

namespace catena::scene {

namespace {

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
    StartFit::Chain const chain{draft.chain.name, beads};
    fit.make_whole(chain, false);
    if (std::int64_t const k = coincident_bead(beads, Base::free); k >= 0)
        fail_at(openmm, "bead", k + 1,
                fmt::format("bead {} of chain `{}` coincides with bead {}", k + 1,
                            shown(draft.chain.name), k),
                "move one of them in the topology");
    fit.fit(chain);
    return draft;
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
    std::vector<Draft> drafts;
    // Frames of a run with soft springs stretch them as far as their thermal motion does.
    StartFit fit(scene, *openmm.find("topology"),
                 "give the topology positions that fit the System's bonds",
                 largest_change_of(imported.largest_spread), largest_relaxed_change);
    for (ImportedChain& chain : imported.chains)
        drafts.push_back(draft_of(std::move(chain), openmm, warm, fit));
    fit.note();
    return drafts;
}

}  // namespace catena::scene
