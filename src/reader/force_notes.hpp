// What is doubtful about the forces that a scene asks for.
#pragma once

#include "scene/scene.hpp"

namespace catena::scene {

/// Notes a force field's temperature that is not the run's, an ionic strength or a pH that no
/// solution has, a step in the wrong unit, and water outside its permittivity's measurements.
/// Everything but the chains must have been read.
void note_forces(Scene&);
/// Notes a box that the forces of the scene's System leave out.
void note_box_that_no_force_knows(Scene&, bool system_is_periodic);

}  // namespace catena::scene
