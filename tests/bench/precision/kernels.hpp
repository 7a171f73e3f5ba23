// Sweeps over one chain with single- or double-precision numbers, for one instruction set: what its
// source offers.
//
// A chain is cut into as many stretches as a vector has lanes, one a lane: row i of an array holds
// body i of every stretch, number after number. Within a stretch runs of 16 bodies join, then pairs
// of runs, pairs of these, ...; at last the stretches do, lane by lane.
#pragma once

#include <cstdint>

namespace catena::precision {

inline constexpr std::int64_t bodies_of_run = 16;

/// What a chain keeps. Sweeps are in Real, which is single or double; `body`, `given`, `solution`
/// are always in double.
enum Array {
    state,   // what sweeps read of a body; one row more (the direction of the link behind the last
             // body)
    loads,   // forces, torques, rates and joints' biases
    joint,   // eliminated joints
    offset,  // their biases
    force,   // at the ends of runs
    matrix,  // segments of runs and of nodes above them
    bias,    // theirs
    top,     // joints between stretches, and that to the ground
    top_offset,  // biases of these
    body,        // as `state`, with the mass and inertia that equations of motion have; double
    given,       // as `loads`; double
    solution,    // accelerations and joint forces; double
    defect,      // what the equations lack of them, as loads
    arrays
};

/// Bodies a lane: runs of 16, their number a power of two.
struct Work {
    void* of[arrays];
    std::int64_t rows = 0;
    int restricted_at_base = 0;  // directions that the first joint restricts
};

struct Kernels {
    int lanes = 0;
    int record_bytes[arrays] = {};
    int real_bytes = 0;
    /// Matrices of all segments and joints; false where one is not positive definite.
    bool (*assemble)(Work const&) = nullptr;
    /// Biases, forces and accelerations from `loads` into `solution`; from `defect` added to it.
    void (*solve)(Work const&) = nullptr;
    void (*correct)(Work const&) = nullptr;
    /// From `solution` to `defect`, in double.
    void (*find_defect)(Work const&) = nullptr;
};

enum class Joint { link, spherical, revolute };
inline constexpr int kinds_of_joint = 3;
/// Of one instruction set.
struct KernelTable {
    Kernels in_double[kinds_of_joint], in_single[kinds_of_joint];
};
KernelTable scalar_kernels();
/// Preconditions: simd_levels() has them.
KernelTable avx2_kernels();
KernelTable avx512_kernels();

}  // namespace catena::precision
