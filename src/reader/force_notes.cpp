// Implements the notes on forces. Thresholds are physical: solubility of salts, range of measured
// permittivities, steps of models with one bead per residue.
#include "reader/force_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "scene/branches.hpp"
#include "structure/calvados2.hpp"
#include "structure/calvados_rna.hpp"
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

/// Shortest and longest plausible step of residues with friction, ps.
double constexpr shortest_usual_step = 0.001, longest_usual_step = 0.2;
/// A step below this is taken for one in seconds, ps.
double constexpr least_step = 1e-9, picoseconds_a_second = 1e12;
/// Mass of the lightest residue in amu and length of a link in nm for which that step was shown.
double constexpr shown_mass = 57.05, shown_link = 0.38;
/// Relative difference of masses and lengths that leaves the step as it is.
double constexpr similar = 0.1;

/// Permittivities that are taken for water's, and the largest difference in K between the run's
/// temperature and that of water with the System's permittivity that needs no note. Models with a
/// fixed permittivity have whole or half numbers, and may be used at other temperatures.
double constexpr least_water = 40, most_water = 100, noted_difference = 2,
                 noted_difference_of_fixed = 10, fixed_within = 0.01;

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

/// True if the run has a temperature that was given or is held.
bool is_warm(DynamicsSpec const& run) {
    return run.given && run.temperature > 0 &&
           (is_langevin(run.integrator) || run.temperature != DynamicsSpec{}.temperature);
}

/// Temperature in K at which water has this permittivity.
double water_of(double permittivity) {
    double low = coldest_usual, high = calvados2::warmest_water;
    for (int i = 0; i < 60; ++i) {
        double const middle = std::midpoint(low, high);
        (calvados2::yukawa(middle, 0).permittivity > permittivity ? low : high) = middle;
    }
    return low;
}

/// The bead on a link whose time scale, which grows as sqrt(mass) times length, is the shortest.
struct FastestBead {
    double mass = 0, length = 0;
    /// Time scale relative to that of the residues whose steps were shown.
    double scale = std::numeric_limits<double>::infinity();
};

FastestBead fastest_bead(Scene const& scene) {
    FastestBead fastest;
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 1; k < chain.beads.size(); ++k) {
            std::size_t const inboard = inboard_of(chain.parent, k);
            double const mass = std::min(chain.beads.mass[inboard], chain.beads.mass[k]),
                         length = chain.beads.length[k],
                         scale = std::sqrt(mass / shown_mass) * length / shown_link;
            if (scale < fastest.scale) fastest = {mass, length, scale};
        }
    return fastest;
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
    if (is_warm(run) &&
        std::abs(openmm.temperature - run.temperature) > same_temperature * run.temperature)
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
}

namespace {

/// Value that may have been meant by `step` in another unit; empty if it is none that is usual.
std::string meant(double step) {
    return step < shortest_usual_step || step > longest_usual_step
               ? ""
               : fmt::format(" Did you mean {:.6g}?", step);
}

/// Sentence on a step of chains like those whose steps were shown; empty if it needs none.
std::string step_of_residues(double step, ShownStep const& shown) {
    if (step > longest_usual_step)
        return fmt::format(
            "dynamics.step is {:.6g} ps, that is {:.6g} fs: steps of such chains are "
            "0.01 to 0.06 ps.{}",
            step, 1000 * step, meant(step / 1000));
    if (step < least_step)
        return fmt::format(
            "dynamics.step is {:.6g} ps: steps of such chains are 0.01 to 0.06 ps.{}", step,
            meant(step * picoseconds_a_second));
    if (step <= shown.longest) return "";
    if (shown.evidence == StepEvidence::not_compared)
        return fmt::format(
            "dynamics.step is {:.6g} fs: {} was simulated with steps up to {:.6g} fs, longer ones "
            "were not compared.",
            1000 * step, shown.chains, 1000 * shown.longest);
    if (shown.evidence == StepEvidence::no_bias_found)
        return fmt::format(
            "dynamics.step is {:.6g} fs: no bias of {} was found up to {:.6g} fs, within errors of "
            "1 %, longer steps are not advised.",
            1000 * step, shown.chains, 1000 * shown.longest);
    return fmt::format(
        "dynamics.step is {:.6g} fs: steps up to {:.6g} fs were shown to sample {} correctly, "
        "longer ones were not.",
        1000 * step, 1000 * shown.longest, shown.chains);
}

/// The same for beads of other masses and distances.
std::string step_of_others(double step, ShownStep const& of_residues, FastestBead const& fastest,
                           bool of_a_system) {
    double const shown = of_residues.longest * fastest.scale;
    if (step <= shown) return "";
    return fmt::format(
        "dynamics.step is {:.6g} fs: steps up to {:.6g} fs were shown for residues, which are "
        "{:.2g} fs for {}beads of {:.4g} amu on links of {:.4g} nm.",
        1000 * step, 1000 * of_residues.longest, 1000 * shown, of_a_system ? "the System's " : "",
        fastest.mass, fastest.length);
}

/// True if the scene's residues move as slowly as those whose steps were shown.
bool is_as_slow(Scene const& scene, FastestBead const& fastest) {
    return std::isinf(fastest.scale) || std::abs(fastest.scale - 1) < similar ||
           (fastest.scale > 1 && (!scene.forces.openmm->builder.empty() || has_amino_acids(scene)));
}

bool has_nucleotides(ChainSpec const& chain) {
    auto const& residues = residues_of(chain);
    return std::find(residues.begin(), residues.end(), calvados_rna::backbone) != residues.end();
}

}  // namespace

ShownStep shown_step(Scene const& scene) {
    auto const& chains = scene.chains;
    if (std::any_of(chains.begin(), chains.end(), has_nucleotides))
        return {0.01, "RNA", StepEvidence::not_compared};
    if (!std::all_of(chains.begin(), chains.end(),
                     [](ChainSpec const& chain) { return chain.is_beads(); }))
        return {0.02, "rigid domains"};
    if (scene.chains_a_replica() == 1) return {0.06, "chains of beads", StepEvidence::shown};
    return {0.04, scene.box ? "condensates and slabs" : "chains that may meet"};
}

std::string longer_steps(Scene const& scene) {
    DynamicsSpec const& run = scene.dynamics;
    if (!run.given || !is_langevin(run.integrator) || !scene.forces.openmm ||
        scene.forces.openmm->builder.empty() || !is_as_slow(scene, fastest_bead(scene)))
        return {};
    ShownStep const shown = shown_step(scene);
    if (shown.evidence == StepEvidence::not_compared || run.step >= shown.longest) return {};
    if (shown.evidence == StepEvidence::no_bias_found)
        return fmt::format("up to {:.6g} ps no bias of {} was found, within errors of 1 %",
                           shown.longest, shown.chains);
    return fmt::format("up to {:.6g} ps sample {} within 1 % of shorter ones", shown.longest,
                       shown.chains);
}

void note_step(Scene& scene) {
    DynamicsSpec const& run = scene.dynamics;
    if (!scene.forces.openmm || !run.given || scene.si || is_implicit(run.integrator)) return;
    FastestBead const fastest = fastest_bead(scene);
    ShownStep const shown = shown_step(scene);
    std::string const note =
        is_as_slow(scene, fastest)
            ? step_of_residues(run.step, shown)
            : step_of_others(run.step, shown, fastest, scene.forces.openmm->builder.empty());
    if (!note.empty()) scene.note(note);
}

namespace {

/// Largest difference of temperatures in K that needs no note at that permittivity of the System.
double unnoted_difference(double permittivity) {
    double const halves = 2 * permittivity;
    return std::abs(halves - std::round(halves)) <= 2 * fixed_within ? noted_difference_of_fixed
                                                                     : noted_difference;
}

}  // namespace

void note_screening(Scene& scene, std::optional<Screening> const& screening) {
    if (!screening) return;
    calvados2::Yukawa const usual = calvados2::yukawa(DynamicsSpec{}.temperature, 0);
    double const permittivity = usual.permittivity * usual.prefactor / screening->prefactor,
                 temperature = scene.forces.openmm->temperature;
    if (!(permittivity >= least_water && permittivity <= most_water)) return;
    double const water = water_of(permittivity);
    if (is_warm(scene.dynamics) && std::abs(water - temperature) > unnoted_difference(permittivity))
        scene.note(fmt::format(
            "the System's charges act as in water at {:.4g} K (permittivity {:.4g}), the run is at "
            "{:.6g} K: serialise the System for that temperature, unless this is meant.",
            water, permittivity, temperature));
    if (temperature < coldest_water || temperature > hottest_water)
        scene.note(fmt::format("water {} at {:.6g} K, and the System's charges act as in water.",
                               temperature < coldest_water ? "is frozen" : "boils", temperature));
}

void note_water(Scene& scene) {
    if (!scene.forces.openmm) return;
    double const temperature = scene.forces.openmm->temperature;
    // Beyond the warmest water the builder refuses, which no note needs to precede.
    bool const cold = temperature<coldest_water, hot = temperature> hottest_water &&
                      temperature <= calvados2::warmest_water,
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

void note_long_screening(Scene& scene) {
    if (!scene.forces.openmm || scene.forces.openmm->builder.empty()) return;
    OpenMmSpec const& spec = *scene.forces.openmm;
    if (!(spec.temperature > 0 && spec.temperature <= calvados2::warmest_water)) return;
    double const kappa = calvados2::yukawa(spec.temperature, spec.ionic_strength).kappa;
    if (kappa * calvados2::yukawa_cutoff >= 1 || !has_charges(scene)) return;
    scene.note(fmt::format(
        "forces.openmm.ionic_strength is {:.6g} mol/l: {}, and forces between charges end at "
        "{:.6g} nm. Give more salt, unless this is meant.",
        spec.ionic_strength,
        kappa > 0 ? fmt::format("the Debye length is {:.4g} nm", 1 / kappa)
                  : std::string("nothing screens charges"),
        calvados2::yukawa_cutoff));
}

void note_missing_forces(Scene& scene) {
    if (scene.si || !scene.dynamics.given || scene.forces.openmm) return;
    auto const found = std::find_if(scene.chains.begin(), scene.chains.end(), has_residues);
    if (found != scene.chains.end())
        scene.note(fmt::format(
            "no forces act between the residues of chain `{}`: did you mean forces: {{openmm: "
            "{{builder: calvados2}}}}?",
            scene.name_in_file(static_cast<std::size_t>(found - scene.chains.begin()))));
}

}  // namespace catena::scene
