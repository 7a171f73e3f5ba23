// Implements the copies of bonded forces, with one overload per kind.
#include "systems/bonded_forces.hpp"

#include <functional>
#include <vector>

namespace catena {

namespace {

using namespace OpenMM;  // this file uses no other library

template <class Source>
/// Copies names and default values of global parameters.
void copy_globals(Source const& from, Source& to) {
    for (int i = 0; i < from.getNumGlobalParameters(); ++i)
        to.addGlobalParameter(from.getGlobalParameterName(i),
                              from.getGlobalParameterDefaultValue(i));
}

template <class Source>
/// Copies the flag for periodic boundary conditions.
void copy_periodicity(Source const& from, Source& to) {
    to.setUsesPeriodicBoundaryConditions(from.usesPeriodicBoundaryConditions());
}

// Overloads of copy_terms(), one per bonded force: copies its terms that pass the filter.

std::unique_ptr<Force> copy_terms(HarmonicBondForce const& from, TermFilter& filter) {
    auto to = std::make_unique<HarmonicBondForce>();
    copy_periodicity(from, *to);
    for (int i = 0; i < from.getNumBonds(); ++i) {
        int a, b;
        double length, k;
        from.getBondParameters(i, a, b, length, k);
        filter.each({&a, &b}, [&] { to->addBond(a, b, length, k); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(HarmonicAngleForce const& from, TermFilter& filter) {
    auto to = std::make_unique<HarmonicAngleForce>();
    copy_periodicity(from, *to);
    for (int i = 0; i < from.getNumAngles(); ++i) {
        int a, b, c;
        double angle, k;
        from.getAngleParameters(i, a, b, c, angle, k);
        filter.each({&a, &b, &c}, [&] { to->addAngle(a, b, c, angle, k); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(PeriodicTorsionForce const& from, TermFilter& filter) {
    auto to = std::make_unique<PeriodicTorsionForce>();
    copy_periodicity(from, *to);
    for (int i = 0; i < from.getNumTorsions(); ++i) {
        int a, b, c, d, periodicity;
        double phase, k;
        from.getTorsionParameters(i, a, b, c, d, periodicity, phase, k);
        filter.each({&a, &b, &c, &d}, [&] { to->addTorsion(a, b, c, d, periodicity, phase, k); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(RBTorsionForce const& from, TermFilter& filter) {
    auto to = std::make_unique<RBTorsionForce>();
    copy_periodicity(from, *to);
    for (int i = 0; i < from.getNumTorsions(); ++i) {
        int a, b, c, d;
        double c0, c1, c2, c3, c4, c5;
        from.getTorsionParameters(i, a, b, c, d, c0, c1, c2, c3, c4, c5);
        filter.each({&a, &b, &c, &d}, [&] { to->addTorsion(a, b, c, d, c0, c1, c2, c3, c4, c5); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(CustomBondForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomBondForce>(from.getEnergyFunction());
    copy_periodicity(from, *to);
    copy_globals(from, *to);
    for (int i = 0; i < from.getNumPerBondParameters(); ++i)
        to->addPerBondParameter(from.getPerBondParameterName(i));
    std::vector<double> parameters;
    for (int i = 0; i < from.getNumBonds(); ++i) {
        int a, b;
        from.getBondParameters(i, a, b, parameters);
        filter.each({&a, &b}, [&] { to->addBond(a, b, parameters); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(CustomAngleForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomAngleForce>(from.getEnergyFunction());
    copy_periodicity(from, *to);
    copy_globals(from, *to);
    for (int i = 0; i < from.getNumPerAngleParameters(); ++i)
        to->addPerAngleParameter(from.getPerAngleParameterName(i));
    std::vector<double> parameters;
    for (int i = 0; i < from.getNumAngles(); ++i) {
        int a, b, c;
        from.getAngleParameters(i, a, b, c, parameters);
        filter.each({&a, &b, &c}, [&] { to->addAngle(a, b, c, parameters); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(CustomTorsionForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomTorsionForce>(from.getEnergyFunction());
    copy_periodicity(from, *to);
    copy_globals(from, *to);
    for (int i = 0; i < from.getNumPerTorsionParameters(); ++i)
        to->addPerTorsionParameter(from.getPerTorsionParameterName(i));
    std::vector<double> parameters;
    for (int i = 0; i < from.getNumTorsions(); ++i) {
        int a, b, c, d;
        from.getTorsionParameters(i, a, b, c, d, parameters);
        filter.each({&a, &b, &c, &d}, [&] { to->addTorsion(a, b, c, d, parameters); });
    }
    return to;
}

std::unique_ptr<Force> copy_terms(CustomExternalForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomExternalForce>(from.getEnergyFunction());
    copy_globals(from, *to);
    for (int i = 0; i < from.getNumPerParticleParameters(); ++i)
        to->addPerParticleParameter(from.getPerParticleParameterName(i));
    std::vector<double> parameters;
    for (int i = 0; i < from.getNumParticles(); ++i) {
        int a;
        from.getParticleParameters(i, a, parameters);
        filter.each({&a}, [&] { to->addParticle(a, parameters); });
    }
    return to;
}

/// Copies the tabulated functions.
template <class Source>
void copy_tables(Source const& from, Source& to) {
    for (int i = 0; i < from.getNumTabulatedFunctions(); ++i)
        to.addTabulatedFunction(from.getTabulatedFunctionName(i),
                                from.getTabulatedFunction(i).Copy());
}

/// Passes a term with any number of particles to the filter.
void each_of(TermFilter& filter, std::vector<int>& particles, std::function<void()> const& add) {
    std::vector<int*> pointers;
    for (int& p : particles) pointers.push_back(&p);
    if (!pointers.empty()) filter.each(std::span<int* const>(pointers), add);
}

/// Copies all of a force with energy function and tables but its terms.
template <class Source>
void copy_all_but_terms(Source const& from, Source& to) {
    copy_periodicity(from, to);
    copy_globals(from, to);
    copy_tables(from, to);
    for (int i = 0; i < from.getNumPerBondParameters(); ++i)
        to.addPerBondParameter(from.getPerBondParameterName(i));
}

std::unique_ptr<Force> copy_terms(CustomCompoundBondForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomCompoundBondForce>(from.getNumParticlesPerBond(),
                                                        from.getEnergyFunction());
    copy_all_but_terms(from, *to);
    std::vector<int> particles;
    std::vector<double> parameters;
    for (int i = 0; i < from.getNumBonds(); ++i) {
        from.getBondParameters(i, particles, parameters);
        each_of(filter, particles, [&] { to->addBond(particles, parameters); });
    }
    return to;
}

/// A term needs the particles of all its groups. Each kept term gets groups of its own.
std::unique_ptr<Force> copy_terms(CustomCentroidBondForce const& from, TermFilter& filter) {
    auto to = std::make_unique<CustomCentroidBondForce>(from.getNumGroupsPerBond(),
                                                        from.getEnergyFunction());
    copy_all_but_terms(from, *to);
    std::vector<int> groups, copied, members, all;
    std::vector<double> parameters, weights;
    for (int i = 0; i < from.getNumBonds(); ++i) {
        from.getBondParameters(i, groups, parameters);
        all.clear();
        for (int const group : groups) {
            from.getGroupParameters(group, members, weights);
            all.insert(all.end(), members.begin(), members.end());
        }
        each_of(filter, all, [&] {
            auto next = all.begin();
            copied.clear();
            for (int const group : groups) {
                from.getGroupParameters(group, members, weights);
                auto const end = next + static_cast<std::ptrdiff_t>(members.size());
                copied.push_back(to->addGroup({next, end}, weights));
                next = end;
            }
            to->addBond(copied, parameters);
        });
    }
    return to;
}

/// Tries the bonded kinds one after the other; nullptr if none matches.
template <class... Kinds>
std::unique_ptr<Force> copy_bonded_as(Force const& from, TermFilter& filter) {
    std::unique_ptr<Force> to;
    auto const attempt = [&]<class Kind>(Kind const* force) {
        if (force != nullptr) to = copy_terms(*force, filter);
        return force != nullptr;
    };
    (void)(attempt(dynamic_cast<Kinds const*>(&from)) || ...);
    return to;
}

}  // namespace

std::unique_ptr<Force> copy_bonded(Force const& from, TermFilter& filter) {
    return copy_bonded_as<HarmonicBondForce, HarmonicAngleForce, PeriodicTorsionForce,
                          RBTorsionForce, CustomBondForce, CustomAngleForce, CustomTorsionForce,
                          CustomExternalForce, CustomCompoundBondForce, CustomCentroidBondForce>(
        from, filter);
}

}  // namespace catena
