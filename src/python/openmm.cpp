// Integrators for plain OpenMM scripts. OpenMM's own Python package wraps them: it makes them from
// XML, and knows their base classes.
#include "bindings.hpp"

#if CATENA_PYTHON_OPENMM_PLUGIN
#include "error.hpp"
#include "plugin/integrators.hpp"
#endif

namespace nb = nanobind;

namespace catena::python {

void add_openmm(nb::module_& module) {
    module.attr("has_openmm_integrators") = CATENA_PYTHON_OPENMM_PLUGIN != 0;
#if CATENA_PYTHON_OPENMM_PLUGIN
    module.def(
        "register_openmm_integrators",
        [] {
            try {
                plugin::register_integrators();
            } catch (catena::InputError const& error) {
                PyErr_SetString(PyExc_ImportError, error.what());
                throw nb::python_error();
            }
        },
        "Makes Catena's integrators known to OpenMM's XmlSerializer.");
#endif
}

}  // namespace catena::python
