// Copies of bodies' motion: collection on a rank, exchange between ranks and hand-over.
#include "integrate/snapshots.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace catena {

/// Each row belongs to a body. It holds position and velocity; orientation and angular velocity if
/// bodies can rotate; then joint force, joint coordinates and joint rates if asked for.
OwnBodies Snapshots::own(bool joint_forces, bool joint_states,
                         std::vector<std::vector<double>> rows) const {
    auto const& groups = system_.groups();
    bool const turning =
        std::any_of(groups.begin(), groups.end(), [](auto const& group) { return !group->beads; });
    OwnBodies own{{turning, joint_forces, joint_states}, std::move(rows)};
    int const width = own.columns.width();
    own.rows.resize(groups.size());
    std::vector<BodyResults> const found =
        joint_forces ? results_of(system_) : std::vector<BodyResults>();
    std::size_t result = 0;
    auto const add = [&](ChainGroup const& group, auto const& row,
                         JointState const* joints = nullptr) {
        std::vector<double>& of_group = own.rows[system_.index_of(group)];
        of_group.resize(static_cast<std::size_t>(group.size * width));
        system_.executor().for_each(group.size, [&](std::int64_t k) {
            double* to = of_group.data() + k * width;
            auto const put = [&to](double const* numbers, int count) {
                to = std::copy_n(numbers, count, to);
            };
            row(k, put);
            if (joint_forces) put(found[result].joint_force[static_cast<std::size_t>(k)].data, 6);
            if (!joint_states || joints == nullptr) return;
            put(Vector<double, 4>(joints->q[k]).data, 4);
            put(Vec3(joints->qd[k]).data, 3);
        });
        ++result;
    };
    for (AbsoluteDynamics* const group : system_.absolute()) {
        ObservedMotion const observed = group->observed();
        add(group->group(), [&](std::int64_t k, auto const& put) {
            static constexpr double at_rest[] = {1, 0, 0, 0, 0, 0, 0};
            put(observed.position.load(k).data, 3);
            put(observed.velocity.load(k).data, 3);
            if (!turning) return;
            if (group->group().beads) return put(at_rest, 7);
            put(observed.orientation.load(k).data, 4);
            put(observed.omega.load(k).data, 3);
        });
    }
    for (JointDynamics* const dynamics : system_.joint()) {
        ChainGroup const& group = dynamics->group();
        BodyMotion const motion = dynamics->motion();
        std::optional<JointState> joints;
        if (joint_states) joints = dynamics->state();
        auto const row = [&](std::int64_t k, auto const& put) {
            Vector<double, 4> const q = motion.orientation[k];
            Mat3 const rotation = to_matrix(Quat{q[0], q[1], q[2], q[3]});
            Vec3 const omega = motion.omega[k],
                       x = motion.origin[k] - rotation * group.bodies.r1[k];
            Vec3 const v = rotation * (motion.velocity[k] - cross(omega, group.bodies.r1[k]));
            put(x.data, 3);
            put(v.data, 3);
            put(q.data, 4);
            put(omega.data, 3);
        };
        add(group, row, joints ? &*joints : nullptr);
    }
    return own;
}

namespace {

/// Converts rows of Snapshots::own() into motions; the first row is body `first` of the scene.
SceneBodies bodies_of(BodyColumns const& columns, std::int64_t first,
                      std::span<double const> values, Executor const& executor) {
    SceneBodies bodies;
    bodies.first = first;
    SceneMotion& motion = bodies.motion;
    std::size_t const count = values.size() / static_cast<std::size_t>(columns.width());
    motion.position.resize(count);
    motion.velocity.resize(count);
    motion.orientation.resize(count, Quat::identity());
    motion.omega.resize(count, Vec3::zero());
    if (columns.joint_forces) bodies.joint_force.resize(count);
    if (columns.joint_states) {
        bodies.joint_position.resize(count);
        bodies.joint_rate.resize(count);
    }
    executor.for_each(static_cast<std::int64_t>(count), [&](std::int64_t body) {
        auto const k = static_cast<std::size_t>(body);
        double const* row = values.data() + body * columns.width();
        auto const next = [&] { return *row++; };
        auto const three = [&] { return Vec3{{next(), next(), next()}}; };
        motion.position[k] = three();
        motion.velocity[k] = three();
        if (columns.turning) {
            motion.orientation[k] = Quat{next(), next(), next(), next()};
            motion.omega[k] = three();
        }
        if (columns.joint_forces)
            bodies.joint_force[k] = {{next(), next(), next(), next(), next(), next()}};
        if (!columns.joint_states) return;
        bodies.joint_position[k] = {next(), next(), next(), next()};
        bodies.joint_rate[k] = three();
    });
    return bodies;
}

}  // namespace

void Snapshots::pass(OwnBodies const& own, Take const& take) const {
    windows().pass(own.columns.width(), own.rows,
                   [&](std::int64_t first, std::span<double const> values) {
                       take(bodies_of(own.columns, first, values, system_.executor()));
                   });
}

void Snapshots::pass(AllBodies const& all, Take const& take) const {
    auto const width = static_cast<std::size_t>(all.columns.width());
    std::size_t const length = std::max<std::size_t>(
                          SceneWindows::usual_bytes / (width * sizeof(double)), 1),
                      bodies = all.rows.size() / width;
    for (std::size_t first = 0; first < bodies; first += length) {
        std::size_t const count = std::min(length, bodies - first);
        take(bodies_of(all.columns, static_cast<std::int64_t>(first),
                       std::span(all.rows).subspan(first * width, count * width),
                       system_.executor()));
    }
}

AllBodies Snapshots::gathered(OwnBodies const& own, std::vector<double> rows) const {
    int const width = own.columns.width();
    if (system_.communicator().rank() == 0)
        rows.resize(static_cast<std::size_t>(system_.scene().bodies() * width));
    windows().gather(width, own.rows, rows);
    return {own.columns, std::move(rows)};
}

void Snapshots::pass_own(OwnBodies const& own,
                         std::function<void(std::vector<SceneBodies> const&)> const& take) const {
    windows().pass_own(own.columns.width(), own.rows,
                       [&](std::vector<SceneWindows::Own> const& round) {
                           std::vector<SceneBodies> bodies(round.size());
                           system_.executor().for_each_of_many_or_few(
                               std::ssize(round), [&](std::int64_t i, Executor const& within) {
                                   auto const& [first, values] = round[static_cast<std::size_t>(i)];
                                   bodies[static_cast<std::size_t>(i)] =
                                       bodies_of(own.columns, first, values, within);
                               });
                           take(bodies);
                       });
}

SceneMotion Snapshots::motion() const {
    SceneMotion all;
    auto const append = [](auto& to, auto const& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    pass(own(false), [&](SceneBodies const& bodies) {
        append(all.position, bodies.motion.position);
        append(all.velocity, bodies.motion.velocity);
        append(all.omega, bodies.motion.omega);
        append(all.orientation, bodies.motion.orientation);
    });
    return all;
}

}  // namespace catena
