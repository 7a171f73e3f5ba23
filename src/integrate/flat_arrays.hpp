// Arrays of vectors as arrays of numbers, and arrays of pieces as arrays of bodies.
#pragma once

#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// Returns the components of all vectors, one vector after the other.
std::vector<double> flat(std::vector<Vec3> const& values);
/// Inverse of flat().
std::vector<Vec3> triples(std::vector<double> const& values);
/// Stores a quantity of pieces' first bodies as one entry per body; zeros elsewhere.
std::vector<double> at_starts(ChainGroup const& group, Field<3> const& of_piece);
/// Inverse of at_starts().
Field<3> of_starts(ChainGroup const& group, std::vector<Vec3> const& of_body);

}  // namespace catena
