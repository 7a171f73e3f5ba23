// Chains with a jointed tip: closure of the tip joint, and the wrench that satisfies it.
#include <cmath>

#include "joints/joint_models.hpp"
#include "oracle/full_pivoting.hpp"
#include "oracle/joint.hpp"
#include "oracle/rotations.hpp"

namespace catena::oracle {
namespace {

/// Returns the link without velocities and loads. Its chain then responds linearly to applied
/// forces.
template <class S>
Link<S> silent(Link<S> link) {
    link.rate = link.slide = link.drift = link.prescribed = link.effort = link.applied_torque =
        link.applied_force = V3<S>::zero();
    link.gap = {};
    return link;
}

/// Open chain under a wrench along the locked directions of its tip.
template <class S>
class OpenChain {
  public:
    OpenChain(ChainSpec const& chain, Loads const& loads)
        : links_(read_links<S>(chain, loads)), gravity_(lift<S>(loads.gravity)) {
        std::vector<Attitude<S>> const attitude = attitudes(links_);
        tip_ = read_tip(chain, links_, attitude);
        last_ = attitude.back().orientation, first_ = attitude.front().orientation;
        omega_ = last_ * attitude.back().omega;
        first_omega_ = first_ * attitude.front().omega;
        for (Link<S> const& link : links_) silent_.push_back(silent(link));
    }
    TipClosure<S> const& tip() const { return tip_; }
    /// Solves the open chain under the given components of the tip wrench.
    OracleResult<S> solve(std::vector<S> const& components) const {
        return aba_links(pushed(links_, components), gravity_);
    }
    /// Residual of the tip's closure.
    Column<S> defect(OracleResult<S> const& r) const {
        return as_column(tip_, omega_, first_omega_, r);
    }
    /// Minus the change of `defect` per unit of component j; the matrix of all columns is symmetric
    /// and positive (semi)definite.
    Column<S> response(std::size_t j) const {
        std::vector<S> components(tip_.locked.size(), S(0));
        components[j] = S(1);
        TipClosure<S> still = tip_;
        still.closure = {};
        return -as_column(still, V3<S>::zero(), V3<S>::zero(),
                          aba_links(pushed(silent_, components), V3<S>::zero()));
    }

    /// What response(j)[j] would be if the bodies at the tip were free. It is never less.
    S free_response(std::size_t j) const {
        std::vector<S> components(tip_.locked.size(), S(0));
        components[j] = S(1);
        return mobility(links_.back(), last_, tip_wrench(tip_, components, V3<S>::zero())) +
               mobility(links_.front(), first_, wrench_on_first(tip_, components, tip_.first_arm));
    }

  private:
    /// Power of the acceleration that a wrench about the centre of mass gives a free body.
    static S mobility(Link<S> const& link, M3<S> const& orientation, SpatialForce<S> const& f) {
        V3<S> const torque = transposed_times(orientation, f.torque);
        return dot(torque, Cholesky<S, 3>(link.inertia).solve(torque)) +
               dot(f.force, f.force) / link.mass;
    }
    /// Returns the links with the tip wrench added to the loads of the end bodies.
    std::vector<Link<S>> pushed(std::vector<Link<S>> links,
                                std::vector<S> const& components) const {
        SpatialForce<S> const f = tip_wrench(tip_, components, V3<S>::zero());
        links.back().applied_torque = links.back().applied_torque + f.torque;
        links.back().applied_force = links.back().applied_force + f.force;
        SpatialForce<S> const on_first = wrench_on_first(tip_, components, tip_.first_arm);
        links.front().applied_torque = links.front().applied_torque + on_first.torque;
        links.front().applied_force = links.front().applied_force + on_first.force;
        return links;
    }
    static Column<S> as_column(TipClosure<S> const& tip, V3<S> const& omega,
                               V3<S> const& first_omega, OracleResult<S> const& r) {
        std::vector<S> const d =
            tip_defect<S>(tip, {r.com_acceleration.back(), r.alpha.back(), omega},
                          {r.com_acceleration.front(), r.alpha.front(), first_omega});
        return Eigen::Map<Column<S> const>(d.data(), static_cast<Index>(d.size()));
    }

    std::vector<Link<S>> links_, silent_;
    V3<S> gravity_, omega_, first_omega_;
    M3<S> last_, first_;
    TipClosure<S> tip_;
};

/// System for the components of the tip wrench. Rows and columns are scaled to a unit diagonal, so
/// that moments and forces have equal weight when the rank is determined. Rows that are rounding
/// errors beside the responses of free bodies count as zero.
template <class S>
class TipSystem {
  public:
    TipSystem(Dense<S> matrix, Column<S> const& free, double bodies) : scale_(matrix.rows()) {
        using std::sqrt;
        S const most = matrix.rows() > 0 ? S(matrix.diagonal().maxCoeff()) : S(0),
                rounding = S(64 * bodies) * Eigen::NumTraits<S>::epsilon();
        for (Index i = 0; i < matrix.rows(); ++i) {
            S const d = matrix(i, i);
            bool const moves =
                d > S(Eigen::NumTraits<S>::epsilon()) * most && d > rounding * free[i];
            scale_[i] = moves ? S(S(1) / S(sqrt(d))) : S(0);
        }
        matrix = scale_.asDiagonal() * matrix * scale_.asDiagonal();
        lu_ = FullPivoting<S>(matrix, rounding);
    }
    /// Adds to `components` the change that removes the residual `defect`.
    void correct(Column<S> const& defect, std::vector<S>& components) const {
        if (components.empty()) return;
        Column<S> const scaled = scale_.cwiseProduct(defect);
        Column<S> const x = lu_.solve(scaled);
        for (Index i = 0; i < x.size(); ++i)
            components[static_cast<std::size_t>(i)] += scale_[i] * x[i];
    }

  private:
    Column<S> scale_;
    FullPivoting<S> lu_;
};

}  // namespace

template <class S>
TipClosure<S> read_tip(ChainSpec const& chain, std::vector<Link<S>> const& links,
                       std::vector<Attitude<S>> const& attitude) {
    TipJoint const& j = chain.tip_joint;
    Link<S> g;
    JointShape<S> const shape{j.type,
                              lift<S>(j.axis),
                              lift<S>(j.first_axis),
                              S(j.pitch),
                              orthonormal<S>(j.rotation),
                              lift<S>(j.translation),
                              {S(j.q[0]), S(j.q[1]), S(j.q[2])},
                              j.q};
    place(shape, "tip", g);
    Attitude<S> const &last = attitude.back(), &first = attitude.front();
    // The first body of a ring determines the pose.
    if (j.ring) {
        g.rotation = transposed_times(last.orientation, first.orientation);
        g.translation = transposed_times(last.orientation, first.origin - last.origin);
        set_inboard_directions(shape, g);
    }
    // The velocity of G relative to the last body, in G's axes, gives the joint rates.
    M3<S> const axes = last.orientation * g.rotation;  // axes of G in W
    V3<S> const omega = last.orientation * last.omega, to_g = last.orientation * g.translation;
    V3<S> const com = last.orientation * links.back().com;
    V3<S> const turning = j.ring ? first.orientation * first.omega : V3<S>::zero(),
                moving_g = j.ring ? first.velocity : V3<S>::zero();
    Motion<S> const relative{
        transposed_times(axes, turning - omega),
        transposed_times(axes, moving_g - (last.velocity + cross(omega, to_g)))};
    V3<S> const rates = coordinates(g, relative);
    Motion<S> const moving = along(g, rates);
    // The closure consists of the Coriolis terms of the rates and of the universal joint's drift.
    TipClosure<S> tip{
        j.ring, V3<S>::zero(), to_g - com, last.orientation * shape.translation - com, {}, {}};
    if (j.ring) tip.first_arm = -(first.orientation * links.front().com);
    V3<S> drift = V3<S>::zero();
    if (turns_twice(g.type))
        drift = S(rates[0] * rates[1]) * cross(g.free[0].angular, g.free[1].angular);
    tip.closure = {cross(omega, axes * moving.angular) + axes * drift,
                   S(2) * cross(omega, axes * moving.linear)};
    for (Motion<S> const& d : restricted(g))
        tip.locked.push_back({axes * d.angular, axes * d.linear});
    return tip;
}

template <class S>
std::vector<S> tip_defect(TipClosure<S> const& tip, TipEnd<S> const& last, TipEnd<S> const& first) {
    auto const at = [](TipEnd<S> const& end, V3<S> const& arm) {
        return end.com_acceleration + cross(end.alpha, arm) +
               cross(end.omega, cross(end.omega, arm));
    };
    V3<S> linear = at(last, tip.arm) + tip.closure.linear,
          angular = last.alpha + tip.closure.angular;
    if (tip.ring) {
        linear = linear - at(first, tip.first_arm);
        angular = angular - first.alpha;
    }
    std::vector<S> defect;
    for (Motion<S> const& d : tip.locked)
        defect.push_back(dot(d.angular, angular) + dot(d.linear, linear));
    return defect;
}

template <class S>
SpatialForce<S> tip_wrench(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                           V3<S> const& about) {
    SpatialForce<S> f;
    for (std::size_t i = 0; i < along_locked.size(); ++i) {
        Motion<S> const& d = tip.locked[i];
        f = f + SpatialForce<S>{-along_locked[i] * (d.angular + cross(tip.arm - about, d.linear)),
                                -along_locked[i] * d.linear};
    }
    return f;
}

template <class S>
SpatialForce<S> wrench_on_first(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                                V3<S> const& arm) {
    SpatialForce<S> f;
    for (std::size_t i = 0; i < along_locked.size() && tip.ring; ++i) {
        Motion<S> const& d = tip.locked[i];
        f = f + SpatialForce<S>{along_locked[i] * (d.angular + cross(arm, d.linear)),
                                along_locked[i] * d.linear};
    }
    return f;
}

template <class S>
OracleResult<S> aba_with_tip(ChainSpec const& chain, Loads const& loads) {
    OpenChain<S> const open(chain, loads);
    std::size_t const m = open.tip().locked.size();
    Dense<S> matrix(m, m);
    // Column j of the matrix is the open chain's response to a unit of component j.
    Column<S> free(m);
    for (std::size_t j = 0; j < m; ++j) {
        matrix.col(static_cast<Index>(j)) = open.response(j);
        free[static_cast<Index>(j)] = open.free_response(j);
    }
    TipSystem<S> const system(matrix, free, static_cast<double>(chain.size()));
    std::vector<S> components(m, S(0));
    OracleResult<S> result = open.solve(components);
    // The second pass corrects the rounding errors of the first.
    for (int pass = 0; pass < 2; ++pass) {
        system.correct(open.defect(result), components);
        result = open.solve(components);
    }
    result.tip_force = tip_wrench(open.tip(), components, open.tip().frame);
    if (open.tip().ring)
        result.joint_force[0] = result.constraint_force[0] =
            wrench_on_first(open.tip(), components, V3<S>::zero());
    return result;
}

// NOLINTBEGIN(bugprone-macro-parentheses): S is a type
#define CATENA_ORACLE(S)                                                                     \
    template TipClosure<S> read_tip<S>(ChainSpec const&, std::vector<Link<S>> const&,        \
                                       std::vector<Attitude<S>> const&);                     \
    template std::vector<S> tip_defect<S>(TipClosure<S> const&, TipEnd<S> const&,            \
                                          TipEnd<S> const&);                                 \
    template SpatialForce<S> tip_wrench<S>(TipClosure<S> const&, std::vector<S> const&,      \
                                           V3<S> const&);                                    \
    template SpatialForce<S> wrench_on_first<S>(TipClosure<S> const&, std::vector<S> const&, \
                                                V3<S> const&);                               \
    template OracleResult<S> aba_with_tip<S>(ChainSpec const&, Loads const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace catena::oracle
