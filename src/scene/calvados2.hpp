// The CALVADOS 2 model of proteins, one bead per residue: Tesei & Lindorff-Larsen, Open Research
// Europe 2:94 (2023). The parameters are those of inputs/calvados2_parameters.csv, embedded at
// configuration of the build. The model needs no OpenMM.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// Parameters of one residue type.
struct Calvados2Residue {
    char letter;       // one-letter code
    std::string name;  // three-letter code, upper case
    double mass;       // amu
    double lambda;     // stickiness
    double sigma;      // bead diameter, nm
    double charge;     // e, inside a chain; histidine: neutral, see histidine_charge
};

/// The twenty residues, in the order of the parameter file.
std::vector<Calvados2Residue> const& calvados2_residues();

/// Returns nullptr for a code that is not in the model. Letters and names must be in upper case.
Calvados2Residue const* find_calvados2(char letter);
Calvados2Residue const* find_calvados2(std::string_view three_letter_name);

namespace calvados2 {

inline constexpr double bond_length = 0.38;  // nm
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
/// Charged termini of all chains, read from OpenMmSpec::map of a builder. The map holds 1 or 0 for
/// the first and the last bead, by the chain's name. The name "" stands for chains without an
/// entry. Without any entry both ends are charged.
class ChainEnds {
  public:
    explicit ChainEnds(OpenMmSpec const&);
    /// Charged termini of the chain of that name.
    ChargedTermini of(std::string const& chain) const;

  private:
    std::unordered_map<std::string, ChargedTermini> ends_;
};

/// Position of a bead in its chain: bead k (from 0) of a chain of n residues.
struct ChainPlace {
    std::int64_t k, n;
    ChargedTermini termini = {};
    bool is_n_terminus() const { return k == 0 && termini.n; }
    bool is_c_terminus() const { return k == n - 1 && termini.c; }
};

/// Mass in amu of the bead, including the additional mass of a charged terminus.
double bead_mass(Calvados2Residue const&, ChainPlace const&);

/// Charge of histidine in e: its protonated fraction 1 / (1 + 10^(pH - 6)), as in the authors' own
/// simulations. Without a pH histidine is neutral.
double histidine_charge(std::optional<double> ph);

/// Charge of the bead in e, charged termini included.
double bead_charge(Calvados2Residue const&, ChainPlace const&, std::optional<double> ph);

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
