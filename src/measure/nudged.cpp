// Perturbation of chains and of their equations.
#include "measure/nudged.hpp"

#include <cmath>

#include "generate/random.hpp"
#include "oracle/algebra.hpp"
#include "scene/branches.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

using Exact = oracle::OracleResult<long double>;

/// Changes numbers by random factors of 1 - size .. 1 + size, and rotations by random angles.
class Perturbation {
  public:
    Perturbation(std::uint64_t seed, double size) : draws_(seed, 0), size_(size) {}
    void operator()(double& x) { x *= 1 + draws_.between(-size_, size_); }
    template <class Container>
    void operator()(Container& values) {
        for (auto& value : values) (*this)(value);
    }
    void operator()(Vec3& v) { (*this)(v.data); }
    void operator()(Sym3& m) { (*this)(m.data); }
    void operator()(std::pair<Vec3, Vec3>& wrench) {
        (*this)(wrench.first);
        (*this)(wrench.second);
    }
    void operator()(DrivenJoint& drive) {
        for (PrescribedMotion& c : drive.course)
            (*this)(c.offset), (*this)(c.rate), (*this)(c.amplitude), (*this)(c.frequency),
                (*this)(c.phase);
    }
    void operator()(Mat3& rotation) {
        rotation = to_matrix(from_rotation_vector(draws_.in_cube(size_))) * rotation;
    }

  private:
    scene::Draws draws_;
    double size_;
};

struct Wrench {
    Vec3 torque, force;
};
/// Returns the wrench in double precision.
Wrench in_double(oracle::SpatialForce<long double> const& f) {
    Wrench w;
    for (int i = 0; i < 3; ++i)
        w.torque[i] = static_cast<double>(f.torque[i]),
        w.force[i] = static_cast<double>(f.force[i]);
    return w;
}

/// Sums of the magnitudes of the forces and moments on a body, and of the accelerations that they
/// add: at the centre of mass, and per radius about it.
struct Terms {
    double force = 0, moment = 0, linear = 0, angular = 0;
    /// Acceleration that they add at a handle at `arm` from the centre of mass.
    double at(Vec3 const& arm) const { return linear + angular * norm(arm); }
};

/// Returns the terms of every body.
std::vector<Terms> terms_of(ChainSpec const& chain, oracle::Kinematics<double> const& at,
                            Exact const& exact) {
    BodyArrays const& b = chain.bodies;
    std::vector<Terms> all(b.size());
    auto const add = [&](std::size_t k, Wrench const& wrench, Vec3 const& arm) {
        oracle::Cholesky<double, 3> const inertia(full(b.inertia[k]));
        all[k].force += norm(wrench.force);
        for (Vec3 const& m : {wrench.torque, cross(arm, wrench.force)}) {
            all[k].moment += norm(m);
            all[k].angular += norm(inertia.solve(transposed_times(at.orientation[k], m)));
        }
    };
    for (std::size_t k = 0; k < b.size(); ++k) {
        Wrench const inboard = in_double(exact.joint_force[k]);
        add(k, inboard, at.origin[k] - at.com_position[k]);
        if (k > 0) {
            std::size_t const before = scene::inboard_of(chain.parent, k);
            add(before, inboard, at.origin[k] - at.com_position[before]);
        }
        if (!b.wrench.empty()) add(k, {b.wrench[k].first, b.wrench[k].second}, Vec3::zero());
    }
    add(b.size() - 1, in_double(exact.tip_force),
        at.orientation.back() * (chain.tip_joint.translation - b.com.back()));
    for (std::size_t k = 0; k < b.size(); ++k) all[k].linear = all[k].force / b.mass[k];
    return all;
}

/// Perturbs the force on each bead, and the closing of each link by a fraction of what forces and
/// links add to the accelerations of its ends.
void nudge_beads(Nudged& n, Exact const& exact, scene::Draws draws, double size) {
    std::size_t const beads = n.chain.size();
    n.loads.bead_forces.resize(beads, Vec3::zero());
    n.loads.link_gaps.assign(exact.tension.size() + (n.chain.tip == Tip::jointed ? 1 : 0), 0.0);
    std::vector<double> outboard(beads, 0.0), acceleration(beads, 0.0);
    for (std::size_t k = 1; k < beads; ++k)
        outboard[scene::inboard_of(n.chain.parent, k)] +=
            std::abs(static_cast<double>(exact.tension[k]));
    outboard.back() += norm(in_double(exact.tip_force).force);
    for (std::size_t k = 0; k < beads; ++k) {
        double const inboard = std::abs(static_cast<double>(exact.tension[k]));
        Vec3& force = n.loads.bead_forces[k];
        double const terms = inboard + outboard[k] + norm(force);
        acceleration[k] = terms / n.chain.beads.mass[k];
        double const before = k == 0 ? 0 : acceleration[scene::inboard_of(n.chain.parent, k)];
        force = force + draws.in_cube(size * terms);
        n.loads.link_gaps[k] = draws.between(-size, size) * (before + acceleration[k]);
    }
    if (n.chain.tip == Tip::jointed)
        n.loads.link_gaps.back() = draws.between(-size, size) * acceleration.back();
}

/// Perturbs the wrench on each body and the closing of each joint.
void nudge_bodies(Nudged& n, ChainSpec const& chain, oracle::Loads const& loads, Exact const& exact,
                  scene::Draws draws, double size) {
    BodyArrays& b = n.chain.bodies;
    auto const at = oracle::kinematics<double>(chain, loads);
    b.wrench.resize(b.size(), {Vec3::zero(), Vec3::zero()});
    std::vector<Terms> const terms = terms_of(chain, at, exact);
    for (std::size_t k = 0; k < b.size(); ++k) {
        Terms const& t = terms[k];
        double turning = t.angular, linear = t.at(at.origin[k] - at.com_position[k]);
        if (k > 0) {
            std::size_t const before = scene::inboard_of(chain.parent, k);
            turning += terms[before].angular;
            linear += terms[before].at(at.origin[k] - at.com_position[before]);
        }
        b.wrench[k].first = b.wrench[k].first + draws.in_cube(size * t.moment);
        b.wrench[k].second = b.wrench[k].second + draws.in_cube(size * t.force);
        Vec3 const of_turning = draws.in_cube(size * turning);
        n.loads.gaps.emplace_back(of_turning, draws.in_cube(size * linear));
    }
}

}  // namespace

ChainSpec perturbed(std::uint64_t seed, ChainSpec chain, double size) {
    Perturbation move(seed, size);
    BodyArrays& b = chain.bodies;
    move(b.mass), move(b.com), move(b.inertia), move(b.axis), move(b.rotation), move(b.translation),
        move(b.q), move(b.qd);
    move(b.free_base.position), move(b.free_base.velocity);
    terms::for_each_column([&](auto const& column) {
        if (!column.named) move(b.*column.values);
    });
    move(chain.beads.mass), move(chain.beads.position), move(chain.beads.velocity),
        move(chain.beads.anchor);
    TipJoint& tip = chain.tip_joint;
    move(tip.axis), move(tip.first_axis), move(tip.pitch), move(tip.rotation),
        move(tip.translation), move(tip.q);
    if (tip.anchor) move(*tip.anchor);
    LinkedArrays& l = chain.linked;
    move(l.mass), move(l.inertia), move(l.position), move(l.velocity), move(l.orientation),
        move(l.omega), move(l.inboard);
    move(l.outboard), move(l.anchor);
    move(b.first_axis), move(b.pitch);
    terms::for_each_column([&](auto const& column) {
        if (column.named) move(b.*column.values);
    });
    move(b.driven);
    for (TermNumbers& each : chain.term_numbers) move(each.values);
    return chain;
}

Nudged nudged(std::uint64_t seed, ChainSpec const& chain, oracle::Loads const& loads,
              Exact const& exact, double size) {
    Nudged n{perturbed(seed, chain, size), loads};
    if (chain.is_beads()) nudge_beads(n, exact, scene::Draws(seed, 1), size);
    if (chain.bodies.size() > 0) nudge_bodies(n, chain, loads, exact, scene::Draws(seed, 1), size);
    return n;
}

}  // namespace catena
