// Implements the removal of bonds and constraints along links, with sentences on their lengths.
#include "systems/linked_bonds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "error.hpp"
#include "systems/bonded_forces.hpp"
#include "systems/model.hpp"

namespace catena {

namespace {

using OpenMM::HarmonicBondForce;
using OpenMM::System;

double constexpr same_length = 1e-6;  // nm; covers lengths written in decimals

std::pair<int, int> ordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Statistics of the terms that rigid links replace.
struct Savings {
    /// Number of terms, their range of lengths, and the largest difference from a link's length,
    /// nm.
    int count = 0;
    double shortest = INFINITY, longest = 0, largest_difference = 0;

    void add(double length, double link) {
        ++count;
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
        largest_difference = std::max(largest_difference, std::abs(length - link));
    }
    /// Sentence on the terms; `what` is their plural noun.
    std::string note(std::string const& what) const {
        std::string text =
            longest - shortest < same_length
                ? fmt::format("{} {} along rigid links left out (length {:.6g} nm)", count, what,
                              longest)
                : fmt::format("{} {} along rigid links left out (lengths {:.6g} to {:.6g} nm)",
                              count, what, shortest, longest);
        if (largest_difference > same_length)
            text += fmt::format("; their links differ from them by up to {:.3g} nm",
                                largest_difference);
        return text;
    }
};

/// Statistics of the harmonic bonds and of the custom bonds that links replace.
struct AllSavings {
    Savings harmonic, custom;
};

/// Keeps the bonds that are not along links, and counts the others.
class BondsOffLinks : public TermFilter {
  public:
    /// `length` is the length of the links that replace the bonds, nm.
    BondsOffLinks(LinkTable const& links, double length, Savings& left_out)
        : links_(links), length_(length), left_out_(left_out) {}
    bool keep(std::span<int* const> particles) override {
        double const* const link = links_.length(*particles[0], *particles[1]);
        if (link != nullptr) left_out_.add(length_, *link);
        return link == nullptr;
    }

  private:
    LinkTable const& links_;
    double length_;
    Savings& left_out_;
};

/// Copies the bonds that are not along links, and counts the others in `left_out`.
std::unique_ptr<HarmonicBondForce> without_links(HarmonicBondForce const& bonds,
                                                 LinkTable const& links, Savings& left_out) {
    auto kept = std::make_unique<HarmonicBondForce>();
    kept->setUsesPeriodicBoundaryConditions(bonds.usesPeriodicBoundaryConditions());
    for (int i = 0; i < bonds.getNumBonds(); ++i) {
        int a, b;
        double length, k;
        bonds.getBondParameters(i, a, b, length, k);
        if (double const* link = links.length(a, b))
            left_out.add(length, *link);
        else
            kept->addBond(a, b, length, k);
    }
    return kept;
}

/// Number of bonds of a force.
int bonds_of(OpenMM::Force const& force) {
    if (auto const* harmonic = dynamic_cast<HarmonicBondForce const*>(&force))
        return harmonic->getNumBonds();
    auto const* custom = dynamic_cast<OpenMM::CustomBondForce const*>(&force);
    return custom == nullptr ? 0 : custom->getNumBonds();
}

/// Copies a force without the bonds that links replace. Returns nullptr for a force that links do
/// not touch.
std::unique_ptr<OpenMM::Force> off_links(OpenMM::Force const& force, LinkTable const& links,
                                         NamedLinks const& named, AllSavings& left_out) {
    std::unique_ptr<OpenMM::Force> kept;
    if (auto const* harmonic = dynamic_cast<HarmonicBondForce const*>(&force)) {
        kept = without_links(*harmonic, links, left_out.harmonic);
    } else if (double const length = named_length(named, force); length > 0) {
        BondsOffLinks filter(links, length, left_out.custom);
        kept = copy_bonded(force, filter);
    }
    if (kept == nullptr) return nullptr;
    kept->setName(force.getName());
    kept->setForceGroup(force.getForceGroup());
    return kept;
}

/// Names the forces after their terms, in the System's order. This must precede the removal of
/// bonds, which moves forces to the end. Forces that lose all bonds to `links` get no name. Throws
/// InputError for more forces than OpenMM has groups.
void name_in_order(System& system, LinkTable const& links, NamedLinks const& named,
                   std::string const& where) {
    std::vector<int> remaining;
    for (int i = 0; i < system.getNumForces(); ++i) {
        AllSavings ignored;
        auto const kept = off_links(system.getForce(i), links, named, ignored);
        if (kept == nullptr || bonds_of(*kept) > 0) remaining.push_back(i);
    }
    if (std::ssize(remaining) > force_groups_of_openmm)
        throw InputError(fmt::format("the System has {} forces", remaining.size()), where,
                         fmt::format("merge forces of one kind: OpenMM distinguishes {} groups",
                                     force_groups_of_openmm));
    std::vector<std::string> const names = term_names(system, remaining);
    for (std::size_t n = 0; n < names.size(); ++n) system.getForce(remaining[n]).setName(names[n]);
}

}  // namespace

LinkTable::LinkTable(BeadSystem const& beads, std::vector<int> const& particle_of_bead) {
    for (auto const& link : beads.links)
        lengths_[ordered(particle_of_bead[link.inboard], particle_of_bead[link.outboard])] =
            link.length;
}

double const* LinkTable::length(int a, int b) const {
    auto const found = lengths_.find(ordered(a, b));
    return found == lengths_.end() ? nullptr : &found->second;
}

std::vector<std::string> remove_constraints(System& system, LinkTable const& links,
                                            std::string const& where) {
    Savings left_out;
    // The loop runs backwards, because removals shift later indices.
    for (int i = system.getNumConstraints() - 1; i >= 0; --i) {
        int a, b;
        double length;
        system.getConstraintParameters(i, a, b, length);
        double const* link = links.length(a, b);
        if (link == nullptr)
            throw InputError(fmt::format("the constraint between particles {} and {} (from 0) is "
                                         "not a link of the scene",
                                         a, b),
                             where,
                             "join the two beads by a link or by `crosslinks` of their chain, or "
                             "make it a bond");
        if (std::abs(*link - length) > same_length)
            throw InputError(fmt::format("the constraint between particles {} and {} (from 0) has "
                                         "length {}, its link {}",
                                         a, b, length, *link),
                             where, "give both the same length");
        left_out.add(length, *link);
        system.removeConstraint(i);
    }
    return left_out.count > 0 ? std::vector{left_out.note("constraints")}
                              : std::vector<std::string>{};
}

std::vector<std::string> remove_linked_bonds(System& system, LinkTable const& links,
                                             NamedLinks const& named, std::string const& where) {
    AllSavings left_out;
    name_in_order(system, links, named, where);
    for (int i = system.getNumForces() - 1; i >= 0; --i) {
        auto kept = off_links(system.getForce(i), links, named, left_out);
        if (kept == nullptr) continue;
        system.removeForce(i);
        if (bonds_of(*kept) > 0) system.addForce(kept.release());
    }
    std::vector<std::string> notes;
    if (left_out.harmonic.count > 0) notes.push_back(left_out.harmonic.note("harmonic bonds"));
    if (left_out.custom.count > 0)
        notes.push_back(left_out.custom.note("bonds of CustomBondForces"));
    return notes;
}

}  // namespace catena
