#include <string>

#include "dca/oracle/joint.hpp"
#include "error.hpp"

// Articulated masses of point beads on rigid links: a bead and everything outboard of it answers the force lambda u of its
// inboard link by M a + p = lambda u. The link pushes the inboard bead with -lambda u; the tension is -lambda.
namespace catena::oracle {
namespace {

template <class S>
struct ArticulatedBead {
    M3<S> mass;
    V3<S> bias;
    S compliance = S(0), drive = S(0);  // lambda = (closure + drive + u . a_inboard) / compliance
};

template <class S>
Cholesky<S, 3> factor(ArticulatedBead<S> const& bead, std::size_t k) {
    Cholesky<S, 3> const f(bead.mass);
    if (!f.definite())
        throw ComputationError("articulated mass is not positive definite (bead " + std::to_string(k + 1) + "): check the beads' masses");
    return f;
}

}  // namespace

template <class S>
OracleResult<S> aba_beads(ChainSpec const& chain, Loads const& loads) {
    std::size_t const n = chain.size(), first = chain.base == Base::fixed ? 0 : 1;
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    std::vector<ArticulatedBead<S>> beads(n);
    for (std::size_t k = 0; k < n; ++k)
        beads[k] = {scaled(S(chain.beads.mass[k]), M3<S>::identity()), -bead_force<S>(chain, loads, k), S(0), S(0)};
    for (std::size_t k = n; k-- > first;) {
        V3<S> const& u = links[k].direction;
        V3<S> const softness = factor(beads[k], k).solve(u);
        beads[k].compliance = dot(u, softness);
        beads[k].drive = dot(softness, beads[k].bias);
        if (k == 0) break;
        beads[k - 1].mass = plus_outer(beads[k - 1].mass, S(S(1) / beads[k].compliance), u, u);
        beads[k - 1].bias = plus_scaled(beads[k - 1].bias, S((links[k].closure + beads[k].drive) / beads[k].compliance), u);
    }
    OracleResult<S> result;
    V3<S> a = V3<S>::zero();
    for (std::size_t k = 0; k < n; ++k) {
        V3<S> const& u = links[k].direction;
        S const lambda = k < first ? S(0) : S((links[k].closure + beads[k].drive + dot(u, a)) / beads[k].compliance);
        a = factor(beads[k], k).solve(lambda * u - beads[k].bias);
        result.com_acceleration.push_back(a);
        result.tension.push_back(-lambda);
    }
    return result;
}

template OracleResult<double> aba_beads<double>(ChainSpec const&, Loads const&);
template OracleResult<long double> aba_beads<long double>(ChainSpec const&, Loads const&);
template OracleResult<Quad> aba_beads<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
