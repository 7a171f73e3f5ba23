// Comparison of a CALVADOS folder's settings with the forces of its System.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "foreign/calvados_components.hpp"
#include "foreign/made_system.hpp"
#include "foreign/package_file.hpp"
#include "foreign/system_text.hpp"

namespace catena::foreign {

/// Returns the force of contacts in the package's form; nullptr without one.
ForceText const* contacts_of(SystemText const&);

/// Throws InputError if depth, cutoff or `fixed_lambda` of contacts are not those of the
/// configuration. Notes contacts of another form.
void compare_contacts(PackageFile const& config, SystemText const& system,
                      std::vector<std::string>& notes);

/// Throws InputError if the System lacks bonds or elastic networks that components and custom
/// restraints make, or has them with another stiffness, depth or reach, or as compare_networks()
/// does. Notes further ones, and components whose bonds are not compared.
void compare_bonds(PackageFile const& config, CalvadosComponents const& components,
                   std::string const& folder, MadeSystem const& made,
                   std::vector<std::string>& notes);

/// The forces of bonds of one component; nullptr for what the System lacks.
struct ComponentForces {
    CalvadosComponent const* component;
    ForceText const* bonds;
    /// The harmonic network, or the Go contacts with their scaled contacts and scaled charges.
    std::vector<ForceText const*> networks = {};
    ForceText const *stacks = nullptr, *angles = nullptr;  // of RNA
};
/// Returns those of each component. The package writes one component after the other.
std::vector<ComponentForces> forces_of(CalvadosComponents const&, SystemText const&);

/// Particles of a component: `count` molecules of `beads` from particle `first` on.
struct Molecules {
    std::size_t first, beads, count;
};
/// Returns those of each component; nothing if the topology does not tell.
std::vector<Molecules> molecules_of(CalvadosComponents const&, MadeSystem const&);

/// Throws InputError if molecules of a component have different bonds or networks, if a network has
/// other lengths than the distances in top.pdb, or other bonds than restr_NAME.txt and
/// bonds_NAME.txt list. Notes networks that cannot be compared, and forces that ignore the box.
void compare_networks(PackageFile const& config, CalvadosComponents const&,
                      std::string const& folder, MadeSystem const&,
                      std::vector<std::string>& notes);

/// Throws InputError if the System's external force is not that of the configuration: the slab's
/// axis, centre and stiffness (`slab_eq`), or the expression (`ext_force`). Notes a force that the
/// configuration does not ask for.
void compare_pull(PackageFile const& config, SystemText const& system,
                  std::vector<std::string>& notes);

/// Throws InputError if the external force that the configuration asks for acts on other molecules
/// than `ext_restraint` says.
void refuse_other_pulled(PackageFile const& config, CalvadosComponents const&, MadeSystem const&);

}  // namespace catena::foreign
