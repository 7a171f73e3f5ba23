// Implements the Schur complement of cross-links.
#include "dca/solvers/crosslinked_solver.hpp"

#include <algorithm>

#include "clock.hpp"
#include "error.hpp"

namespace catena::dca {

CrossLinkedSolver::CrossLinkedSolver(ChainGroup const& group, Executor const& executor,
                                     std::unique_ptr<ChainSolver> tree)
    : group_(group),
      executor_(executor),
      tree_(std::move(tree)),
      force_(group.size),
      acceleration_(group.size) {
    for (std::size_t c = 0; c < group.branching.crosslinks.size(); ++c) {
        if (c == 0 ||
            group.branching.crosslinks[c].piece != group.branching.crosslinks[c - 1].piece)
            links_.push_back({c, c});
        links_.back().end = c + 1;
    }
    for (Links const& of : links_) {
        auto const count = static_cast<Eigen::Index>(of.end - of.first);
        matrices_.emplace_back(Eigen::MatrixXd::Zero(count, count));
        rounds_ = std::max<std::int64_t>(rounds_, count);
    }
}

double CrossLinkedSolver::apart(std::size_t crosslink) const {
    LocalCrossLink const& link = group_.branching.crosslinks[crosslink];
    ConstView<3> const a = acceleration_.view();
    return dot(direction(crosslink), a.load(link.outboard) - a.load(link.inboard));
}

void CrossLinkedSolver::push(std::size_t crosslink, double force) {
    LocalCrossLink const& link = group_.branching.crosslinks[crosslink];
    Vec3 const f = force * direction(crosslink);
    View<3> const forces = force_.view();
    forces.store(link.outboard, forces.load(link.outboard) + f);
    forces.store(link.inboard, forces.load(link.inboard) - f);
}

double CrossLinkedSolver::free_response(std::size_t crosslink) const {
    LocalCrossLink const& link = group_.branching.crosslinks[crosslink];
    return group_.bodies.inverse_mass[link.inboard][0] +
           group_.bodies.inverse_mass[link.outboard][0];
}

void CrossLinkedSolver::respond(std::int64_t round, AccelerationsView const& out) {
    executor_.for_each(group_.size, [&](std::int64_t k) { force_.view().store(k, Vec3::zero()); });
    for (Links const& of : links_)
        if (of.first + static_cast<std::size_t>(round) < of.end)
            push(of.first + static_cast<std::size_t>(round), 1);
    LoadsView loads;
    loads.force = force_.view();
    tree_->solve(loads, out);
}

void CrossLinkedSolver::assemble_matrices(ConfigurationView const& configuration) {
    direction_ = configuration.direction;
    tree_->assemble_matrices(configuration);
    double const start = seconds_now();
    for (std::int64_t round = 0; round < rounds_; ++round) {
        double const begun = seconds_now();
        respond(round, {{}, acceleration_.view(), {}, {}});
        swept_for_matrices_ += seconds_now() - begun;
        for (std::size_t i = 0; i < links_.size(); ++i)
            for (Eigen::Index row = 0; round < matrices_[i].cols() && row < matrices_[i].rows();
                 ++row)
                matrices_[i](row, round) = apart(links_[i].first + static_cast<std::size_t>(row));
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
        Links& of = links_[i];
        Eigen::MatrixXd const symmetric = 0.5 * (matrices_[i] + matrices_[i].transpose());
        Eigen::VectorXd size(symmetric.rows());
        for (Eigen::Index row = 0; row < size.size(); ++row)
            size[row] = free_response(of.first + static_cast<std::size_t>(row));
        if (!of.system.factorize(symmetric, size)) refuse(of);
    }
    of_matrices_ += seconds_now() - start;
}

/// The forces of cross-links cancel what the chains' answer without them leaves open.
void CrossLinkedSolver::solve(LoadsView const& loads, AccelerationsView const& out) {
    tree_->solve(loads, {{}, acceleration_.view(), {}, {}});
    executor_.for_each(group_.size, [&](std::int64_t k) {
        force_.view().store(k, loads.force.origin ? loads.force.load(k) : Vec3::zero());
    });
    for (Links const& of : links_) {
        Eigen::VectorXd open(static_cast<Eigen::Index>(of.end - of.first));
        for (std::size_t c = of.first; c < of.end; ++c) {
            std::int64_t const link = group_.first_crosslink() + static_cast<std::int64_t>(c);
            double const bias = loads.bias.origin ? loads.bias.at(link, 0) : 0.0;
            open[static_cast<Eigen::Index>(c - of.first)] = -(apart(c) + bias);
        }
        Eigen::VectorXd const force = of.system.solve(open);
        for (std::size_t c = of.first; c < of.end; ++c) {
            double const along = force[static_cast<Eigen::Index>(c - of.first)];
            push(c, along);
            if (out.joint_force)
                out.joint_force.at(group_.first_crosslink() + static_cast<std::int64_t>(c), 0) =
                    along;
        }
    }
    LoadsView with = loads;
    with.force = force_.view();
    tree_->solve(with, out);
}

SolverReport CrossLinkedSolver::report() const {
    SolverReport r = tree_->report();
    r.matrix_seconds += of_matrices_;
    r.bias_seconds -= swept_for_matrices_;
    r.memory_bytes +=
        static_cast<std::int64_t>(2 * 3 * sizeof(double)) * group_.size +
        static_cast<std::int64_t>(sizeof(LocalCrossLink)) * std::ssize(group_.branching.crosslinks);
    for (Eigen::MatrixXd const& matrix : matrices_)
        r.memory_bytes += static_cast<std::int64_t>(2 * sizeof(double)) * matrix.size();
    return r;
}

void CrossLinkedSolver::refuse(Links const& of) const {
    dca::Piece const& piece =
        group_.pieces[static_cast<std::size_t>(group_.branching.crosslinks[of.first].piece)];
    throw ComputationError("the matrix of the " + std::to_string(of.end - of.first) +
                           " cross-links of chain " +
                           group_.chains[static_cast<std::size_t>(piece.chain)].name +
                           " is not positive semidefinite: check the positions, and masses that "
                           "differ by many decades");
}

}  // namespace catena::dca
