#include "scene/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/fields.hpp"

namespace catena::scene {

namespace {

double constexpr rounding = 64 * std::numeric_limits<double>::epsilon();
double constexpr printed_digits = 1e-6;

double largest_entry(Mat3 const& m) {
    double largest = 0;
    for (double const entry : m.data) largest = std::max(largest, std::abs(entry));
    return largest;
}

Mat3 full_inertia(Node const& node) {
    if (node.kind == Node::Kind::list && node.items.size() == 3 && node.items[0].kind != Node::Kind::list) {
        Vec3 const diagonal = vector3(node);
        return {{diagonal[0], 0, 0, 0, diagonal[1], 0, 0, 0, diagonal[2]}};
    }
    return matrix3(node);
}

Sym3 symmetric(Node const& node, Mat3 const& m) {
    Sym3 j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) {
            if (std::abs(m(a, b) - m(b, a)) > rounding * largest_entry(m))
                fail(node,
                     fmt::format("the inertia is not symmetric: entries ({},{}) and ({},{}) are {} and {}", b + 1, a + 1, a + 1, b + 1,
                                 m(b, a), m(a, b)),
                     "give both the same value");
            j(a, b) = 0.5 * m(a, b) + 0.5 * m(b, a);
        }
    return j;
}

/// One Jacobi rotation that makes entry (p, q) zero.
void rotate(Mat3& a, int p, int q) {
    if (a(p, q) == 0) return;
    double const theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
    double const t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(theta, 1.0));
    double const c = 1 / std::hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 3; ++k) {
        double const x = a(k, p), y = a(k, q);
        a(k, p) = c * x - s * y;
        a(k, q) = s * x + c * y;
    }
    for (int k = 0; k < 3; ++k) {
        double const x = a(p, k), y = a(q, k);
        a(p, k) = c * x - s * y;
        a(q, k) = s * x + c * y;
    }
}

}  // namespace

std::array<double, 3> principal_moments(Sym3 const& j) {
    Mat3 a = full(j);
    double const scale = largest_entry(a);
    if (scale == 0) return {0, 0, 0};
    for (double& entry : a.data) entry /= scale;
    // Quadratic convergence: six sweeps take a 3x3 matrix to rounding from anywhere.
    for (int sweep = 0; sweep < 6; ++sweep) {
        rotate(a, 0, 1);
        rotate(a, 0, 2);
        rotate(a, 1, 2);
    }
    std::array<double, 3> moments{scale * a(0, 0), scale * a(1, 1), scale * a(2, 2)};
    std::sort(moments.begin(), moments.end());
    return moments;
}

Sym3 inertia(Node const& node) {
    Sym3 const j = symmetric(node, full_inertia(node));
    auto const [a, b, c] = principal_moments(j);
    double const slack = rounding * std::max(std::abs(a), std::abs(c));
    if (a < -slack)
        fail(node, fmt::format("the inertia is not positive definite: its smallest principal moment is {:.6g}", a),
             "check the signs: off-diagonal entries are minus the products of inertia");
    if (a <= slack)
        fail(node,
             fmt::format("the inertia is singular: its principal moments are {:.6g}, {:.6g}, {:.6g}", std::max(a, 0.0), std::max(b, 0.0),
                         std::max(c, 0.0)),
             "give the point mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal");
    if (a + b < c - slack)
        fail(node,
             fmt::format("no rigid body has the principal moments {:.6g}, {:.6g}, {:.6g}: they break the triangle inequality", a, b, c),
             "the largest may not exceed the sum of the other two");
    return j;
}

Mat3 rotation(Node const& node) {
    Mat3 r = matrix3(node);
    Mat3 const gram = transposed_times(r, r);
    double deviation = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) deviation = std::max(deviation, std::abs(gram(i, j) - (i == j ? 1 : 0)));
    if (!(deviation <= printed_digits))
        fail(node, fmt::format("the rotation is not orthonormal: R^T R differs from 1 by {:.3g}", deviation),
             "give unit columns at right angles");
    if (dot(r.column(0), cross(r.column(1), r.column(2))) < 0)
        fail(node, "the rotation is left-handed: its determinant is -1", "change the sign of one column");
    // Newton's iteration for the nearest rotation, R (3 - R^T R) / 2: quadratic, so that two steps take 1e-6 below rounding.
    for (int step = 0; step < 2; ++step) {
        Mat3 correction = transposed_times(r, r);
        for (int i = 0; i < 9; ++i) correction.data[i] = 0.5 * ((i % 4 == 0 ? 3 : 0) - correction.data[i]);
        r = r * correction;
    }
    return r;
}

std::array<double, 4> unit_quaternion(Node const& node) {
    std::vector<double> const v = numbers(node, 4);
    Quat const q{v[0], v[1], v[2], v[3]};
    double const length = std::sqrt(squared_norm(q));
    if (!(std::abs(length - 1) <= printed_digits))
        fail(node, fmt::format("the quaternion is not a unit quaternion: its norm is {:.9g}", length),
             "normalise it: divide its four numbers by their norm");
    return {v[0] / length, v[1] / length, v[2] / length, v[3] / length};
}

Vec3 direction(Node const& node) {
    Vec3 v = vector3(node);
    double const scale = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (scale == 0) fail(node, "the axis is zero", "give a direction such as [0, 0, 1]");
    for (double& x : v.data) x /= scale;
    double const length = norm(v);
    // A vector that is a unit vector to rounding stays as it was written.
    if (std::abs(scale * length - 1) <= 4 * std::numeric_limits<double>::epsilon()) return scale * v;
    return (1 / length) * v;
}

}  // namespace catena::scene
