// Implements the comparison of charges. The package (version 0.8, calvados/interactions.py and
// calvados/sequence.py) writes its numbers into the System.
#include "foreign/calvados_charges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <string>

#include "error.hpp"
#include "foreign/settings.hpp"
#include "scene/fields.hpp"
#include "structure/calvados2.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

/// Relative difference of prefactors and Debye lengths; covers constants of other digits, and is
/// 0.2 K or 0.2 % of the ionic strength.
constexpr double most_difference = 1e-3;
constexpr double most_charge_difference = 1e-3;  // e
constexpr double most_cutoff_difference = 1e-6;  // nm

/// Throws InputError for another temperature or ionic strength. Notes a temperature beyond that of
/// liquid water, at which nothing can be compared.
void refuse_water(PackageFile const& config, std::string const& system, Screening const& made,
                  std::vector<std::string>& notes) {
    Node const *const temp = config.find("temp"), *const ionic = config.find("ionic");
    if (temp == nullptr) return;
    double const temperature = number_of(*temp), salt = config.non_negative("ionic", 0);
    if (!(temperature > 0 && temperature <= hottest)) return;  // settings_of() refuses these
    if (temperature > calvados2::warmest_water)
        return notes.push_back(fmt::format(
            "temp is {:.6g} K, and the permittivity of water is known up to {:g} K: whether the "
            "charges of {} are those of config.yaml's `temp` and `ionic` is not checked.",
            temperature, calvados2::warmest_water, system));
    calvados2::Yukawa const asked = calvados2::yukawa(temperature, salt);
    if (std::abs(made.prefactor / asked.prefactor - 1) > most_difference)
        scene::fail(*temp,
                    fmt::format("at {:.6g} K charges act with a prefactor of {:.6g} kJ nm/mol, "
                                "those of {} with {:.6g}: it was written at another temperature",
                                temperature, asked.prefactor, system, made.prefactor),
                    run_again);
    if (ionic != nullptr && std::abs(made.kappa - asked.kappa) > most_difference * made.kappa)
        scene::fail(*ionic,
                    fmt::format("{:.6g} mol/l at {:.6g} K screen charges with {:.4g}/nm, {} does "
                                "with {:.4g}/nm: it was written with another ionic strength",
                                salt, temperature, asked.kappa, system, made.kappa),
                    run_again);
}

/// Throws InputError for another cutoff of charges.
void refuse_cutoff(PackageFile const& config, std::string const& system, Screening const& made) {
    Node const* const cutoff = config.find("cutoff_yu");
    if (cutoff == nullptr) return;
    double const asked = number_of(*cutoff);
    if (!(std::abs(asked - made.cutoff) <= most_cutoff_difference))
        scene::fail(*cutoff,
                    fmt::format("charges are cut at {:.6g} nm, those of {} at {:.6g} nm", asked,
                                system, made.cutoff),
                    run_again);
}

/// Throws InputError if the energy of charges is not shifted to 0 at their cutoff.
void refuse_shift(SystemText const& system) {
    static std::regex const form(R"([^(]*\(exp\(-([^*]+)\*r\)/r-([^)]+)\);.*)");
    for (ForceText const& force : system.forces()) {
        std::smatch parts;
        double kappa = 0, shift = 0;
        bool const is_read =
            force.kind == "CustomNonbondedForce" && force.cutoff > 0 &&
            std::regex_match(force.energy, parts, form) &&
            scene::parse_number(parts[1].str(), kappa) == scene::NumberFault::none &&
            scene::parse_number(parts[2].str(), shift) == scene::NumberFault::none;
        double const asked = std::exp(-kappa * force.cutoff) / force.cutoff;
        if (!is_read || std::abs(shift - asked) <= most_difference * asked) continue;
        throw InputError(
            fmt::format("the energy of charges is shifted by {:.6g}/nm, and is 0 at the cutoff of "
                        "{:.6g} nm with {:.6g}/nm",
                        shift, force.cutoff, asked),
            scene::shown_path(system.file()), run_again);
    }
}

/// True for a particle within a chain: its charge is that of its residue. The package writes a
/// complex as one chain of the topology, so that the System's bonds tell the ends.
bool is_inner(std::vector<bool> const& joined, std::size_t p) {
    return joined[p] && p + 1 < joined.size() && joined[p + 1];
}

/// Throws InputError for histidines with the charge of another pH.
void refuse_ph(Node const& ph, MadeSystem const& made) {
    double const asked = calvados2::histidine_charge(number_of(ph));
    std::vector<double> const& charges = made.charges->screening.charges;
    std::size_t p = 0;
    for (PdbChain const& chain : made.chains)
        for (std::size_t k = 0; k < chain.size() && p < charges.size(); ++k, ++p)
            if (chain.residue[k] == "HIS" && is_inner(made.charges->joined, p) &&
                std::abs(charges[p] - asked) > most_charge_difference)
                scene::fail(ph,
                            fmt::format("at that pH a histidine has {:.3g} e, that of particle {} "
                                        "(from 0) of {} has {:.3g} e: it was written at another "
                                        "pH, or {} has its atoms in another order than the "
                                        "particles",
                                        asked, p, made.name(), charges[p], made.topology),
                            run_again);
}

/// Notes the charge of histidines that the System was written with.
void note_histidines(MadeSystem const& made, std::vector<std::string>& notes) {
    std::vector<double> const& charges = made.charges->screening.charges;
    std::size_t p = 0;
    for (PdbChain const& chain : made.chains)
        for (std::size_t k = 0; k < chain.size() && p < charges.size(); ++k, ++p) {
            if (chain.residue[k] != "HIS" || !is_inner(made.charges->joined, p)) continue;
            double const q = charges[p];
            return notes.push_back(fmt::format(
                "config.yaml has no `pH`: the histidine of particle {} (from 0) of {} has {:.3g} "
                "e{}.",
                p, made.name(), q,
                q > 0 && q < 1 ? fmt::format(", as at pH {:.3g}", 6 + std::log10(1 / q - 1))
                               : std::string()));
        }
    notes.push_back(fmt::format("config.yaml has no `pH`, and {} has no histidine within a chain.",
                                made.name()));
}

/// Charges of residues within chains, by name: the System's own, of which the most frequent counts,
/// else those of the CALVADOS models.
class InnerCharges {
  public:
    explicit InnerCharges(MadeSystem const& made) {
        std::size_t p = 0;
        auto const& [screening, joined] = *made.charges;
        for (PdbChain const& chain : made.chains)
            for (std::size_t k = 0; k < chain.size() && p < joined.size(); ++k, ++p)
                if (is_inner(joined, p)) ++found_[chain.residue[k]][screening.charges[p]];
    }
    /// Returns nothing for a residue that neither has.
    std::optional<double> of(std::string const& residue, Node const* ph) const {
        if (auto const own = found_.find(residue); own != found_.end())
            return std::max_element(
                       own->second.begin(), own->second.end(),
                       [](auto const& a, auto const& b) { return a.second < b.second; })
                ->first;
        ResidueType const* const known = find_calvados2(residue);
        if (known == nullptr || (known->letter == 'H' && ph == nullptr)) return std::nullopt;
        return known->letter == 'H' ? calvados2::histidine_charge(number_of(*ph)) : known->charge;
    }

  private:
    std::map<std::string, std::map<double, std::size_t>> found_;  // numbers of particles
};

/// An end of a chain in the System.
struct ChainEnd {
    std::size_t particle;
    bool n, c;  // no bond to the preceding particle, to the next one
};

/// Throws InputError if an end has another charge than `charge_termini` gives it.
void refuse_end(ChainEnd const& end, CalvadosComponent const& component, double inner,
                CalvadosComponents const& components, MadeSystem const& made) {
    bool const n = end.n && component.charges('N'), c = end.c && component.charges('C');
    double const asked = inner + (n ? calvados2::first_bead_charge : 0) +
                         (c ? calvados2::last_bead_charge : 0),
                 found = made.charges->screening.charges[end.particle];
    if (std::abs(found - asked) <= most_charge_difference) return;
    throw InputError(fmt::format("with {} the {} end of `{}` has {:.3g} e, and particle {} "
                                 "(from 0) of {} has {:.3g} e",
                                 component.termini.empty()
                                     ? "an empty `charge_termini`"
                                     : "`charge_termini` " + scene::shown(component.termini),
                                 end.n ? "N" : "C", scene::shown(component.name), asked,
                                 end.particle, made.name(), found),
                     components.place(component, "charge_termini"), run_again);
}

}  // namespace

void compare_charges(PackageFile const& config, MadeSystem const& made,
                     std::vector<std::string>& notes) {
    if (!made.charges)
        return notes.push_back(fmt::format(
            "No charges of the package's form are found in {}: whether `temp`, `ionic`, `pH`, "
            "`cutoff_yu` and `charge_termini` are those of its run is not checked.",
            made.name()));
    refuse_water(config, made.name(), made.charges->screening, notes);
    refuse_cutoff(config, made.name(), made.charges->screening);
    refuse_shift(made.text);
    if (Node const* const ph = config.find("pH"))
        refuse_ph(*ph, made);
    else
        note_histidines(made, notes);
}

void refuse_other_termini(PackageFile const& config, CalvadosComponents const& components,
                          MadeSystem const& made) {
    auto const owners = components.of_chains(made.chains.size());
    if (!made.charges || owners.empty()) return;
    InnerCharges const inner(made);
    std::vector<bool> const& joined = made.charges->joined;
    std::size_t p = 0;
    for (std::size_t i = 0; i < owners.size(); ++i)
        for (std::size_t k = 0; k < made.chains[i].size() && p < joined.size(); ++k, ++p) {
            ChainEnd const end{p, !joined[p], p + 1 == joined.size() || !joined[p + 1]};
            auto const charge = inner.of(made.chains[i].residue[k], config.find("pH"));
            if ((end.n || end.c) && charge && owners[i]->is_protein())
                refuse_end(end, *owners[i], *charge, components, made);
        }
}

}  // namespace catena::foreign
