// Condition numbers of the joint-space inertia and of the links' matrix.
#include <Eigen/Eigenvalues>

#include "joints/joint_models.hpp"
#include "oracle/eigen.hpp"
#include "oracle/inverse.hpp"
#include "oracle/linked.hpp"
#include "scene/branches.hpp"

namespace catena::oracle {
namespace {

/// Returns the first row of each body's degrees of freedom, then their number. The linear ones of a
/// free base come first.
template <class S>
std::vector<Index> freedoms(std::vector<Link<S>> const& links) {
    Index dof = !links.empty() && floats(links[0].type) ? 3 : 0;
    std::vector<Index> first;
    for (Link<S> const& link : links) {
        first.push_back(dof);
        dof += link.unknown();
    }
    first.push_back(dof);
    return first;
}

/// Returns the joint-space inertia. Column j has the joint efforts for a unit acceleration of
/// degree of freedom j, at rest and without loads.
template <class S>
Dense<S> joint_space_inertia(ChainSpec const& chain, Loads const& loads) {
    std::vector<Link<S>> links = read_links<S>(chain, loads);
    for (Link<S>& link : links)
        link.rate = link.slide = link.drift = link.applied_torque = link.applied_force =
            V3<S>::zero();
    std::vector<Index> const first = freedoms(links);
    Inverse<S> const inverse(links, V3<S>::zero());
    Dense<S> inertia(first.back(), first.back());
    for (Index j = 0; j < inertia.cols(); ++j) {
        std::vector<V3<S>> qdd(links.size(), V3<S>::zero());
        V3<S> base = V3<S>::zero();
        for (Index i = 0; i < first[0]; ++i) base[static_cast<int>(i)] = S(i == j ? 1 : 0);
        for (std::size_t k = 0; k < links.size(); ++k)
            for (Index i = first[k]; i < first[k + 1]; ++i)
                qdd[k][static_cast<int>(i - first[k])] = S(i == j ? 1 : 0);
        std::vector<InverseBody<S>> const bodies = inverse(qdd, base);
        for (Index i = 0; i < first[0]; ++i)
            inertia(i, j) = bodies[0].force.sum[static_cast<int>(i)];
        for (std::size_t k = 0; k < links.size(); ++k) {
            V3<S> const effort = inverse.needed(k, bodies[k]);
            for (Index i = first[k]; i < first[k + 1]; ++i)
                inertia(i, j) = effort[static_cast<int>(i - first[k])];
        }
    }
    return inertia;
}

/// Returns G M^-1 G^T of a chain of beads, where G has the gradients of the link lengths.
template <class S>
Dense<S> bead_link_matrix(ChainSpec const& chain) {
    std::vector<BeadLink<S>> links = read_bead_links<S>(chain);
    std::size_t const n = chain.size(), first = chain.base == Base::fixed ? 0 : 1,
                      in_row = links.size();
    std::vector<BeadLink<S>> const crosslinks = read_crosslinks<S>(chain);
    links.insert(links.end(), crosslinks.begin(), crosslinks.end());
    auto const count = static_cast<Index>(links.size() - first);
    Dense<S> t = Dense<S>::Zero(count, count);
    /// Links at each bead; the sign is 1 at the outboard end of the link.
    std::vector<std::vector<std::pair<std::size_t, int>>> at(n);
    for (std::size_t c = 0; c < crosslinks.size(); ++c) {
        at[static_cast<std::size_t>(chain.crosslinks[c].inboard)].emplace_back(in_row + c, -1);
        at[static_cast<std::size_t>(chain.crosslinks[c].outboard)].emplace_back(in_row + c, 1);
    }
    for (std::size_t k = first; k < in_row; ++k) {
        if (k > 0) at[k == n ? n - 1 : scene::inboard_of(chain.parent, k)].emplace_back(k, -1);
        if (k < n) at[k].emplace_back(k, 1);
    }
    for (std::size_t bead = 0; bead < n; ++bead)
        for (auto const& [a, sign_a] : at[bead])
            for (auto const& [b, sign_b] : at[bead]) {
                S const cosine = a == b ? S(1) : dot(links[a].direction, links[b].direction);
                t(static_cast<Index>(a - first), static_cast<Index>(b - first)) +=
                    S(sign_a * sign_b) * (cosine / S(chain.beads.mass[bead]));
            }
    return t;
}

/// Returns G M^-1 G^T of a chain of linked bodies.
template <class S>
Dense<S> linked_matrix(ChainSpec const& chain) {
    LinkedModel<S> const model = read_linked<S>(chain, {});
    std::vector<S> diagonal, beside;
    link_compliance(model, diagonal, beside);
    auto const count = static_cast<Index>(diagonal.size() - model.first);
    Dense<S> t = Dense<S>::Zero(count, count);
    for (Index i = 0; i < count; ++i) {
        std::size_t const k = static_cast<std::size_t>(i) + model.first;
        t(i, i) = diagonal[k];
        if (i + 1 < count) t(i, i + 1) = t(i + 1, i) = beside[k];
    }
    return t;
}

}  // namespace

double condition_estimate(ChainSpec const& chain, Loads const& loads) {
    Dense<double> const m = chain.is_beads()    ? bead_link_matrix<double>(chain)
                            : chain.is_linked() ? linked_matrix<double>(chain)
                                                : joint_space_inertia<double>(chain, loads);
    if (m.rows() == 0) return 1;
    Eigen::SelfAdjointEigenSolver<Dense<double>> const eigen((m + m.transpose()) / 2,
                                                             Eigen::EigenvaluesOnly);
    double const largest = eigen.eigenvalues().maxCoeff(),
                 smallest = eigen.eigenvalues().minCoeff();
    return largest / std::max(smallest, largest * Eigen::NumTraits<double>::epsilon());
}

}  // namespace catena::oracle
