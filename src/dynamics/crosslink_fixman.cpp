// Implements the part of cross-links in the Fixman potential.
#include "dynamics/crosslink_fixman.hpp"

#include <string>

#include "error.hpp"

namespace catena {

CrossLinkFixman::CrossLinkFixman(ChainGroup const& group, Scene const& scene,
                                 Executor const& executor, dca::CrossLinkedSolver& solver)
    : group_(group),
      executor_(executor),
      solver_(solver),
      kt_(scene.boltzmann() * scene.dynamics.temperature),
      without_(group, scene, executor),
      energy_(solver.links().size(), 0) {
    for (std::int64_t round = 0; round < solver.rounds(); ++round)
        columns_.push_back(
            {Field<3>(group.size), DirectionsField(group.link_entries() + 1, group.directions)});
}

void CrossLinkFixman::add_forces(ConfigurationView const& configuration, View<3> force) {
    without_.add_forces(configuration, force);
    for (std::size_t round = 0; round < columns_.size(); ++round)
        solver_.respond(
            static_cast<std::int64_t>(round),
            {{}, columns_[round].acceleration.view(), columns_[round].force.view(), {}});
    for (std::size_t i = 0; i < solver_.links().size(); ++i)
        if (Links const& of = solver_.links()[i]; !of.system.is_regular())
            throw ComputationError(
                "the Fixman potential is infinite: links of chain " +
                group_
                    .chains[static_cast<std::size_t>(
                        group_
                            .pieces[static_cast<std::size_t>(
                                group_.branching.crosslinks[of.first].piece)]
                            .chain)]
                    .name +
                " have become redundant; use a smaller step, or leave out fixman");
    executor_.for_each(std::ssize(solver_.links()), [&](std::int64_t i) {
        Links const& of = solver_.links()[static_cast<std::size_t>(i)];
        Eigen::Index const count = of.system.unknowns();
        Eigen::MatrixXd inverse(count, count);
        for (Eigen::Index j = 0; j < count; ++j)
            inverse.col(j) = of.system.solve(Eigen::VectorXd::Unit(count, j));
        energy_[static_cast<std::size_t>(i)] = 0.5 * kt_ * of.system.log_determinant();
        add_chain(of, inverse, configuration.direction, force);
    });
}

Vec3 CrossLinkFixman::apart(Eigen::VectorXd const& weight, std::int64_t from,
                            std::int64_t to) const {
    Vec3 sum = Vec3::zero();
    for (Eigen::Index r = 0; r < weight.size(); ++r) {
        ConstView<3> const a = columns_[static_cast<std::size_t>(r)].acceleration.view();
        sum = plus_scaled(sum, weight[r], from < 0 ? a.load(to) : a.load(to) - a.load(from));
    }
    return sum;
}

/// The force on the outboard end of link k is -kT sum_qr (G^-1)_qr lambda_k^q P (a^r_out - a^r_in)
/// / l, where P takes out what is along the link; lambda^q of cross-link q itself is 1.
void CrossLinkFixman::add_chain(Links const& of, Eigen::MatrixXd const& inverse,
                                ConstView<3> direction, View<3> force) const {
    Eigen::Index const count = inverse.rows();
    auto const add = [&](std::int64_t link, Eigen::VectorXd const& lambda, std::int64_t from,
                         std::int64_t to) {
        Vec3 const d = apart(inverse * lambda, from, to), u = direction.load(link);
        Vec3 const turning =
            (kt_ / group_.joints.length.view().at(link, 0)) * plus_scaled(d, -dot(u, d), u);
        force.store(to, force.load(to) - turning);
        if (from >= 0) force.store(from, force.load(from) + turning);
    };
    dca::Piece const& piece =
        group_.pieces[static_cast<std::size_t>(group_.branching.crosslinks[of.first].piece)];
    Eigen::VectorXd lambda(count);
    for (std::int64_t k = piece.local; k < piece.local + piece.count; ++k) {
        if (!is_rod(group_.joints.type[static_cast<std::size_t>(k)])) continue;
        for (Eigen::Index q = 0; q < count; ++q)
            lambda[q] = columns_[static_cast<std::size_t>(q)].force.view().load<1>(k)[0];
        add(k, lambda, group_.branching.inboard[static_cast<std::size_t>(k)], k);
    }
    for (Eigen::Index q = 0; q < count; ++q) {
        std::size_t const c = of.first + static_cast<std::size_t>(q);
        add(group_.first_crosslink() + static_cast<std::int64_t>(c),
            Eigen::VectorXd::Unit(count, q), group_.branching.crosslinks[c].inboard,
            group_.branching.crosslinks[c].outboard);
    }
}

std::vector<double> CrossLinkFixman::energy() const {
    std::vector<double> energy = without_.energy();
    for (std::size_t i = 0; i < energy_.size(); ++i) {
        LocalCrossLink const& link = group_.branching.crosslinks[solver_.links()[i].first];
        std::int64_t const first = group_.pieces[static_cast<std::size_t>(link.piece)].local;
        energy[static_cast<std::size_t>(first)] += energy_[i];
    }
    return energy;
}

}  // namespace catena
