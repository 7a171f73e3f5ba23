// Chains with a jointed tip or loops: closure of their joints, and the wrenches that satisfy it.
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

/// Open chain under wrenches along the locked directions of the joints that close its loops. The
/// components of these wrenches are numbered joint by joint.
template <class S>
class OpenChain {
  public:
    OpenChain(ChainSpec const& chain, Loads const& loads)
        : links_(read_links<S>(chain, loads)), gravity_(lift<S>(loads.gravity)) {
        attitude_ = attitudes(links_);
        closures_ = read_closures(chain, links_, attitude_);
        for (Link<S> const& link : links_) silent_.push_back(silent(link));
        for (TipClosure<S> const& closure : closures_) size_ += closure.locked.size();
    }
    std::vector<TipClosure<S>> const& closures() const { return closures_; }
    /// Number of locked directions.
    std::size_t size() const { return size_; }
    /// Components of one joint's wrench.
    std::vector<S> of_joint(std::size_t joint, std::vector<S> const& components) const {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < joint; ++i) begin += closures_[i].locked.size();
        auto const first = components.begin() + static_cast<std::ptrdiff_t>(begin);
        return {first, first + static_cast<std::ptrdiff_t>(closures_[joint].locked.size())};
    }
    /// Solves the open chain under the given components.
    OracleResult<S> solve(std::vector<S> const& components) const {
        return aba_links(pushed(links_, components), gravity_);
    }
    /// Residual of all closures.
    Column<S> defect(OracleResult<S> const& r) const { return as_column(r, true); }
    /// Minus the change of `defect` per unit of component j; the matrix of all columns is symmetric
    /// and positive (semi)definite.
    Column<S> response(std::size_t j) const {
        return -as_column(aba_links(pushed(silent_, unit(j)), V3<S>::zero()), false);
    }
    /// What response(j)[j] would be if the bodies at the joint were free. It is never less.
    S free_response(std::size_t j) const {
        S sum(0);
        push(unit(j), [&](std::size_t body, SpatialForce<S> const& f) {
            sum += mobility(links_[body], attitude_[body].orientation, f);
        });
        return sum;
    }

  private:
    std::vector<S> unit(std::size_t j) const {
        std::vector<S> components(size_, S(0));
        components[j] = S(1);
        return components;
    }
    /// Power of the acceleration that a wrench about the centre of mass gives a free body.
    static S mobility(Link<S> const& link, M3<S> const& orientation, SpatialForce<S> const& f) {
        V3<S> const torque = transposed_times(orientation, f.torque);
        return dot(torque, Cholesky<S, 3>(link.inertia).solve(torque)) +
               dot(f.force, f.force) / link.mass;
    }
    /// Calls on(body, wrench about its centre of mass) for the two bodies of every joint.
    template <class On>
    void push(std::vector<S> const& components, On const& on) const {
        for (std::size_t i = 0; i < closures_.size(); ++i) {
            TipClosure<S> const& c = closures_[i];
            std::vector<S> const own = of_joint(i, components);
            if (c.last_body >= 0)
                on(static_cast<std::size_t>(c.last_body), tip_wrench(c, own, V3<S>::zero()));
            if (c.ring)
                on(static_cast<std::size_t>(c.first_body), wrench_on_first(c, own, c.first_arm));
        }
    }
    /// Returns the links with the wrenches added to the loads of the bodies.
    std::vector<Link<S>> pushed(std::vector<Link<S>> links,
                                std::vector<S> const& components) const {
        push(components, [&](std::size_t body, SpatialForce<S> const& f) {
            links[body].applied_torque = links[body].applied_torque + f.torque;
            links[body].applied_force = links[body].applied_force + f.force;
        });
        return links;
    }
    /// Motion of a body in a result, at rest unless `moving`; that of the ground is zero.
    TipEnd<S> end(std::int64_t body, OracleResult<S> const& r, bool moving) const {
        if (body < 0) return {V3<S>::zero(), V3<S>::zero(), V3<S>::zero()};
        auto const k = static_cast<std::size_t>(body);
        return {r.com_acceleration[k], r.alpha[k],
                moving ? attitude_[k].orientation * attitude_[k].omega : V3<S>::zero()};
    }
    /// Residual of all closures; without the velocity terms unless `moving`.
    Column<S> as_column(OracleResult<S> const& r, bool moving) const {
        std::vector<S> all;
        for (TipClosure<S> closure : closures_) {
            if (!moving) closure.closure = {};
            std::vector<S> const d =
                tip_defect<S>(closure, end(closure.last_body, r, moving),
                              end(closure.ring ? closure.first_body : -1, r, moving));
            all.insert(all.end(), d.begin(), d.end());
        }
        return Eigen::Map<Column<S> const>(all.data(), static_cast<Index>(all.size()));
    }

    std::vector<Link<S>> links_, silent_;
    std::vector<Attitude<S>> attitude_;
    V3<S> gravity_;
    std::vector<TipClosure<S>> closures_;
    std::size_t size_ = 0;
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

namespace {

/// Joint of a loop in the oracle's scalar.
template <class S>
JointShape<S> shape_of(TipJoint const& j) {
    return {j.type,
            lift<S>(j.axis),
            lift<S>(j.first_axis),
            S(j.pitch),
            orthonormal<S>(j.rotation),
            lift<S>(j.translation),
            {S(j.q[0]), S(j.q[1]), S(j.q[2])},
            j.q};
}

/// The ground as a body.
template <class S>
Attitude<S> attitude_of_ground() {
    return {M3<S>::identity(), V3<S>::zero(), V3<S>::zero(), V3<S>::zero()};
}

/// Closes a joint of the shape `shape` whose G moves as `end`. `g` has that pose relative to the
/// last body; `com` is the centre of mass of the last body from its origin, B.
template <class S>
TipClosure<S> closed(JointShape<S> const& shape, Link<S> const& g, Attitude<S> const& last,
                     V3<S> const& last_com, Attitude<S> const& end) {
    // The velocity of G relative to the last body, in G's axes, gives the joint rates.
    M3<S> const axes = last.orientation * g.rotation;  // axes of G in W
    V3<S> const omega = last.orientation * last.omega, to_g = last.orientation * g.translation;
    V3<S> const com = last.orientation * last_com;
    Motion<S> const relative{
        transposed_times(axes, end.orientation * end.omega - omega),
        transposed_times(axes, end.velocity - (last.velocity + cross(omega, to_g)))};
    V3<S> const rates = coordinates(g, relative);
    Motion<S> const moving = along(g, rates);
    // The closure consists of the Coriolis terms of the rates and of the universal joint's drift.
    TipClosure<S> tip;
    tip.arm = to_g - com;
    tip.frame = last.orientation * shape.translation - com;
    V3<S> drift = V3<S>::zero();
    if (turns_twice(g.type))
        drift = S(rates[0] * rates[1]) * cross(g.free[0].angular, g.free[1].angular);
    tip.closure = {cross(omega, axes * moving.angular) + axes * drift,
                   S(2) * cross(omega, axes * moving.linear)};
    for (Motion<S> const& d : restricted(g))
        tip.locked.push_back({axes * d.angular, axes * d.linear});
    return tip;
}

/// Sets the pose of G relative to the last body, where it stands.
template <class S>
void stand(JointShape<S> const& shape, Attitude<S> const& last, Attitude<S> const& end,
           Link<S>& g) {
    g.rotation = transposed_times(last.orientation, end.orientation);
    g.translation = transposed_times(last.orientation, end.origin - last.origin);
    set_inboard_directions(shape, g);
}

/// Reads the joint of one loop.
template <class S>
TipClosure<S> read_loop(LoopClosure const& loop, std::vector<Link<S>> const& links,
                        std::vector<Attitude<S>> const& attitude) {
    auto const body = [&](std::int64_t k) {
        return k < 0 ? attitude_of_ground<S>() : attitude[static_cast<std::size_t>(k)];
    };
    auto const com = [&](std::int64_t k) {
        return k < 0 ? V3<S>::zero() : links[static_cast<std::size_t>(k)].com;
    };
    Attitude<S> const last = body(loop.inboard), first = body(loop.outboard);
    M3<S> const turned = orthonormal<S>(loop.end_rotation);
    V3<S> const at = lift<S>(loop.end_translation), omega = first.orientation * first.omega,
                arm = first.orientation * at;
    Attitude<S> const end{first.orientation * turned, transposed_times(turned, first.omega),
                          first.origin + arm, first.velocity + cross(omega, arm)};
    JointShape<S> const shape = shape_of<S>(loop.joint);
    Link<S> g;
    place(shape, "loop", g);
    stand(shape, last, end, g);
    TipClosure<S> closure = closed(shape, g, last, com(loop.inboard), end);
    closure.ring = loop.outboard >= 0;
    closure.last_body = loop.inboard;
    closure.first_body = loop.outboard;
    closure.first_arm = arm - first.orientation * com(loop.outboard);
    return closure;
}

}  // namespace

template <class S>
TipClosure<S> read_tip(ChainSpec const& chain, std::vector<Link<S>> const& links,
                       std::vector<Attitude<S>> const& attitude) {
    JointShape<S> const shape = shape_of<S>(chain.tip_joint);
    bool const ring = chain.tip_joint.ring;
    Link<S> g;
    place(shape, "tip", g);
    Attitude<S> const &last = attitude.back(), &first = attitude.front();
    // The first body of a ring determines the pose.
    if (ring) stand(shape, last, first, g);
    TipClosure<S> tip =
        closed(shape, g, last, links.back().com, ring ? first : attitude_of_ground<S>());
    tip.ring = ring;
    tip.last_body = static_cast<std::int64_t>(links.size()) - 1;
    tip.first_body = ring ? 0 : -1;
    if (ring) tip.first_arm = -(first.orientation * links.front().com);
    return tip;
}

template <class S>
std::vector<TipClosure<S>> read_closures(ChainSpec const& chain, std::vector<Link<S>> const& links,
                                         std::vector<Attitude<S>> const& attitude) {
    std::vector<TipClosure<S>> all;
    if (chain.tip == Tip::jointed) all.push_back(read_tip(chain, links, attitude));
    for (LoopClosure const& loop : chain.loops) all.push_back(read_loop(loop, links, attitude));
    return all;
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
OracleResult<S> aba_with_closures(ChainSpec const& chain, Loads const& loads) {
    OpenChain<S> const open(chain, loads);
    std::size_t const m = open.size();
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
    if (chain.tip != Tip::jointed) return result;
    TipClosure<S> const& tip = open.closures().front();
    std::vector<S> const own = open.of_joint(0, components);
    result.tip_force = tip_wrench(tip, own, tip.frame);
    if (tip.ring)
        result.joint_force[0] = result.constraint_force[0] =
            wrench_on_first(tip, own, V3<S>::zero());
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
    template std::vector<TipClosure<S>> read_closures<S>(                                    \
        ChainSpec const&, std::vector<Link<S>> const&, std::vector<Attitude<S>> const&);     \
    template OracleResult<S> aba_with_closures<S>(ChainSpec const&, Loads const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace catena::oracle
