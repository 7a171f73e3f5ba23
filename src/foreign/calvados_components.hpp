// components.yaml of a CALVADOS folder: what its molecules are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Parameters of RNA under the package's keys, without `rna_`.
struct RnaParameters {
    /// Stiffness of bonds along the backbone and to bases, kJ/mol/nm2.
    double kb1 = 8033, kb2 = 8033;
    /// Angle, rad, and its stiffness, kJ/mol/rad2.
    double pa = 3.14, ka = 7.24;
    /// Diameter, nm, factor and cutoff, nm, of stacked bases.
    double nb_sigma = 0.4, nb_scale = 15, nb_cutoff = 0.6;
};

/// One component of the package. Its own properties override the defaults.
struct CalvadosComponent {
    std::string name, type;  // type: protein, crowder, rna, lipid, ...
    std::int64_t molecules = 1;
    /// Charged ends: both, N, C; any other word and an empty one mean none.
    std::string termini;
    /// True if external forces act on its particles.
    bool pulled = true;
    bool restrained = false;
    /// True if its network was made with nearest images in its structure's own cell.
    bool periodic = false;
    std::string network;  // harmonic or go
    /// Stiffness of its bonds and of its harmonic network, kJ/mol/nm2; depth of its Go contacts,
    /// kJ/mol; distance up to which a network joins pairs, nm.
    double kb = 8033, k_harmonic = 700, k_go = 15, cutoff_restr = 0.9;
    RnaParameters rna;
    /// Files of residues and sequences as they are written; empty without one.
    std::string residues, sequences;
    /// Places of its properties in messages: "FILE: system.A.kb, line 3".
    std::map<std::string, std::string> places;

    bool is_protein() const { return type == "protein"; }
    bool is_rna() const { return type == "rna"; }
    bool is_go() const { return restrained && network == "go"; }
    /// True for a charged terminus at the first (N) or the last (C) bead.
    bool charges(char end) const { return termini == "both" || termini == std::string(1, end); }
};

/// Holds what the package's components say.
struct CalvadosComponents {
    std::string file;  // its name in messages
    /// The components in the order of the System's particles: proteins first.
    std::vector<CalvadosComponent> all;

    /// Number of molecules of all components.
    std::int64_t molecules() const;
    /// True if a component has restraints within its domains.
    bool restrained() const;
    /// True if all are proteins, RNA or crowders: other kinds are not compared with the System.
    bool comparable() const;
    /// Returns the component of each of `chains` chains of the topology. Empty if these are no
    /// molecules and several components share them.
    std::vector<CalvadosComponent const*> of_chains(std::size_t chains) const;
    /// Returns the place of a property of the component, or the file where it has a default.
    std::string place(CalvadosComponent const&, std::string const& property) const;
};

/// Reads components.yaml. Throws InputError for one without components and for values of the wrong
/// kind.
CalvadosComponents read_components(PackageFile const& file);

}  // namespace catena::foreign
