// Settings of the other tool, which moved its particles: temperature, friction, step.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "foreign/files.hpp"

namespace catena::foreign {

/// Highest temperature that an import accepts, K. Replica exchange ends at about 1000 K.
inline constexpr double hottest = 1e4;

/// Settings of a run, with defaults for tools that leave none.
struct Settings {
    /// Name of the tool in the scene and in messages; empty if it is not known.
    std::string tool;
    double temperature = 300;  // K
    double friction = 0.01;    // 1/ps
    double step = 0.01;        // ps
    std::int64_t steps = 100000;
    std::int64_t every = 1000;  // steps between frames
    std::uint64_t seed = 1;
    /// True if the tool minimises the energy of this start before its first step.
    bool minimises = false;
    /// Forces of the System that act during an equilibration only.
    std::vector<std::string> equilibration_forces;
    /// Number of steps of the equilibration that comes before; empty without one.
    std::optional<std::int64_t> equilibration_steps;
    /// Sentences on what was assumed or cannot be taken over.
    std::vector<std::string> notes;
    /// Places that values of the scene come from, by their keys: "dynamics.temperature" has
    /// "FOLDER/config.yaml: temp, line 3". Assumed values have none, or the file alone.
    std::map<std::string, std::string> origins;
};

/// Settings that were read; the others hold defaults.
struct Found {
    bool temperature, friction, step;
};

/// Returns "NAME (KIND): 300 K, friction 0.01/ps assumed, steps of 0.01 ps.".
std::string settings_note(std::string const& name, std::string const& kind, Settings const&,
                          Found const&);

/// Returns a sentence on how the scene's dynamics differs from that of an integrator, or an empty
/// text for a Langevin integrator with fixed steps. `kind` is the name of OpenMM's class in any
/// case, with or without "Integrator".
std::string integrator_note(std::string const& kind, Settings const&);

/// Reads the settings from the tool's own file or from a serialised Integrator. Otherwise the
/// defaults hold, with a note. Throws InputError for files that cannot be read or lack what their
/// kind has, and for a temperature that no scene can have. Notes a friction beyond any chain's.
Settings settings_of(Files const&);

}  // namespace catena::foreign
