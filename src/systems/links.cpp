// Implements the collection of bonds and constraints and the messages on missing links. Each pair
// of particles is stored at the higher one; parallel bonds are merged into one Joining.
#include "systems/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Bonds can become links if the scene names their force.
void Joinings::add_custom_bonds(int force, NamedLinks const& links, std::string const& where) {
    auto const& bonds = dynamic_cast<OpenMM::CustomBondForce const&>(system_.getForce(force));
    auto const named = std::find_if(links.begin(), links.end(),
                                    [&](auto const& link) { return is_named(bonds, link.first); });
    std::vector<double> ignored;
    for (int j = 0; j < bonds.getNumBonds(); ++j) {
        int a, b;
        bonds.getBondParameters(j, a, b, ignored);
        refuse_foreign("custom bond", a, b, where);
        if (std::abs(a - b) == 1)
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

template <class Accept>
int Joinings::stiffest(int p, int first, double temperature, Accept const& accept) const {
    int found = -1;
    double least = std::numeric_limits<double>::infinity();
    for (auto const& [other, joining] : to_lower_[static_cast<std::size_t>(p)]) {
        double const spread = joining.spread(temperature);
        bool const stiffer = spread < least || (spread == least && other > found);
        if (other >= first && stiffer && accept(other, joining)) found = other, least = spread;
    }
    return found;
}

int Joinings::inboard(int p, int first, double temperature) const {
    Joining const previous = to_previous(p), usual = between(first, first + 1);
    int const other = stiffest(p, first, temperature, [&](int q, Joining const& joining) {
        return q != p - 1 && joining.spread(temperature) <= StiffLinks::softest &&
               joining.is_like(usual, temperature);
    });
    bool const constrained = std::isinf(previous.stiffness),
               links = previous.holds() && previous.spread(temperature) <= StiffLinks::softest;
    // A constraint must become a link: forces do not hold it.
    bool const outranked = !constrained && other >= 0 && std::isinf(between(other, p).stiffness);
    if (previous.holds() && (other < 0 || (links && !outranked))) return p - 1;
    return other;
}

bool Joinings::goes_on(int p, int first, double temperature) const {
    return joins_to_previous(p) || inboard(p, first, temperature) >= 0;
}

int Joinings::custom_inboard(int p, int first) const {
    std::vector<double> ignored;
    for (int i = 0; i < system_.getNumForces(); ++i) {
        auto const* bonds = dynamic_cast<OpenMM::CustomBondForce const*>(&system_.getForce(i));
        for (int j = 0; bonds && j < bonds->getNumBonds(); ++j) {
            int a, b;
            bonds->getBondParameters(j, a, b, ignored);
            if (std::max(a, b) == p && std::min(a, b) >= first) return std::min(a, b);
        }
    }
    return -1;
}

void Joinings::refuse_gap(int p, int first, double temperature, std::string const& at) const {
    if (int const custom = custom_inboard(p, first); custom >= 0)
        throw InputError(
            fmt::format("particle {} (from 0) is joined to particle {} by a CustomBondForce alone, "
                        "and to no earlier one otherwise",
                        p, custom),
            at,
            "make such bonds links of the length that `links` gives, or end the chain before it "
            "in the topology (TER): the bond then stays a force");
    if (int const soft = stiffest(p, first, temperature, [](int, Joining const&) { return true; });
        soft >= 0)
        throw InputError(
            fmt::format("particle {0} (from 0) hangs on no earlier one of its chain by a bond like "
                        "that of particles {1} and {2}: the stiffest, to particle {3}, has {4:.6g} "
                        "kJ/mol/nm2",
                        p, first, first + 1, soft, between(soft, p).stiffness),
            at, "end the chain before it in the topology (TER): its bonds then stay springs");
    // The next particle follows in a row after a gap.
    auto const high =
        std::find_if(to_lower_.begin() + std::min(p + 2, static_cast<int>(to_lower_.size())),
                     to_lower_.end(), [&](auto const& lower) { return lower.contains(p); });
    bool const is_bridged =
        std::any_of(to_lower_.begin() + p, to_lower_.end(), [&](auto const& lower) {
            return std::any_of(lower.begin(), lower.end(), [&](auto const& joined) {
                return joined.first >= first && joined.first < p;
            });
        });
    if (high != to_lower_.end() && !is_bridged)
        throw InputError(
            fmt::format("no bond and no constraint joins particle {} (from 0) or a later one to an "
                        "earlier one of its chain: these are two chains, such as the strands of "
                        "double-stranded RNA",
                        p),
            at, "write a line TER, or another chain's letter, before it in the topology");
    if (high != to_lower_.end())
        throw InputError(
            fmt::format("particle {} (from 0) is joined to particle {} and to no earlier one", p,
                        high - to_lower_.begin()),
            at,
            "number the particles so that each of a chain is joined to an earlier one, or end the "
            "chain before it in the topology (TER): the other bonds then stay springs");
    throw InputError(
        fmt::format("particles {} and {} (from 0) are joined by no harmonic bond and no constraint",
                    p - 1, p),
        at,
        "join each particle of a chain to an earlier one (a bond of stiffness 0 does not), or end "
        "the chain between them in the topology (TER)");
}

}  // namespace catena
