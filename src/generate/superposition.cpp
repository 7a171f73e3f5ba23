// Implements the superposition by the largest eigenvector of Horn's symmetric matrix.
#include "generate/superposition.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace catena::scene {

namespace {

Vec3 mean_of(std::span<Vec3 const> points) {
    // Sums relative to the first point keep their digits far from the origin.
    Vec3 sum = Vec3::zero();
    for (Vec3 const& point : points) sum = sum + (point - points[0]);
    return points[0] + (1 / static_cast<double>(points.size())) * sum;
}

}  // namespace

Superposition superpose(std::span<Vec3 const> shape, std::span<Vec3 const> target) {
    Vec3 const from = mean_of(shape), to = mean_of(target);
    Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < shape.size(); ++k)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) s(i, j) += (shape[k][i] - from[i]) * (target[k][j] - to[j]);
    Eigen::Matrix4d n;
    n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),
        s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),
        s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),
        s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> const solver(n);
    Eigen::Vector4d const q = solver.eigenvectors().col(3);
    Superposition found;
    found.rotation = normalized(Quat{q[0], q[1], q[2], q[3]});
    Mat3 const r = to_matrix(found.rotation);
    found.shift = to - r * from;
    for (std::size_t k = 0; k < shape.size(); ++k)
        found.largest = std::max(found.largest, norm(found.shift + r * shape[k] - target[k]));
    return found;
}

}  // namespace catena::scene
