// Implements the charges of beads and the texts on them.
#include "systems/charges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/node.hpp"
#include "structure/calvados2.hpp"

namespace catena {

namespace {

double constexpr same_charge = 5e-4;  // e; three decimals are printed
/// Largest number of groups of chains in the text.
std::size_t constexpr most_groups = 12;

/// Prints three decimals, without "-0.000".
std::string charge_in_e(double charge) {
    return fmt::format("{:.3f} e", std::abs(charge) < same_charge ? 0.0 : charge);
}

/// Consecutive chains of the same charge.
struct Group {
    /// Indices of the first and the last chain.
    std::size_t first, last;
    double charge;
};

/// The parts of a BeadSystem that charges depend on, of one replica.
BeadSystem charged_beads(Scene const& scene) {
    BeadSystem beads;
    beads.chain_offset.push_back(0);
    for (std::size_t c = 0; c < scene.chains_a_replica(); ++c) {
        ChainSpec const& chain = scene.chains[c];
        auto const& names = chain.is_beads() ? chain.beads.residue : chain.carried().residue;
        beads.residue.insert(beads.residue.end(), names.begin(), names.end());
        beads.chain_name.push_back(scene.name_in_file(c));
        beads.chain_offset.push_back(std::ssize(beads.residue));
    }
    return beads;
}

/// Begins each text of charge_text().
constexpr std::string_view charge_heading = "net charge: ";

}  // namespace

std::vector<double> bead_charges(OpenMmSpec const& spec, ForceResidues const& residues,
                                 BeadSystem const& beads) {
    calvados2::ChainEnds const ends(spec);
    std::vector<double> charges;
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        std::int64_t const first = beads.chain_offset[c],
                           length = beads.chain_offset[c + 1] - first;
        calvados2::ChargedTermini const termini = ends.of(beads.chain_name[c]);
        for (std::int64_t k = 0; k < length; ++k) {
            ResidueType const* const type =
                residues.find(beads.residue[static_cast<std::size_t>(first + k)]);
            charges.push_back(type ? calvados2::bead_charge(*type, {k, length, termini}, spec.ph)
                                   : 0);
        }
        for (auto const& [bead, charged] : ends.inside(beads.chain_name[c]))
            charges[static_cast<std::size_t>(first + bead)] +=
                (charged.n ? calvados2::first_bead_charge : 0) +
                (charged.c ? calvados2::last_bead_charge : 0);
    }
    return charges;
}

std::string histidine_text(OpenMmSpec const& spec, ForceResidues const& table,
                           std::span<std::string const> residues) {
    auto const number = std::count(residues.begin(), residues.end(), "HIS");
    ResidueType const* const type = table.find("HIS");
    double const charge = spec.ph ? calvados2::histidine_charge(spec.ph) : type ? type->charge : 0;
    std::string const state = spec.ph ? fmt::format("{:.3g} e (pH {})", charge, *spec.ph)
                              : charge == 0
                                  ? "neutral (no ph given)"
                                  : fmt::format("{:.3g} e (of the table, no ph given)", charge);
    return fmt::format("histidine {}{}", state,
                       number > 0 ? fmt::format(", {} of them", number) : "");
}

bool has_charges(Scene const& scene) {
    if (!scene.forces.openmm || scene.forces.openmm->builder.empty()) return false;
    OpenMmSpec const& spec = *scene.forces.openmm;
    std::vector<double> const charges =
        bead_charges(spec, ForceResidues(spec), charged_beads(scene));
    return std::any_of(charges.begin(), charges.end(), [](double charge) { return charge != 0; });
}

std::string assumed_charges(Scene const& scene) {
    if (!scene.forces.openmm || scene.forces.openmm->builder.empty()) return {};
    OpenMmSpec const& spec = *scene.forces.openmm;
    ForceResidues const residues(spec);
    BeadSystem const beads = charged_beads(scene);
    std::string text =
        charge_text(bead_charges(spec, residues, beads), beads).substr(charge_heading.size());
    if (std::find(beads.residue.begin(), beads.residue.end(), "HIS") != beads.residue.end())
        text += "; " + histidine_text(spec, residues, beads.residue);
    if (scene.replicas > 1) text += "; in each replica";
    return text;
}

std::string charge_text(std::span<double const> of_bead, BeadSystem const& beads) {
    std::vector<Group> groups;
    double sum = 0;
    for (std::size_t c = 0; c < beads.chain_name.size(); ++c) {
        double charge = 0;
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k)
            charge += of_bead[static_cast<std::size_t>(k)];
        sum += charge;
        if (groups.empty() || std::abs(groups.back().charge - charge) >= same_charge)
            groups.push_back({c, c, charge});
        else
            groups.back().last = c;
    }
    std::string text(charge_heading);
    for (std::size_t i = 0; i < std::min(groups.size(), most_groups); ++i) {
        Group const& g = groups[i];
        text += i == 0 ? "" : ", ";
        text += scene::shown(beads.chain_name[g.first]);
        if (g.last > g.first)
            text +=
                (g.last == g.first + 1 ? " and " : " to ") + scene::shown(beads.chain_name[g.last]);
        text += " " + charge_in_e(g.charge) + (g.last > g.first ? " each" : "");
    }
    if (groups.size() > most_groups) text += ", ...";
    return beads.chain_name.size() == 1 ? text : text + "; together " + charge_in_e(sum);
}

}  // namespace catena
