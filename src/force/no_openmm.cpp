// Stubs for a program without OpenMM: every function that needs it throws no_openmm().
#include "force/no_openmm.hpp"

#include "force/contacts.hpp"
#include "force/openmm_force.hpp"
#include "force/openmm_integrator.hpp"
#include "systems/import.hpp"

namespace catena {

std::unique_ptr<OpenMmForce> make_openmm_force(OpenMmSpec const&, BeadSystem const& beads,
                                               Communicator const&, ChainsOnDevice const&) {
    throw no_openmm(beads.scene_file + ": forces.openmm");
}

std::unique_ptr<OpenMmForce> make_openmm_contacts(OpenMmSpec const&, BeadSystem const& beads,
                                                  Communicator const&, double) {
    throw no_openmm(beads.scene_file + ": forces.openmm");
}

SystemLinks read_system_links(OpenMmSpec const&, std::string const& scene_file) {
    throw no_openmm(scene_file + ": forces.openmm");
}

ImportedSystem import_openmm_system(OpenMmSpec const&, std::string const& scene_file) {
    throw no_openmm(scene_file + ": forces.openmm");
}

BondedChains chains_by_bonds(OpenMmSpec const&, std::string const& name) { throw no_openmm(name); }

OpenMmState read_openmm_state(std::string const&, std::string const& where) {
    throw no_openmm(where);
}

std::optional<ScreenedChains> read_screened_chains(std::string const&, std::string const& where) {
    throw no_openmm(where);
}

std::unique_ptr<OpenMmIntegrator> make_openmm_integrator(OpenMmSpec const&, BeadSystem const& beads,
                                                         Communicator const&, OwnLinks,
                                                         OwnRun const&, std::vector<Vec3> const&) {
    throw no_openmm(beads.scene_file);
}

std::string openmm_version() { return "none"; }

std::vector<std::string> openmm_platforms() { return {}; }

}  // namespace catena
