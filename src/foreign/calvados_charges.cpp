// Implements the comparison of charges. The package (version 0.8, calvados/interactions.py and
// calvados/sequence.py) writes its numbers into the System.
#include "foreign/calvados_charges.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "foreign/settings.hpp"
#include "scene/fields.hpp"
#include "structure/calvados2.hpp"
#include "systems/import.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

using scene::Node;

/// Relative difference of prefactors and Debye lengths; covers constants of other digits, and is
/// 0.2 K or 0.2 % of the ionic strength.
constexpr double most_difference = 1e-3;
constexpr double most_charge_difference = 1e-3;  // e
constexpr double most_cutoff_difference = 1e-6;  // nm

/// Name of the System without its folder, for messages.
std::string system_name(Files const& files) {
    return scene::shown_path(std::filesystem::path(files.system).filename().string());
}

/// Name of the topology without its folder, for messages.
std::string name_of_topology(Files const& files) {
    return scene::shown_path(std::filesystem::path(files.topology).filename().string());
}

/// Throws InputError for another temperature or ionic strength. Notes a temperature beyond that of
/// liquid water, at which nothing can be compared.
void refuse_water(PackageFile const& config, Files const& files, Screening const& made,
                  std::vector<std::string>& notes) {
    Node const *const temp = config.find("temp"), *const ionic = config.find("ionic");
    if (temp == nullptr) return;
    double const temperature = scene::number(*temp), salt = config.non_negative("ionic", 0);
    if (!(temperature > 0 && temperature <= hottest)) return;  // settings_of() refuses these
    if (temperature > calvados2::warmest_water)
        return notes.push_back(fmt::format(
            "temp is {:.6g} K, and the permittivity of water is known up to {:g} K: whether the "
            "charges of {} are those of config.yaml's `temp` and `ionic` is not checked.",
            temperature, calvados2::warmest_water, system_name(files)));
    calvados2::Yukawa const asked = calvados2::yukawa(temperature, salt);
    if (std::abs(made.prefactor / asked.prefactor - 1) > most_difference)
        scene::fail(*temp,
                    fmt::format("at {:.6g} K charges act with a prefactor of {:.6g} kJ nm/mol, "
                                "those of {} with {:.6g}: it was written at another temperature",
                                temperature, asked.prefactor, system_name(files), made.prefactor),
                    run_again);
    if (ionic != nullptr && std::abs(made.kappa - asked.kappa) > most_difference * made.kappa)
        scene::fail(*ionic,
                    fmt::format("{:.6g} mol/l at {:.6g} K screen charges with {:.4g}/nm, {} does "
                                "with {:.4g}/nm: it was written with another ionic strength",
                                salt, temperature, asked.kappa, system_name(files), made.kappa),
                    run_again);
}

/// Throws InputError for another cutoff of charges.
void refuse_cutoff(PackageFile const& config, Files const& files, Screening const& made) {
    Node const* const cutoff = config.find("cutoff_yu");
    if (cutoff == nullptr) return;
    double const asked = scene::number(*cutoff);
    if (!(std::abs(asked - made.cutoff) <= most_cutoff_difference))
        scene::fail(*cutoff,
                    fmt::format("charges are cut at {:.6g} nm, those of {} at {:.6g} nm", asked,
                                system_name(files), made.cutoff),
                    run_again);
}

/// Throws InputError for histidines with the charge of another pH. Ends of chains have charges of
/// their own and are left out. The package writes a complex as one chain of the topology, so that
/// the System's bonds tell the ends.
void refuse_ph(PackageFile const& config, Files const& files, ScreenedChains const& made) {
    Node const* const ph = config.find("pH");
    if (ph == nullptr || files.topology.empty()) return;
    double const asked = calvados2::histidine_charge(scene::number(*ph));
    std::vector<double> const& charges = made.screening.charges;
    std::size_t p = 0;
    for (PdbChain const& chain : read_pdb_topology(files.topology, files.topology))
        for (std::size_t k = 0; k < chain.size() && p < charges.size(); ++k, ++p) {
            bool const inner = made.joined[p] && p + 1 < charges.size() && made.joined[p + 1];
            if (!inner || chain.residue[k] != "HIS" ||
                std::abs(charges[p] - asked) <= most_charge_difference)
                continue;
            scene::fail(
                *ph,
                fmt::format("at that pH a histidine has {:.3g} e, that of particle {} "
                            "(from 0) of {} has {:.3g} e: it was written at another pH, "
                            "or {} has its atoms in another order than the particles",
                            asked, p, system_name(files), charges[p], name_of_topology(files)),
                run_again);
        }
}

}  // namespace

void refuse_other_charges(PackageFile const& config, Files const& files,
                          std::vector<std::string>& notes) {
    auto const made = read_screened_chains(files.system, scene::shown_path(files.system));
    if (!made) return;
    refuse_water(config, files, made->screening, notes);
    refuse_cutoff(config, files, made->screening);
    refuse_ph(config, files, *made);
}

}  // namespace catena::foreign
