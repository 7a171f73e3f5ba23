// Entry point of the reader: reads a scene file.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

namespace scene {
/// A predicted structure with its rigid domains, see domains/rigid_entry.hpp.
struct Prediction;
}  // namespace scene

/// Looks at a scene that has the chains of its first replica only. `replicas` is their number.
using LookAtOne = std::function<void(Scene const&)>;

/// Reads and validates a scene file. `overrides` holds "key.path=value" with list indices as in
/// "chains[0].count=10". Throws InputError with one line that names file, key, body index and
/// remedy. `before_replicas` is called before the chains of a first replica are repeated.
Scene load_scene(std::string const& file, std::vector<std::string> const& overrides = {},
                 LookAtOne const& before_replicas = {});

/// A chain whose rigid domains follow from a prediction.
struct PredictedChain {
    std::string name;
    std::shared_ptr<scene::Prediction const> found;
};

/// Returns the chains of a scene file that have `rigid: {pae: ...}`. Nothing else of the scene's
/// chains is checked. Throws InputError like load_scene().
std::vector<PredictedChain> load_predictions(std::string const& file,
                                             std::vector<std::string> const& overrides = {});

/// Reads a scene from text like load_scene(). `name` is the file name in messages; its folder
/// resolves relative paths.
Scene parse_scene(std::string const& text, std::string const& name,
                  std::vector<std::string> const& overrides = {},
                  LookAtOne const& before_replicas = {});

}  // namespace catena
