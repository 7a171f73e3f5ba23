// Third-party and extended-precision accelerations (tests/data/reference) as chains and what is
// expected of them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::test {

/// Entry k of every array belongs to body k + 1; W ground axes. Arrays that a file does not give
/// are empty.
struct ReferenceChain {
    std::string name;  // "chain3", "chain50", "rods-8 rest", "rods-8 moving", "rods-32 rest",
                       // "rods-32 moving"
    ChainSpec chain;
    Vec3 gravity = Vec3::zero();  // W
    std::vector<Vec3> qdd;        // as in the contract: revolute {q'', 0, 0}; spherical, free: B
    Vec3 base_acceleration = Vec3::zero();            // of the origin of a free body 1, W
    std::vector<std::array<double, 6>> joint_wrench;  // trees: torque, force on the body, W
    std::vector<Vec3> com_position, com_velocity, omega, com_acceleration, alpha;  // W
    std::vector<Vec3> pin_force;  // rods: whole force on the rod at its inboard pin, W
    std::vector<std::string> qdd_digits,
        alpha_digits;  // rods: 50 digits of q'' and of the absolute alpha_z
    std::optional<double> kinetic_energy, potential_energy;
    double condition = 0;  // of the joint-space inertia
    /// How far other programs are from `qdd` relative to its largest component ("simbody_double",
    /// "mujoco_double", "pinocchio_double_aba_local", ...; rods:
    /// "pinocchio_double_relative_to_largest"), and the change of `qdd` when every input moves by
    /// 2^-52 of itself ("change_when_every_input_moves_by_2pow_minus52_relative"); chain3 and
    /// chain50.
    std::map<std::string, double> agreement;
};

/// Branched chains of rigid bodies, "tree12" and "tree60free". Throws as reference_chains().
std::vector<ReferenceChain> const& reference_trees();

/// The six chains above. Throws std::runtime_error naming the file when one cannot be read.
std::vector<ReferenceChain> const& reference_chains();
/// One of them by its name.
ReferenceChain const& reference_chain(std::string const& name);

/// Largest |component| of a - b over the largest |component| of b (Real: double, long double, ...;
/// b: the reference).
template <class Real>
Real relative_difference(std::vector<Vector<Real, 3>> const& a,
                         std::vector<Vector<Real, 3>> const& b) {
    Real difference(0), largest(0);
    for (std::size_t k = 0; k < b.size(); ++k)
        for (int i = 0; i < 3; ++i) {
            Real const d = a[k][i] - b[k][i];
            difference = d > difference ? d : -d > difference ? -d : difference;
            largest = b[k][i] > largest ? b[k][i] : -b[k][i] > largest ? -b[k][i] : largest;
        }
    return largest > Real(0) ? Real(difference / largest) : difference;
}
/// The same vectors in another scalar.
template <class To, class From>
std::vector<Vector<To, 3>> converted(std::vector<Vector<From, 3>> const& values) {
    std::vector<Vector<To, 3>> result;
    for (auto const& v : values)
        result.push_back({{static_cast<To>(v[0]), static_cast<To>(v[1]), static_cast<To>(v[2])}});
    return result;
}

}  // namespace catena::test
