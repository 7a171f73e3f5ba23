#include "scene/force_notes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace catena::scene {

namespace {

double constexpr most_salt = 10;       // mol/l: saturated brine has 6
double constexpr coldest_water = 273;  // K, of the measurements behind the permittivity
double constexpr same_temperature = 1e-9;

}  // namespace

void note_forces(Scene& scene) {
    if (!scene.forces.openmm) return;
    OpenMmSpec const& openmm = *scene.forces.openmm;
    DynamicsSpec const& run = scene.dynamics;
    bool const warm = run.given && run.temperature > 0 && (is_langevin(run.integrator) || run.temperature != DynamicsSpec{}.temperature);
    if (warm && std::abs(openmm.temperature - run.temperature) > same_temperature * run.temperature)
        scene.note(fmt::format(
            "forces.openmm.temperature is {:.6g} K and dynamics.temperature {:.6g} K: {} at {:.6g} K.", openmm.temperature, run.temperature,
            openmm.builder.empty() ? "the System's bonds are judged" : "water's permittivity and the Debye length are those",
            openmm.temperature));
    if (openmm.builder.empty()) return;
    if (openmm.ionic_strength > most_salt)
        scene.note(fmt::format(
            "forces.openmm.ionic_strength is {:.6g} mol/l, more than the solubility of any salt: did you mean {:.6g} (for {:.6g} "
            "mmol/l)?",
            openmm.ionic_strength, openmm.ionic_strength / 1000, openmm.ionic_strength));
    if (openmm.temperature < coldest_water)
        scene.note(fmt::format("water is frozen at {:.6g} K: its permittivity is extrapolated below {:.6g} K.", openmm.temperature,
                               coldest_water));
}

}  // namespace catena::scene
