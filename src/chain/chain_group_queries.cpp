// Queries of a chain group, and its units.
#include <algorithm>

#include "chain/chain_group.hpp"
#include "scene/freedom.hpp"

namespace catena {

char const* ChainGroup::kind() const {
    return scene::name_of(static_cast<scene::HandleKind>(smallest_directions - 1));
}

bool LocalJoints::is_driven(std::int64_t k) const {
    auto const found =
        std::lower_bound(drives.begin(), drives.end(), k,
                         [](LocalDrive const& d, std::int64_t body) { return d.body < body; });
    return found != drives.end() && found->body == k;
}

std::vector<std::int64_t> last_bodies(std::vector<LocalTip> const& tips) {
    std::vector<std::int64_t> bodies;
    for (LocalTip const& tip : tips) bodies.push_back(tip.body);
    return bodies;
}

std::size_t ChainGroup::index_of_piece(std::int64_t k) const {
    auto const after =
        std::upper_bound(pieces.begin(), pieces.end(), k,
                         [](std::int64_t body, dca::Piece const& p) { return body < p.local; });
    return static_cast<std::size_t>(after - pieces.begin()) - 1;
}

std::int64_t ChainGroup::scene_index(std::int64_t k) const {
    dca::Piece const& piece = pieces[index_of_piece(k)];
    return chains[static_cast<std::size_t>(piece.chain)].first_body + piece.body +
           (k - piece.local);
}

GroupView ChainGroup::view() const {
    return {size,
            ends.is_first.data(),
            ends.is_last.data(),
            ends.jointed_tip.empty() ? nullptr : ends.jointed_tip.data(),
            ends.tip_screw.data(),
            bodies.inverse_mass.view(),
            bodies.inverse_inertia.view(),
            bodies.r1.view(),
            bodies.r2.view(),
            bodies.axes1.view(),
            bodies.axes2.view(),
            joints.screw.view(),
            mass_of_sweeps().view(),
            inertia_of_sweeps().view()};
}
Field<1> const& ChainGroup::mass_of_sweeps() const {
    static Field<1> const none;
    return sweeps_read_inertias() ? bodies.mass : none;
}
Field<6> const& ChainGroup::inertia_of_sweeps() const {
    static Field<6> const none;
    return sweeps_read_inertias() ? bodies.inertia : none;
}
bool ChainGroup::sweeps_read_inertias() const {
    return handles == Handles::articulated ||
           (!beads && !linked && directions == 5 && !joints.has_screws);
}

int ChainGroup::scene_chain(std::int64_t k) const {
    return chains[static_cast<std::size_t>(pieces[index_of_piece(k)].chain)].in_scene;
}

std::vector<LocalUnit> local_units(ChainGroup const& group) {
    std::vector<LocalUnit> units;
    for (std::size_t p = 0; p < group.pieces.size(); ++p) {
        dca::Piece const& piece = group.pieces[p];
        dca::ChainTree const& tree = group.partition.trees[piece.chain];
        for (std::int64_t unit = piece.first_unit; unit < piece.first_unit + piece.units; ++unit) {
            std::int64_t const begin = tree.first_body_of_unit(unit),
                               end = tree.first_body_of_unit(unit + 1);
            units.push_back({p, piece.local + begin - piece.body, end - begin, unit});
        }
    }
    return units;
}

}  // namespace catena
