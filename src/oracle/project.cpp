// Least-squares projection of velocities on the constraints of tips and links.
#include <Eigen/QR>

#include "joints/joint_models.hpp"
#include "oracle/eigen.hpp"
#include "oracle/linked.hpp"
#include "scene/branches.hpp"

namespace catena::oracle {
namespace {

/// Returns the smallest change dx with J dx = - defect.
Column<double> least_change(Dense<double> const& jacobian, Column<double> const& defect) {
    if (jacobian.rows() == 0) return Column<double>::Zero(jacobian.cols());
    return -jacobian.completeOrthogonalDecomposition().solve(defect);
}

/// Motion of body k at `arm` from its centre of mass, W; zero for the ground.
Motion<double> velocity_at(std::int64_t body, Vec3 const& arm,
                           std::vector<Link<double>> const& links,
                           std::vector<Attitude<double>> const& all) {
    if (body < 0) return {};
    auto const k = static_cast<std::size_t>(body);
    Vec3 const omega = all[k].orientation * all[k].omega;
    return {omega, all[k].velocity + cross(omega, arm + all[k].orientation * links[k].com)};
}

/// Velocities of tip and loops along their locked directions; zero if they are consistent.
Column<double> velocity_of(std::vector<TipClosure<double>> const& closures,
                           std::vector<Link<double>> const& links) {
    std::vector<Attitude<double>> const all = attitudes(links);
    std::vector<double> v;
    for (TipClosure<double> const& c : closures) {
        Motion<double> const last = velocity_at(c.last_body, c.arm, links, all),
                             first = velocity_at(c.first_body, c.first_arm, links, all);
        for (Motion<double> const& d : c.locked)
            v.push_back(dot(d.angular, last.angular - first.angular) +
                        dot(d.linear, last.linear - first.linear));
    }
    return Eigen::Map<Column<double> const>(v.data(), static_cast<Index>(v.size()));
}

/// Projects the velocities of a joint chain with a jointed tip or loops. Column i of the Jacobian
/// is their velocity for a unit of velocity i.
void project_bodies(ChainSpec& chain, double time) {
    Loads loads;
    loads.time = time;
    std::vector<Link<double>> const links = read_links<double>(chain, loads);
    std::vector<TipClosure<double>> const closures = read_closures(chain, links, attitudes(links));
    Column<double> const open = velocity_of(closures, links);
    std::vector<Link<double>> still = links;
    for (Link<double>& link : still) link.rate = link.slide = Vec3::zero();
    std::vector<double*> numbers;
    Dense<double> jacobian(open.size(), 0);
    auto const add = [&](double& number, std::size_t k, Motion<double> const& unit) {
        std::vector<Link<double>> one = still;
        one[k].rate = unit.angular;
        one[k].slide = unit.linear;
        jacobian.conservativeResize(Eigen::NoChange, jacobian.cols() + 1);
        jacobian.col(jacobian.cols() - 1) = velocity_of(closures, one);
        numbers.push_back(&number);
    };
    for (std::size_t k = 0; k < links.size(); ++k) {
        for (int i = 0; i < links[k].unknown(); ++i)
            add(chain.bodies.qd[k][i], k, links[k].free[static_cast<std::size_t>(i)]);
        if (!floats(links[k].type)) continue;
        for (int i = 0; i < 3; ++i) {
            Motion<double> unit;
            unit.linear[i] = 1;
            add(chain.bodies.free_base.velocity[i], k, unit);
        }
    }
    if (numbers.empty()) return;
    Column<double> const change = least_change(jacobian, open);
    for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] += change[static_cast<Index>(i)];
}

/// Calls add_end(link, body, end, sign) for both ends of every link; these are the entries of the
/// Jacobian of the link lengths.
template <class Directions, class AddEnd>
void add_link_rows(Directions const& links, std::size_t first, ChainSpec const& chain,
                   AddEnd const& add_end) {
    for (std::size_t k = first; k < links.size(); ++k) {
        if (k < chain.size()) add_end(k, k, std::size_t{0}, 1.0);
        if (k == chain.size() && chain.is_ring()) add_end(k, std::size_t{0}, std::size_t{0}, 1.0);
        if (k > 0)
            add_end(k, k < chain.size() ? scene::inboard_of(chain.parent, k) : k - 1,
                    std::size_t{1}, -1.0);
    }
}

/// Projects the velocities of beads.
void project_beads(ChainSpec& chain) {
    std::vector<BeadLink<double>> const links = read_bead_links<double>(chain);
    std::size_t const n = chain.size(), first = chain.base == Base::fixed ? 0 : 1;
    std::vector<BeadLink<double>> const crosslinks = read_crosslinks<double>(chain);
    Dense<double> jacobian = Dense<double>::Zero(
        static_cast<Index>(links.size() + crosslinks.size()), static_cast<Index>(3 * n));
    Column<double> velocity(static_cast<Index>(3 * n));
    for (std::size_t c = 0; c < crosslinks.size(); ++c)
        for (int i = 0; i < 3; ++i) {
            auto const row = static_cast<Index>(links.size() + c);
            jacobian(row, 3 * chain.crosslinks[c].outboard + i) = crosslinks[c].direction[i];
            jacobian(row, 3 * chain.crosslinks[c].inboard + i) = -crosslinks[c].direction[i];
        }
    add_link_rows(links, first, chain,
                  [&](std::size_t link, std::size_t k, std::size_t, double sign) {
                      for (int i = 0; i < 3; ++i)
                          jacobian(static_cast<Index>(link), static_cast<Index>(3 * k) + i) =
                              sign * links[link].direction[i];
                  });
    for (Index i = 0; i < velocity.size(); ++i)
        velocity[i] =
            chain.beads.velocity[static_cast<std::size_t>(i / 3)][static_cast<int>(i % 3)];
    velocity += least_change(jacobian, jacobian * velocity);
    for (Index i = 0; i < velocity.size(); ++i)
        chain.beads.velocity[static_cast<std::size_t>(i / 3)][static_cast<int>(i % 3)] =
            velocity[i];
}

/// Projects the velocities of linked bodies.
void project_linked(ChainSpec& chain) {
    LinkedModel<double> const model = read_linked<double>(chain, {});
    std::size_t const n = chain.size();
    Dense<double> jacobian =
        Dense<double>::Zero(static_cast<Index>(model.links.size()), static_cast<Index>(6 * n));
    Column<double> velocity(static_cast<Index>(6 * n));
    auto const number = [&](Index i) -> double& {
        auto const k = static_cast<std::size_t>(i / 6);
        auto const c = static_cast<int>(i % 6);
        return c < 3 ? chain.linked.velocity[k][c] : chain.linked.omega[k][c - 3];
    };
    add_link_rows(
        model.links, model.first, chain,
        [&](std::size_t link, std::size_t k, std::size_t end, double sign) {
            LinkedBody<double> const& body = model.bodies[k];
            Vec3 const &u = model.links[link].direction,
                       lever = transposed_times(body.orientation, cross(body.end[end], u));
            for (int i = 0; i < 3; ++i) {
                jacobian(static_cast<Index>(link), static_cast<Index>(6 * k) + i) += sign * u[i];
                jacobian(static_cast<Index>(link), static_cast<Index>(6 * k) + 3 + i) +=
                    sign * lever[i];
            }
        });
    for (Index i = 0; i < velocity.size(); ++i) velocity[i] = number(i);
    velocity += least_change(jacobian, jacobian * velocity);
    for (Index i = 0; i < velocity.size(); ++i) number(i) = velocity[i];
}

}  // namespace

void project_velocities(ChainSpec& chain, double time) {
    // The second pass corrects the rounding errors of the first.
    for (int pass = 0; pass < 2 && chain.size() > 0; ++pass) {
        if (chain.is_beads())
            project_beads(chain);
        else if (chain.is_linked())
            project_linked(chain);
        else if (chain.is_closed())
            project_bodies(chain, time);
    }
}

}  // namespace catena::oracle
