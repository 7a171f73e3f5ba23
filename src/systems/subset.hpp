// A System for some particles of another one: what a rank computes. For files that see OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <optional>
#include <vector>

namespace catena {

/// Computed values came with OpenMM 8: a class that lacks them has none.
template <class Source>
int computed_values_of(Source const& force) {
    if constexpr (requires { force.getNumComputedValues(); }) return force.getNumComputedValues();
    return 0;
}

/// Whether forces on some particles can be had without the others: the cutoff kinds of nonbonded
/// forces, all the common bonded ones.
bool can_be_split(OpenMM::Force const&);

/// How far a nonbonded force reaches: infinite without a cutoff; 0: a bonded one; negative: it
/// cannot be split.
double reach_of(OpenMM::Force const&);
/// The longest. Precondition: every force can be split.
double reach_of(OpenMM::System const&);

/// Particles, ascending, that share a bonded term, an exception or an exclusion with one of `own`
/// and are not among them.
std::vector<int> bonded_partners(OpenMM::System const&, std::vector<int> const& own);

/// Of each particle 1 where it shares such a term with one of another rank, else 0.
std::vector<char> joined_across_ranks(OpenMM::System const&,
                                      std::vector<int> const& rank_of_particle);

/// Particles of another System: the first `own` of them with all the forces that act on them, the
/// first `fixed` for good, those after exchangeable.
struct Subset {
    std::vector<int> particles;
    int own = 0, fixed = 0;
    std::vector<int> after = {};  // exchangeable ones, by their places here, that are one molecule
                                  // to OpenMM with the one before
};

/// Whether particles of a Subset's System can be exchanged: parameters can, members of interaction
/// groups and of offsets cannot.
bool can_exchange_particles(OpenMM::System const&);

/// A number for each particle: those of one number have the same parameters in all nonbonded
/// forces.
std::vector<int> kinds_of_particles(OpenMM::System const&);

/// The System of the subset's particles, in this order: bonded terms that touch own ones, and all
/// pairs, but that exchangeable particles have no exclusions but those of neighbours in a molecule.
/// Force groups and names stay. Precondition: what shares a bonded term with own particles is among
/// the fixed ones, as is, where some are exchangeable, what shares an exclusion.
std::unique_ptr<OpenMM::System> system_of(Subset const&, OpenMM::System const& whole);
/// With some of its forces alone.
std::unique_ptr<OpenMM::System> system_of(Subset const&, OpenMM::System const& whole,
                                          std::vector<int> const& forces);

/// Gives the exchangeable particles of `system`, made for a subset of that shape, the parameters
/// that those of this one have in `whole`, and so in its `context`.
void exchange_particles(Subset const&, OpenMM::System const& whole, OpenMM::System& system,
                        OpenMM::Context& context);

}  // namespace catena
