// What all forces on bodies have in common. A force term is a type with static members, one file
// per term; force_terms.hpp lists them. It reads its keys, says on what it acts, adds its force and
// its energy, and enters descriptions and fingerprints. Frames: W ground axes, B body axes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "math/host_device.hpp"
#include "scene/fields.hpp"
#include "scene/scene.hpp"

namespace catena::terms {

/// Torque about the centre of mass and force, W.
using ConstantWrench = std::pair<Vec3, Vec3>;

/// An optional array of BodyArrays that belongs to a term.
template <class T>
struct Column {
    using Member = std::vector<T> BodyArrays::*;
    Member values;
    /// Place in fingerprints, from 0. It must not change.
    int place = 0;
    /// Name under which fingerprints hold the array, and only if it is not empty. Null for arrays
    /// that they always hold.
    char const* named = nullptr;
};
/// Number of places of columns in fingerprints.
inline constexpr int places_of_columns = 6;

/// Place of a term's values for the whole scene in fingerprints. It must not change.
enum class PrintPlace { none, before_chains, forces, before_dynamics, after_dynamics };
/// Section of the scene that holds a term's values for all bodies.
enum class Section { none, forces, dynamics };

/// A body whose energy in a term is asked for.
struct PlacedBody {
    /// Index among this rank's bodies of the group.
    std::int64_t k = 0;
    double mass = 0;
    Vec3 centre = Vec3::zero();  // Centre of mass, W.
    JointType joint = JointType::free;
    /// Position of the inboard joint as BodyArrays::q; zero where a joint has no springs.
    Vector<double, 4> q = Vector<double, 4>::zero();
};

/// Members of a term that has nothing special. Each term also has `name`, and count().
struct ForceTerm {
    /// Name of the column of its energy; null if it has none, or if OpenMM computes it.
    static constexpr char const* energy = nullptr;
    /// True if the column is there even if the term does not act.
    static constexpr bool always_has_energy = false;
    /// True if it adds or removes energy that no column counts.
    static constexpr bool does_work = false;
    /// True if its force depends on velocities.
    static constexpr bool depends_on_velocities = false;
    /// True if its force may heat bodies under a thermostat without bound.
    static constexpr bool pushes = false;
    /// True if its force needs the matrices of the solver.
    static constexpr bool needs_matrices = false;
    /// Properties of bodies in joint coordinates on which it acts: positions and linear velocities,
    /// orientations, and whether it exerts forces besides torques.
    static constexpr bool uses_positions = false, uses_orientations = false, exerts_forces = false;
    /// True if it acts along the coordinates of joints.
    static constexpr bool acts_along_joints = false;
    /// True if bodies and beads on links may have it; each body on other joints may.
    static constexpr bool on_links = true;
    /// True if it exerts a constant wrench on bodies (constant_wrench()).
    static constexpr bool has_constant_wrench = false;
    /// Object of its action, in messages.
    static constexpr char const* on_one = "body";
    static constexpr char const* on_many = "bodies";
    /// Name in messages that refuse it.
    static constexpr char const* in_messages = "";
    /// Advice to remove it, in messages that refuse it.
    static constexpr char const* remedy = "leave it out";
    /// Name in `check`; null if `check` has a line of its own for it.
    static constexpr char const* in_check = nullptr;
    /// Key of each body, and key of `forces`; null if it has none.
    static constexpr char const* body_key = nullptr;
    static constexpr char const* scene_key = nullptr;
    /// True if the programs of `bench peers` have it, and those of `bench sampling`.
    static constexpr bool known_to_peers = false, known_to_openmm = false;
    /// Lack of inverse dynamics in words; null if the oracles know the term.
    static constexpr char const* unknown_to_oracles = nullptr;
    /// Savings of forward dynamics without it, for `plan`; null if that is not measured.
    static constexpr char const* saving = nullptr;
    static constexpr PrintPlace print_place = PrintPlace::none;
    static constexpr Section section = Section::none;

    /// Reads the term's values for all bodies from `forces`.
    static void read(scene::Fields const& /*forces*/, ForceSpec&) {}
    /// Reads the keys of body k of a chain written body by body. The chain's other arrays are
    /// complete.
    static void read_body(scene::Node const& /*body*/, std::size_t /*k*/, ForceSpec const&,
                          ChainSpec&) {}
    /// Reads the datasets of a chain in a file (Hdf5Bodies).
    template <class Table>
    static void read_table(Table&, ChainSpec&) {}

    /// Calls use(column) for each of the term's columns.
    template <class Use>
    static void columns(Use const&) {}
    /// Sets the constant wrench of body k; returns false if the chain has none.
    static bool constant_wrench(ChainSpec const&, std::size_t /*k*/, ConstantWrench&) {
        return false;
    }

    /// Adds the values for all bodies to those that decide the motion (scene::DecidingValues).
    template <class Values>
    static void decide(Scene const&, Values&) {}
    /// Adds them to a fingerprint (scene::Fingerprint).
    template <class Print>
    static void print(Scene const&, Print&) {}
    /// The term in words, with its values for all bodies; empty if it has none.
    static std::string text(Scene const&) { return {}; }
    /// Addition to the dynamics in words.
    static std::string dynamics_text(Scene const&) { return {}; }
    /// Reason that excludes GPUs; empty if there is none.
    static std::string why_host_alone(Scene const&) { return {}; }
    /// Puts the term on all bodies of the first chain, to measure it.
    static void put(Scene&, std::size_t /*bodies*/) {}

    /// Properties of a group's bodies: arrays on the host, in a Space, or views of them.
    template <template <int> class F>
    struct Arrays {};
    /// Converts arrays: convert() makes a field of another one.
    template <class To, class From, class Convert>
    static To converted(From const&, Convert const&) {
        return {};
    }
    /// Fills the arrays from a group (BodyLoadsMaker).
    template <class Maker, class To>
    static void collect(Maker const&, To&) {}
    /// True if the term acts on a body of the group.
    template <class From>
    static bool acts_in(From const&) {
        return false;
    }
    /// Energy of a body, kJ/mol.
    template <class From>
    static double energy_of(From const&, PlacedBody const&) {
        return 0;
    }
    /// Adds the loads along the coordinates of a joint (LoadedJoint, LoadedAxis).
    template <class Joint, class Vector3>
    CATENA_HD static void add_along(Joint const&, Vector3& /*along*/) {}
    template <class Axis>
    CATENA_HD static void add_about_axis(Axis const&, double& /*along*/) {}
    /// Adds the force and the moment about the centre of mass of body k, B.
    template <class Bodies, class Place, class Vector3>
    CATENA_HD static void add_on_body(Bodies const&, Place, Vector3& /*moment*/,
                                      Vector3& /*push*/) {}
};

/// Returns "[x, y, z]".
std::string vector_text(Vec3 const&);
/// True if a component is not zero.
inline bool acts(Vec3 const& v) { return v[0] != 0 || v[1] != 0 || v[2] != 0; }
/// Number of entries that are not zero.
inline std::int64_t count_of(std::vector<Vec3> const& values) {
    std::int64_t count = 0;
    for (Vec3 const& v : values) count += acts(v) ? 1 : 0;
    return count;
}
/// Entry k of an optional array; zero if the array is empty.
inline Vec3 entry(std::vector<Vec3> const& values, std::size_t k) {
    return values.empty() ? Vec3::zero() : values[k];
}
/// Sets entry k of an optional array of n entries, which is filled with `others` first.
template <class T>
void set_entry(std::vector<T>& values, std::size_t k, std::size_t n, T const& value,
               T const& others) {
    if (values.empty()) values.assign(n, others);
    values[k] = value;
}
/// Numbers that a term keeps for body k (ChainSpec::term_numbers); null if the chain has none.
inline double const* numbers_of(ChainSpec const& chain, std::string_view term, std::size_t k) {
    for (TermNumbers const& each : chain.term_numbers)
        if (each.term == term) return each.values.data() + k * static_cast<std::size_t>(each.width);
    return nullptr;
}
/// Numbers of body k, to be set; those of all bodies are 0 at first.
inline double* numbers_for(ChainSpec& chain, std::string_view term, int width, std::size_t k) {
    for (TermNumbers& each : chain.term_numbers)
        if (each.term == term) return each.values.data() + k * static_cast<std::size_t>(width);
    chain.term_numbers.push_back(
        {std::string(term), width,
         std::vector<double>(chain.size() * static_cast<std::size_t>(width), 0.0)});
    return chain.term_numbers.back().values.data() + k * static_cast<std::size_t>(width);
}

}  // namespace catena::terms
