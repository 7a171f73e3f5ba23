// Measures of one conformation of a bead chain: its size and its configurational temperature, for
// rigid links or for springs.
#pragma once

#include <span>

#include "math/linear.hpp"

namespace catena {

/// Measure in which the directions of bonds are weighted by exp(-U / kT). `flexible` is the measure
/// of springs, and of rigid links with the Fixman potential. `rigid` is that of rigid links, with
/// an additional factor (det T)^1/2 (dynamics/fixman.hpp).
enum class BondMeasure { flexible, rigid };

/// Sizes of a chain, and two sums for the configurational temperature, T = <virial> / (kB
/// <divergence>).
///
/// Bond b_j (j = 0 .. n - 2) points from bead j to bead j + 1. Let e_j = b_j / |b_j| and
/// c_j = e_j-1 . e_j. For j > 0 all beads beyond bond j are displaced across bond j, along
///
///     w_j = e_j-1 - c_j e_j.
///
/// No bond changes its length, so the bonds' own forces do no work. For a density
/// mu exp(-U / kT) of the b_j, the mean of the derivative of (density w_j) is zero:
///
///     <F_j . w_j> = kT <2 c_j / |b_j| - d ln mu / dw_j>.
///
/// F_j is the sum of all forces except the bonds' on the beads beyond bond j, and 2 c_j / |b_j| is
/// -div w_j.
///
/// For springs, mu depends on lengths alone: d ln mu / dw_j = 0. For rigid links
/// mu = (det T)^1/2 with T_jj = 1/m_j + 1/m_j+1, T_j-1,j = -c_j / m_j. Then
/// g_j = d ln mu / dc_j = -(T^-1)_j-1,j / m_j, and for a rotation of bond j
///
///     d ln mu / dw_j = (g_j (1 - c_j^2) + g_j+1 w_j . e_j+1) / |b_j|.
///
/// Both sides are summed over j.
///
/// Bond j is rotated towards e_j-1, because the force between second neighbours, the stiffest after
/// the bonds', acts along it. Mean cosines of 0.2 to 0.5 keep the divergence far from zero. A chain
/// without forces has mean divergence zero in its own measure, and no temperature.
struct ChainSample {
    /// Radius of gyration, weighted with masses, and end-to-end distance, in the unit of x.
    double radius_of_gyration = 0, end_to_end = 0;
    double cosine = 0;                  // mean of c_j
    double virial = 0, divergence = 0;  // in units of force and 1 / length
};

/// Computes the sample of one chain with n > 2 beads. `x`: positions; `force`: forces without those
/// of the bonds; `mass`: masses; all in the order of the beads.
ChainSample sample_chain(std::span<Vec3 const> x, std::span<Vec3 const> force,
                         std::span<double const> mass, BondMeasure);

/// Returns 1/2 ln det T of beads on rigid links. `e`: unit vectors along the bonds, one fewer than
/// masses.
double half_log_det(std::span<Vec3 const> e, std::span<double const> mass);

}  // namespace catena
