// What is doubtful about the forces that a scene asks for.
#pragma once

#include "scene/scene.hpp"

namespace catena::scene {

/// Notes a force field's temperature that is not the run's, an ionic strength that no solution has, and water outside its permittivity's
/// measurements. Everything but the chains must have been read.
void note_forces(Scene&);

}  // namespace catena::scene
