// The CALVADOS models of proteins, one bead per residue. CALVADOS 2: Tesei & Lindorff-Larsen, Open
// Research Europe 2:94 (2023). CALVADOS 3: Cao, von Buelow, Tesei & Lindorff-Larsen, Protein
// Science 33:e5172 (2024). Both have the same energy function and differ in their residue tables
// (residue_table.hpp). The models need no OpenMM.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/scene.hpp"
#include "structure/residue_table.hpp"

namespace catena {

/// The twenty residues of CALVADOS 2, in the order of the parameter file.
std::vector<ResidueType> const& calvados2_residues();

/// Returns nullptr for a code that is not in CALVADOS 2. Letters and names must be in upper case.
ResidueType const* find_calvados2(char letter);
ResidueType const* find_calvados2(std::string_view three_letter_name);

/// Parameters that a builder's forces give to residues: those of the chains' own table
/// (OpenMmSpec::topology), else those of the builder's table, else those of RNA.
class ForceResidues {
  public:
    /// Reads the chains' own table if there is one. Throws InputError for a faulty file.
    explicit ForceResidues(OpenMmSpec const&);
    /// Returns nullptr for unknown names.
    ResidueType const* find(std::string_view three_letter_name) const;
    /// The chains' own table, or nullptr.
    ResidueTable const* own() const { return own_ ? &*own_ : nullptr; }

  private:
    std::optional<ResidueTable> own_;
    ResidueTable const* built_in_;
};

namespace calvados2 {

/// Stiffness of the harmonic bonds that the links replace, kJ/mol/nm2.
inline constexpr double bond_stiffness = 8033;
inline constexpr double first_bead_mass = 2.0;        // amu, added to a chain's first bead
inline constexpr double last_bead_mass = 16.0;        // amu, added to a chain's last bead
inline constexpr double first_bead_charge = 1.0;      // e, added to a chain's first bead
inline constexpr double last_bead_charge = -1.0;      // e, added to a chain's last bead
inline constexpr double epsilon = 0.8368;             // kJ/mol, Ashbaugh-Hatch
inline constexpr double ashbaugh_hatch_cutoff = 2.0;  // nm
inline constexpr double yukawa_cutoff = 4.0;          // nm

/// Charged ends of a chain: N before the first bead, C after the last. A charged end also has the
/// additional mass of a free terminus.
struct ChargedTermini {
    bool n = true, c = true;
    bool operator==(ChargedTermini const&) const = default;
};
/// A charged terminus of a complex, at any bead of its chain.
struct InnerTerminus {
    std::int64_t bead;
    ChargedTermini charged;
};
/// Entry of OpenMmSpec::map for such a terminus. A first number from 2 on marks it.
std::pair<std::int64_t, std::int64_t> as_map_entry(InnerTerminus const&);

/// Charged termini of all chains, read from OpenMmSpec::map of a builder. The map holds 1 or 0 for
/// the first and the last bead, by the chain's name. The name "" stands for chains without an
/// entry. Without any entry both ends are charged. Further entries of a name are inner termini.
class ChainEnds {
  public:
    explicit ChainEnds(OpenMmSpec const&);
    /// Charged termini of the chain of that name.
    ChargedTermini of(std::string const& chain) const;
    /// Further termini of the chain of that name.
    std::vector<InnerTerminus> const& inside(std::string const& chain) const;

  private:
    std::unordered_map<std::string, ChargedTermini> ends_;
    std::unordered_map<std::string, std::vector<InnerTerminus>> inner_;
};

/// Position of a bead in its chain: bead k (from 0) of a chain of n residues.
struct ChainPlace {
    std::int64_t k, n;
    ChargedTermini termini = {};
    bool is_n_terminus() const { return k == 0 && termini.n; }
    bool is_c_terminus() const { return k == n - 1 && termini.c; }
};

/// Mass in amu of the bead, including the additional mass of a charged terminus.
double bead_mass(ResidueType const&, ChainPlace const&);

/// Charge of histidine in e: its protonated fraction 1 / (1 + 10^(pH - 6)), as in the authors' own
/// simulations. Without a pH it is 0.
double histidine_charge(std::optional<double> ph);

/// Charge of the bead in e, charged termini included. A pH sets the charge of the residue with the
/// letter H, histidine, as in the CALVADOS package.
double bead_charge(ResidueType const&, ChainPlace const&, std::optional<double> ph);

/// Screened Coulomb energy between charges q_i, q_j: q_i q_j prefactor exp(-kappa r) / r.
struct Yukawa {
    double permittivity;    // water relative to vacuum
    double bjerrum_length;  // nm
    double prefactor;       // kJ nm/mol
    double kappa;           // 1/nm, inverse Debye length
};
/// Highest temperature of the measurements behind the permittivity of water, K (Akerlof & Oshry, J.
/// Am. Chem. Soc. 72:2844, 1950): up to 370 C.
constexpr double warmest_water = 643;
/// Computes the screened interaction from temperature in K and ionic strength in mol/l.
/// Precondition: 0 < temperature <= warmest_water.
Yukawa yukawa(double temperature, double ionic_strength);

}  // namespace calvados2
}  // namespace catena
