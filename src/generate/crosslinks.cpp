// Implements all of it by Newton's iteration on the links of a tree of beads of equal weight, whose
// system is eliminated bead by bead, and on the Schur complement of the cross-links.
#include "generate/crosslinks.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "generate/random.hpp"
#include "generate/start_fit.hpp"
#include "math/semidefinite.hpp"
#include "scene/branches.hpp"

namespace catena::scene {
namespace {

using Point = Eigen::Vector3d;
using Points = std::vector<Point>;

Point point(Vec3 const& v) { return {v[0], v[1], v[2]}; }

/// A link with its direction and the length that it lacks.
struct Link {
    Point along = Point::Zero();
    double missing = 0;
    /// True if that exceeds rounding.
    bool wrong = false;
};

Link link_between(Point const& from, Point const& to, double length) {
    Point const d = to - from;
    double const distance = d.norm();
    double const rounding =
        1e-13 * length + 4 * std::numeric_limits<double>::epsilon() * from.norm();
    return {distance > 0 ? Point(d / distance) : Point::UnitX(), length - distance,
            !(std::abs(length - distance) <= rounding)};
}

/// The links of a chain at some positions, and the displacements of its beads under forces.
class EvenChain {
  public:
    /// `lengths`: those of the cross-links.
    EvenChain(ChainSpec const& chain, Points const& at, std::vector<double> const& lengths)
        : chain_(chain), links_(at.size()), yield_(at.size()), mass_(at.size(), 0) {
        for (std::size_t k = first(); k < at.size(); ++k)
            links_[k] = link_between(k == 0 ? point(chain.beads.anchor) : at[inboard(k)], at[k],
                                     chain.beads.length[k]);
        for (std::size_t c = 0; c < chain.crosslinks.size(); ++c)
            crosslinks_.push_back(link_between(
                at[static_cast<std::size_t>(chain.crosslinks[c].inboard)],
                at[static_cast<std::size_t>(chain.crosslinks[c].outboard)], lengths[c]));
        eliminate();
        is_definite_ = factorize();
    }

    bool has_all_lengths() const {
        for (Link const& link : links_)
            if (link.wrong) return false;
        for (Link const& link : crosslinks_)
            if (link.wrong) return false;
        return true;
    }
    bool is_definite() const { return is_definite_; }
    std::int64_t redundant() const { return system_.unknowns() - system_.rank(); }
    /// Returns the displacements that close all links to first order.
    Points closing() const {
        Points push(links_.size(), Point::Zero());
        Points const open = displaced(push, true);
        Eigen::VectorXd missing(std::ssize(crosslinks_));
        for (Eigen::Index c = 0; c < missing.size(); ++c)
            missing[c] = crosslinks_[static_cast<std::size_t>(c)].missing - apart(c, open);
        Eigen::VectorXd const force = system_.solve(missing);
        for (Eigen::Index c = 0; c < missing.size(); ++c) add(c, force[c], push);
        return displaced(push, true);
    }

  private:
    std::size_t first() const { return chain_.base == Base::fixed ? 0 : 1; }
    std::size_t inboard(std::size_t k) const { return inboard_of(chain_.parent, k); }
    CrossLink const& ends(Eigen::Index c) const {
        return chain_.crosslinks[static_cast<std::size_t>(c)];
    }
    double apart(Eigen::Index c, Points const& by) const {
        return crosslinks_[static_cast<std::size_t>(c)].along.dot(
            by[static_cast<std::size_t>(ends(c).outboard)] -
            by[static_cast<std::size_t>(ends(c).inboard)]);
    }
    void add(Eigen::Index c, double force, Points& push) const {
        Point const f = force * crosslinks_[static_cast<std::size_t>(c)].along;
        push[static_cast<std::size_t>(ends(c).outboard)] += f;
        push[static_cast<std::size_t>(ends(c).inboard)] -= f;
    }
    /// Computes how each bead, with all that hangs on it, yields to a force.
    void eliminate() {
        std::vector<Eigen::Matrix3d> weight(links_.size(), Eigen::Matrix3d::Identity());
        for (std::size_t k = links_.size(); k-- > 0;) {
            yield_[k] = weight[k].llt().solve(Eigen::Matrix3d::Identity());
            if (k < first()) continue;
            Point const& u = links_[k].along;
            mass_[k] = 1 / u.dot(yield_[k] * u);
            if (k > 0) weight[inboard(k)] += mass_[k] * u * u.transpose();
        }
    }
    /// Displacements under forces. With `gaps`, links change by what they lack.
    Points displaced(Points push, bool gaps) const {
        Points by(links_.size());
        std::vector<double> drive(links_.size(), 0);
        for (std::size_t k = links_.size(); k-- > first();) {
            Point const& u = links_[k].along;
            drive[k] = (gaps ? links_[k].missing : 0) - u.dot(yield_[k] * push[k]);
            if (k > 0) push[inboard(k)] -= mass_[k] * drive[k] * u;
        }
        for (std::size_t k = 0; k < links_.size(); ++k) {
            Point const& u = links_[k].along;
            double const before = k > 0 ? u.dot(by[inboard(k)]) : 0;
            by[k] = yield_[k] * (push[k] + mass_[k] * (drive[k] + before) * u);
        }
        return by;
    }
    /// Factorises the system of the cross-links.
    bool factorize() {
        auto const count = std::ssize(crosslinks_);
        Eigen::MatrixXd matrix(count, count);
        for (Eigen::Index column = 0; column < count; ++column) {
            Points push(links_.size(), Point::Zero());
            add(column, 1, push);
            Points const by = displaced(std::move(push), false);
            for (Eigen::Index row = 0; row < count; ++row) matrix(row, column) = apart(row, by);
        }
        double constexpr of_free_beads = 2;
        return system_.factorize(0.5 * (matrix + matrix.transpose()),
                                 Eigen::VectorXd::Constant(count, of_free_beads));
    }

    ChainSpec const& chain_;
    std::vector<Link> links_, crosslinks_;
    std::vector<Eigen::Matrix3d> yield_;
    std::vector<double> mass_;
    SemidefiniteSystem system_;
    bool is_definite_ = false;
};

Points points_of(std::vector<Vec3> const& positions) {
    Points at;
    for (Vec3 const& each : positions) at.push_back(point(each));
    return at;
}
void take(Points const& at, std::vector<Vec3>& positions) {
    for (std::size_t k = 0; k < at.size(); ++k) positions[k] = {{at[k][0], at[k][1], at[k][2]}};
}

/// Returns the chain with its beads a little elsewhere, at places that are not special.
ChainSpec shaken(ChainSpec chain) {
    double constexpr way = 0.01;  // of a link
    double longest = 0;
    for (double const length : chain.beads.length) longest = std::max(longest, length);
    Draws draws(1, 0);
    for (Vec3& each : chain.beads.position) each = each + draws.in_cube(way * longest);
    return chain;
}

/// Gives all links their lengths by Newton's iteration; false if it does not converge.
bool project(ChainSpec const& chain, std::vector<double> const& lengths, Points& at) {
    int constexpr most_sweeps = 30;
    for (int sweep = 0; sweep <= most_sweeps; ++sweep) {
        EvenChain const links(chain, at, lengths);
        if (links.has_all_lengths()) return true;
        if (!links.is_definite()) return false;
        Points const by = links.closing();
        for (std::size_t k = 0; k < at.size(); ++k) at[k] += by[k];
    }
    return false;
}

double distance_of(CrossLink const& link, std::vector<Vec3> const& at) {
    return norm(at[static_cast<std::size_t>(link.outboard)] -
                at[static_cast<std::size_t>(link.inboard)]);
}

std::vector<double> lengths_of(ChainSpec const& chain) {
    std::vector<double> lengths;
    for (CrossLink const& link : chain.crosslinks) lengths.push_back(link.length);
    return lengths;
}

/// Moves the beads until cross-links have their lengths. Those that change much change in steps.
bool close_in_steps(ChainSpec const& chain, std::vector<Vec3>& positions) {
    double constexpr step = 0.25;  // of the longest link, for the cross-link that changes most
    Points at = points_of(positions);
    double longest = 0, furthest = 0;
    for (double const length : chain.beads.length) longest = std::max(longest, length);
    std::vector<double> start;
    for (CrossLink const& link : chain.crosslinks) {
        start.push_back(distance_of(link, positions));
        furthest = std::max(furthest, std::abs(start.back() - link.length));
    }
    int const steps = 1 + static_cast<int>(furthest / (step * longest));
    for (int s = 1; s <= steps; ++s) {
        std::vector<double> lengths = lengths_of(chain);
        for (std::size_t c = 0; s < steps && c < lengths.size(); ++c)
            lengths[c] = start[c] + (lengths[c] - start[c]) * s / steps;
        if (!project(chain, lengths, at)) return false;
    }
    take(at, positions);
    return true;
}

std::string ends_text(ChainSpec const& chain, CrossLink const& link) {
    return fmt::format("beads {} and {} of chain `{}`", link.inboard + 1, link.outboard + 1,
                       shown(chain.name));
}

/// Sets the lengths that are those of the start. Returns the cross-link that changes most, relative
/// to its length, or nullptr if none changes.
CrossLink const* take_open_lengths(ChainSpec& chain, Node const& from) {
    double constexpr rounding = 1e-12;
    CrossLink const* most = nullptr;
    double part = rounding;
    for (CrossLink& link : chain.crosslinks) {
        double const distance = distance_of(link, chain.beads.position);
        if (!(distance > 0))
            fail(from, ends_text(chain, link) + ", which a cross-link joins, coincide",
                 "move one of them");
        if (link.length == 0) link.length = distance;
        if (double const change = std::abs(distance - link.length) / link.length; change > part)
            part = change, most = &link;
    }
    return most;
}

/// Notes what is particular in the links of a chain.
void note_redundant(ChainSpec const& chain, Scene& scene, bool is_known) {
    std::int64_t const elsewhere = redundant_links(shaken(chain));
    if (std::int64_t const here = chain.redundant_links - elsewhere; here > 0)
        scene.note(fmt::format(
            "chain `{}` starts where {} of its links {} the others' lengths but would not "
            "elsewhere, as in a flat or a stretched loop: {}",
            shown(chain.name), here, here == 1 ? "follows from" : "follow from", special_note));
    if (elsewhere > 0 && !is_known)
        scene.note(fmt::format(
            "{} of the {} links of chain `{}` {} redundant: {} no degree of freedom, and "
            "their tensions are the least of many that fit",
            elsewhere,
            std::ssize(chain.beads.length) - (chain.base == Base::free ? 1 : 0) +
                std::ssize(chain.crosslinks),
            shown(chain.name), elsewhere == 1 ? "is" : "are",
            elsewhere == 1 ? "it takes" : "they take"));
}

/// Moves the beads until all links have their lengths; `most` changes most.
void close(ChainSpec& chain, CrossLink const& most, CrossLinkFit const& fit) {
    std::vector<Vec3> const given = chain.beads.position;
    char const* const unit = fit.scene.si ? "m" : "nm";
    double const distance = distance_of(most, given),
                 part = std::abs(distance - most.length) / most.length;
    std::string const what =
        fmt::format("{} are {:.4g} {} apart, their cross-link is {:.4g} {} long",
                    ends_text(chain, most), distance, unit, most.length, unit);
    if (!fit.far && !fit.scene.relax && part > largest_link_change)
        fail(fit.from, what, fit.remedy);
    if (!close_in_steps(chain, chain.beads.position))
        fail(fit.from, what + ", and no positions nearby close all links",
             "give other positions, or other lengths");
    double moved = 0;
    for (std::size_t k = 0; k < given.size(); ++k)
        moved = std::max(moved, norm(chain.beads.position[k] - given[k]));
    if (part >= noted_link_change && !fit.quiet)
        fit.scene.note(fmt::format("{}: beads are moved by up to {:.3g} {} {}", what, moved, unit,
                                   closing_note));
}

}  // namespace

std::int64_t redundant_links(ChainSpec const& chain) {
    if (!chain.is_cross_linked()) return 0;
    return EvenChain(chain, points_of(chain.beads.position), lengths_of(chain)).redundant();
}

bool project_links(ChainSpec const& chain, std::vector<Vec3>& positions) {
    Points at = points_of(positions);
    if (!project(chain, lengths_of(chain), at)) return false;
    take(at, positions);
    return true;
}

void fit_crosslinks(ChainSpec& chain, CrossLinkFit const& fit) {
    if (CrossLink const* const most = take_open_lengths(chain, fit.from)) close(chain, *most, fit);
    chain.redundant_links = redundant_links(chain);
    if (!fit.quiet) note_redundant(chain, fit.scene, fit.is_known);
}

}  // namespace catena::scene
