// Implements the parameters and charges of CALVADOS 2.
#include "scene/calvados2.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Generated: embedded_parameters with one {name, mass, lambda, sigma, charge} per residue.
#include "calvados2_parameters.inc"

namespace catena {

namespace {

char letter_of(std::string_view name) {
    static constexpr std::string_view names =
        "ALA ARG ASN ASP CYS GLN GLU GLY HIS ILE LEU LYS MET PHE PRO SER THR TRP TYR VAL";
    static constexpr std::string_view letters = "ARNDCQEGHILKMFPSTWYV";
    std::size_t const at = names.find(name);
    return at == std::string_view::npos ? '?' : letters[at / 4];
}

}  // namespace

std::vector<Calvados2Residue> const& calvados2_residues() {
    static std::vector<Calvados2Residue> const residues = [] {
        std::vector<Calvados2Residue> made;
        for (auto const& p : embedded_parameters)
            made.push_back({letter_of(p.name), p.name, p.mass, p.lambda, p.sigma, p.charge});
        return made;
    }();
    return residues;
}

Calvados2Residue const* find_calvados2(char letter) {
    auto const& all = calvados2_residues();
    auto const found =
        std::find_if(all.begin(), all.end(), [&](auto const& r) { return r.letter == letter; });
    return found == all.end() ? nullptr : &*found;
}

Calvados2Residue const* find_calvados2(std::string_view name) {
    auto const& all = calvados2_residues();
    auto const found =
        std::find_if(all.begin(), all.end(), [&](auto const& r) { return r.name == name; });
    return found == all.end() ? nullptr : &*found;
}

namespace calvados2 {

ChainEnds::ChainEnds(OpenMmSpec const& spec) {
    for (auto const& [name, charged] : spec.map)
        ends_[name] = {charged.first != 0, charged.second != 0};
}

ChargedTermini ChainEnds::of(std::string const& chain) const {
    auto const named = ends_.find(chain);
    auto const found = named == ends_.end() ? ends_.find("") : named;
    return found == ends_.end() ? ChargedTermini{} : found->second;
}

double bead_mass(Calvados2Residue const& residue, ChainPlace const& at) {
    return residue.mass + (at.is_n_terminus() ? first_bead_mass : 0) +
           (at.is_c_terminus() ? last_bead_mass : 0);
}

double histidine_charge(std::optional<double> ph) {
    return ph ? 1 / (1 + std::pow(10.0, *ph - 6)) : 0;
}

double bead_charge(Calvados2Residue const& residue, ChainPlace const& at,
                   std::optional<double> ph) {
    double const inside =
        residue.letter == 'H' ? residue.charge + histidine_charge(ph) : residue.charge;
    return inside + (at.is_n_terminus() ? first_bead_charge : 0) +
           (at.is_c_terminus() ? last_bead_charge : 0);
}

Yukawa yukawa(double temperature, double ionic_strength) {
    // Constants with the digits of the model's published simulations (powers of ten cancel).
    double constexpr elementary_charge = 1.6021766, vacuum_permittivity = 8.854188,
                     avogadro = 6.02214076, gas_constant = 8.3145;
    double const t = temperature, thermal = gas_constant * t / 1000;
    Yukawa y;
    y.permittivity = 5321 / t + 233.76 - 0.9297 * t + 0.1417e-2 * t * t - 0.8292e-6 * t * t * t;
    y.prefactor = elementary_charge * elementary_charge /
                  (4 * std::numbers::pi * vacuum_permittivity * y.permittivity) * avogadro * 1000;
    y.bjerrum_length = y.prefactor / thermal;
    y.kappa = std::sqrt(8 * std::numbers::pi * y.bjerrum_length * ionic_strength * avogadro / 10);
    return y;
}

}  // namespace calvados2
}  // namespace catena
