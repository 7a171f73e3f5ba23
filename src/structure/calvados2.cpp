// Implements the charges of the CALVADOS models and the choice of a residue's parameters.
#include "structure/calvados2.hpp"

#include <cmath>
#include <numbers>

#include "scene/node.hpp"
#include "structure/calvados_rna.hpp"

namespace catena {

std::vector<ResidueType> const& calvados2_residues() {
    return built_in_table("calvados2")->types();
}

ResidueType const* find_calvados2(char letter) { return built_in_table("calvados2")->find(letter); }

ResidueType const* find_calvados2(std::string_view name) {
    return built_in_table("calvados2")->find(name);
}

ForceResidues::ForceResidues(OpenMmSpec const& spec) : built_in_(built_in_table(spec.builder)) {
    if (spec.builder.empty() || spec.topology.empty()) return;
    scene::Node at;  // the file itself
    at.text = spec.topology;
    own_ = read_residue_table(spec.topology, at);
}

ResidueType const* ForceResidues::find(std::string_view name) const {
    if (ResidueType const* const type = own_ ? own_->find(name) : nullptr) return type;
    if (!built_in_) return nullptr;
    ResidueType const* const type = built_in_->find(name);
    return type ? type : built_in_table(calvados_rna::model)->find(name);
}

namespace calvados2 {

namespace {
/// Numbers of entries for inner termini: the bead is counted from `first_inner` on.
std::int64_t constexpr first_inner = 2, n_flag = 1, c_flag = 2;
}  // namespace

std::pair<std::int64_t, std::int64_t> as_map_entry(InnerTerminus const& end) {
    return {first_inner + end.bead, (end.charged.n ? n_flag : 0) + (end.charged.c ? c_flag : 0)};
}

ChainEnds::ChainEnds(OpenMmSpec const& spec) {
    for (auto const& [name, charged] : spec.map)
        if (charged.first >= first_inner)
            inner_[name].push_back(
                {charged.first - first_inner,
                 {(charged.second & n_flag) != 0, (charged.second & c_flag) != 0}});
        else
            ends_[name] = {charged.first != 0, charged.second != 0};
}

std::vector<InnerTerminus> const& ChainEnds::inside(std::string const& chain) const {
    static std::vector<InnerTerminus> const none;
    auto const found = inner_.find(chain);
    return found == inner_.end() ? none : found->second;
}

ChargedTermini ChainEnds::of(std::string const& chain) const {
    auto const named = ends_.find(chain);
    auto const found = named == ends_.end() ? ends_.find("") : named;
    return found == ends_.end() ? ChargedTermini{} : found->second;
}

double bead_mass(ResidueType const& residue, ChainPlace const& at) {
    return residue.mass + (at.is_n_terminus() ? first_bead_mass : 0) +
           (at.is_c_terminus() ? last_bead_mass : 0);
}

double histidine_charge(std::optional<double> ph) {
    return ph ? 1 / (1 + std::pow(10.0, *ph - 6)) : 0;
}

double bead_charge(ResidueType const& residue, ChainPlace const& at, std::optional<double> ph) {
    double const inside = residue.letter == 'H' && ph ? histidine_charge(ph) : residue.charge;
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
