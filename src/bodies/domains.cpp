// Implements rigid domains: inertia and principal axes.
#include "bodies/domains.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "bodies/carried_beads.hpp"

namespace catena::scene {

namespace {

/// Smallest ratio of principal moments. Below it the beads lie on one line within the precision of
/// positions with a few digits.
double constexpr least_ratio = 1e-6;

/// Mass properties of a domain.
struct RigidBody {
    double mass = 0;
    /// Centre of mass, W, and principal moments in ascending order.
    Vec3 com = Vec3::zero(), moments = Vec3::zero();
    /// R_WB, with the principal axes as columns.
    Mat3 axes = Mat3::identity();
};

/// Computes mass, centre of mass and principal moments of the domain's beads.
RigidBody body_of(BeadArrays const& beads, Domain const& domain) {
    RigidBody body;
    // Sums relative to the first bead keep their digits far from the origin.
    Vec3 const origin = beads.position[domain.first];
    for (std::size_t k = domain.first; k <= domain.last; ++k) {
        body.mass += beads.mass[k];
        body.com = plus_scaled(body.com, beads.mass[k], beads.position[k] - origin);
    }
    body.com = origin + (1 / body.mass) * body.com;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (std::size_t k = domain.first; k <= domain.last; ++k) {
        Vec3 const p = beads.position[k] - body.com;
        Eigen::Vector3d const r(p[0], p[1], p[2]);
        inertia +=
            beads.mass[k] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    // Eigenvectors may form a left-handed system; body axes must be right-handed.
    if (axes.determinant() < 0) axes.col(2) *= -1;
    for (int i = 0; i < 3; ++i) {
        body.moments[i] = solver.eigenvalues()[i];
        for (int j = 0; j < 3; ++j) body.axes(i, j) = axes(i, j);
    }
    return body;
}

/// Builds a linked chain from beads and domains, in the order of the chain.
class LinkedBuilder {
  public:
    /// Builder for the chain of `beads`; a fixed base keeps its anchor.
    explicit LinkedBuilder(BeadArrays const& beads) : beads_(beads) {
        linked_.anchor = beads.anchor;
    }

    /// Adds bead k as a point that carries itself.
    void add_bead(std::size_t k) {
        add(k, beads_.mass[k], beads_.position[k], beads_.velocity[k]);
        linked_.inertia.push_back(Sym3::zero());
        linked_.orientation.push_back({1, 0, 0, 0});
        linked_.inboard.push_back(Vec3::zero());
        linked_.outboard.push_back(Vec3::zero());
        carried_.append(Vec3::zero(), beads_.mass[k], beads_.residue[k]);
        carried_.close();
    }

    /// Adds a domain as one rigid body, at rest. Throws InputError for beads on one line, whose
    /// smallest principal moment vanishes.
    void add_domain(Domain const& domain, Node const& node) {
        RigidBody const body = body_of(beads_, domain);
        if (!(body.moments[0] > least_ratio * body.moments[2]))
            fail(node,
                 fmt::format("the beads of {} lie on one line and form a thin rod", domain.name),
                 "include a residue next to it, or leave the domain out");
        add(domain.first, body.mass, body.com, Vec3::zero());
        linked_.inertia.push_back(
            Sym3{{body.moments[0], 0, body.moments[1], 0, 0, body.moments[2]}});
        Quat const q = to_quaternion(body.axes);
        linked_.orientation.push_back({q.w, q.x, q.y, q.z});
        Mat3 const r = to_matrix(q);
        auto const inside = [&](std::size_t k) {
            return transposed_times(r, beads_.position[k] - body.com);
        };
        linked_.inboard.push_back(inside(domain.first));
        linked_.outboard.push_back(inside(domain.last));
        for (std::size_t k = domain.first; k <= domain.last; ++k)
            carried_.append(inside(k), beads_.mass[k], beads_.residue[k]);
        carried_.close();
    }

    LinkedArrays take() {
        linked_.carried = carried_.take();
        return std::move(linked_);
    }

  private:
    /// Adds the entries that beads and domains share. The inboard link is that of bead k.
    void add(std::size_t k, double mass, Vec3 const& position, Vec3 const& velocity) {
        linked_.mass.push_back(mass);
        linked_.position.push_back(position);
        linked_.velocity.push_back(velocity);
        linked_.omega.push_back(Vec3::zero());
        linked_.length.push_back(beads_.length[k]);
    }

    BeadArrays const& beads_;
    /// Arrays of the chain so far.
    LinkedArrays linked_;
    /// Beads carried by its bodies so far.
    CarriedList carried_;
};

}  // namespace

LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains,
                          Node const& rigid) {
    LinkedBuilder builder(beads);
    auto next = domains.begin();
    for (std::size_t k = 0; k < beads.size(); ++k) {
        if (next == domains.end() || k < next->first) {
            builder.add_bead(k);
            continue;
        }
        builder.add_domain(*next, rigid);
        k = next->last;
        ++next;
    }
    return builder.take();
}

}  // namespace catena::scene
