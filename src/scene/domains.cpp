#include "scene/domains.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "scene/carried_beads.hpp"

namespace catena::scene {

namespace {

/// Below this ratio of principal moments the beads stand on a line as far as positions with a few digits can tell.
double constexpr least_ratio = 1e-6;

struct RigidBody {
    double mass = 0;
    Vec3 com = Vec3::zero(), moments = Vec3::zero();
    Mat3 axes = Mat3::identity();  // R_WB: principal axes as columns
};

RigidBody body_of(BeadArrays const& beads, Domain const& domain) {
    RigidBody body;
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
        inertia += beads.mass[k] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) *= -1;
    for (int i = 0; i < 3; ++i) {
        body.moments[i] = solver.eigenvalues()[i];
        for (int j = 0; j < 3; ++j) body.axes(i, j) = axes(i, j);
    }
    return body;
}

class LinkedBuilder {
  public:
    explicit LinkedBuilder(BeadArrays const& beads) : beads_(beads) { linked_.anchor = beads.anchor; }

    void add_bead(std::size_t k) {
        add(k, beads_.mass[k], beads_.position[k], beads_.velocity[k]);
        linked_.inertia.push_back(Sym3::zero());
        linked_.orientation.push_back({1, 0, 0, 0});
        linked_.inboard.push_back(Vec3::zero());
        linked_.outboard.push_back(Vec3::zero());
        carried_.append(Vec3::zero(), beads_.mass[k], beads_.residue[k]);
        carried_.close();
    }

    void add_domain(Domain const& domain, Node const& node) {
        RigidBody const body = body_of(beads_, domain);
        if (!(body.moments[0] > least_ratio * body.moments[2]))
            fail(node, fmt::format("the beads of residues {} to {} stand on one line: a thin rod", domain.first + 1, domain.last + 1),
                 "take in a residue beside it, or leave the domain out");
        add(domain.first, body.mass, body.com, Vec3::zero());
        linked_.inertia.push_back(Sym3{{body.moments[0], 0, body.moments[1], 0, 0, body.moments[2]}});
        Quat const q = to_quaternion(body.axes);
        linked_.orientation.push_back({q.w, q.x, q.y, q.z});
        Mat3 const r = to_matrix(q);
        auto const inside = [&](std::size_t k) { return transposed_times(r, beads_.position[k] - body.com); };
        linked_.inboard.push_back(inside(domain.first));
        linked_.outboard.push_back(inside(domain.last));
        for (std::size_t k = domain.first; k <= domain.last; ++k) carried_.append(inside(k), beads_.mass[k], beads_.residue[k]);
        carried_.close();
    }

    LinkedArrays take() {
        linked_.carried = carried_.take();
        return std::move(linked_);
    }

  private:
    void add(std::size_t k, double mass, Vec3 const& position, Vec3 const& velocity) {
        linked_.mass.push_back(mass);
        linked_.position.push_back(position);
        linked_.velocity.push_back(velocity);
        linked_.omega.push_back(Vec3::zero());
        linked_.length.push_back(beads_.length[k]);
    }

    BeadArrays const& beads_;
    LinkedArrays linked_;
    CarriedList carried_;
};

}  // namespace

std::vector<Domain> read_domains(Node const& rigid, std::size_t residues) {
    std::string const remedy = fmt::format("give [first, last] with residues from 1 to {}, both included", residues);
    if (list(rigid).items.empty()) fail(rigid, "the list of rigid domains is empty", "leave the key out or " + remedy);
    std::vector<Domain> domains;
    for (Node const& item : rigid.items) {
        if (item.kind != Node::Kind::list || item.items.size() != 2) fail(item, describe(item) + " is not a pair of residues", remedy);
        std::int64_t const first = whole(item.items[0], 1), last = whole(item.items[1], 1);
        if (last > static_cast<std::int64_t>(residues)) fail(item, fmt::format("residue {} of a chain of {}", last, residues), remedy);
        if (last < first + 2)
            fail(item, fmt::format("residues {} to {} are no rigid body: it needs three that do not stand on one line", first, last),
                 remedy);
        Domain const domain{static_cast<std::size_t>(first - 1), static_cast<std::size_t>(last - 1)};
        for (Domain const& other : domains)
            if (domain.first <= other.last && other.first <= domain.last)
                fail(item, fmt::format("residues {} to {} overlap the domain {} to {}", first, last, other.first + 1, other.last + 1),
                     "give each residue to one domain");
        domains.push_back(domain);
    }
    std::sort(domains.begin(), domains.end(), [](Domain const& a, Domain const& b) { return a.first < b.first; });
    return domains;
}

LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains, Node const& rigid) {
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
