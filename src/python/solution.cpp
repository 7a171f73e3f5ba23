// Binds solutions: accelerations, joint forces and their errors as arrays.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "catena/scene.hpp"
#include "catena/solver.hpp"
#include "force.hpp"

namespace catena::python {
namespace {

using Self = nb::handle_t<SolverResult>;

/// Returns the result of which `self` is the Python object.
SolverResult const& at(Self self) { return *nb::inst_ptr<SolverResult>(self); }

SolverResult solve(Model const& model, nb::object callable) {
    PythonForce force(std::move(callable));
    static_cast<void>(model.bodies());  // reads the scene while no other thread can
    SolverResult result;
    {
        nb::gil_scoped_release const free;
        result = Solver(model, force.function()).solve();
    }
    if (auto interrupt = force.take_interrupt()) throw std::move(*interrupt);
    return result;
}

}  // namespace

void add_solution(nb::module_& module) {
    nb::class_<SolverResult>(module, "Solution", "Accelerations and joint forces at the start.")
        .def_prop_ro("joint_accelerations",
                     [](Self self) { return view_of(at(self).joint_acceleration, self); })
        .def_prop_ro("first", [](Self self) { return view_of(at(self).first, self); })
        .def_prop_ro("accelerations",
                     [](Self self) { return view_of(at(self).acceleration, self); })
        .def_prop_ro("angular_accelerations",
                     [](Self self) { return view_of(at(self).angular_acceleration, self); })
        .def_prop_ro("joint_forces",
                     [](Self self) { return forces_of(at(self).joint_force, self); })
        .def_prop_ro("joint_torques",
                     [](Self self) { return torques_of(at(self).joint_force, self); })
        .def_prop_ro("tip_forces", [](Self self) { return forces_of(at(self).tip_force, self); })
        .def_prop_ro("tip_torques", [](Self self) { return torques_of(at(self).tip_force, self); })
        .def_prop_ro("loop_forces", [](Self self) { return forces_of(at(self).loop_force, self); })
        .def_prop_ro("loop_torques",
                     [](Self self) { return torques_of(at(self).loop_force, self); })
        .def_ro("residual", &SolverResult::residual)
        .def_ro("residual_bound", &SolverResult::residual_bound)
        .def_ro("error", &SolverResult::error)
        .def_ro("error_bound", &SolverResult::error_bound)
        .def_prop_ro("valid", &SolverResult::valid);
    module.def("solve", &solve, nb::arg("model"), nb::arg("force").none() = nb::none(),
               "Solves a model at its start.");
}

}  // namespace catena::python
