// Implements the rank of the Jacobian of loops.
#include "scene/loops.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "joints/joint_models.hpp"
#include "scene/branches.hpp"

namespace catena::scene {

namespace {

using Six = Eigen::Matrix<double, 6, 1>;

/// Square root of the eigenvalue below which the solver drops a direction (SemidefiniteSystem).
double constexpr negligible = 0x1p-16 * 0.70710678118654752440;

/// Twist at a point `from` the joint frame's origin, lengths in units of `length`.
Six numbers_of(Mat3 const& axes, Twist const& twist, Vec3 const& from, double length) {
    Vec3 const angular = axes * twist.angular,
               linear = (1 / length) * (axes * twist.linear + cross(angular, from));
    Six all;
    all << angular[0], angular[1], angular[2], linear[0], linear[1], linear[2];
    return all;
}

/// Bodies between the ground and a body, that body first.
std::vector<std::size_t> way_of(ChainSpec const& chain, std::int64_t body) {
    std::vector<std::size_t> way;
    for (std::int64_t k = body; k >= 0;) {
        auto const at = static_cast<std::size_t>(k);
        way.push_back(at);
        k = k == 0 ? -1 : static_cast<std::int64_t>(inboard_of(chain.parent, at));
    }
    return way;
}

/// The Jacobian of all loops, row by row; columns are the coordinates of joints that no motion
/// drives.
class LoopJacobian {
  public:
    explicit LoopJacobian(ChainSpec const& chain) : chain_(chain), poses_(start_poses(chain)) {
        std::vector<bool> driven(chain.size());
        for (DrivenJoint const& joint : chain.bodies.driven)
            driven[static_cast<std::size_t>(joint.body)] = true;
        for (std::size_t k = 0; k < chain.size(); ++k) {
            first_column_.push_back(columns_);
            columns_ += driven[k] ? 0 : freedom_of(chain.bodies.joint[k]);
            is_driven_.push_back(driven[k]);
        }
    }

    std::int64_t rank() {
        matrix_ = Eigen::MatrixXd::Zero(directions_of_loops(chain_), columns_);
        Eigen::Index row = 0;
        for (LoopClosure const& loop : chain_.loops) row = add(loop, row);
        if (matrix_.size() == 0) return 0;
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
        qr.setThreshold(negligible);
        return qr.compute(matrix_).rank();
    }

  private:
    /// Returns the joint frame of body k, W.
    Pose frame_of(std::size_t k) const {
        if (floats(chain_.bodies.joint[k])) return {Quat::identity(), poses_[k].origin};
        Pose const inboard = k == 0 ? Pose{} : poses_[inboard_of(chain_.parent, k)];
        return inboard *
               Pose{to_quaternion(chain_.bodies.rotation[k]), chain_.bodies.translation[k]};
    }
    /// Returns the twists of joint k at point `p`, a column per coordinate.
    Eigen::MatrixXd twists_of(std::size_t k, Vec3 const& p, double length) const {
        BodyArrays const& b = chain_.bodies;
        Pose const frame = frame_of(k);
        Mat3 const axes = to_matrix(frame.orientation);
        Vec3 const first = b.first_axis.empty() ? Vec3::zero() : b.first_axis[k];
        return twists(b.joint[k], {b.axis[k], first, b.pitch.empty() ? 0 : b.pitch[k]}, b.q[k],
                      axes, p - frame.origin, length);
    }
    static Eigen::MatrixXd twists(JointType type, JointShape const& shape,
                                  std::array<double, 4> const& q, Mat3 const& axes,
                                  Vec3 const& from, double length) {
        Eigen::MatrixXd columns(6, freedom_of(type));
        Eigen::Index next = 0;
        with_joint(type, [&](auto model) {
            for (Twist const& t : decltype(model)::twists(shape, q))
                columns.col(next++) = numbers_of(axes, t, from, length);
            return true;
        });
        return columns;
    }
    /// Bodies whose joints move the ends of a loop against each other, with the sign of each.
    std::vector<std::pair<std::size_t, double>> joints_of(LoopClosure const& loop) const {
        std::vector<std::size_t> in = way_of(chain_, loop.inboard),
                                 out = way_of(chain_, loop.outboard);
        while (!in.empty() && !out.empty() && in.back() == out.back())
            in.pop_back(), out.pop_back();
        std::vector<std::pair<std::size_t, double>> joints;
        for (std::size_t const k : out) joints.emplace_back(k, 1.0);
        for (std::size_t const k : in) joints.emplace_back(k, -1.0);
        return joints;
    }
    /// Adds the rows of a loop from `row` on; returns the next row.
    Eigen::Index add(LoopClosure const& loop, Eigen::Index row) {
        Pose const at = held_frame(poses_, loop);
        auto const joints = joints_of(loop);
        double length = 0;
        for (auto const& [k, sign] : joints)
            length = std::max(length, norm(at.origin - frame_of(k).origin));
        if (!(length > 0)) length = 1;
        Pose const frame = pose_at(poses_, loop.inboard) *
                           Pose{to_quaternion(loop.joint.rotation), loop.joint.translation};
        Eigen::MatrixXd const own =
            twists(loop.joint.type, {loop.joint.axis, loop.joint.first_axis, loop.joint.pitch},
                   loop.joint.q, to_matrix(frame.orientation), at.origin - frame.origin, length);
        // The restricted directions are those across the joint's own motions.
        Eigen::MatrixXd all = Eigen::MatrixXd::Identity(6, 6);
        if (own.cols() > 0) all = Eigen::HouseholderQR<Eigen::MatrixXd>(own).householderQ() * all;
        Eigen::Index const restricted = restricted_by(loop.joint.type);
        Eigen::MatrixXd const across = all.rightCols(restricted).transpose();
        for (auto const& [k, sign] : joints) {
            if (is_driven_[k]) continue;
            Eigen::MatrixXd const moved = sign * (across * twists_of(k, at.origin, length));
            matrix_.block(row, first_column_[k], restricted, moved.cols()) = moved;
        }
        return row + restricted;
    }
    ChainSpec const& chain_;
    std::vector<Pose> poses_;
    std::vector<Eigen::Index> first_column_;
    std::vector<bool> is_driven_;
    Eigen::Index columns_ = 0;
    Eigen::MatrixXd matrix_;
};

}  // namespace

std::vector<Pose> start_poses(ChainSpec const& chain) {
    std::vector<Pose> poses;
    for (std::size_t k = 0; k < chain.bodies.size(); ++k)
        poses.push_back(
            next_pose(chain.bodies, k, k == 0 ? Pose{} : poses[inboard_of(chain.parent, k)]));
    return poses;
}

Pose pose_at(std::vector<Pose> const& poses, std::int64_t body) {
    return body == LoopClosure::ground ? Pose{} : poses[static_cast<std::size_t>(body)];
}

Pose held_frame(std::vector<Pose> const& poses, LoopClosure const& loop) {
    TipJoint const& j = loop.joint;
    return pose_at(poses, loop.inboard) * Pose{to_quaternion(j.rotation), j.translation} *
           joint_motion(j.type, j.axis, j.first_axis, j.pitch, j.q);
}

std::int64_t directions_of_loops(ChainSpec const& chain) {
    std::int64_t sum = 0;
    for (LoopClosure const& loop : chain.loops) sum += restricted_by(loop.joint.type);
    return sum;
}

std::int64_t redundant_directions(ChainSpec const& chain) {
    return chain.has_loops() ? directions_of_loops(chain) - LoopJacobian(chain).rank() : 0;
}

std::int64_t redundant_nearby(ChainSpec chain) {
    double constexpr turned = 0.05;
    double extent = 0;
    for (Vec3 const& translation : chain.bodies.translation)
        extent = std::max(extent, norm(translation));
    int number = 0;
    for (std::size_t k = 0; k < chain.bodies.size(); ++k) {
        JointType const type = chain.bodies.joint[k];
        if (floats(type)) continue;
        std::array<double, 4>& q = chain.bodies.q[k];
        double const change = turned * (slides(type) && extent > 0 ? extent : 1);
        for (int i = 0; i < (is_ball(type) ? 4 : freedom_of(type)); ++i)
            q[static_cast<std::size_t>(i)] += change * std::sin(1.0 + 2.4 * ++number);
        if (!is_ball(type)) continue;
        double const size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (double& each : q) each /= size;
    }
    return redundant_directions(chain);
}

}  // namespace catena::scene
