// Implements the forces of RNA. The energies are those of the CALVADOS package (calvados/
// components.py, class RNA): bases of neighbours stack by an Ashbaugh-Hatch potential of their own,
// whose energy is shifted by that at the cutoff and acts at any distance.
#include "systems/calvados/rna_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "error.hpp"
#include "structure/calvados_rna.hpp"

namespace catena {

namespace {

/// Links of one bead of a backbone; -1: none.
struct Nucleotide {
    std::int64_t before = -1, after = -1, base = -1;
};

bool is_backbone(BeadSystem const& beads, std::int64_t bead) {
    return beads.residue[static_cast<std::size_t>(bead)] == calvados_rna::backbone;
}

/// Sets one link of a nucleotide; throws InputError if it has another one.
void set(std::int64_t& link, std::int64_t to, std::int64_t bead, BeadSystem const& beads) {
    if (link >= 0)
        throw InputError(
            fmt::format("the backbone bead {} of RNA has links to beads {} and {}, where CALVADOS "
                        "has one",
                        beads.name(bead) + 1, beads.name(link) + 1, beads.name(to) + 1),
            beads.scene_file,
            fmt::format(
                "hang one base on each bead {}, let one follow it, and leave out cross-links",
                calvados_rna::backbone));
    link = to;
}

/// The nucleotides by the bead of their backbone, for all beads; other beads have no links.
std::vector<Nucleotide> linked(BeadSystem const& beads) {
    std::vector<Nucleotide> found(static_cast<std::size_t>(beads.size()));
    auto const of = [&](std::int64_t bead) -> Nucleotide& {
        return found[static_cast<std::size_t>(bead)];
    };
    for (auto const& [inboard, outboard, length] : beads.links) {
        bool const in = is_backbone(beads, inboard), out = is_backbone(beads, outboard);
        if (in && out) {
            set(of(inboard).after, outboard, inboard, beads);
            set(of(outboard).before, inboard, outboard, beads);
        } else if (in || out) {
            std::int64_t const bead = in ? inboard : outboard;
            set(of(bead).base, in ? outboard : inboard, bead, beads);
        }
    }
    return found;
}

/// True if the bead has the parameters of the model's own table, and not those of the chains'.
bool is_of_model(BeadSystem const& beads, ForceResidues const& residues, std::int64_t bead) {
    std::string_view const name = beads.residue[static_cast<std::size_t>(bead)];
    return built_in_table(calvados_rna::model)->find(name) != nullptr &&
           (residues.own() == nullptr || residues.own()->find(name) == nullptr);
}

/// Throws InputError for beads of the model's table that are no part of a nucleotide: one-letter
/// codes of amino acids are names of bases, too.
void refuse_lone(BeadSystem const& beads, ForceResidues const& residues) {
    std::vector<int> partners(static_cast<std::size_t>(beads.size()), 0);
    for (auto const& [inboard, outboard, length] : beads.links)
        if (is_backbone(beads, inboard) != is_backbone(beads, outboard))
            ++partners[static_cast<std::size_t>(inboard)],
                ++partners[static_cast<std::size_t>(outboard)];
    for (std::int64_t bead = 0; bead < beads.size(); ++bead) {
        int const links = partners[static_cast<std::size_t>(bead)];
        bool const backbone = is_backbone(beads, bead);
        if (links == 1 || (links > 1 && backbone) || !is_of_model(beads, residues, bead)) continue;
        throw InputError(
            fmt::format("bead {} has residue {} of RNA and links to {} of RNA",
                        beads.name(bead) + 1, beads.residue[static_cast<std::size_t>(bead)],
                        backbone     ? "no base"
                        : links == 0 ? "no backbone"
                                     : "several backbones"),
            beads.scene_file,
            "give amino acids their three letters (ALA), and RNA as `sequence` with `model: "
            "calvados_rna`");
    }
}

/// Stacking potential. Its parameters are diameter, stickiness and depth of a pair.
std::unique_ptr<OpenMM::CustomBondForce> stacking(bool periodic) {
    auto force = std::make_unique<OpenMM::CustomBondForce>(
        "select(step(r-2^(1/6)*s), l*(lj-edge), lj-l*edge+depth*(1-l));"
        "lj=4*depth*a*(a-1); a=(s/r)^6; edge=4*depth*b*(b-1); b=(s/rc)^6");
    for (char const* const parameter : {"s", "l", "depth"}) force->addPerBondParameter(parameter);
    force->addGlobalParameter("rc", calvados2::ashbaugh_hatch_cutoff);
    force->setUsesPeriodicBoundaryConditions(periodic);
    force->setName("stacking");
    return force;
}

/// Adds the force in a group of its own.
void add_force(OpenMmModel& model, std::unique_ptr<OpenMM::Force> force) {
    force->setForceGroup(model.system->getNumForces());
    model.terms.push_back(force->getName());
    model.system->addForce(force.release());
}

std::string note_on(Nucleotides const& rna) {
    return fmt::format(
        "CALVADOS RNA, which does not tell bases apart: nucleotides {}, stacked pairs of bases {}, "
        "angles of backbones {}; links replace bonds of {} and {} kJ/mol/nm2",
        rna.count, rna.stacks.size(), rna.angles.size(), calvados_rna::backbone_stiffness,
        calvados_rna::base_stiffness);
}

}  // namespace

Nucleotides nucleotides_of(BeadSystem const& beads, ForceResidues const& residues) {
    Nucleotides rna;
    refuse_lone(beads, residues);
    if (std::find(beads.residue.begin(), beads.residue.end(), calvados_rna::backbone) ==
        beads.residue.end())
        return rna;
    std::vector<Nucleotide> const all = linked(beads);
    for (std::int64_t bead = 0; bead < beads.size(); ++bead) {
        Nucleotide const& here = all[static_cast<std::size_t>(bead)];
        if (here.base >= 0) ++rna.count;
        if (here.after < 0) continue;
        Nucleotide const& next = all[static_cast<std::size_t>(here.after)];
        if (here.base >= 0 && next.base >= 0) rna.stacks.emplace_back(here.base, next.base);
        if (here.before >= 0) rna.angles.push_back({here.before, bead, here.after});
    }
    return rna;
}

void add_rna_forces(OpenMmModel& model, Nucleotides const& rna, ForceResidues const& residues,
                    BeadSystem const& beads, std::span<OpenMM::CustomNonbondedForce* const> pairs) {
    if (rna.count == 0) return;
    auto const exclude = [&](std::int64_t a, std::int64_t b) {
        for (OpenMM::CustomNonbondedForce* const force : pairs)
            force->addExclusion(static_cast<int>(a), static_cast<int>(b));
    };
    auto const lambda = [&](std::int64_t base) {
        return residues.find(beads.residue[static_cast<std::size_t>(base)])->lambda;
    };
    auto stacks = stacking(beads.box.has_value());
    for (auto const& [a, b] : rna.stacks) {
        stacks->addBond(static_cast<int>(a), static_cast<int>(b),
                        {calvados_rna::stacking_diameter, (lambda(a) + lambda(b)) / 2,
                         calvados_rna::stacking_factor * calvados2::epsilon});
        exclude(a, b);
    }
    auto angles = std::make_unique<OpenMM::HarmonicAngleForce>();
    angles->setUsesPeriodicBoundaryConditions(beads.box.has_value());
    angles->setName("backbone-angles");
    for (auto const& [first, middle, last] : rna.angles) {
        angles->addAngle(static_cast<int>(first), static_cast<int>(middle), static_cast<int>(last),
                         calvados_rna::rest_angle, calvados_rna::angle_stiffness);
        exclude(first, last);
    }
    model.notes.push_back(note_on(rna));
    if (!rna.stacks.empty()) add_force(model, std::move(stacks));
    if (!rna.angles.empty()) add_force(model, std::move(angles));
}

}  // namespace catena
