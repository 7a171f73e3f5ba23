// Taking constraints out of a System, and putting them back.
#include "plugin/held_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "error.hpp"

namespace catena::plugin {
namespace {

constexpr char const* where = "catena.openmm.prepared";

/// Throws InputError for what OpenMM checks of constraints when it creates a Context.
void check(OpenMM::System const& system, std::vector<Constraint> const& constraints) {
    std::set<std::pair<int, int>> pairs;
    auto const refuse = [](Constraint const& c, char const* what, char const* remedy) {
        throw InputError(what, fmt::format("System, particles {} and {}", c.first, c.second),
                         remedy);
    };
    for (Constraint const& c : constraints) {
        if (std::min(c.first, c.second) < 0 || c.first == c.second ||
            std::max(c.first, c.second) >= system.getNumParticles())
            refuse(c, "a constraint between impossible particles", "name two of the System");
        if ((system.getParticleMass(c.first) == 0) != (system.getParticleMass(c.second) == 0))
            refuse(c, "a constraint of a massless particle", "give it a mass");
        if (!pairs.insert(std::minmax(c.first, c.second)).second)
            refuse(c, "two constraints between the same particles", "leave one out");
    }
    for (int i = 0; i < system.getNumForces(); ++i)
        if (dynamic_cast<OpenMM::AndersenThermostat const*>(&system.getForce(i)) != nullptr)
            throw InputError(
                "an AndersenThermostat, which reads constraints when a Context is made", where,
                "create the Context without `prepared`");
}

/// A particle's constraints, as far as there are two.
struct Ends {
    int count = 0;
    std::array<int, 2> particle{-1, -1};
    std::array<float, 2> distance{};

    void add(int neighbour, double to) {
        if (count < 2) {
            particle[std::size_t(count)] = neighbour;
            distance[std::size_t(count)] = static_cast<float>(to);
        }
        ++count;
    }
    /// Index of the constraint that does not lead to a particle.
    std::size_t beside(int other) const { return particle[0] == other ? 1 : 0; }
};

/// True if two distances of a triangle are equal in single precision, as SETTLE requires.
bool is_isosceles(float first, float second, float third) {
    return first == second || second == third || third == first;
}

void add_to(OpenMM::System& system, Constraint const& c) {
    system.addConstraint(c.first, c.second, c.distance);
}

void remove_all(OpenMM::System& system) {
    for (int i = system.getNumConstraints(); i-- > 0;) system.removeConstraint(i);
}

}  // namespace

std::vector<Constraint> constraints_in(OpenMM::System const& system) {
    std::vector<Constraint> all(static_cast<std::size_t>(system.getNumConstraints()));
    for (int i = 0; i < system.getNumConstraints(); ++i) {
        Constraint& c = all[std::size_t(i)];
        system.getConstraintParameters(i, c.first, c.second, c.distance);
    }
    return all;
}

std::vector<bool> left_to_settle(int particles, std::vector<Constraint> const& constraints) {
    std::vector<Ends> ends(static_cast<std::size_t>(particles));
    for (Constraint const& c : constraints) {
        ends[std::size_t(c.first)].add(c.second, c.distance);
        ends[std::size_t(c.second)].add(c.first, c.distance);
    }
    std::vector<bool> marks;
    for (Constraint const& c : constraints) {
        Ends const &first = ends[std::size_t(c.first)], &second = ends[std::size_t(c.second)];
        std::size_t const i = first.beside(c.second), j = second.beside(c.first);
        int const apex = first.particle[i];
        marks.push_back(
            first.count == 2 && second.count == 2 && apex == second.particle[j] &&
            ends[std::size_t(apex)].count == 2 &&
            is_isosceles(static_cast<float>(c.distance), first.distance[i], second.distance[j]));
    }
    return marks;
}

void HeldConstraints::take(OpenMM::System& system) {
    if (!all_.empty())
        throw InputError("constraints that are held already", where,
                         "use it once at a time for each integrator");
    std::vector<Constraint> all = constraints_in(system);
    check(system, all);
    std::vector<bool> const stays = left_to_settle(system.getNumParticles(), all);
    remove_all(system);
    held_.clear();
    for (std::size_t i = 0; i < all.size(); ++i)
        if (stays[i])
            add_to(system, all[i]);
        else
            held_.push_back(all[i]);
    left_ = system.getNumConstraints();
    all_ = std::move(all);
}

bool HeldConstraints::put_back(OpenMM::System& system) {
    if (all_.empty()) return false;
    bool const changed = system.getNumConstraints() != left_;
    if (changed) {
        for (Constraint const& c : held_) add_to(system, c);
    } else {
        remove_all(system);
        for (Constraint const& c : all_) add_to(system, c);
    }
    all_.clear();
    held_.clear();
    if (changed)
        throw InputError("a System whose constraints have changed", where,
                         "change them before or after it");
    return true;
}

}  // namespace catena::plugin
