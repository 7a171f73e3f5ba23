// Lists all maps in the order of the manual's pages.
#include "keys/maps.hpp"

namespace catena::scene::keys {

std::span<KeyMap const* const> all() {
    static constexpr KeyMap const* maps[] = {
        &top,         &box,          &cubic,          &place,        &slab,
        &region,      &start,        &chain,          &model,        &conformation,
        &rigid,       &body,         &wrench,         &carried_bead, &joint,
        &free_pose,   &free_rates,   &motion,         &tip,          &tip_joint,
        &tip_ring,    &loop,         &loop_joint,     &bead,         &bead_link,
        &linked,      &link,         &hdf5,           &datasets,     &generator,
        &random,      &distribution, &pendulum,       &coil,         &dill,
        &elastic_rod, &polygon,      &freely_jointed, &worm_like,    &star,
        &brush,       &dendrimer,    &random_tree,    &forces,       &drag,
        &openmm,      &dynamics,     &solver,         &output};
    return maps;
}

}  // namespace catena::scene::keys
