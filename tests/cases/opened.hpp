// What Catena makes of a scene that may be damaged.
#pragma once

#include <algorithm>
#include <string>

#include "error.hpp"
#include "reader/load_scene.hpp"
#include "scene/scene.hpp"

namespace catena::test {

struct Opened {
    bool refused = false;
    std::string message;
    Scene scene;

    bool notes(std::string const& part) const {
        return std::any_of(scene.notes.begin(), scene.notes.end(), [&](std::string const& note) {
            return note.find(part) != std::string::npos;
        });
    }
};

/// The scene in `text`, as the file at `path`.
inline Opened open_scene(std::string const& text, std::string const& path) {
    Opened opened;
    try {
        opened.scene = parse_scene(text, path);
    } catch (InputError const& error) {
        opened.refused = true;
        opened.message = error.what();
    }
    return opened;
}

}  // namespace catena::test
