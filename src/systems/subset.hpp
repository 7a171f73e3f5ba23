// System of some particles of another System: the share of one rank. Needs OpenMM's headers.
#pragma once

#include <OpenMM.h>

#include <memory>
#include <optional>
#include <vector>

namespace catena {

/// Number of computed values of a force. They exist since OpenMM 8; a class that lacks them has
/// none.
template <class Source>
int computed_values_of(Source const& force) {
    if constexpr (requires { force.getNumComputedValues(); }) return force.getNumComputedValues();
    return 0;
}

/// True if forces on some particles can be computed without the others. This holds for nonbonded
/// forces with a cutoff and for all common bonded forces.
bool can_be_split(OpenMM::Force const&);

/// Cutoff of a nonbonded force, nm: infinite without a cutoff, 0 for a bonded force, negative for a
/// force that cannot be split.
double reach_of(OpenMM::Force const&);
/// Longest cutoff of all forces. Precondition: every force can be split.
double reach_of(OpenMM::System const&);

/// Particles, ascending, that share a bonded term, an exception or an exclusion with one of `own`
/// and are not among them.
std::vector<int> bonded_partners(OpenMM::System const&, std::vector<int> const& own);

/// For each particle: 1 if it shares such a term with a particle of another rank, else 0.
std::vector<char> joined_across_ranks(OpenMM::System const&,
                                      std::vector<int> const& rank_of_particle);

/// Particles of another System. The first `own` particles receive all the forces that act on them.
/// The first `fixed` particles are permanent; the following ones can be exchanged.
struct Subset {
    /// Numbers of the particles in the other System.
    std::vector<int> particles;
    int own = 0, fixed = 0;
    /// Exchangeable particles, by their index here, that OpenMM treats as one molecule with the
    /// preceding particle.
    std::vector<int> after = {};
    /// Number of times that the fixed particles and all their terms are repeated; the repetitions
    /// follow one another. Above 1 all particles must be own ones.
    int repetitions = 1;
};

/// True if particles of a Subset's System can be exchanged. Parameters can be exchanged, members of
/// interaction groups and of parameter offsets cannot.
bool can_exchange_particles(OpenMM::System const&);

/// Kind of each particle. Particles of one kind have the same parameters in all nonbonded forces.
std::vector<int> kinds_of_particles(OpenMM::System const&);

/// Builds the System of the subset's particles, in their order. It has the bonded terms that
/// involve own particles, and all pairs. Exchangeable particles have no exclusions except between
/// neighbours in a molecule. Force groups and names are kept. Precondition: particles that share a
/// bonded term with own particles are among the fixed ones. If some particles are exchangeable,
/// this holds for exclusions, too.
std::unique_ptr<OpenMM::System> system_of(Subset const&, OpenMM::System const& whole);
/// Builds the System with the given forces only, by their indices in `whole`.
std::unique_ptr<OpenMM::System> system_of(Subset const&, OpenMM::System const& whole,
                                          std::vector<int> const& forces);

/// Gives the exchangeable particles of `system` the parameters of this subset's particles in
/// `whole`, also in its `context`. `system` must have been built for a subset of the same shape.
void exchange_particles(Subset const&, OpenMM::System const& whole, OpenMM::System& system,
                        OpenMM::Context& context);

}  // namespace catena
