// Implements the Schur complement of loops.
#include "dca/solvers/looped_solver.hpp"

#include <algorithm>

#include "clock.hpp"
#include "error.hpp"

namespace catena::dca {
namespace {

/// Openings beside those of the open chains, scaled, above which another sweep follows.
double constexpr lost_digits = 0x1p-46;
int constexpr most_corrections = 2;

Vector<double, 6> unit(int direction) {
    auto v = Vector<double, 6>::zero();
    v[direction] = 1;
    return v;
}

}  // namespace

LoopedSolver::LoopedSolver(ChainGroup const& group, std::unique_ptr<ChainSolver> open)
    : group_(group),
      open_(std::move(open)),
      torque_(group.size),
      force_(group.size),
      alpha_(group.size),
      acceleration_(group.size),
      components_(group.loops.own.size()) {
    for (std::size_t l = 0; l < group.loops.own.size(); ++l) {
        if (l == 0 || group.loops.own[l].piece != group.loops.own[l - 1].piece)
            chains_.push_back({l, l});
        chains_.back().end = l + 1;
    }
    for (Chain& chain : chains_) {
        auto const count = static_cast<Eigen::Index>(directions_of(chain).size());
        chain.matrix = Eigen::MatrixXd::Zero(count, count);
        rounds_ = std::max(rounds_, count);
    }
    take({}, torque_);
    take({}, force_);
}

std::vector<LoopedSolver::Direction> LoopedSolver::directions_of(Chain const& chain) const {
    std::vector<Direction> all;
    for (std::size_t l = chain.first; l < chain.end; ++l)
        for (int i = 0; i < group_.loops.own[l].restricted; ++i) all.push_back({l, i});
    return all;
}

void LoopedSolver::take(ConstView<3> const& given, Field<3>& to) {
    View<3> const all = to.view();
    for (std::int64_t k = 0; k < group_.size; ++k)
        all.store(k, given.origin ? given.load(k) : Vec3::zero());
}

LoopedSolver::Along LoopedSolver::side(std::int64_t body, LoopEnd const& end, Found const& found,
                                       ConstView<3> const& omega) const {
    if (body == LoopClosure::ground) return {Vec3::zero(), Vec3::zero()};
    Vec3 const alpha = found.alpha.load(body), w = omega.origin ? omega.load(body) : Vec3::zero();
    Vec3 const a =
        found.acceleration.load(body) + cross(alpha, end.arm) + cross(w, cross(w, end.arm));
    return {transposed_times(end.axes, a), transposed_times(end.axes, alpha)};
}

Vector<double, 6> LoopedSolver::apart(std::size_t l, Found const& found,
                                      ConstView<3> const& omega) const {
    LocalLoop const& loop = group_.loops.own[l];
    Along const out = side(loop.outboard, ends_[l].outboard, found, omega),
                in = side(loop.inboard, ends_[l].inboard, found, omega);
    return along_directions(as_screw(loop.screw),
                            Along{out.linear - in.linear, out.angular - in.angular});
}

void LoopedSolver::push(std::size_t l, Vector<double, 6> const& components) {
    LocalLoop const& loop = group_.loops.own[l];
    Along const along = along_axes(as_screw(loop.screw), components);
    auto const add = [&](std::int64_t body, LoopEnd const& end, double sign) {
        if (body == LoopClosure::ground) return;
        Vec3 const f = sign * (end.axes * along.linear);
        Vec3 const t = sign * (end.axes * along.angular) + cross(end.arm, f);
        force_.set(body, force_[body] + f);
        torque_.set(body, torque_[body] + t);
    };
    add(loop.outboard, ends_[l].outboard, 1);
    add(loop.inboard, ends_[l].inboard, -1);
}

void LoopedSolver::release() {
    for (LocalLoop const& loop : group_.loops.own)
        for (std::int64_t const body : {loop.inboard, loop.outboard}) {
            if (body == LoopClosure::ground) continue;
            force_.set(body, Vec3::zero());
            torque_.set(body, Vec3::zero());
        }
}

double LoopedSolver::free_response(Direction const& direction) const {
    LocalLoop const& loop = group_.loops.own[direction.loop];
    Along const along = along_axes(as_screw(loop.screw), unit(direction.number));
    auto const of = [&](std::int64_t body, LoopEnd const& end) {
        if (body == LoopClosure::ground) return 0.0;
        Vec3 const f = end.axes * along.linear;
        Vec3 const t = end.axes * along.angular + cross(end.arm, f);
        return dot(t, as_symmetric(group_.bodies.inverse_inertia[body]) * t) +
               group_.bodies.inverse_mass[body][0] * dot(f, f);
    };
    return of(loop.inboard, ends_[direction.loop].inboard) +
           of(loop.outboard, ends_[direction.loop].outboard);
}

void LoopedSolver::respond(Eigen::Index round) {
    release();
    for (Chain const& chain : chains_) {
        if (round >= chain.matrix.cols()) continue;
        Direction const direction = directions_of(chain)[static_cast<std::size_t>(round)];
        push(direction.loop, unit(direction.number));
    }
    LoadsView loads;
    loads.torque = torque_.view();
    loads.force = force_.view();
    double const begun = seconds_now();
    open_->solve(loads, {alpha_.view(), acceleration_.view(), {}, {}});
    swept_for_matrices_ += seconds_now() - begun;
    for (Chain& chain : chains_) {
        if (round >= chain.matrix.cols()) continue;
        Eigen::Index row = 0;
        for (std::size_t l = chain.first; l < chain.end; ++l) {
            Vector<double, 6> const moved = apart(l, {alpha_.view(), acceleration_.view()}, {});
            for (int i = 0; i < group_.loops.own[l].restricted; ++i)
                chain.matrix(row++, round) = moved[i];
        }
    }
}

void LoopedSolver::factorize(Chain& chain) {
    Eigen::MatrixXd const symmetric = 0.5 * (chain.matrix + chain.matrix.transpose());
    Eigen::VectorXd size(symmetric.rows());
    Eigen::Index row = 0;
    for (Direction const& direction : directions_of(chain)) size[row++] = free_response(direction);
    chain.scale = size.cwiseSqrt().cwiseInverse();
    if (!chain.system.factorize(symmetric, size)) refuse(chain);
}

void LoopedSolver::assemble_matrices(ConfigurationView const& configuration) {
    ends_ = configuration.loop_ends;
    open_->assemble_matrices(configuration);
    double const start = seconds_now();
    take({}, torque_);
    take({}, force_);
    for (Eigen::Index round = 0; round < rounds_; ++round) respond(round);
    for (Chain& chain : chains_) factorize(chain);
    of_matrices_ += seconds_now() - start;
}

Eigen::VectorXd LoopedSolver::open_directions(Chain const& chain, LoadsView const& loads,
                                              Found const& found) const {
    Eigen::VectorXd open(chain.matrix.rows());
    Eigen::Index row = 0;
    for (std::size_t l = chain.first; l < chain.end; ++l) {
        Vector<double, 6> const moved = apart(l, found, loads.omega);
        for (int i = 0; i < group_.loops.own[l].restricted; ++i)
            open[row++] = -(moved[i] + (loads.loop_bias ? loads.loop_bias[l][i] : 0.0));
    }
    return open;
}

void LoopedSolver::add_forces(Chain const& chain, Eigen::VectorXd const& open) {
    Eigen::VectorXd const found = chain.system.solve(open);
    Eigen::Index row = 0;
    for (std::size_t l = chain.first; l < chain.end; ++l) {
        auto components = Vector<double, 6>::zero();
        for (int i = 0; i < group_.loops.own[l].restricted; ++i) components[i] = found[row++];
        push(l, components);
        components_[l] = components_[l] + components;
    }
}

bool LoopedSolver::correct(LoadsView const& loads, Found const& found) {
    bool any = false;
    for (Chain& chain : chains_) {
        Eigen::VectorXd const open = open_directions(chain, loads, found);
        double const size = open.cwiseProduct(chain.scale).norm();
        if (!(size > lost_digits * chain.size)) continue;
        add_forces(chain, open);
        any = true;
    }
    return any;
}

/// The forces of loops cancel what the open chains' answer leaves open. Where that has lost digits,
/// one or two more sweeps restore them.
void LoopedSolver::solve(LoadsView const& loads, AccelerationsView const& out) {
    Found const own{alpha_.view(), acceleration_.view()};
    open_->solve(loads, {alpha_.view(), acceleration_.view(), {}, {}});
    take(loads.torque, torque_);
    take(loads.force, force_);
    std::fill(components_.begin(), components_.end(), Vector<double, 6>::zero());
    for (Chain& chain : chains_) {
        Eigen::VectorXd const open = open_directions(chain, loads, own);
        chain.size = open.cwiseProduct(chain.scale).norm();
        add_forces(chain, open);
    }
    LoadsView with = loads;
    with.torque = torque_.view();
    with.force = force_.view();
    AccelerationsView all = out;
    if (!all.alpha.origin) all.alpha = alpha_.view();
    if (!all.acceleration.origin) all.acceleration = acceleration_.view();
    open_->solve(with, all);
    for (int i = 0; i < most_corrections && correct(loads, {all.alpha, all.acceleration}); ++i)
        open_->solve(with, all);
    if (out.loop_force) std::copy(components_.begin(), components_.end(), out.loop_force);
}

SolverReport LoopedSolver::report() const {
    SolverReport r = open_->report();
    r.matrix_seconds += of_matrices_;
    r.bias_seconds -= swept_for_matrices_;
    r.memory_bytes += static_cast<std::int64_t>(4 * 3 * sizeof(double)) * group_.size +
                      static_cast<std::int64_t>(sizeof(LocalLoop)) * std::ssize(group_.loops.own);
    for (Chain const& chain : chains_)
        r.memory_bytes += static_cast<std::int64_t>(2 * sizeof(double)) * chain.matrix.size();
    return r;
}

void LoopedSolver::refuse(Chain const& chain) const {
    dca::Piece const& piece =
        group_.pieces[static_cast<std::size_t>(group_.loops.own[chain.first].piece)];
    throw ComputationError("the matrix of the " + std::to_string(chain.end - chain.first) +
                           " loops of chain " +
                           group_.chains[static_cast<std::size_t>(piece.chain)].name +
                           " is not positive semidefinite: check the positions, and masses that "
                           "differ by many decades");
}

}  // namespace catena::dca
