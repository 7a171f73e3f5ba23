// Scenes of beads for the tests of forces.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "error.hpp"
#include "force/openmm_force.hpp"
#include "math/field.hpp"

namespace catena::testing {

/// Chains of amino acids (one-letter codes) with links of 0.38 nm, named A, B, ..., split evenly
/// over the ranks.
BeadSystem proteins(std::vector<std::string> const& sequences, int ranks = 1,
                    std::optional<Vec3> const& box = std::nullopt);

/// The same beads on another number of ranks.
BeadSystem split(BeadSystem beads, int ranks);

/// Beads without overlaps: the chains wind about parallel lines along x, 0.3 nm a bead. Neighbours
/// are not 0.38 nm apart: forces do not mind.
std::vector<Vec3> wound(BeadSystem const& beads, std::uint64_t seed);

/// Each component moved by up to `amplitude`.
void shake(std::vector<Vec3>& positions, double amplitude, std::uint64_t seed);

/// `length` letters.
std::string random_sequence(std::size_t length, std::uint64_t seed);

/// The forces on a rank's own beads in one evaluation.
std::vector<Vec3> evaluate(OpenMmForce& force, BeadSystem const& beads, int rank,
                           std::vector<Vec3> const& all);

/// The forces on all beads, computed by one rank.
std::vector<Vec3> evaluate(OpenMmForce& force, std::vector<Vec3> const& all);

double largest(std::vector<Vec3> const& forces);

/// The largest difference of a component between `part` and the run of `whole` that begins at
/// `first`.
double difference(std::vector<Vec3> const& part, std::vector<Vec3> const& whole,
                  std::int64_t first = 0);

/// A spec for the double-precision platform, inline.
OpenMmSpec on_reference(std::string const& builder = "calvados2");

/// What `call` complains about as an InputError; fails the test where it does not.
template <class Call>
std::string complaint(Call call) {
    try {
        call();
    } catch (InputError const& e) {
        return e.what();
    } catch (std::exception const& e) {
        ADD_FAILURE() << "not an InputError: " << e.what();
        return "";
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

/// A file in the tests' scratch folder that no other process uses, holding `text`.
std::string scratch_file(std::string const& name, std::string const& text);

/// A PDB topology with one atom a bead.
std::string pdb_of(BeadSystem const& beads, std::vector<Vec3> const& positions);

}  // namespace catena::testing
