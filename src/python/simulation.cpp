// Binds Simulation: steps without the GIL, states as arrays, checkpoints as bytes.
#include "catena/simulation.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "catena/errors.hpp"
#include "force.hpp"

namespace catena::python {
namespace {

using Clock = std::chrono::steady_clock;

/// Time between looks for signals, which need the GIL.
constexpr auto between_looks = std::chrono::milliseconds(20);

/// A Simulation that computes without the GIL, for one caller at a time. Step count, time and notes
/// are copies, which other threads may read during a computation.
class LiveSimulation {
  public:
    LiveSimulation(Model const& model, nb::object force)
        : force_(std::move(force)), simulation_(make(model)) {
        remember();
        pass_interrupt();
    }

    /// Takes steps until a signal arrives. Returns the exception of that signal, or None. The
    /// caller raises it; the simulation can go on.
    nb::object run(std::int64_t steps) {
        std::optional<nb::python_error> signal;
        alone([&] {
            ++changes_;
            auto looked = Clock::now();
            simulation_.run(steps, [&](std::int64_t) {
                remember_step();
                if (force_.was_interrupted()) return false;
                if (Clock::now() - looked < between_looks) return true;
                looked = Clock::now();
                return !has_signal(signal);
            });
        });
        if (auto interrupt = force_.take_interrupt()) signal.emplace(std::move(*interrupt));
        if (!signal) has_signal(signal);  // Python would raise it before the observers are called
        return signal ? nb::borrow(signal->value()) : nb::none();
    }
    SimulationState state() {
        SimulationState state;
        alone([&] { state = simulation_.state(); });
        pass_interrupt();
        return state;
    }
    nb::bytes checkpoint() {
        std::string bytes;
        alone([&] { bytes = simulation_.checkpoint(); });
        pass_interrupt();
        return nb::bytes(bytes.data(), bytes.size());
    }
    void restore(nb::bytes const& checkpoint) {
        std::string const bytes(checkpoint.c_str(), checkpoint.size());
        alone([&] {
            ++changes_;
            simulation_.restore(bytes);
        });
        pass_interrupt();
    }
    std::int64_t steps() const { return steps_; }
    double time() const { return time_; }
    std::vector<std::string> const& notes() const { return notes_; }
    /// Counts runs and restorations. States with the same count are equal.
    std::int64_t changes() const { return changes_; }
    PythonForce& force() { return force_; }

  private:
    Simulation make(Model const& model) {
        static_cast<void>(model.bodies());  // reads the scene while no other thread can
        nb::gil_scoped_release const free;
        return Simulation(model, force_.function());
    }
    /// Runs `action` without the GIL. Throws Error if another call is still computing.
    template <class Action>
    void alone(Action const& action) {
        if (computes_.exchange(true))
            throw Error(
                "the simulation is computing (Simulation): wait for its thread, and do not ask it "
                "inside its own force",
                Error::Reason::computation);
        Turn const turn{computes_};
        try {
            nb::gil_scoped_release const free;
            action();
        } catch (...) {
            force_.take_interrupt();  // the failure ends the call as well
            remember();
            throw;
        }
        remember();
    }
    /// Throws the exception of a signal that arrived in the force.
    void pass_interrupt() {
        if (auto interrupt = force_.take_interrupt()) throw std::move(*interrupt);
    }
    void remember_step() {
        steps_ = simulation_.step();
        time_ = simulation_.time();
    }
    /// Copies what other threads may read. Needs the GIL.
    void remember() {
        remember_step();
        notes_ = simulation_.notes();
    }
    /// Lets the signal handlers run; keeps the exception of one in `signal`.
    static bool has_signal(std::optional<nb::python_error>& signal) {
        nb::gil_scoped_acquire const gil;
        if (PyErr_CheckSignals() == 0) return false;
        signal.emplace();
        return true;
    }
    /// Ends the turn of a caller.
    struct Turn {
        std::atomic<bool>& computes;
        ~Turn() { computes = false; }
    };

    PythonForce force_;
    Simulation simulation_;
    std::atomic<bool> computes_ = false;
    std::atomic<std::int64_t> steps_ = 0, changes_ = 0;
    std::atomic<double> time_ = 0;
    std::vector<std::string> notes_;
};

/// A force may refer to its simulation: the collector of garbage must see that circle.
int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (nb::inst_ready(self))
        Py_VISIT(nb::inst_ptr<LiveSimulation>(self)->force().callable().ptr());
    return 0;
}
int clear(PyObject* self) {
    nb::inst_ptr<LiveSimulation>(self)->force().callable().reset();
    return 0;
}
PyType_Slot const slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                             {Py_tp_clear, reinterpret_cast<void*>(clear)},
                             {0, nullptr}};

using Self = nb::handle_t<SimulationState>;

/// Returns the state of which `self` is the Python object.
SimulationState const& at(Self self) { return *nb::inst_ptr<SimulationState>(self); }

void add_state(nb::module_& module) {
    nb::class_<SimulationState>(module, "State", "State of a simulation at one step.")
        .def_ro("steps", &SimulationState::step)
        .def_ro("time", &SimulationState::time)
        .def_prop_ro("positions", [](Self self) { return view_of(at(self).position, self); })
        .def_prop_ro("velocities", [](Self self) { return view_of(at(self).velocity, self); })
        .def_prop_ro("orientations", [](Self self) { return view_of(at(self).orientation, self); })
        .def_prop_ro("angular_velocities",
                     [](Self self) { return view_of(at(self).angular_velocity, self); })
        .def_prop_ro("joint_forces",
                     [](Self self) { return forces_of(at(self).joint_force, self); })
        .def_prop_ro("joint_torques",
                     [](Self self) { return torques_of(at(self).joint_force, self); })
        .def_prop_ro("joint_positions",
                     [](Self self) { return view_of(at(self).joint_position, self); })
        .def_prop_ro("joint_rates", [](Self self) { return view_of(at(self).joint_rate, self); })
        .def_ro("kinetic_energy", &SimulationState::kinetic_energy)
        .def_ro("potential_energies", &SimulationState::potential_energy)
        .def_prop_ro("total_energy", &SimulationState::total_energy)
        .def_ro("temperature", &SimulationState::temperature)
        .def_ro("constraint_error", &SimulationState::constraint_error);
}

}  // namespace

void add_simulation(nb::module_& module) {
    add_state(module);
    nb::class_<LiveSimulation>(module, "Simulation", nb::type_slots(slots),
                               "Steps of the integrator that a model names.")
        .def(nb::init<Model const&, nb::object>(), nb::arg("model"),
             nb::arg("force").none() = nb::none())
        .def("run", &LiveSimulation::run, nb::arg("steps"),
             nb::sig("def run(self, steps: int) -> BaseException | None"),
             "Takes steps until a signal arrives; returns its exception, or None.")
        .def("state", &LiveSimulation::state, "Returns the present state.")
        .def("checkpoint", &LiveSimulation::checkpoint, "Returns the present state as bytes.")
        .def("restore", &LiveSimulation::restore, nb::arg("checkpoint"),
             "Returns to the state of a checkpoint.")
        .def_prop_ro("steps", &LiveSimulation::steps)
        .def_prop_ro("time", &LiveSimulation::time)
        .def_prop_ro("changes", &LiveSimulation::changes)
        .def_prop_ro("notes", &LiveSimulation::notes);
}

}  // namespace catena::python
