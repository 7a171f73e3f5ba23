// The list of force terms, and what is asked of all of them. A new term is one file beside this
// one, an entry of ForceTerms and its keys (src/keys).
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

#include "joints/joint_models.hpp"
#include "terms/constant_force.hpp"
#include "terms/drag.hpp"
#include "terms/fixman_term.hpp"
#include "terms/gravity.hpp"
#include "terms/joint_damper.hpp"
#include "terms/joint_spring.hpp"
#include "terms/joint_torque.hpp"
#include "terms/openmm_term.hpp"
#include "terms/wrench.hpp"

namespace catena::terms {

/// All force terms, in the order of columns of energies, of `check`, and of sums.
using ForceTerms = TypeList<Gravity, JointSpring, JointDamper, JointTorque, Wrench, Drag,
                            ConstantForce, FixmanTerm, OpenMmTerm>;

/// Calls visitor(term) for every term.
template <class Visitor>
void for_each(Visitor const& visitor) {
    joints::for_each(visitor, ForceTerms{});
}
/// True if property(term) is true for a term.
template <class Property>
bool any_of(Property const& property) {
    bool any = false;
    for_each([&](auto term) { any = any || property(term); });
    return any;
}

/// Number of joints, bodies or beads of the scene on which a term acts.
template <class Term>
std::int64_t count_in(Scene const& scene) {
    std::int64_t count = 0;
    for (ChainSpec const& chain : scene.chains) count += Term::count(scene, chain);
    return count;
}
/// True if it acts on a body of the scene.
template <class Term>
bool acts_in(Scene const& scene) {
    for (ChainSpec const& chain : scene.chains)
        if (Term::count(scene, chain) > 0) return true;
    return false;
}

/// Sum of the constant wrenches on body k of a chain. A single one keeps its bits.
inline ConstantWrench constant_wrench(ChainSpec const& chain, std::size_t k) {
    ConstantWrench sum{Vec3::zero(), Vec3::zero()}, one = sum;
    bool any = false;
    for_each([&](auto term) {
        if (!decltype(term)::constant_wrench(chain, k, one)) return;
        sum = any ? ConstantWrench{sum.first + one.first, sum.second + one.second} : one;
        any = true;
    });
    return sum;
}
/// Columns of BodyArrays that belong to terms, in the order of fingerprints.
template <class Use>
void for_each_column(Use const& use) {
    for (int place = 0; place < places_of_columns; ++place)
        for_each([&](auto term) {
            decltype(term)::columns([&](auto const& column) {
                if (column.place == place) use(column);
            });
        });
}

/// Place of a term's energy among those of all terms; those without energy do not count.
template <class Term>
constexpr std::size_t place_of_energy() {
    std::size_t place = 0, found = 0;
    auto const look = [&](auto term) {
        if constexpr (std::is_same_v<decltype(term), Term>) found = place;
        if (decltype(term)::energy != nullptr) ++place;
    };
    [&]<class... Terms>(TypeList<Terms...>) { (look(Terms{}), ...); }(ForceTerms{});
    return found;
}
/// Number of terms with an energy.
constexpr std::size_t count_energies() {
    std::size_t count = 0;
    [&]<class... Terms>(TypeList<Terms...>) {
        ((count += Terms::energy != nullptr ? 1 : 0), ...);
    }(ForceTerms{});
    return count;
}
inline constexpr std::size_t number_of_energies = count_energies();

/// A column of energies in output.
struct EnergyColumn {
    char const* name = "";
    std::size_t place = 0;  // Among the energies of all terms.
};
/// Columns of energies that the scene has, but for OpenMM's.
std::vector<EnergyColumn> energy_columns(Scene const&);
/// Names of all columns that a scene may have.
std::vector<std::string> names_of_energies();
/// True if a term with an energy acts on a body of the scene.
bool has_potential(Scene const&);

/// Numbers of joints, bodies or beads on which a term acts.
struct TermCount {
    std::string name;                   // In JSON.
    std::string text, on_one, on_many;  // "dampers", "joint", "joints".
    bool on_joints = false;
    std::int64_t count = 0;
};
/// Counts of the terms for which `check` has no line of their own.
std::vector<TermCount> counts(Scene const&);
/// Returns what acts on the chains in words: the force model of OpenMM, then terms with values for
/// all bodies; empty if nothing does.
std::string forces_text(Scene const&);
/// Returns the reason that excludes GPUs, or an empty string if a GPU can run the scene.
std::string why_host_alone(Scene const&);

/// Returns `before`, the keys of bodies that do not act on links, and `after`.
std::vector<char const*> keys_beside(std::initializer_list<char const*> before,
                                     std::initializer_list<char const*> after);
/// Reads the keys of terms from `forces`.
void read(scene::Fields const& forces, ForceSpec&);
/// Reads the keys of terms of a chain whose bodies stand in a list.
void read_bodies(scene::Node const& list, ForceSpec const&, ChainSpec&);

}  // namespace catena::terms
