// Sweeps of the Fixman potential over branched chains.
#include "dynamics/branched_fixman.hpp"

#include <cmath>

#include "dca/leaf.hpp"

namespace catena {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Adds mu u u^T.
void add_along(Sym3& m, double mu, Vec3 const& u) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) m(i, j) += mu * u[i] * u[j];
}
Sym3 sum(Sym3 a, Sym3 const& b) {
    for (int i = 0; i < Sym3::size; ++i) a.data[i] += b.data[i];
    return a;
}
Sym3 isotropic(double mass) { return {{mass, 0, mass, 0, 0, mass}}; }

}  // namespace

BranchedFixman::BranchedFixman(ChainGroup const& group, Scene const& scene,
                               Executor const& executor)
    : group_(group),
      executor_(executor),
      kt_(scene.boltzmann() * scene.dynamics.temperature),
      first_child_(at(group.size) + 1, 0),
      child_(at(group.size)),
      inertia_(at(group.size)),
      held_(at(group.size), Vec3::zero()),
      beyond_(at(group.size), 0),
      before_(at(group.size), 0),
      energy_(at(group.size), 0) {
    for (std::int64_t const p : group.branching.inboard)
        if (p >= 0) ++first_child_[at(p) + 1];
    for (std::size_t k = 1; k < first_child_.size(); ++k) first_child_[k] += first_child_[k - 1];
    std::vector<std::int64_t> next = first_child_;
    for (std::int64_t k = 0; k < group.size; ++k)
        if (std::int64_t const p = group.branching.inboard[at(k)]; p >= 0)
            child_[at(next[at(p)]++)] = k;
}

void BranchedFixman::add_forces(ConfigurationView const& configuration, View<3> force) {
    executor_.for_each(std::ssize(group_.pieces), [&](std::int64_t i) {
        sweep_inwards(group_.pieces[at(i)], configuration.direction);
        sweep_outwards(group_.pieces[at(i)], configuration.direction, force);
    });
}

void BranchedFixman::sweep_inwards(dca::Piece const& chain, ConstView<3> direction) {
    for (std::int64_t k = chain.local; k < chain.local + chain.count; ++k)
        inertia_[at(k)] = isotropic(group_.bodies.mass[k][0]);
    for (std::int64_t k = chain.local + chain.count; k-- > chain.local;) {
        Sym3 const factor = dca::factorize(inertia_[at(k)], 3);
        double logarithm = -3 * std::log(group_.bodies.mass[k][0]);
        for (int i = 0; i < 3; ++i) logarithm -= std::log(factor(i, i));
        if (has_link(k)) {
            Vec3 const u = direction.load(k);
            held_[at(k)] = dca::solve_upper(factor, dca::solve_lower(factor, u));
            beyond_[at(k)] = dot(u, held_[at(k)]);
            logarithm += std::log(beyond_[at(k)]);
            if (std::int64_t const p = group_.branching.inboard[at(k)]; p >= 0)
                add_along(inertia_[at(p)], 1 / beyond_[at(k)], u);
        }
        energy_[at(k)] = 0.5 * kt_ * logarithm;
    }
}

/// The inboard side of a link is its bead with all links but this one. Their sum is made anew for
/// each link, from the links before it and after it, because taking one away would cancel.
void BranchedFixman::sweep_outwards(dca::Piece const& chain, ConstView<3> direction,
                                    View<3> force) {
    if (has_link(chain.local)) add_force(chain.local, Vec3::zero(), direction, force);
    std::vector<Sym3> after;
    for (std::int64_t p = chain.local; p < chain.local + chain.count; ++p) {
        std::int64_t const first = first_child_[at(p)], end = first_child_[at(p) + 1];
        after.assign(at(end - first) + 1, Sym3::zero());
        for (std::int64_t i = end - 1; i > first; --i) {
            after[at(i - first - 1)] = after[at(i - first)];
            std::int64_t const k = child_[at(i)];
            add_along(after[at(i - first - 1)], 1 / beyond_[at(k)], direction.load(k));
        }
        Sym3 others = isotropic(group_.bodies.mass[p][0]);
        Vec3 const inboard = direction.load(p);
        for (std::int64_t i = first; i < end; ++i) {
            std::int64_t const k = child_[at(i)];
            Vec3 const u = direction.load(k);
            Sym3 const factor = dca::factorize(sum(others, after[at(i - first)]), 3);
            auto const yield_to = [&](Vec3 const& push) {
                return dca::solve_upper(factor, dca::solve_lower(factor, push));
            };
            Vec3 yield = yield_to(u);
            if (has_link(p)) {
                Vec3 const to_inboard = yield_to(inboard);
                yield = plus_scaled(
                    yield, -dot(inboard, yield) / (before_[at(p)] + dot(inboard, to_inboard)),
                    to_inboard);
            }
            before_[at(k)] = dot(u, yield);
            add_force(k, yield, direction, force);
            add_along(others, 1 / beyond_[at(k)], u);
        }
    }
}

/// grad U_F = kT (d - (u . d) u) / l at the outboard end of the link and the opposite at the
/// inboard end, where d is (T^-1)_kk times the sum of both ends' accelerations under a unit force.
void BranchedFixman::add_force(std::int64_t k, Vec3 const& yield, ConstView<3> direction,
                               View<3> force) {
    Vec3 const u = direction.load(k);
    Vec3 const d = (1 / (beyond_[at(k)] + before_[at(k)])) * (held_[at(k)] + yield);
    Vec3 const turning = (kt_ / group_.joints.length[k][0]) * plus_scaled(d, -dot(u, d), u);
    force.store(k, force.load(k) - turning);
    if (std::int64_t const p = group_.branching.inboard[at(k)]; p >= 0)
        force.store(p, force.load(p) + turning);
}

}  // namespace catena
