#include <cmath>

#include "dca/oracle/eigen.hpp"
#include "dca/oracle/joint.hpp"

// Newton's and Euler's equations of every body beside the second time derivative of every joint's closure, all in ground
// axes about the centres of mass, as one linear system for the accelerations and the joint forces.
namespace catena::oracle {
namespace {

template <class S>
struct System {
    explicit System(Index size) : matrix(Dense<S>::Zero(size, size)), right(Column<S>::Zero(size)) {}
    void add(Index row, Index column, M3<S> const& m) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) matrix(row + i, column + j) += m(i, j);
    }
    void add(Index row, V3<S> const& v) {
        for (int i = 0; i < 3; ++i) right[row + i] += v[i];
    }
    Dense<S> matrix;
    Column<S> right;
};

/// The power of two next to 1 / x: scaling by it is free of rounding.
template <class S>
S scale_of(S x) {
    int exponent = 0;
    std::frexp(static_cast<double>(x), &exponent);
    return S(std::ldexp(1.0, -exponent));
}

/// LU of the row-scaled matrix and one step of iterative refinement.
template <class S>
Column<S> solve(System<S> const& system) {
    Index const n = system.right.size();
    Column<S> scale(n), right = system.right;
    Dense<S> scaled_matrix = system.matrix;
    for (Index i = 0; i < n; ++i) {
        scale[i] = scale_of(S(system.matrix.row(i).cwiseAbs().maxCoeff()));
        scaled_matrix.row(i) *= scale[i];
        right[i] *= scale[i];
    }
    Eigen::FullPivLU<Dense<S>> const lu(scaled_matrix);
    Column<S> x = lu.solve(right);
    Column<S> rest = system.right;
    for (Index j = 0; j < n; ++j) rest -= system.matrix.col(j) * x[j];
    for (Index i = 0; i < n; ++i) rest[i] *= scale[i];
    x += Column<S>(lu.solve(rest));
    return x;
}

template <class S>
V3<S> segment(Column<S> const& x, Index row) {
    return {{x[row], x[row + 1], x[row + 2]}};
}

/// Body k in ground axes.
template <class S>
struct Body {
    M3<S> orientation;            // B to W
    V3<S> omega, to_inboard;      // to_inboard: from com to the inboard joint's centre
    V3<S> rate, joint_torque;     // relative angular velocity, torque along the joint's free directions
    std::array<V3<S>, 2> locked;  // revolute: directions of the constraint torque
    int locked_count = 0;
    Index motion = 0, joint = 0;  // first rows of [a; alpha] and of [joint force; constraint torque]
};

/// Two unit vectors at right angles to the unit vector `axis` and to each other.
template <class S>
std::array<V3<S>, 2> across(V3<S> const& axis) {
    using std::abs;
    int smallest = 0;
    for (int i = 1; i < 3; ++i)
        if (abs(axis[i]) < abs(axis[smallest])) smallest = i;
    V3<S> other = V3<S>::zero();
    other[smallest] = S(1);
    V3<S> first = cross(axis, other);
    first = S(S(1) / norm(first)) * first;
    return {first, cross(axis, first)};
}

template <class S>
class Assembly {
  public:
    Assembly(ChainSpec const& chain, Loads const& loads) : links_(read_links<S>(chain)), gravity_(lift<S>(loads.gravity)) {
        size_ = 6 * static_cast<Index>(links_.size());
        std::vector<Attitude<S>> const attitude = attitudes(links_);
        for (std::size_t k = 0; k < links_.size(); ++k) {
            Link<S> const& link = links_[k];
            M3<S> const& r = attitude[k].orientation;
            Body<S> b;
            b.orientation = r;
            b.omega = r * attitude[k].omega;
            b.to_inboard = -(r * link.com);
            b.rate = r * link.rate;
            b.joint_torque = r * link.torque;
            b.motion = 6 * static_cast<Index>(k);
            b.joint = size_;
            if (link.type == JointType::revolute) {
                b.locked = across(r * link.axis);
                b.locked_count = 2;
            }
            if (link.type != JointType::free) size_ += 3 + b.locked_count;
            bodies_.push_back(b);
        }
    }

    System<S> system() const {
        System<S> s(size_);
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            add_body(k, s);
            if (links_[k].type == JointType::free) continue;
            add_joint_end(bodies_[k], bodies_[k].to_inboard, k, S(1), s);
            if (k == 0) continue;
            V3<S> const to_outboard = bodies_[k - 1].orientation * (links_[k].translation - links_[k - 1].com);
            add_joint_end(bodies_[k - 1], to_outboard, k, S(-1), s);
            for (int i = 0; i < bodies_[k].locked_count; ++i)
                s.right[bodies_[k].joint + 3 + i] += dot(bodies_[k].locked[i], cross(bodies_[k - 1].omega, bodies_[k].rate));
        }
        return s;
    }

    OracleResult<S> read(Column<S> const& x) const {
        OracleResult<S> result;
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            Body<S> const& b = bodies_[k];
            V3<S> const a = segment(x, b.motion), alpha = segment(x, b.motion + 3);
            result.com_acceleration.push_back(a);
            result.alpha.push_back(alpha);
            result.qdd.push_back(joint_acceleration(k, x));
            result.joint_force.emplace_back();
            result.constraint_force.emplace_back();
            if (links_[k].type == JointType::free) {
                result.base_acceleration = a + cross(alpha, b.to_inboard) + cross(b.omega, cross(b.omega, b.to_inboard));
                continue;
            }
            V3<S> torque = V3<S>::zero();
            for (int i = 0; i < b.locked_count; ++i) torque = torque + x[b.joint + 3 + i] * b.locked[i];
            result.joint_force[k] = {torque + b.joint_torque, segment(x, b.joint)};
            result.constraint_force[k] = {torque, segment(x, b.joint)};
        }
        return result;
    }

  private:
    void add_body(std::size_t k, System<S>& s) const {
        Body<S> const& b = bodies_[k];
        Link<S> const& link = links_[k];
        M3<S> const inertia = turned(b.orientation, link.inertia);
        s.add(b.motion, b.motion, scaled(link.mass, M3<S>::identity()));
        s.add(b.motion + 3, b.motion + 3, inertia);
        s.add(b.motion, link.mass * gravity_ + link.applied_force);
        s.add(b.motion + 3, link.applied_torque - cross(b.omega, inertia * b.omega) + b.joint_torque);
        if (k + 1 < bodies_.size()) s.add(b.motion + 3, -bodies_[k + 1].joint_torque);
    }

    /// One end of joint k: `arm` from the body's centre of mass to the joint; sign +1 on the outboard body, -1 on the inboard.
    void add_joint_end(Body<S> const& body, V3<S> const& arm, std::size_t k, S sign, System<S>& s) const {
        Body<S> const& outboard = bodies_[k];
        Index const motion = body.motion, joint = outboard.joint;
        M3<S> const one = scaled(sign, M3<S>::identity()), lever = scaled(sign, skew(arm));
        s.add(motion, joint, scaled(S(-1), one));        // Newton: the joint force
        s.add(motion + 3, joint, scaled(S(-1), lever));  // Euler: its moment
        s.add(joint, motion, one);                       // closure: acceleration of the joint's centre
        s.add(joint, motion + 3, scaled(S(-1), lever));
        s.add(joint, -sign * cross(body.omega, cross(body.omega, arm)));
        for (int i = 0; i < outboard.locked_count; ++i)
            for (int j = 0; j < 3; ++j) {
                s.matrix(motion + 3 + j, joint + 3 + i) -= sign * outboard.locked[i][j];
                s.matrix(joint + 3 + i, motion + 3 + j) += sign * outboard.locked[i][j];
            }
    }

    V3<S> joint_acceleration(std::size_t k, Column<S> const& x) const {
        Body<S> const& b = bodies_[k];
        V3<S> relative = segment(x, b.motion + 3);
        if (k > 0) relative = relative - segment(x, bodies_[k - 1].motion + 3) - cross(bodies_[k - 1].omega, b.rate);
        V3<S> const in_body = transposed_times(b.orientation, relative);
        return links_[k].type == JointType::revolute ? V3<S>{{dot(links_[k].axis, in_body), S(0), S(0)}} : in_body;
    }

    std::vector<Link<S>> links_;
    std::vector<Body<S>> bodies_;
    V3<S> gravity_;
    Index size_ = 0;
};

template <class S>
OracleResult<S> dense_beads(ChainSpec const& chain, Loads const& loads) {
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    auto const n = static_cast<Index>(chain.size());
    Index const first = chain.base == Base::fixed ? 0 : 1;
    System<S> s(4 * n - first);
    for (Index k = 0; k < n; ++k) {
        auto const at = static_cast<std::size_t>(k);
        s.add(3 * k, 3 * k, scaled(S(chain.beads.mass[at]), M3<S>::identity()));
        s.add(3 * k, bead_force<S>(chain, loads, at));
        if (k < first) continue;
        Index const row = 3 * n + k - first;
        s.right[row] = links[at].closure;
        for (int i = 0; i < 3; ++i) {
            S const u = links[at].direction[i];
            s.matrix(row, 3 * k + i) = u;
            s.matrix(3 * k + i, row) = -u;
            if (k == 0) continue;
            s.matrix(row, 3 * k - 3 + i) = -u;
            s.matrix(3 * k - 3 + i, row) = u;
        }
    }
    Column<S> const x = solve(s);
    OracleResult<S> result;
    for (Index k = 0; k < n; ++k) {
        result.com_acceleration.push_back(segment(x, 3 * k));
        result.tension.push_back(k < first ? S(0) : S(-x[3 * n + k - first]));
    }
    return result;
}

}  // namespace

template <class S>
OracleResult<S> dense(ChainSpec const& chain, Loads const& loads) {
    if (chain.size() == 0) return {};
    if (chain.is_beads()) return dense_beads<S>(chain, loads);
    Assembly<S> const assembly(chain, loads);
    return assembly.read(solve(assembly.system()));
}

template OracleResult<double> dense<double>(ChainSpec const&, Loads const&);
template OracleResult<long double> dense<long double>(ChainSpec const&, Loads const&);
template OracleResult<Quad> dense<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
