// Implements forces of the user's: arrays for the function, and checks of what it returns.
#include "force.hpp"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "arrays.hpp"
#include "catena/errors.hpp"

namespace catena::python {
namespace {

[[noreturn]] void refuse(std::string const& what, std::size_t bodies) {
    throw Error(fmt::format("{} (own force): return (energy, forces) or (energy, forces, torques) "
                            "with arrays of shape ({}, 3), energy a number or None",
                            what, bodies),
                Error::Reason::input);
}

/// Copies an array that the function returned. Throws Error for one of another shape.
void copy(nb::handle value, char const* name, std::span<Triple> to) {
    Numbers<2> rows;
    if (!nb::try_cast(value, rows, true))
        refuse(fmt::format("the {} are not a two-dimensional array of numbers", name), to.size());
    if (rows.shape(0) != to.size() || rows.shape(1) != 3)
        refuse(fmt::format("the {} have the shape ({}, {})", name, rows.shape(0), rows.shape(1)),
               to.size());
    if (!to.empty()) std::memcpy(to.data(), rows.data(), to.size() * sizeof(Triple));
}

}  // namespace

PythonForce::PythonForce(nb::object callable) : callable_(std::move(callable)) {
    if (!callable_.is_none() && PyCallable_Check(callable_.ptr()) == 0)
        throw Error(
            "the force is not callable (force): give a function of positions and "
            "orientations",
            Error::Reason::input);
}

OwnForce PythonForce::function() {
    if (callable_.is_none()) return {};
    return [this](BodyPositions const& at, BodyForces const& on) { return evaluate(at, on); };
}

nb::object PythonForce::result_of(BodyPositions const& at) {
    try {
        return callable_(copy_of(at.position), copy_of(at.orientation));
    } catch (nb::python_error& error) {
        if (interrupt_ || !error.matches(PyExc_KeyboardInterrupt)) throw;
        interrupt_.emplace(error);
    }
    return callable_(copy_of(at.position), copy_of(at.orientation));
}

std::optional<double> PythonForce::evaluate(BodyPositions const& at, BodyForces const& on) {
    nb::gil_scoped_acquire const gil;
    nb::object const result = result_of(at);
    std::size_t const bodies = on.force.size();
    if (!nb::isinstance<nb::tuple>(result) || nb::len(result) < 2 || nb::len(result) > 3)
        refuse("the function did not return a tuple of 2 or 3", bodies);
    copy(result[1], "forces", on.force);
    if (nb::len(result) == 3) copy(result[2], "torques", on.torque);
    nb::object const energy = result[0];
    if (energy.is_none()) return std::nullopt;
    double value = 0;
    PyObject* const number = PyNumber_Float(energy.ptr());
    if (number == nullptr) {
        PyErr_Clear();
        refuse("the energy is not a number", bodies);
    }
    value = PyFloat_AsDouble(number);
    Py_DECREF(number);
    return value;
}

}  // namespace catena::python
