// Number of directions that a tip's joint restricts, from the dense Jacobian of its closure.
#pragma once

#include <Eigen/Dense>

#include "joints/joint_models.hpp"
#include "oracle/joint.hpp"

namespace catena::test {

/// Returns the rank of the closure's Jacobian: velocities of the tip's joint along its locked
/// directions, per unit of each coordinate. Joints with prescribed motion have none.
inline int closure_rank(ChainSpec const& chain, oracle::Loads const& loads = {}) {
    auto const links = oracle::read_links<double>(chain, loads);
    auto const attitude = oracle::attitudes(links);
    auto const tip = oracle::read_tip(chain, links, attitude);
    Vec3 const at =
        attitude.back().origin + attitude.back().orientation * links.back().com + tip.arm;
    auto const rows = static_cast<Eigen::Index>(tip.locked.size());
    Eigen::MatrixXd jacobian(rows, 0);
    auto const add = [&](std::size_t k, Vec3 const& angular, Vec3 const& linear) {
        Vec3 const there = linear + cross(angular, at - attitude[k].origin);
        jacobian.conservativeResize(Eigen::NoChange, jacobian.cols() + 1);
        for (Eigen::Index i = 0; i < rows; ++i) {
            auto const& locked = tip.locked[static_cast<std::size_t>(i)];
            jacobian(i, jacobian.cols() - 1) =
                dot(locked.angular, angular) + dot(locked.linear, there);
        }
    };
    for (std::size_t k = chain.is_ring() ? 1 : 0; k < links.size(); ++k) {
        Mat3 const& axes = attitude[k].orientation;
        for (int i = 0; i < links[k].unknown(); ++i) {
            auto const& free = links[k].free[static_cast<std::size_t>(i)];
            add(k, axes * free.angular, axes * free.linear);
        }
        for (int i = 0; i < 3 && floats(links[k].type); ++i)
            add(k, Vec3::zero(), rotations[static_cast<std::size_t>(i)].angular);
    }
    if (jacobian.size() == 0) return 0;
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian);
    svd.setThreshold(1e-9);
    double const largest = svd.singularValues()[0];
    return largest > 1e-12 ? static_cast<int>(svd.rank()) : 0;
}

}  // namespace catena::test
