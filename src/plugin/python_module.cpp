// The extension module catena._integrators: integrators for plain OpenMM scripts. OpenMM's own
// Python package makes them from XML and wraps them by their base classes.
#include <nanobind/nanobind.h>

#include <cstdint>

#include "error.hpp"
#include "plugin/integrators.hpp"

namespace nb = nanobind;

namespace catena::plugin {
namespace {

// OpenMM's Python package gives the addresses of its C++ objects as numbers.
OpenMM::System& system_at(std::uintptr_t address) {
    return *reinterpret_cast<OpenMM::System*>(address);
}
HeldConstraints& held_at(std::uintptr_t integrator) {
    return held_by(*reinterpret_cast<OpenMM::Integrator*>(integrator));
}

/// Calls `action`; what is wrong with its input becomes an InputError of the package.
template <class Action>
void translated(Action const& action) {
    try {
        action();
    } catch (InputError const& error) {
        nb::object const type = nb::module_::import_("catena.errors").attr("InputError");
        PyErr_SetString(type.ptr(), error.what());
        throw nb::python_error();
    }
}

}  // namespace
}  // namespace catena::plugin

NB_MODULE(_integrators, module) {
    using namespace catena::plugin;
    module.doc() = "Integrators for OpenMM in C++; use catena.openmm.";
    module.def(
        "register", [] { translated(register_integrators); },
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
            bool held = false;
            translated([&] { held = held_at(integrator).put_back(system_at(system)); });
            return held;
        },
        "Puts back what take_constraints() has taken. Returns False if the integrator has done "
        "so.");
}
