// Implements the checks of inertia, rotations and directions.
#include "bodies/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Rounding error of a few products and sums, relative.
double constexpr rounding = 64 * std::numeric_limits<double>::epsilon();
/// Tolerance for numbers printed with seven digits.
double constexpr printed_digits = 1e-6;

double largest_entry(Mat3 const& m) {
    double largest = 0;
    for (double const entry : m.data) largest = std::max(largest, std::abs(entry));
    return largest;
}

/// Throws InputError with the fault, if any.
void refuse(Node const& node, std::optional<Fault> const& fault) {
    if (fault) fail(node, fault->what, fault->remedy);
}

/// Reads three numbers as a diagonal, or a 3x3 matrix.
Mat3 full_inertia(Node const& node) {
    if (node.kind == Node::Kind::list && node.items.size() == 3 &&
        node.items[0].kind != Node::Kind::list) {
        Vec3 const diagonal = vector3(node);
        return {{diagonal[0], 0, 0, 0, diagonal[1], 0, 0, 0, diagonal[2]}};
    }
    return matrix3(node);
}

/// True if the second moments of the mass, tr(J) / 2 - J, are positive definite with a margin. J
/// then is positive definite, and the triangle inequality holds. Sylvester's minors take a tenth of
/// the time of principal moments, which decide the remaining cases.
bool is_plainly_physical(Sym3 const& j) {
    double const half = 0.5 * (j(0, 0) + j(1, 1) + j(2, 2)), margin = 1e-9;
    double const a = (half - j(0, 0)) / half, b = (half - j(1, 1)) / half,
                 c = (half - j(2, 2)) / half;
    double const d = j(1, 0) / half, e = j(2, 0) / half, f = j(2, 1) / half;
    return half > 0 && a > margin && a * b - d * d > margin &&
           a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e) > margin;
}

/// One Jacobi rotation, which makes entry (p, q) zero.
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
    // Scaling prevents overflow and underflow of the squares.
    for (double& entry : a.data) entry /= scale;
    // Convergence is quadratic: six sweeps reduce any 3x3 matrix to rounding.
    for (int sweep = 0; sweep < 6; ++sweep) {
        rotate(a, 0, 1);
        rotate(a, 0, 2);
        rotate(a, 1, 2);
    }
    std::array<double, 3> moments{scale * a(0, 0), scale * a(1, 1), scale * a(2, 2)};
    std::sort(moments.begin(), moments.end());
    return moments;
}

std::optional<Fault> make_inertia(Mat3 const& m, Sym3& j) {
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) {
            if (std::abs(m(a, b) - m(b, a)) > rounding * largest_entry(m))
                return Fault{
                    fmt::format(
                        "the inertia is not symmetric: entries ({},{}) and ({},{}) are {} and {}",
                        b + 1, a + 1, a + 1, b + 1, m(b, a), m(a, b)),
                    "give both the same value"};
            j(a, b) = 0.5 * m(a, b) + 0.5 * m(b, a);
        }
    if (is_plainly_physical(j)) return std::nullopt;
    auto const [a, b, c] = principal_moments(j);
    // The tolerance is relative to the largest moment, as all entries are rounded on its scale.
    double const slack = rounding * std::max(std::abs(a), std::abs(c));
    if (a < -slack)
        return Fault{
            fmt::format(
                "the inertia is not positive definite: its smallest principal moment is {:.6g}", a),
            "check the signs: off-diagonal entries are minus the products of inertia"};
    if (a <= slack)
        return Fault{
            fmt::format("the inertia is singular: its principal moments are {:.6g}, {:.6g}, {:.6g}",
                        std::max(a, 0.0), std::max(b, 0.0), std::max(c, 0.0)),
            "give the point mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal"};
    if (a + b < c - slack)
        return Fault{fmt::format("the principal moments {:.6g}, {:.6g}, {:.6g} violate the "
                                 "triangle inequality of rigid bodies",
                                 a, b, c),
                     "the largest may not exceed the sum of the other two"};
    return std::nullopt;
}

std::optional<Fault> make_rotation(Mat3& r) {
    Mat3 const gram = transposed_times(r, r);
    double deviation = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            deviation = std::max(deviation, std::abs(gram(i, j) - (i == j ? 1 : 0)));
    if (!(deviation <= printed_digits))
        return Fault{fmt::format("the rotation is not orthonormal: R^T R differs from 1 by {:.3g}",
                                 deviation),
                     "give unit columns at right angles"};
    // Orthonormal columns have the determinant 1 or -1.
    if (dot(r.column(0), cross(r.column(1), r.column(2))) < 0)
        return Fault{"the rotation is left-handed: its determinant is -1",
                     "change the sign of one column"};
    // Newton's iteration for the nearest rotation, R (3 - R^T R) / 2. Convergence is quadratic, so
    // that two steps reduce 1e-6 below rounding.
    for (int step = 0; step < 2; ++step) {
        Mat3 correction = transposed_times(r, r);
        for (int i = 0; i < 9; ++i)
            correction.data[i] = 0.5 * ((i % 4 == 0 ? 3 : 0) - correction.data[i]);
        r = r * correction;
    }
    return std::nullopt;
}

std::optional<Fault> make_unit(std::array<double, 4>& q) {
    double const length = std::sqrt(squared_norm(Quat{q[0], q[1], q[2], q[3]}));
    if (!(std::abs(length - 1) <= printed_digits))
        return Fault{
            fmt::format("the quaternion is not a unit quaternion: its norm is {:.9g}", length),
            "normalise it: divide its four numbers by their norm"};
    for (double& x : q) x /= length;
    return std::nullopt;
}

std::optional<Fault> make_direction(Vec3& v) {
    // Scaling by the largest component prevents overflow and underflow of the norm.
    double const scale = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (scale == 0) return Fault{"the axis is zero", "give a direction such as [0, 0, 1]"};
    for (double& x : v.data) x /= scale;
    double const length = norm(v);
    // A vector that is a unit vector to rounding stays as written.
    v = std::abs(scale * length - 1) <= 4 * std::numeric_limits<double>::epsilon()
            ? scale * v
            : (1 / length) * v;
    return std::nullopt;
}

std::optional<Fault> check_two_axes(Vec3 const& first, Vec3 const& second) {
    if (norm(cross(first, second)) > printed_digits) return std::nullopt;
    return Fault{"the two axes are parallel",
                 "give two directions, best at right angles, or use a revolute joint"};
}

std::optional<Fault> check_plane(Vec3& along, Vec3 const& normal) {
    if (std::abs(dot(along, normal)) > printed_digits)
        return Fault{"the two axes are not perpendicular",
                     "give a direction in the plane, then its normal"};
    along = plus_scaled(along, -dot(along, normal), normal);
    along = (1 / norm(along)) * along;
    return std::nullopt;
}

Sym3 inertia(Node const& node) {
    Sym3 j;
    refuse(node, make_inertia(full_inertia(node), j));
    return j;
}

Mat3 rotation(Node const& node) {
    Mat3 r = matrix3(node);
    refuse(node, make_rotation(r));
    return r;
}

std::array<double, 4> unit_quaternion(Node const& node) {
    std::vector<double> const v = numbers(node, 4);
    std::array<double, 4> q{v[0], v[1], v[2], v[3]};
    refuse(node, make_unit(q));
    return q;
}

Vec3 direction(Node const& node) {
    Vec3 v = vector3(node);
    refuse(node, make_direction(v));
    return v;
}

}  // namespace catena::scene
