// Update of ghosts in host memory: rebuild the lists if necessary, then exchange positions.
#include "neighbours/ghost_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "neighbours/ghosts.hpp"

namespace catena {

GhostLists::Moves GhostExchange::moves(std::span<Vec3 const> own) const {
    GhostLists::Moves m;
    if (std::optional<double> const farthest = lists_.farthest();
        farthest && listed_.size() == own.size())
        m.far = largest_displacement(listed_, own) >= *farthest;
    for (std::int64_t k = 0; k < std::ssize(own); ++k)
        if (!std::all_of(own[k].data, own[k].data + 3, [](double x) { return std::isfinite(x); }))
            m.bead = std::max(m.bead, lists_.number(lists_.own_bead(k)));
    return m;
}

void GhostExchange::update(std::span<Vec3 const> own) {
    if (lists_.are_used_up(moves(own), "the position of bead {:.0f} is not finite")) {
        lists_.make(own);
        listed_.assign(own.begin(), own.end());
        positions_.resize(lists_.beads().size());
        out_.resize(lists_.sent().size());
        in_.resize(lists_.received().size());
    }
    for (std::size_t i = 0; i < out_.size(); ++i)
        out_[i] = own[static_cast<std::size_t>(lists_.sent()[i])];
    lists_.carry(out_, in_);
    for (std::size_t i = 0; i < in_.size(); ++i)
        positions_[static_cast<std::size_t>(lists_.received()[i])] = in_[i];
}

}  // namespace catena
