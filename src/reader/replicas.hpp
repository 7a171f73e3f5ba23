// Replicas of a scene: its chains again and again, without forces between them.
#pragma once

#include <functional>
#include <vector>

#include "scene/fields.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Reads `replicas`. Throws InputError for what a scene with replicas cannot have: a periodic box,
/// shares by speeds, and ways to split forces. `frame`: all sections except the chains.
std::int64_t read_replicas(Fields const& top, Scene const& frame);

/// Refuses what a scene cannot have beside a System whose forces are periodic: replicas and, if its
/// chains are imported with the System's box, `box: none`. Throws InputError.
void refuse_periodic_system(Fields const& top, bool is_imported, Scene const& scene);

/// Repeats the chains of a scene, whose first replica is complete. Replica r is made by `make` with
/// the r-th next seed. If the seed does not change the start, all replicas have that of the first.
/// Replicas are moved side by side; the first one stays. The names of chains get the number of the
/// replica: NAME-1, NAME-2. Throws InputError if the chains do not fit into memory.
/// Notes replicas that move alike or consist of different chains.
void add_replicas(Scene& scene, Fields const& top,
                  std::function<std::vector<ChainSpec>(std::uint64_t seed)> const& make);

}  // namespace catena::scene
