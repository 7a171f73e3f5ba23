// Implements the Systems of subsets: copies of forces with renumbered particles. Pair forces are
// copied for all particles of the subset. Bonded terms are copied if they involve an own particle,
// so that each rank computes all forces on its own particles.
#include "systems/subset.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "systems/bonded_forces.hpp"

namespace catena {

namespace {

using namespace OpenMM;  // this file uses no other library

/// Collects the partners of own particles; keeps no term.
class PartnerCollector : public TermFilter {
  public:
    /// Collector for the particles `own` among `particle_count`.
    PartnerCollector(int particle_count, std::vector<int> const& own)
        : own_(particle_count, false) {
        for (int p : own) own_[p] = true;
    }
    bool keep(std::span<int* const> particles) override {
        bool const touches =
            std::any_of(particles.begin(), particles.end(), [&](int const* p) { return own_[*p]; });
        if (touches)
            for (int const* p : particles)
                if (!own_[*p]) partners_.insert(*p);
        return false;
    }
    /// Partners in ascending order.
    std::vector<int> partners() const { return {partners_.begin(), partners_.end()}; }

  private:
    std::vector<bool> own_;
    std::set<int> partners_;
};

/// Marks the particles of terms that join different ranks; keeps no term.
class JoinedAcrossRanks : public TermFilter {
  public:
    explicit JoinedAcrossRanks(std::vector<int> const& rank_of_particle)
        : rank_(rank_of_particle), joined_(rank_.size(), 0) {}
    bool keep(std::span<int* const> particles) override {
        int const rank = rank_[*particles.front()];
        if (std::any_of(particles.begin(), particles.end(),
                        [&](int const* p) { return rank_[*p] != rank; }))
            for (int const* p : particles) joined_[*p] = 1;
        return false;
    }
    /// Flag per particle: 1 if a term joins it to another rank.
    std::vector<char> const& joined() const { return joined_; }

  private:
    std::vector<int> const& rank_;
    std::vector<char> joined_;
};

/// Keeps no term; used to recognise bonded forces.
class NoTerm : public TermFilter {
  public:
    bool keep(std::span<int* const>) override { return false; }
};

/// Keeps the terms that involve an own particle, and renumbers them for the subset. Exchangeable
/// particles have no terms.
class Renumbering : public TermFilter {
  public:
    /// Numbers of the fixed particles; all others have the number -1.
    Renumbering(int particle_count, Subset const& subset)
        : particles_(subset.particles),
          after_(subset.after),
          own_count_(subset.own),
          fixed_count_(subset.fixed),
          repetitions_(subset.repetitions),
          index_(particle_count, -1) {
        for (int i = 0; i < subset.fixed; ++i) index_[particles_[i]] = i;
    }
    bool keep(std::span<int* const> particles) override {
        bool const touches = std::any_of(particles.begin(), particles.end(), [&](int const* p) {
            return index_[*p] >= 0 && index_[*p] < own_count_;
        });
        return touches && keep_pair(particles);
    }
    /// Renumbers the particles in place; returns false if one of them is not permanently in the
    /// subset.
    bool keep_pair(std::span<int* const> particles) const {
        if (std::any_of(particles.begin(), particles.end(),
                        [&](int const* p) { return index_[*p] < 0; }))
            return false;
        for (int* p : particles) *p = index_[*p];
        return true;
    }
    void each(std::span<int* const> particles, std::function<void()> const& add) override {
        if (keep(particles)) repeat(particles, add);
    }
    using TermFilter::each;
    /// Calls `add` for each repetition of a pair that is permanently in the subset.
    void each_pair(std::initializer_list<int*> pair, std::function<void()> const& add) const {
        std::span<int* const> const particles(pair.begin(), pair.size());
        if (keep_pair(particles)) repeat(particles, add);
    }
    std::vector<int> const& particles() const { return particles_; }
    std::vector<int> const& after() const { return after_; }
    int repetitions() const { return repetitions_; }

  private:
    void repeat(std::span<int* const> particles, std::function<void()> const& add) const {
        for (int r = 0; r < repetitions_; ++r) {
            if (r > 0)
                for (int* const p : particles) *p += fixed_count_;
            add();
        }
    }
    std::vector<int> const &particles_, &after_;
    int own_count_, fixed_count_, repetitions_;
    std::vector<int> index_;  // index in the subset; -1: not permanently in it
};

template <class Source>
void copy_globals(Source const& from, Source& to) {
    for (int i = 0; i < from.getNumGlobalParameters(); ++i)
        to.addGlobalParameter(from.getGlobalParameterName(i),
                              from.getGlobalParameterDefaultValue(i));
}

/// Passes the exceptions of a NonbondedForce to the filter. They act at any distance, like bonded
/// terms.
void collect_exceptions(NonbondedForce const& from, TermFilter& filter) {
    for (int i = 0; i < from.getNumExceptions(); ++i) {
        int a, b;
        double charge, sigma, epsilon;
        from.getExceptionParameters(i, a, b, charge, sigma, epsilon);
        filter.keep({&a, &b});
    }
}

/// Passes the exclusions to the filter.
void collect_exclusions(CustomNonbondedForce const& from, TermFilter& filter) {
    for (int i = 0; i < from.getNumExclusions(); ++i) {
        int a, b;
        from.getExclusionParticles(i, a, b);
        filter.keep({&a, &b});
    }
}

/// Passes all terms, exceptions and exclusions of a System to the filter.
void collect_terms(System const& system, TermFilter& filter) {
    for (int i = 0; i < system.getNumForces(); ++i) {
        if (auto const* pairs = dynamic_cast<NonbondedForce const*>(&system.getForce(i)))
            collect_exceptions(*pairs, filter);
        if (auto const* pairs = dynamic_cast<CustomNonbondedForce const*>(&system.getForce(i)))
            collect_exclusions(*pairs, filter);
        copy_bonded(system.getForce(i), filter);
    }
}

template <class Source>
void copy_computed_values(Source const& from, Source& to) {
    if constexpr (requires { from.getNumComputedValues(); }) {
        std::string name, expression;
        for (int i = 0; i < from.getNumComputedValues(); ++i) {
            from.getComputedValueParameters(i, name, expression);
            to.addComputedValue(name, expression);
        }
    }
}

/// Copies the interaction groups with the particles that are permanently in the subset.
void copy_interaction_groups(CustomNonbondedForce const& from, Renumbering const& subset,
                             CustomNonbondedForce& to) {
    auto const renumbered = [&](std::set<int> const& all) {
        std::set<int> kept;
        for (int p : all) subset.each_pair({&p}, [&] { kept.insert(p); });
        return kept;
    };
    std::set<int> one, other;
    for (int i = 0; i < from.getNumInteractionGroups(); ++i) {
        from.getInteractionGroupParameters(i, one, other);
        to.addInteractionGroup(renumbered(one), renumbered(other));
    }
}

/// Copies a CustomNonbondedForce for the subset's particles.
std::unique_ptr<Force> copy_pairs(CustomNonbondedForce const& from, Renumbering const& subset) {
    auto to = std::make_unique<CustomNonbondedForce>(from.getEnergyFunction());
    to->setNonbondedMethod(from.getNonbondedMethod());
    to->setCutoffDistance(from.getCutoffDistance());
    to->setUseSwitchingFunction(from.getUseSwitchingFunction());
    to->setSwitchingDistance(from.getSwitchingDistance());
    copy_globals(from, *to);
    for (int i = 0; i < from.getNumPerParticleParameters(); ++i)
        to->addPerParticleParameter(from.getPerParticleParameterName(i));
    for (int i = 0; i < from.getNumTabulatedFunctions(); ++i)
        to->addTabulatedFunction(from.getTabulatedFunctionName(i),
                                 from.getTabulatedFunction(i).Copy());
    copy_computed_values(from, *to);
    std::vector<double> parameters;
    for (int r = 0; r < subset.repetitions(); ++r)
        for (int p : subset.particles()) {
            from.getParticleParameters(p, parameters);
            to->addParticle(parameters);
        }
    for (int i = 0; i < from.getNumExclusions(); ++i) {
        int a, b;
        from.getExclusionParticles(i, a, b);
        subset.each_pair({&a, &b}, [&] { to->addExclusion(a, b); });
    }
    for (int const k : subset.after()) to->addExclusion(k - 1, k);
    copy_interaction_groups(from, subset, *to);
    return to;
}

/// Copies exceptions with their offsets. An exception between two ghosts must stay an exclusion,
/// but its energy is not needed.
void copy_exceptions(NonbondedForce const& from, Renumbering const& subset, NonbondedForce& to) {
    std::vector<std::vector<int>> index(static_cast<std::size_t>(from.getNumExceptions()));
    for (int i = 0; i < from.getNumExceptions(); ++i) {
        int a, b;
        double charge, sigma, epsilon;
        from.getExceptionParameters(i, a, b, charge, sigma, epsilon);
        subset.each_pair({&a, &b}, [&] {
            index[static_cast<std::size_t>(i)].push_back(
                to.addException(a, b, charge, sigma, epsilon));
        });
    }
    for (int const k : subset.after()) to.addException(k - 1, k, 0, 1, 0);
    std::string parameter;
    for (int i = 0; i < from.getNumExceptionParameterOffsets(); ++i) {
        int exception;
        double charge, sigma, epsilon;
        from.getExceptionParameterOffset(i, parameter, exception, charge, sigma, epsilon);
        for (int const copied : index[static_cast<std::size_t>(exception)])
            to.addExceptionParameterOffset(parameter, copied, charge, sigma, epsilon);
    }
}

/// Copies a NonbondedForce for the subset's particles.
std::unique_ptr<Force> copy_pairs(NonbondedForce const& from, Renumbering const& subset) {
    auto to = std::make_unique<NonbondedForce>();
    to->setNonbondedMethod(from.getNonbondedMethod());
    to->setCutoffDistance(from.getCutoffDistance());
    to->setUseSwitchingFunction(from.getUseSwitchingFunction());
    to->setSwitchingDistance(from.getSwitchingDistance());
    to->setReactionFieldDielectric(from.getReactionFieldDielectric());
    to->setExceptionsUsePeriodicBoundaryConditions(
        from.getExceptionsUsePeriodicBoundaryConditions());
    to->setUseDispersionCorrection(false);  // the correction adds no force
    copy_globals(from, *to);
    double charge, sigma, epsilon;
    for (int r = 0; r < subset.repetitions(); ++r)
        for (int p : subset.particles()) {
            from.getParticleParameters(p, charge, sigma, epsilon);
            to->addParticle(charge, sigma, epsilon);
        }
    std::string parameter;
    for (int i = 0; i < from.getNumParticleParameterOffsets(); ++i) {
        int p;
        from.getParticleParameterOffset(i, parameter, p, charge, sigma, epsilon);
        subset.each_pair(
            {&p}, [&] { to->addParticleParameterOffset(parameter, p, charge, sigma, epsilon); });
    }
    copy_exceptions(from, subset, *to);
    return to;
}

/// Copies any force that can be split.
std::unique_ptr<Force> copy_force(Force const& from, Renumbering& subset) {
    if (auto const* pairs = dynamic_cast<CustomNonbondedForce const*>(&from))
        return copy_pairs(*pairs, subset);
    if (auto const* pairs = dynamic_cast<NonbondedForce const*>(&from))
        return copy_pairs(*pairs, subset);
    return copy_bonded(from, subset);
}

/// Sets the parameters of the exchangeable particles in the force and in the Context.
void exchange_parameters(Subset const& subset, CustomNonbondedForce const& from,
                         CustomNonbondedForce& to, Context& context) {
    std::vector<double> parameters;
    for (int k = subset.fixed; k < static_cast<int>(subset.particles.size()); ++k) {
        from.getParticleParameters(subset.particles[k], parameters);
        to.setParticleParameters(k, parameters);
    }
    to.updateParametersInContext(context);
}

void exchange_parameters(Subset const& subset, NonbondedForce const& from, NonbondedForce& to,
                         Context& context) {
    double charge, sigma, epsilon;
    for (int k = subset.fixed; k < static_cast<int>(subset.particles.size()); ++k) {
        from.getParticleParameters(subset.particles[k], charge, sigma, epsilon);
        to.setParticleParameters(k, charge, sigma, epsilon);
    }
    to.updateParametersInContext(context);
}

}  // namespace

double reach_of(Force const& force) {
    double constexpr everywhere = std::numeric_limits<double>::infinity();
    if (auto const* pairs = dynamic_cast<CustomNonbondedForce const*>(&force))
        return pairs->getNonbondedMethod() == CustomNonbondedForce::NoCutoff
                   ? everywhere
                   : pairs->getCutoffDistance();
    if (auto const* pairs = dynamic_cast<NonbondedForce const*>(&force)) {
        auto const method = pairs->getNonbondedMethod();
        if (method == NonbondedForce::NoCutoff) return everywhere;
        bool const cut =
            method == NonbondedForce::CutoffNonPeriodic || method == NonbondedForce::CutoffPeriodic;
        return cut ? pairs->getCutoffDistance() : -1;
    }
    NoTerm filter;
    return copy_bonded(force, filter) ? 0 : -1;
}

bool can_be_split(Force const& force) { return reach_of(force) >= 0; }

double reach_of(System const& system) {
    double reach = 0;
    for (int i = 0; i < system.getNumForces(); ++i)
        reach = std::max(reach, reach_of(system.getForce(i)));
    return reach;
}

std::vector<int> bonded_partners(System const& system, std::vector<int> const& own) {
    PartnerCollector collector(system.getNumParticles(), own);
    collect_terms(system, collector);
    return collector.partners();
}

std::vector<char> joined_across_ranks(System const& system,
                                      std::vector<int> const& rank_of_particle) {
    JoinedAcrossRanks filter(rank_of_particle);
    collect_terms(system, filter);
    return filter.joined();
}

bool can_exchange_particles(System const& system) {
    for (int i = 0; i < system.getNumForces(); ++i) {
        if (auto const* pairs = dynamic_cast<CustomNonbondedForce const*>(&system.getForce(i));
            pairs && pairs->getNumInteractionGroups() > 0)
            return false;
        if (auto const* pairs = dynamic_cast<NonbondedForce const*>(&system.getForce(i));
            pairs && pairs->getNumParticleParameterOffsets() > 0)
            return false;
    }
    return true;
}

std::vector<int> kinds_of_particles(System const& system) {
    std::map<std::vector<double>, int> kinds;
    std::vector<int> kind_of_particle;
    for (int p = 0; p < system.getNumParticles(); ++p) {
        std::vector<double> all, of_force(3);
        for (int i = 0; i < system.getNumForces(); ++i) {
            if (auto const* pairs = dynamic_cast<CustomNonbondedForce const*>(&system.getForce(i)))
                pairs->getParticleParameters(p, of_force);
            else if (auto const* charges = dynamic_cast<NonbondedForce const*>(&system.getForce(i)))
                charges->getParticleParameters(p, of_force[0], of_force[1], of_force[2]);
            else
                continue;
            all.insert(all.end(), of_force.begin(), of_force.end());
            of_force.resize(3);
        }
        kind_of_particle.push_back(
            kinds.try_emplace(std::move(all), static_cast<int>(kinds.size())).first->second);
    }
    return kind_of_particle;
}

std::unique_ptr<System> system_of(Subset const& subset, System const& whole) {
    std::vector<int> forces(static_cast<std::size_t>(whole.getNumForces()));
    std::iota(forces.begin(), forces.end(), 0);
    return system_of(subset, whole, forces);
}

std::unique_ptr<System> system_of(Subset const& subset, System const& whole,
                                  std::vector<int> const& forces) {
    auto system = std::make_unique<System>();
    OpenMM::Vec3 a, b, c;
    whole.getDefaultPeriodicBoxVectors(a, b, c);
    system->setDefaultPeriodicBoxVectors(a, b, c);
    for (int r = 0; r < subset.repetitions; ++r)
        for (int p : subset.particles) system->addParticle(whole.getParticleMass(p));
    Renumbering renumbering(whole.getNumParticles(), subset);
    for (int const i : forces) {
        Force const& from = whole.getForce(i);
        auto to = copy_force(from, renumbering);
        to->setForceGroup(from.getForceGroup());
        to->setName(from.getName());
        system->addForce(to.release());
    }
    return system;
}

void exchange_particles(Subset const& subset, System const& whole, System& system,
                        Context& context) {
    for (int i = 0; i < whole.getNumForces(); ++i) {
        Force const& from = whole.getForce(i);
        if (auto const* custom = dynamic_cast<CustomNonbondedForce const*>(&from))
            exchange_parameters(subset, *custom,
                                dynamic_cast<CustomNonbondedForce&>(system.getForce(i)), context);
        else if (auto const* charges = dynamic_cast<NonbondedForce const*>(&from))
            exchange_parameters(subset, *charges, dynamic_cast<NonbondedForce&>(system.getForce(i)),
                                context);
    }
}

}  // namespace catena
