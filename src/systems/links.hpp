// Links between neighbours in a chain from a System's bonds and constraints. Needs OpenMM's
// headers.
#pragma once

#include <OpenMM.h>

#include <string>
#include <unordered_map>
#include <vector>

#include "systems/model.hpp"
#include "systems/pdb_topology.hpp"
#include "systems/stiff_links.hpp"

namespace catena {

/// All pairs of particles that harmonic bonds or constraints of a System join. Custom bonds join
/// their particles if `links` names their force.
class Joinings {
  public:
    /// Throws InputError for bonds of negative or infinite stiffness and for unknown particles.
    /// `where` is the scene file and key.
    Joinings(OpenMM::System const&, NamedLinks const& links, std::string const& where);
    /// Joining of particle p and the preceding one; it does not hold if nothing joins them.
    Joining to_previous(int p) const { return between(p - 1, p); }
    /// Joining of any two particles.
    Joining between(int a, int b) const;
    /// Calls visit(lower, higher, joining) for all joined particles that are not consecutive.
    template <class Visit>
    void for_each_farther(Visit const& visit) const {
        for (int high = 0; high < static_cast<int>(to_lower_.size()); ++high)
            for (auto const& [low, joining] : to_lower_[static_cast<std::size_t>(high)])
                if (high - low > 1) visit(low, high, joining);
    }
    /// True if a CustomBondForce alone joins particle p and the preceding one.
    bool bond_stays_force(int p) const {
        return custom_to_previous_[static_cast<std::size_t>(p)] >= 0 && !to_previous(p).holds();
    }
    /// True if a bond or constraint joins particle p and the preceding one.
    bool joins_to_previous(int p) const {
        return to_previous(p).holds() || custom_to_previous_[static_cast<std::size_t>(p)] >= 0;
    }
    /// Index of the CustomBondForce whose bond joins particle p and the preceding one; -1: none.
    int custom_force(int p) const { return custom_to_previous_[static_cast<std::size_t>(p)]; }
    /// Kind of the custom bond between particle p and the preceding one, e.g. "CustomBondForce
    /// (FENE)". Precondition: bond_stays_force(p).
    std::string custom_bond(int p) const;
    /// Name by which `links` can name that bond's force.
    std::string custom_name(int p) const;
    /// Particle of the chain on which particle p hangs: an earlier one, from `first` on. This is
    /// the preceding one if both are joined stiffly enough for a link. Else it is the one that is
    /// joined most stiffly, the nearest of several, if that bond is like the chain's first one. A
    /// constraint outranks springs. Failing all this it is the preceding one if a spring joins
    /// both, else -1. Temperature in K; precondition: first < p.
    int inboard(int p, int first, double temperature) const;
    /// True if particle p hangs on an earlier particle of the chain, or if a bond of any kind joins
    /// it to the preceding one. Precondition: first < p.
    bool goes_on(int p, int first, double temperature) const;
    /// Throws the InputError for particle p, which nothing joins to an earlier particle of its
    /// chain, from `first` on. The message names the reason and the place `at`.
    [[noreturn]] void refuse_gap(int p, int first, double temperature, std::string const& at) const;

  private:
    void add_harmonic_bonds(OpenMM::HarmonicBondForce const&, std::string const& where);
    void add_custom_bonds(int force, NamedLinks const&, std::string const& where);
    /// Earlier particle, from `first` on, that is joined most stiffly to particle p among those
    /// that `accept`; -1: none.
    template <class Accept>
    int stiffest(int p, int first, double temperature, Accept const& accept) const;
    /// Earlier particle, from `first` on, that a CustomBondForce joins to particle p; -1: none.
    int custom_inboard(int p, int first) const;
    void refuse_foreign(char const* what, int a, int b, std::string const& where) const;
    Joining& at(int a, int b);

    OpenMM::System const& system_;
    std::vector<std::unordered_map<int, Joining>>
        to_lower_;  // key: higher particle, then lower one
    /// Index of a CustomBondForce that joins each particle to the preceding one; -1: none.
    std::vector<int> custom_to_previous_;
};

/// Returns a sentence on bonds between neighbours that stay forces and are far shorter than the
/// thermal mean of such a bond, as in positions in another unit; empty if there are none.
std::string note_on_short_bonds(std::vector<PdbChain> const&, Joinings const&,
                                OpenMM::System const&, double temperature);

/// Cuts the chains of a topology where a CustomBondForce alone joins neighbours, which Catena's
/// chains cannot hold: the bond stays a force between two chains. Further pieces are named A-2,
/// A-3,
/// ... `notes`, unless nullptr, receives a sentence on them that tells how to make links.
std::vector<PdbChain> cut_at_bonds(std::vector<PdbChain> const&, Joinings const&,
                                   std::vector<std::string>* notes = nullptr);

}  // namespace catena
