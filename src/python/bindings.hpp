// The parts of the extension module catena._core.
#pragma once

#include <nanobind/nanobind.h>

namespace catena::python {

/// Adds the exceptions of the package: catena.InputError and catena.ComputationError.
void add_errors();
void add_model(nanobind::module_& module);
void add_solution(nanobind::module_& module);
void add_simulation(nanobind::module_& module);
void add_topology(nanobind::module_& module);
void add_analysis(nanobind::module_& module);
void add_analyse(nanobind::module_& module);
void add_keys(nanobind::module_& module);

}  // namespace catena::python
