#include "chain/chain_group.hpp"

#define EIGEN_DONT_PARALLELIZE  // threads are the executor's
#include <Eigen/Dense>
#include <algorithm>

namespace catena {
namespace {

/// Columns (p, q, axis), right-handed; the identity where all rotations are free.
Mat3 joint_axes(JointType type, Vec3 const& axis) {
    if (type != JointType::revolute) return Mat3::identity();
    Eigen::Vector3d const z(axis[0], axis[1], axis[2]);
    Eigen::Vector3d const p = z.unitOrthogonal(), q = z.cross(p).normalized();
    Mat3 m;
    m.set_column(0, {{p[0], p[1], p[2]}});
    m.set_column(1, {{q[0], q[1], q[2]}});
    m.set_column(2, axis);
    return m;
}

int restricted_directions(JointType type) {
    switch (type) {
        case JointType::free:
            return 0;
        case JointType::link:
            return 1;
        case JointType::spherical:
            return 3;
        case JointType::universal:
            return 4;
        case JointType::revolute:
        case JointType::prismatic:
        case JointType::helical:
            return 5;
        case JointType::weld:
            return 6;
    }
    return 0;
}

Vector<double, 9> flat(Mat3 const& m) {
    Vector<double, 9> v;
    for (int i = 0; i < 9; ++i) v[i] = m.data[i];
    return v;
}

Vector<double, 6> inverse(Sym3 const& inertia) {
    Eigen::Matrix3d j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) j(a, b) = inertia(a, b);
    Eigen::Matrix3d const i = j.llt().solve(Eigen::Matrix3d::Identity());
    return {{i(0, 0), 0.5 * (i(1, 0) + i(0, 1)), i(1, 1), 0.5 * (i(2, 0) + i(0, 2)), 0.5 * (i(2, 1) + i(1, 2)), i(2, 2)}};
}

JointType joint_type(ChainSpec const& spec, std::int64_t body) {
    if (!spec.is_beads()) return spec.bodies.joint[body];
    return body == 0 && spec.base == Base::free ? JointType::free : JointType::link;
}

void fill_bead(ChainGroup& group, ChainSpec const& spec, std::int64_t body, std::int64_t k) {
    group.mass.set(k, {{spec.beads.mass[body]}});
    group.inverse_mass.set(k, {{1.0 / spec.beads.mass[body]}});
    group.length.set(k, {{spec.beads.length[body]}});
}

void fill_body(ChainGroup& group, ChainSpec const& spec, std::int64_t body, std::int64_t k) {
    BodyArrays const& b = spec.bodies;
    group.mass.set(k, {{b.mass[body]}});
    group.inverse_mass.set(k, {{1.0 / b.mass[body]}});
    Vector<double, 6> inertia;
    for (int i = 0; i < 6; ++i) inertia[i] = b.inertia[body].data[i];
    group.inertia.set(k, inertia);
    group.inverse_inertia.set(k, inverse(b.inertia[body]));
    group.r1.set(k, -b.com[body]);
    group.axes1.set(k, flat(joint_axes(b.joint[body], b.axis[body])));
    Quat const rotation = to_quaternion(b.rotation[body]);
    group.joint_rotation.set(k, {{rotation.w, rotation.x, rotation.y, rotation.z}});
    group.joint_translation.set(k, b.translation[body]);
    bool const last = body + 1 == static_cast<std::int64_t>(b.size());
    group.r2.set(k, last ? Vec3::zero() : b.translation[body + 1] - b.com[body]);
    group.axes2.set(k, flat(last ? Mat3::identity() : b.rotation[body + 1] * joint_axes(b.joint[body + 1], b.axis[body + 1])));
}

int directions_of(ChainGroup const& group) {
    if (group.handles == Handles::full) return group.beads ? 3 : 6;
    return group.beads ? 1 : group.has_revolute ? 5 : 3;
}

void allocate(ChainGroup& group) {
    std::int64_t const n = group.size;
    group.is_first.assign(n, 0);
    group.is_last.assign(n, 0);
    group.joint.assign(n, JointType::free);
    group.mass = Field<1>(n);
    group.inverse_mass = Field<1>(n);
    if (group.beads) {
        group.length = Field<1>(n);
        return;
    }
    group.inertia = Field<6>(n);
    group.inverse_inertia = Field<6>(n);
    group.r1 = Field<3>(n);
    group.r2 = Field<3>(n);
    group.axes1 = Field<9>(n);
    group.axes2 = Field<9>(n);
    group.joint_rotation = Field<4>(n);
    group.joint_translation = Field<3>(n);
}

void fill(ChainGroup& group, Scene const& scene) {
    for (dca::Piece const& piece : group.pieces) {
        ChainSpec const& spec = scene.chains[group.chain[piece.chain]];
        for (std::int64_t i = 0; i < piece.count; ++i) {
            std::int64_t const k = piece.local + i, body = piece.body + i;
            group.joint[k] = joint_type(spec, body);
            group.is_first[k] = body == 0;
            group.is_last[k] = body + 1 == static_cast<std::int64_t>(spec.size());
            group.beads ? fill_bead(group, spec, body, k) : fill_body(group, spec, body, k);
        }
    }
}

/// Joints at the boundaries of shared units are eliminated at the top, under another index: their local entries stay 0.
void fill_restricted(ChainGroup& group, Scene const& scene) {
    dca::Schedule const& s = group.schedule;
    group.restricted_of_joint.assign(static_cast<std::size_t>(s.joints), 0);
    for (std::int64_t k = 0; k < group.size; ++k)
        group.restricted_of_joint[k] = static_cast<std::uint8_t>(restricted_directions(group.joint[k]));
    for (std::size_t i = 0; i < s.top_chain_of_joint.size(); ++i)
        group.restricted_of_joint[s.first_top_joint() + static_cast<std::int64_t>(i)] = static_cast<std::uint8_t>(
            restricted_directions(joint_type(scene.chains[group.chain[s.top_chain_of_joint[i]]], s.top_body_of_joint[i])));
    for (dca::TopCopy const& copy : s.top_copies) group.restricted_of_joint[copy.to] = 0;
}

void find_neighbours(ChainGroup& group, int rank) {
    dca::Partition const& p = group.partition;
    std::int64_t const begin = p.first_of_rank[rank], end = p.first_of_rank[rank + 1];
    if (begin == end) return;
    if (!group.pieces.front().starts) group.neighbour_inboard = p.owner(begin - 1);
    if (!group.pieces.back().ends) group.neighbour_outboard = p.owner(end);
}

ChainGroup make_group(Scene const& scene, std::vector<int> const& chains, bool beads, Axes axes, Handles handles, bool pairwise,
                      Communicator const& communicator) {
    ChainGroup group;
    group.beads = beads;
    group.axes = beads ? Axes::world : axes;
    group.handles = handles;
    group.chain = chains;
    std::vector<std::int64_t> lengths;
    std::vector<std::int64_t> first_in_scene{0};
    for (ChainSpec const& spec : scene.chains) first_in_scene.push_back(first_in_scene.back() + static_cast<std::int64_t>(spec.size()));
    for (int const chain : chains) {
        lengths.push_back(static_cast<std::int64_t>(scene.chains[chain].size()));
        group.name.push_back(scene.chains[chain].name);
        group.base.push_back(scene.chains[chain].base);
        group.first_in_scene.push_back(first_in_scene[chain]);
        auto const& joints = scene.chains[chain].bodies.joint;
        group.has_revolute = group.has_revolute || std::find(joints.begin(), joints.end(), JointType::revolute) != joints.end();
    }
    group.directions = directions_of(group);
    group.partition = dca::Partition(lengths, group.directions, pairwise, communicator.size());
    group.pieces = dca::pieces_of(group.partition, communicator.rank());
    group.schedule = dca::make_schedule(group.partition, communicator.rank());
    group.size = group.schedule.bodies;
    allocate(group);
    fill(group, scene);
    fill_restricted(group, scene);
    find_neighbours(group, communicator.rank());
    return group;
}

}  // namespace

char const* ChainGroup::kind() const { return beads ? "link" : has_revolute ? "revolute" : "spherical"; }

std::int64_t ChainGroup::scene_index(std::int64_t k) const {
    auto const piece =
        std::upper_bound(pieces.begin(), pieces.end(), k, [](std::int64_t body, dca::Piece const& p) { return body < p.local; }) - 1;
    return first_in_scene[piece->chain] + piece->body + (k - piece->local);
}

std::vector<std::unique_ptr<ChainGroup>> make_groups(Scene const& scene, Axes axes, Handles handles, bool pairwise,
                                                     Communicator const& communicator) {
    std::vector<std::unique_ptr<ChainGroup>> groups;
    for (bool const beads : {true, false}) {
        std::vector<int> chains;
        for (std::size_t i = 0; i < scene.chains.size(); ++i)
            if (scene.chains[i].is_beads() == beads) chains.push_back(static_cast<int>(i));
        if (!chains.empty())
            groups.push_back(std::make_unique<ChainGroup>(make_group(scene, chains, beads, axes, handles, pairwise, communicator)));
    }
    return groups;
}

}  // namespace catena
