// Integrators for plain OpenMM scripts. OpenMM's own Python package wraps them: it makes them from
// XML, and knows their base classes.
#include <cstdint>

#include "bindings.hpp"

#if CATENA_PYTHON_OPENMM_PLUGIN
#include "error.hpp"
#include "plugin/integrators.hpp"
#endif

namespace nb = nanobind;

namespace catena::python {

#if CATENA_PYTHON_OPENMM_PLUGIN
namespace {

// OpenMM's Python package gives the addresses of its C++ objects as numbers.
OpenMM::System& system_at(std::uintptr_t address) {
    return *reinterpret_cast<OpenMM::System*>(address);
}
plugin::HeldConstraints& held_at(std::uintptr_t integrator) {
    return plugin::held_by(*reinterpret_cast<OpenMM::Integrator*>(integrator));
}

/// Calls `action`; what is wrong with its input becomes an InputError of the package.
template <class Action>
void translated(Action const& action) {
    try {
        action();
    } catch (catena::InputError const& error) {
        nb::object const type = nb::module_::import_("catena.errors").attr("InputError");
        PyErr_SetString(type.ptr(), error.what());
        throw nb::python_error();
    }
}

}  // namespace
#endif

void add_openmm(nb::module_& module) {
    module.attr("has_openmm_integrators") = CATENA_PYTHON_OPENMM_PLUGIN != 0;
#if CATENA_PYTHON_OPENMM_PLUGIN
    module.def(
        "register_openmm_integrators", [] { translated(plugin::register_integrators); },
        "Makes Catena's integrators known to OpenMM's XmlSerializer.");
    module.def(
        "take_constraints",
        [](std::uintptr_t system, std::uintptr_t integrator) {
            translated([&] { held_at(integrator).take(system_at(system)); });
        },
        "Takes a System's constraints out of it. Arguments: addresses of System and integrator.");
    module.def(
        "put_constraints_back",
        [](std::uintptr_t system, std::uintptr_t integrator) {
            translated([&] { held_at(integrator).put_back(system_at(system)); });
        },
        "Puts back what take_constraints() has taken.");
#endif
}

}  // namespace catena::python
