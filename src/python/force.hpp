// A force of the user's, which Python computes.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "catena/forces.hpp"

namespace catena::python {

namespace nb = nanobind;

/// Calls a Python function as an own force. The object stays where it is while function() is used.
class PythonForce {
  public:
    /// Takes a callable, or None for no force.
    explicit PythonForce(nb::object callable);
    PythonForce(PythonForce const&) = delete;
    PythonForce& operator=(PythonForce const&) = delete;

    /// Returns the force for a Solver or Simulation; empty without a callable.
    OwnForce function();
    nb::object& callable() { return callable_; }
    /// True if a signal such as Ctrl-C arrived in the callable. It is called again where this
    /// happens, so that the step can end.
    bool was_interrupted() const { return interrupt_.has_value(); }
    /// Returns the exception of that signal and forgets it.
    std::optional<nb::python_error> take_interrupt() {
        return std::exchange(interrupt_, std::nullopt);
    }

  private:
    std::optional<double> evaluate(BodyPositions const&, BodyForces const&);
    /// Returns the callable's result, after a second call if Ctrl-C ended the first one.
    nb::object result_of(BodyPositions const&);

    nb::object callable_;
    std::optional<nb::python_error> interrupt_;
};

}  // namespace catena::python
