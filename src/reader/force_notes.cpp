// Implements the notes on forces. Thresholds are physical: solubility of salts, range of measured
// permittivities, steps of models with one bead per residue.
#include "reader/force_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "structure/residue_names.hpp"
#include "systems/charges.hpp"

namespace catena::scene {

namespace {

/// Largest plausible ionic strength, mol/l; saturated brine has 6.
double constexpr most_salt = 10;
/// Lowest and highest temperature of the measurements behind the permittivity, K.
double constexpr coldest_water = 273, hottest_water = 373;
/// Lowest temperature of biomolecules that is not taken for one in degrees Celsius, K.
double constexpr coldest_usual = 200;
/// Zero of the Celsius scale, K.
double constexpr celsius_zero = 273.15;
/// Relative difference below which temperatures count as equal.
double constexpr same_temperature = 1e-9;

/// Longest plausible step of residues with friction, and longest one that was shown to sample
/// them correctly (`catena bench sampling`), ps.
double constexpr longest_usual_step = 0.2, longest_shown_step = 0.06;

std::vector<std::string> const& residues_of(ChainSpec const& chain) {
    return chain.is_beads() ? chain.beads.residue : chain.carried().residue;
}

/// Returns whether a force field is expected to know the beads of the chain.
bool has_residues(ChainSpec const& chain) {
    auto const& residues = residues_of(chain);
    return std::any_of(residues.begin(), residues.end(),
                       [](std::string const& residue) { return residue != "UNK"; });
}

/// True if a chain of the scene has an amino acid.
bool has_amino_acids(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
        auto const& residues = residues_of(chain);
        return std::any_of(residues.begin(), residues.end(), is_amino_acid);
    });
}

}  // namespace

void note_box_that_no_force_knows(Scene& scene, bool system_is_periodic) {
    if (scene.box && !system_is_periodic)
        scene.note(
            "the scene has a periodic box, but no force of the System uses periodic boundaries: "
            "chains do not feel their images.");
}

void note_forces(Scene& scene) {
    if (!scene.forces.openmm) return;
    OpenMmSpec const& openmm = *scene.forces.openmm;
    DynamicsSpec const& run = scene.dynamics;
    bool const warm =
        run.given && run.temperature > 0 &&
        (is_langevin(run.integrator) || run.temperature != DynamicsSpec{}.temperature);
    if (warm && std::abs(openmm.temperature - run.temperature) > same_temperature * run.temperature)
        scene.note(fmt::format(
            "forces.openmm.temperature is {:.6g} K and dynamics.temperature {:.6g} K: {} at {:.6g} "
            "K.",
            openmm.temperature, run.temperature,
            openmm.builder.empty() ? "the System's bonds are judged"
                                   : "water's permittivity and the Debye length are those",
            openmm.temperature));
    if (!openmm.builder.empty() && openmm.ionic_strength > most_salt)
        scene.note(fmt::format(
            "forces.openmm.ionic_strength is {:.6g} mol/l, more than the solubility of any salt: "
            "did you mean {:.6g} (for {:.6g} "
            "mmol/l)?",
            openmm.ionic_strength, openmm.ionic_strength / 1000, openmm.ionic_strength));
    if (!run.given || scene.si || is_implicit(run.integrator)) return;
    if (run.step > longest_usual_step)
        scene.note(
            fmt::format("dynamics.step is {0:.6g} ps, that is {1:.6g} fs: steps of such chains are "
                        "0.01 to 0.06 ps. Did you mean {2:.6g}?",
                        run.step, 1000 * run.step, run.step / 1000));
    else if (run.step > longest_shown_step && !openmm.builder.empty())
        scene.note(
            fmt::format("dynamics.step is {:.6g} fs: steps up to {:.6g} fs were shown to "
                        "sample chains of beads correctly, longer ones were not.",
                        1000 * run.step, 1000 * longest_shown_step));
}

void note_water(Scene& scene) {
    if (!scene.forces.openmm) return;
    double const temperature = scene.forces.openmm->temperature;
    bool const cold = temperature<coldest_water, hot = temperature> hottest_water,
               charged =
                   !scene.forces.openmm->builder.empty() && (cold || hot) && has_charges(scene);
    if (temperature < coldest_usual && (charged || has_amino_acids(scene)))
        scene.note(fmt::format(
            "the temperature is {0:.6g} K: did you mean {1:.6g} K ({0:.6g} degrees Celsius)?",
            temperature, temperature + celsius_zero));
    if (charged)
        scene.note(
            fmt::format("water {} at {:.6g} K: its permittivity is extrapolated {} {:.6g} K.",
                        cold ? "is frozen" : "boils", temperature, cold ? "below" : "above",
                        cold ? coldest_water : hottest_water));
}

void note_missing_forces(Scene& scene) {
    if (scene.si || !scene.dynamics.given || scene.forces.openmm) return;
    auto const found = std::find_if(scene.chains.begin(), scene.chains.end(), has_residues);
    if (found != scene.chains.end())
        scene.note(fmt::format(
            "no forces act between the residues of chain `{}`: did you mean forces: {{openmm: "
            "{{builder: calvados2}}}}?",
            found->name));
}

}  // namespace catena::scene
