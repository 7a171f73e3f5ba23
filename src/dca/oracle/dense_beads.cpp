#include "dca/oracle/system.hpp"

namespace catena::oracle {

template <class S>
OracleResult<S> dense_beads(ChainSpec const& chain, Loads const& loads) {
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    auto const n = static_cast<Index>(chain.size());
    Index const first = chain.base == Base::fixed ? 0 : 1;
    System<S> s(4 * n - first);
    for (Index k = 0; k < n; ++k) {
        auto const at = static_cast<std::size_t>(k);
        s.add(3 * k, 3 * k, scaled(S(chain.beads.mass[at]), M3<S>::identity()));
        s.add(3 * k, bead_force<S>(chain, loads, at));
        if (k < first) continue;
        Index const row = 3 * n + k - first;
        s.right[row] = links[at].closure;
        s.add_constraint(3 * k, row, S(1), links[at].direction);
        if (k > 0) s.add_constraint(3 * k - 3, row, S(-1), links[at].direction);
    }
    Column<S> const x = solve(s);
    OracleResult<S> result;
    for (Index k = 0; k < n; ++k) {
        result.com_acceleration.push_back(segment(x, 3 * k));
        result.tension.push_back(k < first ? S(0) : S(-x[3 * n + k - first]));
    }
    return result;
}

template OracleResult<double> dense_beads<double>(ChainSpec const&, Loads const&);
template OracleResult<long double> dense_beads<long double>(ChainSpec const&, Loads const&);
template OracleResult<Quad> dense_beads<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
