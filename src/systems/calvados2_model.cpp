// Implements the CALVADOS 2 force field as an OpenMM System of two CustomNonbondedForces. The
// model's harmonic bonds are absent, because rigid links replace them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "scene/calvados2.hpp"
#include "systems/charges.hpp"
#include "systems/model.hpp"

namespace catena {

namespace {

/// The chain of a bead and the bead's position k in it (from 0).
struct Place {
    std::string chain;
    std::int64_t k, length;
    calvados2::ChargedTermini termini;
};

/// Calls visit(bead, place) for every bead of every chain.
template <class Visit>
void for_each_bead(OpenMmSpec const& spec, BeadSystem const& beads, Visit visit) {
    calvados2::ChainEnds const ends(spec);
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c) {
        std::int64_t const first = beads.chain_offset[c],
                           length = beads.chain_offset[c + 1] - first;
        Place place{beads.chain_name[c], 0, length, ends.of(beads.chain_name[c])};
        for (; place.k < length; ++place.k) visit(first + place.k, place);
    }
}

/// Names a bead's place in the scene for messages.
std::string chain_key(BeadSystem const& beads, Place const& at) {
    return fmt::format("{}: chain {}, body {}", beads.scene_file, at.chain, at.k + 1);
}

/// Parameters of a bead's residue; throws InputError for unknown names.
Calvados2Residue const& residue_of(BeadSystem const& beads, std::int64_t bead, Place const& at) {
    std::string const& name = beads.residue[bead];
    if (auto const* residue = find_calvados2(std::string_view(name))) return *residue;
    throw InputError(fmt::format("CALVADOS 2 has no residue {}", name), chain_key(beads, at),
                     "use the twenty amino acids (sequence and model: calvados2), or give the "
                     "forces as a System (forces.openmm.system)");
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

/// Sentences on parameters, cutoffs and links, for the user.
std::vector<std::string> notes_on(OpenMmSpec const& spec, BeadSystem const& beads,
                                  calvados2::Yukawa const& y) {
    std::string const histidine = spec.ph
                                      ? fmt::format("histidine {:.3g} e (pH {})",
                                                    calvados2::histidine_charge(spec.ph), *spec.ph)
                                      : "histidine neutral (no ph given)";
    auto const histidines = std::count(beads.residue.begin(), beads.residue.end(), "HIS");
    std::string const number = histidines > 0 ? fmt::format(", {} of them", histidines) : "";
    std::string const edge =
        spec.switch_width > 0 ? fmt::format("switched off over {} nm", spec.switch_width) : "cut";
    return {fmt::format("CALVADOS 2 at {} K, {} mol/l: Debye length {:.4g} nm, {}{}",
                        spec.temperature, spec.ionic_strength, 1 / y.kappa, histidine, number),
            fmt::format("ashbaugh-hatch {} at {} nm, yukawa at {} nm", edge,
                        calvados2::ashbaugh_hatch_cutoff, calvados2::yukawa_cutoff),
            fmt::format("{}{} links replace the model's harmonic bonds of {} nm", rigid_note(beads),
                        beads.links.size(), calvados2::bond_length)};
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
    std::vector<double> charge_of;  // e, per bead
    model.system = std::make_shared<OpenMM::System>();
    if (beads.box)
        model.system->setDefaultPeriodicBoxVectors({(*beads.box)[0], 0, 0}, {0, (*beads.box)[1], 0},
                                                   {0, 0, (*beads.box)[2]});
    for_each_bead(spec, beads, [&](std::int64_t bead, Place const& at) {
        auto const& residue = residue_of(beads, bead, at);
        model.system->addParticle(beads.mass[bead]);
        contact->addParticle({residue.sigma / 2, residue.lambda / 2});
        double const charge =
            calvados2::bead_charge(residue, {at.k, at.length, at.termini}, spec.ph);
        charges->addParticle({unit * charge});
        charge_of.push_back(charge);
        model.bead_of_particle.push_back(bead);
    });
    finish(*contact, spec, beads, 0);
    finish(*charges, spec, beads, 1);
    model.terms = {contact->getName(), charges->getName()};
    model.system->addForce(contact.release());
    model.system->addForce(charges.release());
    model.notes = notes_on(spec, beads, y);
    model.notes.push_back(charge_text(charge_of, beads));
    return model;
}

}  // namespace catena
