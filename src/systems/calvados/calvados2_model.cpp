// Implements the force field of CALVADOS 2 and 3 as an OpenMM System of two CustomNonbondedForces,
// with further forces for RNA. The models' harmonic bonds are absent, because rigid links replace
// them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "error.hpp"
#include "structure/calvados2.hpp"
#include "structure/calvados_rna.hpp"
#include "systems/calvados/rna_forces.hpp"
#include "systems/charges.hpp"
#include "systems/model.hpp"

namespace catena {

namespace {

/// Names a bead's place in the scene for messages.
std::string chain_key(BeadSystem const& beads, std::int64_t bead) {
    auto const next = std::upper_bound(beads.chain_offset.begin(), beads.chain_offset.end(), bead);
    auto const chain = static_cast<std::size_t>(next - beads.chain_offset.begin()) - 1;
    return fmt::format("{}: chain {}, body {}", beads.scene_file, beads.chain_name[chain],
                       bead - beads.chain_offset[chain] + 1);
}

/// The builder's model as publications write it, e.g. "CALVADOS 2".
std::string model_name(OpenMmSpec const& spec) {
    return fmt::format("CALVADOS {}", spec.builder.back());
}

/// Parameters of a bead's residue; throws InputError for unknown names.
ResidueType const& residue_of(OpenMmSpec const& spec, ForceResidues const& residues,
                              BeadSystem const& beads, std::int64_t bead) {
    std::string const& name = beads.residue[static_cast<std::size_t>(bead)];
    if (auto const* residue = residues.find(name)) return *residue;
    throw InputError(fmt::format("{} has no residue {}", model_name(spec), name),
                     chain_key(beads, bead),
                     "use the twenty amino acids (sequence and model: calvados2) or nucleotides "
                     "(model: calvados_rna), or give the forces as a System "
                     "(forces.openmm.system)");
}

/// Throws InputError for parameters outside the model's range and for boxes smaller than twice the
/// longest cutoff.
void check(OpenMmSpec const& spec, BeadSystem const& beads) {
    if (!(spec.temperature > 0))
        throw InputError(fmt::format("temperature {} K is not positive", spec.temperature),
                         openmm_key(beads.scene_file, "temperature"), "give it in kelvin");
    if (spec.temperature > calvados2::warmest_water)
        throw InputError(
            fmt::format(
                "the permittivity of water, which scales the electrostatics, is not known at {} K",
                spec.temperature),
            openmm_key(beads.scene_file, "temperature"),
            fmt::format("give at most {} K (the default is dynamics.temperature)",
                        calvados2::warmest_water));
    if (!(spec.ionic_strength >= 0))
        throw InputError(fmt::format("ionic strength {} mol/l is negative", spec.ionic_strength),
                         openmm_key(beads.scene_file, "ionic_strength"), "give it in mol/l");
    if (!(spec.switch_width >= 0 && spec.switch_width < calvados2::ashbaugh_hatch_cutoff))
        throw InputError(
            fmt::format("switch width {} nm is not between 0 and the shortest cutoff, {} nm",
                        spec.switch_width, calvados2::ashbaugh_hatch_cutoff),
            openmm_key(beads.scene_file, "switch_width"), "use about 0.2");
    if (beads.box)
        for (int i = 0; i < 3; ++i)
            if ((*beads.box)[i] < 2 * calvados2::yukawa_cutoff)
                throw InputError(
                    fmt::format("box edge {} nm is less than twice the cutoff of {} nm",
                                (*beads.box)[i], calvados2::yukawa_cutoff),
                    beads.scene_file + ": box.periodic", "use a larger box or none");
}

/// Ashbaugh-Hatch potential. The particles' parameters are half of sigma and lambda, so that a
/// pair's arithmetic means are sums. The energy is shifted to zero at the cutoff.
std::unique_ptr<OpenMM::CustomNonbondedForce> ashbaugh_hatch() {
    auto force = std::make_unique<OpenMM::CustomNonbondedForce>(
        "select(step(r-2^(1/6)*s), l*(lj-edge), lj-l*edge+eps*(1-l));"
        "lj=4*eps*a*(a-1); a=(s/r)^6; edge=4*eps*b*(b-1); b=(s/rc)^6; s=s1+s2; l=l1+l2");
    force->addPerParticleParameter("s");
    force->addPerParticleParameter("l");
    force->addGlobalParameter("eps", calvados2::epsilon);
    force->addGlobalParameter("rc", calvados2::ashbaugh_hatch_cutoff);
    force->setCutoffDistance(calvados2::ashbaugh_hatch_cutoff);
    force->setName("ashbaugh-hatch");
    return force;
}

/// Yukawa potential, shifted to zero at the cutoff. The parameter q of a particle includes the
/// square root of Yukawa::prefactor.
std::unique_ptr<OpenMM::CustomNonbondedForce> yukawa_force(calvados2::Yukawa const& y) {
    auto force = std::make_unique<OpenMM::CustomNonbondedForce>("q1*q2*(exp(-kappa*r)/r-edge)");
    force->addPerParticleParameter("q");
    force->addGlobalParameter("kappa", y.kappa);
    force->addGlobalParameter(
        "edge", std::exp(-y.kappa * calvados2::yukawa_cutoff) / calvados2::yukawa_cutoff);
    force->setCutoffDistance(calvados2::yukawa_cutoff);
    force->setName("yukawa");
    return force;
}

/// Excludes linked neighbours and pairs within rigid bodies, and sets cutoff method, switching and
/// group.
void finish(OpenMM::CustomNonbondedForce& force, OpenMmSpec const& spec, BeadSystem const& beads,
            int group) {
    for (auto const& link : beads.links)
        force.addExclusion(static_cast<int>(link.inboard), static_cast<int>(link.outboard));
    for (auto const& [inboard, outboard] : beads.neighbours)
        force.addExclusion(static_cast<int>(inboard), static_cast<int>(outboard));
    for (auto const& [first, last] : beads.rigid)
        for (std::int64_t a = first; a < last; ++a)
            for (std::int64_t b = a + 1; b < last; ++b)
                force.addExclusion(static_cast<int>(a), static_cast<int>(b));
    force.setNonbondedMethod(beads.box ? OpenMM::CustomNonbondedForce::CutoffPeriodic
                                       : OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
    force.setUseSwitchingFunction(spec.switch_width > 0);
    if (spec.switch_width > 0)
        force.setSwitchingDistance(force.getCutoffDistance() - spec.switch_width);
    force.setForceGroup(group);
}

/// Part of the note on rigid bodies; empty without any.
std::string rigid_note(BeadSystem const& beads) {
    if (beads.rigid.empty()) return {};
    return fmt::format("no forces within {} rigid {}; ", beads.rigid.size(),
                       beads.rigid.size() == 1 ? "body" : "bodies");
}

/// Length of the model's bond along a link, nm: the mean of its residues' bonds, for nucleotides
/// that of the outboard one.
double bond_of(BeadSystem::Link const& link, ForceResidues const& residues,
               BeadSystem const& beads) {
    std::string const &inboard = beads.residue[static_cast<std::size_t>(link.inboard)],
                      &outboard = beads.residue[static_cast<std::size_t>(link.outboard)];
    double const further = residues.find(outboard)->bond;
    return inboard == calvados_rna::backbone ? further
                                             : (residues.find(inboard)->bond + further) / 2;
}

/// Lengths of the model's bonds along the links, e.g. "0.38 nm" or "0.33 to 0.38 nm".
std::string bond_text(OpenMmSpec const& spec, ForceResidues const& residues,
                      BeadSystem const& beads, bool has_rna) {
    double least = built_in_table(spec.builder)->types().front().bond, most = least;
    // The program's tables of amino acids have one length for all residues.
    for (std::size_t i = 0; (residues.own() || has_rna) && i < beads.links.size(); ++i) {
        double const length = bond_of(beads.links[i], residues, beads);
        least = i == 0 ? length : std::min(least, length);
        most = i == 0 ? length : std::max(most, length);
    }
    return least == most ? fmt::format("{:.6g} nm", most)
                         : fmt::format("{:.6g} to {:.6g} nm", least, most);
}

/// Range of screened charges in words, e.g. "Debye length 0.79 nm".
std::string screening_text(calvados2::Yukawa const& y) {
    return y.kappa > 0 ? fmt::format("Debye length {:.4g} nm", 1 / y.kappa)
                       : "nothing screens charges";
}

/// Number of links that close loops of chains: cross-links and rings. Chains with rigid bodies have
/// none that could be told from others.
std::size_t closing_links(BeadSystem const& beads) {
    auto const open = static_cast<std::size_t>(beads.size()) - beads.chain_name.size();
    return beads.rigid.empty() && beads.links.size() > open ? beads.links.size() - open : 0;
}

/// Treatment of the model's bonds in words.
std::string links_text(OpenMmSpec const& spec, ForceResidues const& residues,
                       BeadSystem const& beads, bool has_rna) {
    std::size_t const closing = closing_links(beads), links = beads.links.size() - closing;
    return fmt::format("{} {} the model's harmonic bonds of {}{}", links,
                       links == 1 ? "link replaces" : "links replace",
                       bond_text(spec, residues, beads, has_rna),
                       closing == 0   ? ""
                       : closing == 1 ? ", 1 more closes a loop"
                                      : fmt::format(", {} more close loops", closing));
}

/// Sentences on parameters, cutoffs and links, for the user.
std::vector<std::string> notes_on(OpenMmSpec const& spec, ForceResidues const& residues,
                                  BeadSystem const& beads, calvados2::Yukawa const& y,
                                  bool has_rna) {
    std::string const own =
        residues.own() ? fmt::format(", parameters of `{}`", residues.own()->name()) : "";
    std::string const edge =
        spec.switch_width > 0 ? fmt::format("switched off over {} nm", spec.switch_width) : "cut";
    return {fmt::format("{} at {} K, {} mol/l: {}, {}{}", model_name(spec), spec.temperature,
                        spec.ionic_strength, screening_text(y),
                        histidine_text(spec, residues, beads.residue), own),
            fmt::format("ashbaugh-hatch {} at {} nm, yukawa at {} nm", edge,
                        calvados2::ashbaugh_hatch_cutoff, calvados2::yukawa_cutoff),
            rigid_note(beads) + links_text(spec, residues, beads, has_rna)};
}

}  // namespace

OpenMmModel calvados2_model(OpenMmSpec const& spec, BeadSystem const& beads) {
    check(spec, beads);
    calvados2::Yukawa const y = calvados2::yukawa(spec.temperature, spec.ionic_strength);
    // Each of the two charges of a pair carries the square root of the prefactor.
    double const unit = std::sqrt(y.prefactor);
    auto contact = ashbaugh_hatch();
    auto charges = yukawa_force(y);

    OpenMmModel model;
    model.system = std::make_shared<OpenMM::System>();
    if (beads.box)
        model.system->setDefaultPeriodicBoxVectors({(*beads.box)[0], 0, 0}, {0, (*beads.box)[1], 0},
                                                   {0, 0, (*beads.box)[2]});
    ForceResidues const residues(spec);
    std::vector<double> const charge_of = bead_charges(spec, residues, beads);  // e
    for (std::int64_t bead = 0; bead < beads.size(); ++bead) {
        ResidueType const& residue = residue_of(spec, residues, beads, bead);
        model.system->addParticle(beads.mass[bead]);
        contact->addParticle({residue.sigma / 2, residue.lambda / 2});
        charges->addParticle({unit * charge_of[bead]});
        model.bead_of_particle.push_back(bead);
    }
    finish(*contact, spec, beads, 0);
    finish(*charges, spec, beads, 1);
    model.terms = {contact->getName(), charges->getName()};
    std::array const pairs{contact.get(), charges.get()};
    model.system->addForce(contact.release());
    model.system->addForce(charges.release());
    Nucleotides const rna = nucleotides_of(beads, residues);
    model.notes = notes_on(spec, residues, beads, y, rna.count > 0);
    add_rna_forces(model, rna, residues, beads, pairs);
    model.notes.push_back(charge_text(charge_of, beads));
    return model;
}

}  // namespace catena
