// Accelerations of a scene by the articulated-body oracles.
#include "measure/oracle_accelerations.hpp"

#include <algorithm>

namespace catena {
namespace {

template <class Scalar>
Matrix<Scalar, 3, 3> orientation_of(ChainSpec const& chain, std::size_t k) {
    auto const& q = chain.linked.orientation[k];
    return to_matrix(Quaternion<Scalar>{Scalar(q[0]), Scalar(q[1]), Scalar(q[2]), Scalar(q[3])});
}

}  // namespace

oracle::Loads oracle_loads(Scene const& scene, std::size_t chain,
                           std::vector<Vec3> const& bead_force) {
    oracle::Loads loads{
        scene.forces.gravity, {}, scene.forces.linear_drag, scene.forces.angular_drag};
    if (bead_force.empty()) return loads;
    std::size_t first = 0;
    for (std::size_t c = 0; c < chain; ++c) first += scene.chains[c].bead_count();
    auto const begin = bead_force.begin() + static_cast<std::ptrdiff_t>(first);
    loads.bead_forces.assign(begin,
                             begin + static_cast<std::ptrdiff_t>(scene.chains[chain].bead_count()));
    return loads;
}

template <class Scalar>
std::vector<double> joint_accelerations(ChainSpec const& chain,
                                        oracle::OracleResult<Scalar> const& r) {
    std::vector<double> list;
    auto const append = [&](Vector<Scalar, 3> const& v, int count) {
        for (int i = 0; i < count; ++i) list.push_back(static_cast<double>(v[i]));
    };
    for (std::size_t k = 0; k < chain.size(); ++k) {
        int const numbers = accelerations_of(chain, k);
        if (chain.is_beads() || (chain.is_linked() && numbers == 3)) {
            append(r.com_acceleration[k], 3);
        } else if (chain.is_linked()) {
            append(transposed_times(orientation_of<Scalar>(chain, k), r.alpha[k]), 3);
            append(r.com_acceleration[k], 3);
        } else {
            append(r.qdd[k], std::min(3, numbers));
            if (numbers == 6) append(r.base_acceleration, 3);
        }
    }
    return list;
}

template <class Scalar>
std::vector<double> oracle_accelerations(Scene const& scene, std::vector<Vec3> const& bead_force) {
    std::vector<double> all;
    for (std::size_t c = 0; c < scene.chains.size(); ++c) {
        ChainSpec const& chain = scene.chains[c];
        std::vector<double> const own = joint_accelerations(
            chain, oracle::aba<Scalar>(chain, oracle_loads(scene, c, bead_force)));
        all.insert(all.end(), own.begin(), own.end());
    }
    return all;
}

#define CATENA_ORACLE(Scalar)                                                                      \
    template std::vector<double> joint_accelerations<Scalar>(ChainSpec const&,                     \
                                                             oracle::OracleResult<Scalar> const&); \
    template std::vector<double> oracle_accelerations<Scalar>(Scene const&,                        \
                                                              std::vector<Vec3> const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(oracle::Quad)
#undef CATENA_ORACLE

}  // namespace catena
