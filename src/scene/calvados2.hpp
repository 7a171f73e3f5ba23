// The CALVADOS 2 model of proteins, one bead a residue: Tesei & Lindorff-Larsen, Open Research
// Europe 2:94 (2023). Parameters are those of inputs/calvados2_parameters.csv, embedded when the
// build is configured. Needs no OpenMM.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

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

/// nullptr for a code that the model does not have. Letters and names in upper case.
Calvados2Residue const* find_calvados2(char letter);
Calvados2Residue const* find_calvados2(std::string_view three_letter_name);

namespace calvados2 {

inline constexpr double bond_length = 0.38;  // nm
inline constexpr double bond_stiffness =
    8033;  // kJ/mol/nm2, of harmonic bonds in the links' places
inline constexpr double first_bead_mass = 2.0;        // amu, added to a chain's first bead
inline constexpr double last_bead_mass = 16.0;        // amu, added to a chain's last bead
inline constexpr double first_bead_charge = 1.0;      // e, added to a chain's first bead
inline constexpr double last_bead_charge = -1.0;      // e, added to a chain's last bead
inline constexpr double epsilon = 0.8368;             // kJ/mol, Ashbaugh-Hatch
inline constexpr double ashbaugh_hatch_cutoff = 2.0;  // nm
inline constexpr double yukawa_cutoff = 4.0;          // nm

/// Ends of a chain of residues that are charged, and have the mass of, free termini: N before the
/// first bead, C after the last.
struct ChargedTermini {
    bool n = true, c = true;
    bool operator==(ChargedTermini const&) const = default;
};
/// Those of every chain, as OpenMmSpec::map of a builder has them: 1 or 0 for the first and the
/// last bead, by the chain's name; "" stands for chains that are not named. Where it says nothing,
/// both ends are charged.
class ChainEnds {
  public:
    explicit ChainEnds(OpenMmSpec const&);
    ChargedTermini of(std::string const& chain) const;

  private:
    std::unordered_map<std::string, ChargedTermini> ends_;
};

/// Bead k (from 0) of a chain of n residues.
struct ChainPlace {
    std::int64_t k, n;
    ChargedTermini termini = {};
    bool is_n_terminus() const { return k == 0 && termini.n; }
    bool is_c_terminus() const { return k == n - 1 && termini.c; }
};

/// The residue's mass, plus what a charged terminus carries.
double bead_mass(Calvados2Residue const&, ChainPlace const&);

/// Charge of histidine in e: its protonated fraction 1 / (1 + 10^(pH - 6)), as the authors' own
/// simulations take it; without a pH it is neutral.
double histidine_charge(std::optional<double> ph);

/// In e, charged termini included.
double bead_charge(Calvados2Residue const&, ChainPlace const&, std::optional<double> ph);

/// Screened Coulomb energy between charges q_i, q_j: q_i q_j prefactor exp(-kappa r) / r.
struct Yukawa {
    double permittivity;    // of water relative to vacuum
    double bjerrum_length;  // nm
    double prefactor;       // kJ nm/mol
    double kappa;           // 1/nm, inverse Debye length
};
/// K, of the measurements behind the permittivity of water (Akerlof & Oshry, J. Am. Chem. Soc.
/// 72:2844, 1950): up to 370 C.
constexpr double warmest_water = 643;
/// Temperature in K, ionic strength in mol/l. Precondition: 0 < temperature <= warmest_water.
Yukawa yukawa(double temperature, double ionic_strength);

}  // namespace calvados2
}  // namespace catena
