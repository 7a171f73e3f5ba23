// Concentrations of chains: numbers of copies and cubic boxes that follow from them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "place/draft.hpp"

namespace catena::scene {

/// A concentration as the scene gives it.
struct Concentration {
    /// Value in mg/ml or, if `molar`, in mmol/l.
    double value = 0;
    bool molar = false;
};

/// Reads a number with a unit: "5 mg/ml", "5 g/l", "0.4 mmol/l", "400 umol/l", "0.4 mM". Throws
/// InputError without a unit and for a number that is not positive.
Concentration read_concentration(Node const&);

/// Returns the mass of a chain, amu.
double mass_of(ChainSpec const& chain);

/// Returns the number of copies of `chain` that come nearest to the concentration in the region.
/// Adds a note if they miss it by more than 2 %. Throws InputError if not even one copy is needed.
std::int64_t copies_for(Node const& concentration, ChainSpec const& chain, Region const& region,
                        Scene& scene);

/// Returns the edges of the cube in which the drafts together have the concentration, rounded to
/// 1e-4 nm.
Vec3 cube_for(Concentration const& concentration, std::vector<Draft> const& drafts);

/// Returns the concentration of a mass, amu, and of a number of chains in a volume, nm^3.
double mg_per_ml_of(double mass, double volume);
double mmol_per_l_of(double chains, double volume);

}  // namespace catena::scene
