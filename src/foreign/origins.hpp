// Places that the values of an imported scene come from, for messages on a scene never written.
#pragma once

#include <string>

#include "foreign/scene_text.hpp"

namespace catena::foreign {

/// Returns a refusal of the scene's text with the files and keys of the import in place of the
/// scene's: "(mine.yaml: dynamics.temperature, line 9)" becomes "(FOLDER/config.yaml: temp, line
/// 3)". Other keys of the scene become the imported folder.
std::string with_origins(std::string const& refusal, SceneDraft const& draft);

}  // namespace catena::foreign
