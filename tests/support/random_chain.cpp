#include "tests/support/random_chain.hpp"

#include <cmath>

namespace catena::test {
namespace {

/// From random second moments of mass about random principal axes: positive definite, triangle inequality kept.
Sym3 random_inertia(Random& random, double mass) {
    double const a = mass * std::pow(random.uniform(0.03, 0.3), 2), b = mass * std::pow(random.uniform(0.03, 0.3), 2),
                 c = mass * std::pow(random.uniform(0.03, 0.3), 2);
    Mat3 const r = to_matrix(random.orientation());
    double const principal[] = {b + c, a + c, a + b};
    Sym3 inertia = Sym3::zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            for (int p = 0; p < 3; ++p) inertia(i, j) += r(i, p) * principal[p] * r(j, p);
    return inertia;
}

std::array<double, 4> as_array(Quat const& q) { return {q.w, q.x, q.y, q.z}; }

JointType random_joint(Random& random, RandomChainOptions const& options, std::size_t k) {
    if (k == 0 && options.base == Base::free) return JointType::free;
    if (options.joints == RandomJoints::mixed) return random.chance(0.5) ? JointType::revolute : JointType::spherical;
    return options.joints == RandomJoints::revolute ? JointType::revolute : JointType::spherical;
}

/// Three numbers of which a revolute joint takes the first.
Vec3 of_joint(JointType type, Vec3 const& v) { return type == JointType::revolute ? Vec3{{v[0], 0, 0}} : v; }

void append_joint(Random& random, RandomChainOptions const& options, BodyArrays& b) {
    JointType const type = random_joint(random, options, b.joint.size());
    bool const revolute = type == JointType::revolute;
    b.joint.push_back(type);
    b.axis.push_back(random.direction());
    b.rotation.push_back(to_matrix(random.orientation()));
    b.translation.push_back(random.uniform(0.2, 0.6) * random.direction());
    Quat const orientation = random.orientation();
    b.q.push_back(revolute ? std::array<double, 4>{random.uniform(-3, 3), 0, 0, 0} : as_array(orientation));
    Vec3 const rate = of_joint(type, random.vector(2));
    b.qd.push_back(options.moving ? rate : Vec3::zero());
    if (options.loaded) b.torque.push_back(type == JointType::free ? Vec3::zero() : of_joint(type, random.vector(1)));
    if (!options.springs) return;
    bool const free = type == JointType::free;
    Vec3 const positive{{random.uniform(0, 5), random.uniform(0, 5), random.uniform(0, 5)}};
    b.stiffness.push_back(free ? Vec3::zero() : of_joint(type, positive));
    b.damping.push_back(free ? Vec3::zero() : of_joint(type, 0.1 * positive));
    Quat const rest = normalized(orientation * from_rotation_vector(random.vector(1)));
    b.rest.push_back(revolute ? std::array<double, 4>{random.uniform(-1, 1), 0, 0, 0} : as_array(rest));
}

/// Moves numbers by up to `size` of themselves.
class Perturbation {
  public:
    Perturbation(std::uint64_t seed, double size) : random_(seed), size_(size) {}
    void operator()(double& x) { x *= 1 + random_.uniform(-size_, size_); }
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
    void operator()(Mat3& rotation) { rotation = to_matrix(from_rotation_vector(random_.vector(size_))) * rotation; }

  private:
    Random random_;
    double size_;
};

}  // namespace

ChainSpec perturbed(std::uint64_t seed, ChainSpec chain, double size) {
    Perturbation move(seed, size);
    BodyArrays& b = chain.bodies;
    move(b.mass), move(b.com), move(b.inertia), move(b.axis), move(b.rotation), move(b.translation), move(b.q), move(b.qd);
    move(b.free_position), move(b.free_velocity), move(b.torque), move(b.stiffness), move(b.damping), move(b.rest), move(b.wrench);
    move(chain.beads.mass), move(chain.beads.position), move(chain.beads.velocity), move(chain.beads.anchor);
    return chain;
}

double Random::uniform(double low, double high) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return low + (high - low) * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
}
Vec3 Random::vector(double size) {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = uniform(-size, size);
    return v;
}
Vec3 Random::direction() {
    Vec3 v = vector(1);
    while (norm(v) > 1 || norm(v) < 0.1) v = vector(1);
    return (1 / norm(v)) * v;
}
Quat Random::orientation() { return from_axis_angle(direction(), uniform(-3, 3)); }

ChainSpec random_chain(std::uint64_t seed, RandomChainOptions const& options) {
    Random random(seed);
    ChainSpec chain;
    chain.name = "random";
    chain.base = options.base;
    BodyArrays& b = chain.bodies;
    for (std::size_t k = 0; k < options.bodies; ++k) {
        b.mass.push_back(std::pow(10.0, random.uniform(-0.5, 0.5)));
        b.com.push_back(random.uniform(0.02, 0.3) * random.direction());
        b.inertia.push_back(random_inertia(random, b.mass.back()));
        append_joint(random, options, b);
        if (options.loaded) {
            Vec3 const torque = random.vector(1), force = random.vector(5);
            b.wrench.push_back({torque, force});
        }
    }
    if (options.base == Base::free) {
        b.free_position = random.vector(1);
        b.free_velocity = options.moving ? random.vector(1) : Vec3::zero();
    }
    return chain;
}

ChainSpec random_bead_chain(std::uint64_t seed, std::size_t beads, Base base) {
    Random random(seed);
    ChainSpec chain;
    chain.name = "random beads";
    chain.base = base;
    BeadArrays& b = chain.beads;
    b.anchor = random.vector(1);
    Vec3 position = base == Base::fixed ? b.anchor : random.vector(1);
    Vec3 velocity = base == Base::fixed ? Vec3::zero() : random.vector(1);
    for (std::size_t k = 0; k < beads; ++k) {
        b.mass.push_back(std::pow(10.0, random.uniform(-0.5, 0.5)));
        b.length.push_back(random.uniform(0.2, 0.6));
        b.residue.push_back("UNK");
        Vec3 const along = b.length.back() * random.direction(), spin = random.vector(3);
        if (k > 0 || base == Base::fixed) {
            position = position + along;
            velocity = velocity + cross(spin, along);
        }
        b.position.push_back(position);
        b.velocity.push_back(velocity);
    }
    return chain;
}

std::vector<Vec3> random_forces(std::uint64_t seed, std::size_t beads) {
    Random random(seed);
    std::vector<Vec3> forces;
    for (std::size_t k = 0; k < beads; ++k) forces.push_back(random.vector(5));
    return forces;
}

}  // namespace catena::test
