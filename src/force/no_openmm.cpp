// Stubs for a build without OpenMM: every function that needs it throws "built without OpenMM".
#include "error.hpp"
#include "force/contacts.hpp"
#include "force/openmm_force.hpp"
#include "force/openmm_integrator.hpp"
#include "systems/import.hpp"

namespace catena {

namespace {

char const* const remedy =
    "install OpenMM (pip install openmm, or Debian's libopenmm-dev) and build again, or leave "
    "forces.openmm out";

}  // namespace

std::unique_ptr<OpenMmForce> make_openmm_force(OpenMmSpec const&, BeadSystem const& beads,
                                               Communicator const&, ChainsOnDevice const&) {
    throw built_without("OpenMM", beads.scene_file + ": forces.openmm", remedy);
}

std::unique_ptr<OpenMmForce> make_openmm_contacts(OpenMmSpec const&, BeadSystem const& beads,
                                                  Communicator const&, double) {
    throw built_without("OpenMM", beads.scene_file + ": forces.openmm", remedy);
}

SystemLinks read_system_links(OpenMmSpec const&, std::string const& scene_file) {
    throw built_without("OpenMM", scene_file + ": forces.openmm", remedy);
}

ImportedSystem import_openmm_system(OpenMmSpec const&, std::string const& scene_file) {
    throw built_without("OpenMM", scene_file + ": forces.openmm", remedy);
}

BondedChains chains_by_bonds(OpenMmSpec const&, std::string const& name) {
    throw built_without("OpenMM", name, remedy);
}

OpenMmState read_openmm_state(std::string const&, std::string const& where) {
    throw built_without("OpenMM", where, remedy);
}

std::optional<ScreenedChains> read_screened_chains(std::string const&, std::string const& where) {
    throw built_without("OpenMM", where, remedy);
}

std::unique_ptr<OpenMmIntegrator> make_openmm_integrator(OpenMmSpec const&, BeadSystem const& beads,
                                                         Communicator const&, OwnLinks,
                                                         OwnRun const&, std::vector<Vec3> const&) {
    throw built_without("OpenMM", beads.scene_file, remedy);
}

std::string openmm_version() { return "none"; }

std::vector<std::string> openmm_platforms() { return {}; }

}  // namespace catena
