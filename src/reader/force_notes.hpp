// Notes on doubtful settings of forces. The values are used as written; a note tells the user what
// is unusual about them.
#pragma once

#include <optional>

#include "scene/scene.hpp"
#include "systems/import.hpp"

namespace catena::scene {

/// Notes water that is frozen or boils where beads are charged, and temperatures of biomolecules
/// that look like degrees Celsius. The chains must be there.
void note_water(Scene&);

/// Notes a temperature of the force field that differs from the run's, and implausible ionic
/// strength or pH. Water outside the range of measured permittivity is noted, too.
/// Precondition: all sections except the chains have been read.
void note_forces(Scene&);
/// Evidence from samples of chains for a step beside shorter ones.
enum class StepEvidence {
    shown,          // biases are below 1 % even with two standard errors more
    no_bias_found,  // biases and their standard errors are below 1 %, or equal to it
    not_compared
};
/// Longest step with which chains of residues were sampled without a bias that was found, and which
/// chains.
struct ShownStep {
    double longest;  // ps
    char const* chains;
    StepEvidence evidence = StepEvidence::no_bias_found;
};
/// Returns the step shown for chains of the scene's kind and density. At 60 fs a slab of
/// glycine-rich chains failed within a nanosecond.
ShownStep shown_step(Scene const&);
/// Tells of longer steps that sample the scene as well; empty if there are none.
std::string longer_steps(Scene const&);

/// Notes a step that is implausible, or beyond those that were shown to sample chains correctly. A
/// System's beads are judged by their masses and the lengths of their links. Precondition: the
/// chains have been read.
void note_step(Scene&);
/// Notes charges of a System that act as in water of another temperature than the run's, and water
/// that is frozen or boils. Precondition: all sections except the chains have been read.
void note_screening(Scene&, std::optional<Screening> const&);
/// Notes charges of a builder that reach further than its cutoff, for want of salt. Precondition:
/// the chains have been read.
void note_long_screening(Scene&);
/// Notes residues between which no forces act, if the scene is to be run: they would move as an
/// ideal chain. Precondition: all sections have been read.
void note_missing_forces(Scene&);
/// Notes a box that the forces of the scene's System do not use.
void note_box_that_no_force_knows(Scene&, bool system_is_periodic);

}  // namespace catena::scene
