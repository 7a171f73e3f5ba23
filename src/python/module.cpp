// The extension module catena._core, on which the Python package stands.
#include "bindings.hpp"
#include "catena/errors.hpp"
#include "catena/version.hpp"
#include "force/openmm_force.hpp"

namespace nb = nanobind;

namespace catena::python {
namespace {

void raise(char const* name, char const* what) {
    nb::object const type = nb::module_::import_("catena.errors").attr(name);
    PyErr_SetString(type.ptr(), what);
}

}  // namespace

void add_errors() {
    nb::register_exception_translator([](std::exception_ptr const& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (Error const& error) {
            bool const input = error.reason() == Error::Reason::input;
            raise(input ? "InputError" : "ComputationError", error.what());
        }
    });
}

}  // namespace catena::python

NB_MODULE(_core, module) {
    module.doc() = "Catena's solver and simulations in C++; use the package catena.";
    module.attr("version") = catena::version().c_str();
    module.attr("has_openmm") = catena::openmm_version() != "none";
    catena::python::add_errors();
    catena::python::add_model(module);
    catena::python::add_solution(module);
    catena::python::add_simulation(module);
    catena::python::add_topology(module);
    catena::python::add_analysis(module);
    catena::python::add_analyse(module);
    catena::python::add_keys(module);
}
