// Implements rigid domains: numbering of residues, inertia and principal axes.
#include "bodies/domains.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

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

/// One end of a domain as written.
struct DomainEnd {
    std::string chain;  // empty without a chain
    std::string label;
};

/// Resolves the residue numbers of a scene's `rigid`.
class Numbering {
  public:
    explicit Numbering(ResidueNumbers const& numbers) : numbers_(numbers) {
        for (std::size_t k = 0; k < numbers.labels.size(); ++k)
            beads_[numbers.labels[k]].push_back(k);
    }

    /// Advice for messages: the valid range of numbers.
    std::string remedy() const {
        if (numbers_.labels.empty())
            return fmt::format("give [first, last] with residues from 1 to {}, both included",
                               numbers_.residues);
        return fmt::format(
            "give [first, last] with the file's residue numbers, here {} to {}, both included",
            numbers_.labels.front(), numbers_.labels.back());
    }
    /// Reads one domain. Throws InputError for fewer than three residues.
    Domain domain(Node const& node) const {
        std::array<DomainEnd, 2> const ends = ends_of(node);
        Domain domain{bead(node, ends[0]), bead(node, ends[1])};
        std::string span =
            fmt::format("residues {} to {}", shown(ends[0].label), shown(ends[1].label));
        if (!ends[0].chain.empty()) span += " of chain " + shown(ends[0].chain);
        if (domain.last < domain.first + 2)
            fail(node,
                 span +
                     " do not form a rigid body, which needs three residues that do not lie on one "
                     "line",
                 remedy());
        domain.name = span;
        return domain;
    }

  private:
    std::array<DomainEnd, 2> ends_of(Node const& node) const {
        if (node.kind == Node::Kind::scalar) return ends_in(node);
        if (node.kind != Node::Kind::list || node.items.size() != 2)
            fail(node, describe(node) + " is not a pair of residues", remedy());
        return {{{"", label(node.items[0])}, {"", label(node.items[1])}}};
    }
    /// Reads "A:1-95". Numbers may be negative: "A:-3-10".
    std::array<DomainEnd, 2> ends_in(Node const& node) const {
        std::string const written = text(node);
        std::size_t const colon = written.rfind(':');
        std::string const chain = colon == std::string::npos ? "" : written.substr(0, colon);
        std::string const span = colon == std::string::npos ? written : written.substr(colon + 1);
        std::size_t const dash = span.find('-', 1);
        if (dash == std::string::npos || dash + 1 == span.size() || colon == 0)
            fail(node, describe(node) + " is not a range of residues",
                 "write CHAIN:FIRST-LAST, such as \"A:1-95\", or [1, 95]");
        return {{{chain, span.substr(0, dash)}, {chain, span.substr(dash + 1)}}};
    }
    /// True if the residue of bead k lies in the chain; every residue does if none is named.
    bool in_chain(std::size_t k, std::string const& chain) const {
        if (chain.empty()) return true;
        return k < numbers_.chains.size() &&
               (numbers_.chains[k][0] == chain || numbers_.chains[k][1] == chain);
    }
    /// Bead (from 0) of one end. Throws InputError for unknown and ambiguous numbers.
    std::size_t bead(Node const& node, DomainEnd const& end) const {
        if (numbers_.labels.empty()) return counted_bead(node, end);
        auto const known = beads_.find(end.label);
        std::vector<std::size_t> found;
        for (std::size_t const k : known == beads_.end() ? found : known->second)
            if (in_chain(k, end.chain)) found.push_back(k);
        if (found.empty())
            fail(node,
                 fmt::format("residue {}{} is not in the file", shown(end.label),
                             end.chain.empty() ? "" : " of chain " + shown(end.chain)),
                 remedy());
        if (found.size() > 1)
            fail(node,
                 fmt::format("{} residues of the file have the number {}", found.size(),
                             shown(end.label)),
                 several_chains() && end.chain.empty()
                     ? "name the chain, such as \"" + numbers_.chains[found[0]][0] + ":" +
                           end.label + "-...\""
                     : "give each residue its own number or insertion code");
        return found[0];
    }
    /// Bead of a number that counts residues from 1.
    std::size_t counted_bead(Node const& node, DomainEnd const& end) const {
        if (!end.chain.empty())
            fail(node, fmt::format("chain {} is no chain of a file", shown(end.chain)), remedy());
        double value = 0;
        bool const number = parse_number(end.label, value) == NumberFault::none &&
                            value == std::floor(value) && std::abs(value) < 1e15;
        if (!number) fail(node, fmt::format("`{}` is no residue", shown(end.label)), remedy());
        if (value < 1 || value > static_cast<double>(numbers_.residues))
            fail(node,
                 fmt::format("residue {} of a chain of {}", static_cast<std::int64_t>(value),
                             numbers_.residues),
                 remedy());
        return static_cast<std::size_t>(value) - 1;
    }
    bool several_chains() const {
        return std::any_of(numbers_.chains.begin(), numbers_.chains.end(),
                           [&](auto const& chain) { return chain != numbers_.chains[0]; });
    }
    /// Returns whole numbers in plain form ("7" for "7.0"), other labels as written. Without labels
    /// of a file the number must be a whole one from 1 on.
    std::string label(Node const& end) const {
        if (numbers_.labels.empty()) return std::to_string(whole(end, 1));
        double value = 0;
        std::string const written = text(end);
        bool const number = parse_number(written, value) == NumberFault::none &&
                            value == std::floor(value) && std::abs(value) < 1e15;
        return number ? std::to_string(static_cast<std::int64_t>(value)) : written;
    }

    ResidueNumbers const& numbers_;
    /// Beads of each label. A file may use a label more than once, which only matters if a domain
    /// names it.
    std::map<std::string, std::vector<std::size_t>> beads_;
};

}  // namespace

std::vector<Domain> read_domains(Node const& rigid, ResidueNumbers const& numbers) {
    Numbering const numbering(numbers);
    if (list(rigid).items.empty())
        fail(rigid, "the list of rigid domains is empty",
             "leave the key out or " + numbering.remedy());
    std::vector<Domain> domains;
    for (Node const& item : rigid.items) {
        Domain const domain = numbering.domain(item);
        for (Domain const& other : domains)
            if (domain.first <= other.last && other.first <= domain.last)
                fail(item,
                     fmt::format("{} overlap the domain{}", domain.name,
                                 other.name.substr(std::string("residues").size())),
                     "assign each residue to one domain");
        domains.push_back(domain);
    }
    std::sort(domains.begin(), domains.end(),
              [](Domain const& a, Domain const& b) { return a.first < b.first; });
    return domains;
}

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
