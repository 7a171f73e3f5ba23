#include "joints/joint_models.hpp"
#include "oracle/system.hpp"

// One linear system for all accelerations and joint forces. Its equations are Newton's and Euler's
// equations of every body, and the second time derivative of every joint's closure, in ground axes
// about the centres of mass.
namespace catena::oracle {
namespace {

/// Body k and its inboard joint in ground axes.
template <class S>
struct Body {
    M3<S> orientation = M3<S>::identity();  // maps B to W
    /// Angular velocity, and vector from com to the body's origin, where the joint acts.
    V3<S> omega = V3<S>::zero(), to_inboard = V3<S>::zero();
    /// Relative acceleration across the joint that is not due to its coordinates' q''.
    Motion<S> closure;
    SpatialForce<S> given;          // wrench of the joint along its coordinates
    std::vector<Motion<S>> locked;  // directions of the constraint wrench
    Index motion = 0, joint = 0;    // first rows of [a; alpha] and of the constraint's components
};

/// Returns the motion with both vectors multiplied by r.
template <class S>
Motion<S> rotated(M3<S> const& r, Motion<S> const& m) {
    return {r * m.angular, r * m.linear};
}

/// Assembly of the system for one chain, and interpretation of its solution.
template <class S>
class Assembly {
  public:
    Assembly(ChainSpec const& chain, Loads const& loads)
        : links_(read_links<S>(chain, loads)), gravity_(lift<S>(loads.gravity)) {
        size_ = 6 * static_cast<Index>(links_.size());
        attitude_ = attitudes(links_);
        for (std::size_t k = 0; k < links_.size(); ++k) {
            Link<S> const& link = links_[k];
            M3<S> const& r = attitude_[k].orientation;
            Body<S> b;
            b.orientation = r;
            b.omega = r * attitude_[k].omega;
            b.to_inboard = -(r * link.com);
            b.motion = 6 * static_cast<Index>(k);
            b.joint = size_;
            if (!floats(link.type)) add_joint(k, b);
            bodies_.push_back(b);
        }
        close_loops(chain);
    }

    /// Returns the assembled system.
    System<S> system() const {
        System<S> s(size_);
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            add_body(k, s);
            Body<S> const& b = bodies_[k];
            if (floats(links_[k].type)) continue;
            add_joint_end(b, b.to_inboard, b, S(1), s);
            if (!links_[k].on_ground()) add_joint_end(inboard_of(k), to_outboard(k), b, S(-1), s);
            add_closure(b, s);
        }
        for (std::size_t i = 0; i < closures_.size(); ++i) {
            TipClosure<S> const& c = closures_[i];
            Body<S> const& joint = closing_joint_[i];
            if (c.last_body >= 0)
                add_joint_end(bodies_[static_cast<std::size_t>(c.last_body)], c.arm, joint, S(-1),
                              s);
            if (c.ring)
                add_joint_end(bodies_[static_cast<std::size_t>(c.first_body)], c.first_arm, joint,
                              S(1), s);
            add_closure(joint, s);
        }
        return s;
    }

    /// Returns the result that corresponds to the solution x.
    OracleResult<S> read(Column<S> const& x) const {
        OracleResult<S> result;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            Body<S> const& b = bodies_[k];
            result.com_acceleration.push_back(segment(x, b.motion));
            result.alpha.push_back(segment(x, b.motion + 3));
            result.qdd.push_back(joint_acceleration(k, x));
            result.joint_force.emplace_back();
            result.constraint_force.emplace_back();
            if (floats(links_[k].type)) {
                result.base_acceleration = at_point(b, b.to_inboard, x).linear;
                continue;
            }
            result.constraint_force[k] = constraint(b, x);
            result.joint_force[k] = result.constraint_force[k] + b.given;
        }
        if (has_tip_) {
            TipClosure<S> const& tip = closures_.front();
            std::vector<S> components;
            for (std::size_t i = 0; i < tip.locked.size(); ++i)
                components.push_back(x[closing_joint_.front().joint + static_cast<Index>(i)]);
            result.tip_force = tip_wrench(tip, components, tip.frame);
            if (tip.ring)
                result.joint_force[0] = result.constraint_force[0] =
                    wrench_on_first(tip, components, V3<S>::zero());
        }
        return result;
    }

  private:
    /// Sets the inboard joint of body k and numbers its constraint rows.
    void add_joint(std::size_t k, Body<S>& b) {
        Link<S> const& link = links_[k];
        V3<S> const inboard = link.on_ground() ? V3<S>::zero() : inboard_of(k).omega,
                    slide = b.orientation * link.slide;
        b.closure = {cross(inboard, b.orientation * link.rate) + b.orientation * link.drift,
                     S(2) * cross(inboard, slide)};
        if (link.driven)
            b.closure = b.closure + rotated(b.orientation, along(link, link.prescribed));
        b.closure = b.closure + rotated(b.orientation, link.gap);
        SpatialForce<S> const given = spread(link, link.effort);
        b.given = {b.orientation * given.torque, b.orientation * given.force};
        for (Motion<S> const& d : restricted(link)) b.locked.push_back(rotated(b.orientation, d));
        size_ += static_cast<Index>(b.locked.size());
    }

    /// Adds the constraint rows of the tip joint and of loops.
    void close_loops(ChainSpec const& chain) {
        has_tip_ = chain.tip == Tip::jointed;
        closures_ = read_closures(chain, links_, attitude_);
        for (TipClosure<S> const& closure : closures_) {
            Body<S> joint;
            joint.locked = closure.locked;
            joint.closure = closure.closure;
            joint.joint = size_;
            size_ += static_cast<Index>(closure.locked.size());
            closing_joint_.push_back(joint);
        }
    }

    /// Inboard body of joint k, which does not join to the ground.
    Body<S> const& inboard_of(std::size_t k) const { return bodies_[links_[k].before()]; }
    /// Vector from the centre of mass of joint k's inboard body to the joint, W.
    V3<S> to_outboard(std::size_t k) const {
        return inboard_of(k).orientation * (links_[k].translation - links_[links_[k].before()].com);
    }

    /// Adds Newton's and Euler's equations of body k.
    void add_body(std::size_t k, System<S>& s) const {
        Body<S> const& b = bodies_[k];
        Link<S> const& link = links_[k];
        M3<S> const inertia = turned(b.orientation, link.inertia);
        s.add(b.motion, b.motion, scaled(link.mass, M3<S>::identity()));
        s.add(b.motion + 3, b.motion + 3, inertia);
        s.add(b.motion, link.mass * gravity_ + link.applied_force + b.given.force);
        s.add(b.motion + 3, link.applied_torque - cross(b.omega, inertia * b.omega));
        s.add(b.motion + 3, b.given.torque + cross(b.to_inboard, b.given.force));
        if (link.on_ground()) return;
        Index const before = inboard_of(k).motion;
        s.add(before, -b.given.force);
        s.add(before + 3, -b.given.torque - cross(to_outboard(k), b.given.force));
    }

    /// Adds one end of a joint. `arm`: vector from the body's centre of mass to the joint. `sign`:
    /// +1 on the outboard body, -1 on the inboard one.
    void add_joint_end(Body<S> const& body, V3<S> const& arm, Body<S> const& joint, S sign,
                       System<S>& s) const {
        V3<S> const centripetal = cross(body.omega, cross(body.omega, arm));
        Index row = joint.joint;
        for (Motion<S> const& d : joint.locked) {
            s.add_constraint(body.motion, row, sign, d.linear);
            s.add_constraint(body.motion + 3, row, sign, d.angular + cross(arm, d.linear));
            s.right[row++] -= sign * dot(d.linear, centripetal);
        }
    }
    /// Adds the velocity-dependent terms of a joint's closure to the right-hand side.
    void add_closure(Body<S> const& joint, System<S>& s) const {
        Index row = joint.joint;
        for (Motion<S> const& d : joint.locked)
            s.right[row++] +=
                dot(d.angular, joint.closure.angular) + dot(d.linear, joint.closure.linear);
    }

    /// Constraint wrench of a joint in the solution x.
    SpatialForce<S> constraint(Body<S> const& joint, Column<S> const& x) const {
        SpatialForce<S> f;
        Index row = joint.joint;
        for (Motion<S> const& d : joint.locked) {
            f = f + SpatialForce<S>{x[row] * d.angular, x[row] * d.linear};
            ++row;
        }
        return f;
    }

    /// Acceleration of the point of a body at `arm` from its centre of mass.
    Motion<S> at_point(Body<S> const& b, V3<S> const& arm, Column<S> const& x) const {
        V3<S> const a = segment(x, b.motion), alpha = segment(x, b.motion + 3);
        return {alpha, a + cross(alpha, arm) + cross(b.omega, cross(b.omega, arm))};
    }

    /// Second derivatives of joint k's coordinates in the solution x.
    V3<S> joint_acceleration(std::size_t k, Column<S> const& x) const {
        Body<S> const& b = bodies_[k];
        if (links_[k].driven) return links_[k].prescribed;
        Motion<S> relative = at_point(b, b.to_inboard, x);
        if (!links_[k].on_ground()) {
            Motion<S> const inboard = at_point(inboard_of(k), to_outboard(k), x);
            relative = {relative.angular - inboard.angular, relative.linear - inboard.linear};
        }
        V3<S> const angular = relative.angular - b.closure.angular,
                    linear = relative.linear - b.closure.linear;
        return coordinates(links_[k], Motion<S>{transposed_times(b.orientation, angular),
                                                transposed_times(b.orientation, linear)});
    }

    std::vector<Link<S>> links_;
    std::vector<Attitude<S>> attitude_;
    std::vector<Body<S>> bodies_;
    /// The tip, if there is one, and the loops, with their joints, of which only the joints'
    /// members are used.
    std::vector<TipClosure<S>> closures_;
    std::vector<Body<S>> closing_joint_;
    bool has_tip_ = false;
    V3<S> gravity_;
    Index size_ = 0;
};

}  // namespace

template <class S>
OracleResult<S> dense(ChainSpec const& chain, Loads const& loads) {
    if (chain.size() == 0) return {};
    if (chain.is_beads()) return dense_beads<S>(chain, loads);
    if (chain.is_linked()) return dense_linked<S>(chain, loads);
    Assembly<S> const assembly(chain, loads);
    return assembly.read(solve(assembly.system()));
}

template OracleResult<double> dense<double>(ChainSpec const&, Loads const&);
template OracleResult<long double> dense<long double>(ChainSpec const&, Loads const&);
template OracleResult<Quad> dense<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
