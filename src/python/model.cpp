// Binds Model: scenes of files and of text.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "catena/scene.hpp"

namespace catena::python {

void add_model(nanobind::module_& module) {
    namespace nb = nanobind;
    nb::class_<Model>(module, "Model", "A scene in memory; it is read and checked when it is used.")
        .def_static("from_file", &Model::from_file, nb::arg("path"), "Reads a scene file.")
        .def_static("from_text", &Model::from_text, nb::arg("yaml"),
                    "Makes a scene of the text of a scene file.")
        .def(
            "set",
            [](Model& model, std::string const& key, std::string const& value) {
                model.set(key, value);
            },
            nb::arg("key"), nb::arg("value"), "Sets a key to a value in YAML.")
        .def(
            "check",
            [](Model const& model) {
                static_cast<void>(model.bodies());  // reads the scene while no other thread can
                nb::gil_scoped_release const free;
                return model.check();
            },
            "Checks what can be checked without a step; returns the notes.")
        .def_prop_ro("bodies", &Model::bodies, "Number of bodies and beads.")
        .def_prop_ro("notes", &Model::notes, "What the reader assumed, changed or left out.");
}

}  // namespace catena::python
