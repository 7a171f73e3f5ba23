// Start, results and residual of bead chains on the host.
#include "dynamics/bead_dynamics.hpp"

#include "dynamics/branched_fixman.hpp"
#include "dynamics/crosslink_fixman.hpp"
#include "joints/joint_models.hpp"

namespace catena {

std::vector<std::uint8_t> links_of(ChainGroup const& group) {
    std::vector<std::uint8_t> links;
    for (std::int64_t k = 0; k < group.size; ++k)
        links.push_back(is_rod(group.joints.type[k]) ? 1 : 0);
    return links;
}

Field<1> halves_over(Field<1> const& length, Executor const& executor) {
    Field<1> halves(length.size());
    executor.for_each(length.size(), [&](std::int64_t k) {
        if (double const l = length[k][0]; l > 0) halves.set(k, {{0.5 / l}});
    });
    return halves;
}

void place_beads(ChainGroup const& group, Scene const& scene, View<3> position, View<3> velocity,
                 Executor const& executor) {
    each_local_body(group, executor, [&](dca::Piece const& piece, std::int64_t i) {
        BeadArrays const& beads = scene.chains[group.chains[piece.chain].in_scene].beads;
        position.store(piece.local + i, beads.position[piece.body + i]);
        velocity.store(piece.local + i, beads.velocity[piece.body + i]);
    });
}

/// Force of the outboard link, with the opposite sign of that on bead k.
Vec3 BeadSolution::outboard_force(std::int64_t k) const {
    if (group.ends.has_jointed_tip(k)) return tip_force.load<1>(k)[0] * tip_direction.load(k);
    return group.ends.is_last[k] ? Vec3::zero()
                                 : joint_force.load<1>(k + 1)[0] * direction.load(k + 1);
}

std::vector<BeadSolution::Outboard> BeadSolution::outboard_forces() const {
    std::vector<Outboard> all(static_cast<std::size_t>(group.size));
    auto const add = [](Outboard& to, Vec3 const& f) { to = {to.force + f, to.size + norm(f)}; };
    for (std::int64_t k = 0; k < group.size; ++k) {
        if (!group.is_branched())
            add(all[static_cast<std::size_t>(k)], outboard_force(k));
        else if (std::int64_t const p = group.branching.inboard[static_cast<std::size_t>(k)];
                 p >= 0)
            add(all[static_cast<std::size_t>(p)], joint_force.load<1>(k)[0] * direction.load(k));
    }
    for (std::size_t i = 0; i < group.branching.crosslinks.size(); ++i) {
        LocalCrossLink const& link = group.branching.crosslinks[i];
        std::int64_t const k = group.first_crosslink() + static_cast<std::int64_t>(i);
        Vec3 const f = joint_force.load<1>(k)[0] * direction.load(k);
        add(all[static_cast<std::size_t>(link.inboard)], f);
        add(all[static_cast<std::size_t>(link.outboard)], -f);
    }
    return all;
}

BodyResults BeadSolution::results() const {
    BodyResults r;
    for (std::int64_t k = 0; k < group.size; ++k) {
        r.acceleration.push_back(acceleration.load(k));
        Vec3 const f = joint_force.load<1>(k)[0] * direction.load(k);
        r.joint_force.push_back({{0, 0, 0, f[0], f[1], f[2]}});
    }
    for (std::int64_t i = 0; i < std::ssize(group.branching.crosslinks); ++i)
        r.crosslink_tension.push_back(
            {group.scene_chain(group.branching.crosslinks[static_cast<std::size_t>(i)].inboard),
             -joint_force.load<1>(group.first_crosslink() + i)[0]});
    for (LocalTip const& tip : group.ends.tips) {
        Vec3 const f = outboard_force(tip.body);
        r.tip_force.push_back({group.scene_chain(tip.body), {{0, 0, 0, -f[0], -f[1], -f[2]}}});
    }
    return r;
}

double BeadSolution::residual(Communicator const& communicator, ConstView<3> velocity,
                              std::vector<HeldTip> const& tips) const {
    /// Acceleration of bead k, and the sum of the sizes of the forces' contributions to it.
    Field<4> terms(group.size);
    double worst = 0;
    std::vector<Outboard> const outboard = outboard_forces();
    for (std::int64_t k = 0; k < group.size; ++k) {
        Vec3 const a = acceleration.load(k), ma = group.bodies.mass.view().at(k, 0) * a,
                   f = force.load(k);
        Vec3 const inboard = joint_force.load<1>(k)[0] * direction.load(k);
        auto const& [beyond, of_outboard] = outboard[static_cast<std::size_t>(k)];
        double const size = norm(f) + norm(inboard) + of_outboard;
        worst = larger(worst, relative(norm(ma - f - inboard + beyond), norm(ma) + size));
        terms.set(k, {{a[0], a[1], a[2], group.bodies.inverse_mass.view().at(k, 0) * size}});
    }
    exchange_from_inboard(communicator, group, terms.view());
    auto const beyond = beyond_tips_of<7>(group, communicator, [&](std::int64_t k) {
        Vector<double, 4> const t = terms[k];
        Vec3 const v = velocity.load(k);
        return Vector<double, 7>{{t[0], t[1], t[2], t[3], v[0], v[1], v[2]}};
    });
    for (HeldTip const& tip : tips) {
        if (tip.body < 0) continue;
        Vector<double, 7> const b = beyond[group.ends.tip_index(tip.body)];
        Vec3 const u = tip_direction.load(tip.body), there{{b[0], b[1], b[2]}};
        double const turning =
            velocity_bias(Vec3{{b[4], b[5], b[6]}} - velocity.load(tip.body), u, tip.length);
        worst = larger(worst, relative(turning + dot(u, there - acceleration.load(tip.body)),
                                       terms[tip.body][3] + b[3] + turning));
    }
    auto const compare = [&](std::int64_t link, std::int64_t from, std::int64_t to, bool grounded) {
        Vector<double, 4> const mine = terms[to], before = grounded ? Vector<double, 4>::zero()
                                                                    : terms.view().load(from);
        Vec3 const across{{mine[0] - before[0], mine[1] - before[1], mine[2] - before[2]}};
        Vec3 const apart = velocity.load(to) - (grounded ? Vec3::zero() : velocity.load(from));
        double const turning =
            velocity_bias(apart, direction.load(link), group.joints.length.view().at(link, 0));
        worst = larger(worst, relative(dot(direction.load(link), across) + turning,
                                       mine[3] + before[3] + turning));
    };
    for (std::int64_t k = 0; k < group.size; ++k)
        if (is_rod(group.joints.type[k]))
            compare(k, group.is_branched() ? group.branching.inboard[k] : k - 1, k,
                    group.ends.is_first[k] != 0);
    for (std::int64_t i = 0; i < std::ssize(group.branching.crosslinks); ++i)
        compare(group.first_crosslink() + i, group.branching.crosslinks[i].inboard,
                group.branching.crosslinks[i].outboard, false);
    return communicator.max(worst);
}

std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const& group, Scene const& scene,
                                                     Executor const& executor,
                                                     Communicator const& communicator,
                                                     std::unique_ptr<ChainSolver> solver) {
    HostSpace const space(executor);
    if (group.is_branched()) {
        auto beads = std::make_unique<BeadDynamics<HostSpace, BranchedFields>>(
            group, scene, space, communicator, std::move(solver));
        if (auto* const crosslinked = dynamic_cast<dca::CrossLinkedSolver*>(&beads->solver());
            scene.dynamics.fixman && crosslinked != nullptr)
            beads->use(std::make_unique<CrossLinkFixman>(group, scene, executor, *crosslinked));
        else if (scene.dynamics.fixman)
            beads->use(std::make_unique<BranchedFixman>(group, scene, executor));
        return beads;
    }
    auto beads = std::make_unique<BeadDynamics<HostSpace>>(group, scene, space, communicator,
                                                           std::move(solver));
    if (scene.dynamics.fixman)
        beads->use(
            std::make_unique<LinkFixman>(group, scene, executor, communicator, beads->solver()));
    return beads;
}

}  // namespace catena
