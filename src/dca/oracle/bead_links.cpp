#include "dca/oracle/joint.hpp"

namespace catena::oracle {

template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain) {
    BeadArrays const& b = chain.beads;
    std::vector<BeadLink<S>> links(b.size());
    for (std::size_t k = chain.base == Base::free ? 1 : 0; k < b.size(); ++k) {
        V3<S> const along = lift<S>(b.position[k]) - lift<S>(k == 0 ? b.anchor : b.position[k - 1]);
        V3<S> const relative = k == 0 ? lift<S>(b.velocity[k]) : lift<S>(b.velocity[k]) - lift<S>(b.velocity[k - 1]);
        S const length = norm(along);
        V3<S> const u = S(S(1) / length) * along;
        V3<S> const across = relative - dot(relative, u) * u;
        links[k] = {u, -dot(across, across) / length};
    }
    return links;
}

template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k) {
    V3<S> const weight = S(chain.beads.mass[k]) * lift<S>(loads.gravity);
    V3<S> const drag = S(loads.linear_drag) * lift<S>(chain.beads.velocity[k]);
    return loads.bead_forces.empty() ? weight - drag : weight + lift<S>(loads.bead_forces[k]) - drag;
}

#define CATENA_ORACLE(S)                                                    \
    template std::vector<BeadLink<S>> read_bead_links<S>(ChainSpec const&); \
    template V3<S> bead_force<S>(ChainSpec const&, Loads const&, std::size_t);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE

}  // namespace catena::oracle
