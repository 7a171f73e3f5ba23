// The time integrators and what distinguishes them. Everything that depends on an integrator reads
// its row here; src/integrate/README.md describes each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace catena {

/// Time integrator.
enum class Integrator : std::uint8_t {
    rk4,
    dormand_prince,
    velocity_verlet,
    leapfrog,
    staggered,
    baoab,
    implicit_baoab,
    rattle,
    g_baoab,
    implicit_g_baoab
};

/// Properties of an integrator.
struct IntegratorTraits {
    Integrator kind;
    /// Name in scenes and messages.
    char const* name;
    /// Number in fingerprints of scenes. It must not change.
    int code;
    /// Order of convergence without noise.
    int order;
    /// Stability limit: time step times the largest angular frequency, undamped.
    double stability;
    /// True if the state is in joint coordinates, false if it is in absolute coordinates.
    bool joint_coordinates;
    /// True if a step consists of whole evaluations, whose solutions are refined `solver.refine`
    /// times. The other integrators solve more than once with one matrix.
    bool refined;
    /// True if a step has an error estimate, which may choose its length. Such a step takes over
    /// the last evaluation of the step before.
    bool adaptive;
    /// True if the integrator has a thermostat.
    bool langevin;
    /// True if springs and dampers of joints are integrated implicitly.
    bool implicit;
    /// True if steps can run on a GPU.
    bool on_gpu;
    /// Factor c of the rotor inertia c h^2 K that replaces a spring K in its joint within a step h.
    /// The least stable value for constant K is 1/4 (src/dca/README.md, "Implicit joint springs").
    /// The value 1/2 leaves room for the contribution of bending and rotation to K. Under a
    /// thermostat a joint rotates by its thermal angle / sqrt(c) per step. Anharmonic terms within
    /// that angle shift the equilibrium; c = 2 has a quarter of the shift of c = 1/2.
    double rotor_of_spring;
};

/// One row per integrator, in the order of the enumeration.
inline constexpr std::array<IntegratorTraits, 10> integrators{{
    // clang-format off
    // kind                        name                code order stability joint  refined adaptive langevin implicit on_gpu rotor
    {Integrator::rk4,              "rk4",              0,   4,    2.8284,   true,  true,   false,   false,   false,   true,  2.0},
    {Integrator::dormand_prince,   "dormand-prince",   8,   5,    3.3,      true,  true,   true,    false,   false,   true,  2.0},
    {Integrator::velocity_verlet,  "velocity-verlet",  3,   2,    2.0,      true,  true,   false,   false,   false,   true,  2.0},
    {Integrator::leapfrog,         "leapfrog",         9,   2,    2.0,      true,  false,  false,   false,   false,   true,  2.0},
    {Integrator::staggered,        "staggered",        4,   2,    2.0,      true,  false,  false,   false,   true,    false, 0.5},
    {Integrator::baoab,            "baoab",            5,   2,    2.0,      true,  false,  false,   true,    false,   false, 2.0},
    {Integrator::implicit_baoab,   "implicit-baoab",   6,   2,    2.0,      true,  false,  false,   true,    true,    false, 2.0},
    {Integrator::rattle,           "rattle",           1,   2,    2.0,      false, false,  false,   false,   false,   true,  2.0},
    {Integrator::g_baoab,          "g-baoab",          2,   2,    2.0,      false, false,  false,   true,    false,   true,  2.0},
    {Integrator::implicit_g_baoab, "implicit-g-baoab", 7,   2,    2.0,      false, false,  false,   true,    true,    false, 2.0},
    // clang-format on
}};

namespace detail {
/// True if each row stands at the place of its integrator.
constexpr bool rows_are_in_order() {
    for (std::size_t k = 0; k < integrators.size(); ++k)
        if (static_cast<std::size_t>(integrators[k].kind) != k) return false;
    return true;
}
static_assert(rows_are_in_order());
}  // namespace detail

/// Returns the row of an integrator.
constexpr IntegratorTraits const& traits_of(Integrator i) {
    return integrators[static_cast<std::size_t>(i)];
}
constexpr char const* name_of(Integrator i) { return traits_of(i).name; }
constexpr bool uses_joint_coordinates(Integrator i) { return traits_of(i).joint_coordinates; }
constexpr bool is_refined(Integrator i) { return traits_of(i).refined; }
constexpr bool is_adaptive(Integrator i) { return traits_of(i).adaptive; }
constexpr bool is_langevin(Integrator i) { return traits_of(i).langevin; }
constexpr bool is_implicit(Integrator i) { return traits_of(i).implicit; }
constexpr double rotor_of_spring(Integrator i) { return traits_of(i).rotor_of_spring; }

}  // namespace catena
