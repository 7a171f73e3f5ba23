// Force and energy of the Fixman potential.
#include "dynamics/fixman.hpp"

#include <cmath>

#include "dynamics/absolute_dynamics.hpp"

namespace catena {
namespace {

/// Force at the outboard end of a link along u that rotates it towards s. `strength` is kT /
/// length.
Vec3 turning(double strength, Vec3 const& s, Vec3 const& u) {
    return strength * plus_scaled(s, -dot(s, u), u);
}

}  // namespace

LinkFixman::LinkFixman(ChainGroup const& group, Scene const& scene, Executor const& executor,
                       Communicator const& communicator, ChainSolver& solver)
    : group_(group),
      executor_(executor),
      communicator_(communicator),
      solver_(solver),
      kt_(scene.boltzmann() * scene.dynamics.temperature),
      tips_(held_tips(group,
                      [&](std::int64_t k) {
                          return scene.chains[group.scene_chain(k)].beads.position.back();
                      })),
      pivot_(group.size),
      tip_pivot_(group.size),
      beside_(group.size),
      pull_(group.size),
      across_(group.size) {}

Vec3 LinkFixman::outboard(ConfigurationView const& at, std::int64_t k) const {
    if (group_.ends.has_jointed_tip(k)) return at.tip_direction.load(k);
    return group_.ends.is_last[static_cast<std::size_t>(k)] ? Vec3::zero()
                                                            : at.direction.load(k + 1);
}

/// Force -grad U_F = kT sum_k w_k grad(u_k . u_k+1), w_k = (T^-1)_k,k+1 / m_k. It rotates link k
/// towards w_k-1 u_k-1 + w_k u_k+1.
void LinkFixman::add_forces(ConfigurationView const& at, View<3> force) {
    solver_.invert({pivot_.view(), tip_pivot_.view(), beside_.view()});
    View<1> const beside = beside_.view();
    ConstView<1> const inverse_mass = group_.bodies.inverse_mass.view(),
                       length = group_.joints.length.view();
    View<3> const pull = pull_.view(), across = across_.view();
    auto const weight = [=](std::int64_t k) { return beside.at(k, 0) * inverse_mass.at(k, 0); };
    executor_.for_each(group_.size,
                       [&](std::int64_t k) { pull.store(k, weight(k) * at.direction.load(k)); });
    exchange_from_inboard(communicator_, group_, pull);
    executor_.for_each(group_.size, [&](std::int64_t k) {
        if (!has_link(k)) return across.store(k, Vec3::zero());
        Vec3 const before =
            group_.ends.is_first[static_cast<std::size_t>(k)] ? Vec3::zero() : pull.load(k - 1);
        across.store(k,
                     turning(kt_ / length.at(k, 0), plus_scaled(before, weight(k), outboard(at, k)),
                             at.direction.load(k)));
    });
    exchange_from_outboard(communicator_, group_, across);
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Vec3 const after =
            group_.ends.is_last[static_cast<std::size_t>(k)] ? Vec3::zero() : across.load(k + 1);
        force.store(k, force.load(k) + (across.load(k) - after));
    });
    for (HeldTip const& tip : tips_) {
        Vec3 const of_tip =
            turning(kt_ / tip.length, pull.load(tip.body), at.tip_direction.load(tip.body));
        force.store(tip.body, force.load(tip.body) - of_tip);
    }
}

std::vector<double> LinkFixman::energy() const {
    std::vector<double> energy;
    for (std::int64_t k = 0; k < group_.size; ++k)
        energy.push_back(0.5 * kt_ * std::log(pivot_.view().at(k, 0)));
    for (HeldTip const& tip : tips_)
        energy[static_cast<std::size_t>(tip.body)] +=
            0.5 * kt_ * std::log(tip_pivot_.view().at(tip.body, 0));
    return energy;
}

}  // namespace catena
