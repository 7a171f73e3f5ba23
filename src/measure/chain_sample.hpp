// What one conformation of a chain of beads says: its size, and its configurational temperature
// whether links are rigid or springs.
#pragma once

#include <span>

#include "math/linear.hpp"

namespace catena {

/// The measure in which bonds' directions are weighed by exp(-U / kT): that of springs, which rigid
/// links with the Fixman potential have too; or that of rigid links, with the root of det T before
/// it (dynamics/fixman.hpp).
enum class BondMeasure { flexible, rigid };

/// `virial` and `divergence` give the configurational temperature, T = <virial> / (kB
/// <divergence>). Bond b_j (j = 0 .. n - 2) leads from bead j to bead j + 1, e_j = b_j / |b_j|, c_j
/// = e_j-1 . e_j. For j > 0 all beads beyond bond j are displaced along
///     w_j = e_j-1 - c_j e_j,
/// across bond j, so that no bond changes its length and the bonds' own forces do no work. The mean
/// of the derivative of (density w_j) is none, for a density mu exp(-U / kT) of the b_j:
///     <F_j . w_j> = kT <2 c_j / |b_j| - d ln mu / dw_j>,    F_j: the forces but the bonds' on all
///     beads beyond bond j,
/// 2 c_j / |b_j| being -div w_j. For springs mu hangs on lengths alone: d ln mu / dw_j = 0. For
/// rigid links mu = (det T)^1/2 with T_jj = 1/m_j + 1/m_j+1, T_j-1,j = -c_j / m_j, so that g_j = d
/// ln mu / dc_j = -(T^-1)_j-1,j / m_j, and as bond j turns
///     d ln mu / dw_j = (g_j (1 - c_j^2) + g_j+1 w_j . e_j+1) / |b_j|.
/// Both sides are summed over j. e_j-1 is taken for what bond j turns towards because what keeps
/// neighbours but one apart, the stiffest force after the bonds', works along it; mean cosines of
/// 0.2 to 0.5 keep the divergence far from zero. A chain without forces has a mean divergence of
/// none in its own measure, and no temperature.
struct ChainSample {
    double radius_of_gyration = 0,
           end_to_end = 0;              // the former weighted with masses; in the unit of x
    double cosine = 0;                  // mean of c_j
    double virial = 0, divergence = 0;  // force; 1 / length
};

/// Of one chain: positions, forces but the bonds' own, and masses of its n > 2 beads in their
/// order.
ChainSample sample_chain(std::span<Vec3 const> x, std::span<Vec3 const> force,
                         std::span<double const> mass, BondMeasure);

/// 1/2 ln det T of beads on rigid links, per bond directions `e` (unit vectors, one fewer than
/// masses).
double half_log_det(std::span<Vec3 const> e, std::span<double const> mass);

}  // namespace catena
