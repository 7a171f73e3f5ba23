// Implements the collection of bonds and constraints and the messages on missing links. Each pair
// of particles is stored at the higher one; parallel bonds are merged into one Joining.
#include "systems/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "systems/model.hpp"

namespace catena {

Joinings::Joinings(OpenMM::System const& system, NamedLinks const& links, std::string const& where)
    : system_(system),
      to_lower_(static_cast<std::size_t>(system.getNumParticles())),
      custom_to_previous_(to_lower_.size(), -1) {
    for (int i = 0; i < system.getNumForces(); ++i) {
        if (auto const* bonds = dynamic_cast<OpenMM::HarmonicBondForce const*>(&system.getForce(i)))
            add_harmonic_bonds(*bonds, where);
    }
    // Constraints override springs, and come last.
    for (int i = 0; i < system.getNumForces(); ++i)
        if (dynamic_cast<OpenMM::CustomBondForce const*>(&system.getForce(i)) != nullptr)
            add_custom_bonds(i, links, where);
    for (int i = 0; i < system.getNumConstraints(); ++i) {
        int a, b;
        double length;
        system.getConstraintParameters(i, a, b, length);
        refuse_foreign("constraint", a, b, where);
        at(a, b).add_constraint(length);
    }
}

Joining& Joinings::at(int a, int b) {
    return to_lower_.at(static_cast<std::size_t>(std::max(a, b)))[std::min(a, b)];
}

void Joinings::refuse_foreign(char const* what, int a, int b, std::string const& where) const {
    if (std::min(a, b) < 0 || std::max(a, b) >= system_.getNumParticles() || a == b)
        throw InputError(fmt::format("a {} joins particles {} and {} (from 0) of {}", what, a, b,
                                     system_.getNumParticles()),
                         where, "correct the System");
}

void Joinings::add_harmonic_bonds(OpenMM::HarmonicBondForce const& bonds,
                                  std::string const& where) {
    for (int j = 0; j < bonds.getNumBonds(); ++j) {
        int a, b;
        double length, k;
        bonds.getBondParameters(j, a, b, length, k);
        refuse_foreign("harmonic bond", a, b, where);
        if (!(k >= 0 && std::isfinite(k) && length >= 0 && std::isfinite(length)))
            throw InputError(fmt::format("the harmonic bond between particles {} and {} (from "
                                         "0) has stiffness {} and length {}",
                                         a, b, k, length),
                             where, "give it a stiffness of 0 or more and a length");
        if (k > 0) at(a, b).add_spring(length, k);
    }
}

/// Only bonds between consecutive particles can become links.
void Joinings::add_custom_bonds(int force, NamedLinks const& links, std::string const& where) {
    auto const& bonds = dynamic_cast<OpenMM::CustomBondForce const&>(system_.getForce(force));
    auto const named = std::find_if(links.begin(), links.end(),
                                    [&](auto const& link) { return is_named(bonds, link.first); });
    std::vector<double> ignored;
    for (int j = 0; j < bonds.getNumBonds(); ++j) {
        int a, b;
        bonds.getBondParameters(j, a, b, ignored);
        refuse_foreign("custom bond", a, b, where);
        if (std::abs(a - b) != 1) continue;
        custom_to_previous_[static_cast<std::size_t>(std::max(a, b))] = force;
        if (named != links.end()) at(a, b).add_constraint(named->second);
    }
}

Joining Joinings::between(int a, int b) const {
    auto const& lower = to_lower_.at(static_cast<std::size_t>(std::max(a, b)));
    auto const found = lower.find(std::min(a, b));
    return found == lower.end() ? Joining{} : found->second;
}

std::string Joinings::custom_bond(int p) const {
    auto const& bonds = dynamic_cast<OpenMM::CustomBondForce const&>(
        system_.getForce(custom_to_previous_[static_cast<std::size_t>(p)]));
    return bonds.getEnergyFunction().find("log(") != std::string::npos ? "CustomBondForce (FENE)"
                                                                       : "CustomBondForce";
}

std::string Joinings::custom_name(int p) const {
    OpenMM::Force const& force = system_.getForce(custom_to_previous_[static_cast<std::size_t>(p)]);
    return force.getName().empty() ? kind_of(force) : force.getName();
}

void Joinings::refuse_gap(int p, int first, std::string const& at) const {
    auto const& lower = to_lower_[static_cast<std::size_t>(p)];
    int partner = -1;
    for (auto const& [other, joining] : lower)
        if (other >= first) partner = std::max(partner, other);
    if (partner >= 0)
        throw InputError(fmt::format("particle {} (from 0) is joined to particle {} and not to "
                                     "particle {} before it: the molecule is branched",
                                     p, partner, p - 1),
                         at,
                         "write its beads in the scene, each with its `parent`, or end the chain "
                         "between particles that are not joined (TER in the topology), so that the "
                         "other bonds stay springs");
    throw InputError(
        fmt::format("particles {} and {} (from 0) are joined by no harmonic bond and no constraint",
                    p - 1, p),
        at,
        "join neighbours in a chain (a bond of stiffness 0 does not), or end the chain between "
        "them in the topology (TER)");
}

}  // namespace catena
