// Implements the collection of bonds and constraints and the messages on missing links. Each pair
// of particles is stored at the higher one; parallel bonds are merged into one Joining.
#include "systems/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "systems/model.hpp"

namespace catena {

Joinings::Joinings(OpenMM::System const& system, std::string const& where)
    : system_(system), to_lower_(static_cast<std::size_t>(system.getNumParticles())) {
    int a, b;
    double length, k;
    auto const at = [&]() -> Joining& {
        return to_lower_.at(static_cast<std::size_t>(std::max(a, b)))[std::min(a, b)];
    };
    auto const refuse_foreign = [&](char const* what) {
        if (std::min(a, b) < 0 || std::max(a, b) >= system.getNumParticles() || a == b)
            throw InputError(fmt::format("a {} joins particles {} and {} (from 0) of {}", what, a,
                                         b, system.getNumParticles()),
                             where, "correct the System");
    };
    for (int i = 0; i < system.getNumForces(); ++i) {
        auto const* bonds = dynamic_cast<OpenMM::HarmonicBondForce const*>(&system.getForce(i));
        for (int j = 0; bonds != nullptr && j < bonds->getNumBonds(); ++j) {
            bonds->getBondParameters(j, a, b, length, k);
            refuse_foreign("harmonic bond");
            if (!(k >= 0 && std::isfinite(k) && length >= 0 && std::isfinite(length)))
                throw InputError(fmt::format("the harmonic bond between particles {} and {} (from "
                                             "0) has stiffness {} and length {}",
                                             a, b, k, length),
                                 where, "give it a stiffness of 0 or more and a length");
            if (k > 0) at().add_spring(length, k);
        }
    }
    for (int i = 0; i < system.getNumConstraints(); ++i) {
        system.getConstraintParameters(i, a, b, length);
        refuse_foreign("constraint");
        at().add_constraint(length);
    }
}

Joining Joinings::between(int a, int b) const {
    auto const& lower = to_lower_.at(static_cast<std::size_t>(std::max(a, b)));
    auto const found = lower.find(std::min(a, b));
    return found == lower.end() ? Joining{} : found->second;
}

/// Returns "CustomBondForce (FENE)" or "CustomBondForce" for a custom bond between a and b; empty
/// if there is none.
std::string Joinings::custom_bond(int a, int b) const {
    std::vector<double> ignored;
    for (int i = 0; i < system_.getNumForces(); ++i) {
        auto const* bonds = dynamic_cast<OpenMM::CustomBondForce const*>(&system_.getForce(i));
        for (int j = 0; bonds != nullptr && j < bonds->getNumBonds(); ++j) {
            int p, q;
            bonds->getBondParameters(j, p, q, ignored);
            if (std::minmax(p, q) == std::minmax(a, b))
                return bonds->getEnergyFunction().find("log(") != std::string::npos
                           ? "CustomBondForce (FENE)"
                           : "CustomBondForce";
        }
    }
    return "";
}

void Joinings::refuse_gap(int p, int first, std::string const& at) const {
    if (std::string const custom = custom_bond(p - 1, p); !custom.empty())
        throw InputError(fmt::format("particles {} and {} (from 0) are joined by a {} and by no "
                                     "harmonic bond or constraint",
                                     p - 1, p, custom),
                         at,
                         "add a constraint of the bond's mean length between neighbours, which "
                         "becomes their rigid link, and remove the pair from the CustomBondForce");
    auto const& lower = to_lower_[static_cast<std::size_t>(p)];
    int partner = -1;
    for (auto const& [other, joining] : lower)
        if (other >= first) partner = std::max(partner, other);
    if (partner >= 0)
        throw InputError(fmt::format("particle {} (from 0) is joined to particle {} and not to "
                                     "particle {} before it: the molecule is branched",
                                     p, partner, p - 1),
                         at,
                         "Catena does not simulate trees yet: leave side beads out, or end the "
                         "chain between particles that are not joined (TER in "
                         "the "
                         "topology), so that the other bonds stay springs");
    throw InputError(
        fmt::format("particles {} and {} (from 0) are joined by no harmonic bond and no constraint",
                    p - 1, p),
        at,
        "join neighbours in a chain (a bond of stiffness 0 does not), or end the chain between "
        "them in the topology (TER)");
}

}  // namespace catena
