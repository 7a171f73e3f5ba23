// Implements the model of a chain of residues.
#include "reader/models.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "keys/maps.hpp"
#include "reader/structure_entry.hpp"
#include "scene/files.hpp"
#include "structure/calvados_rna.hpp"
#include "structure/residue_names.hpp"

namespace catena::scene {

namespace {

/// A phosphate's second dissociation, as in the example single_pIDR of the CALVADOS package.
struct Phosphate {
    char const* name;
    double pka;
};
constexpr std::array<Phosphate, 2> phosphates = {{{"SEP", 6.01}, {"TPO", 6.3}}};
/// Difference of a phosphate's charges, e, that is noted.
double constexpr noted_charge = 5e-3;

/// The file that `model: {residues: FILE}` names.
Node const& own_file(Node const& model) {
    return Fields(model, keys::model).need("residues", "residues: residues.csv");
}

/// Reads the table that `model` names.
ResidueTable read_model(Node const& model, std::string const& scene_file) {
    if (model.kind == Node::Kind::map) {
        Node const& file = own_file(model);
        return read_residue_table(resolved(text(file), scene_file), file);
    }
    if (model.text.ends_with(".csv"))
        fail(model, fmt::format("`{}` is not a model", shown(model.text)),
             "name a table as `model: {residues: FILE.csv}`");
    return *built_in_table(
        choice<std::string_view>(model, {{"calvados2", "calvados2"},
                                         {"calvados3", "calvados3"},
                                         {calvados_rna::model, calvados_rna::model}}));
}

/// True if forces do not tell the two types apart.
bool act_alike(ResidueType const& a, ResidueType const& b) {
    return a.lambda == b.lambda && a.sigma == b.sigma && a.charge == b.charge &&
           (a.letter == 'H') == (b.letter == 'H');
}

/// Notes a phosphate whose charge in the table differs from that at the scene's pH.
void note_phosphate(ChainRequest const& request, ResidueType const& type, double ph) {
    auto const known = std::find_if(phosphates.begin(), phosphates.end(),
                                    [&](Phosphate const& p) { return type.name == p.name; });
    if (known == phosphates.end()) return;
    double const charge = -1 - 1 / (1 + std::pow(10, known->pka - ph));
    if (std::abs(charge - type.charge) > noted_charge)
        request.scene.note(fmt::format(
            "`{}` gives {} the charge {:.3f} e, at `ph` {:.6g} it has {:.3f} e (pKa {}): correct "
            "the table unless its charge is meant",
            request.table->name(), type.name, type.charge, ph, charge, known->pka));
}

/// Notes RNA beside proteins for which it was not fitted.
void note_other_proteins(ChainRequest const& request, OpenMmSpec const& openmm) {
    if (openmm.builder != "calvados2")
        request.scene.note(
            fmt::format("RNA was fitted beside CALVADOS 2, the forces have builder {}: write "
                        "`builder: calvados2` unless proteins of that model are meant",
                        openmm.builder));
}

/// Names the ends of a chain that are not amino acids, with a verb. Returns an empty text if there
/// are none.
std::string other_ends(ChainRequest const& request, Residues const& residues) {
    auto const& [n, c] = request.protein_ends;
    if (n && c) return "";
    std::string const first = residues.front()->name, last = residues.back()->name;
    if (n) return last + " at its last end is";
    return first + (c ? " at its first end is" : " at its ends is");
}

/// The same for a complex, whose ends are those of its members.
std::string other_ends_of_complex(StructurePart const& part, Residues const& residues) {
    std::vector<std::string> named;
    for (ComplexEnd const& end : part.ends)
        if (std::string const& name = residues[end.bead]->name; !is_amino_acid(name))
            named.push_back(fmt::format("{} at bead {}", name, end.bead + 1));
    if (named.empty()) return "";
    return fmt::format("{}{} is", named.size() > 1 ? "each of " : "", fmt::join(named, " and "));
}

}  // namespace

ResidueTable const& table_of(ChainRequest& request) {
    if (!request.table)
        request.table = std::make_shared<ResidueTable const>(
            read_model(request.fields.need("model", "model: calvados2"), request.scene.file));
    return *request.table;
}

void hand_to_forces(ChainRequest const& request, Residues const& residues) {
    std::optional<OpenMmSpec>& openmm = request.scene.forces.openmm;
    if (!openmm || openmm->builder.empty()) return;
    Node const& model = *request.fields.find("model");
    bool const own = model.kind == Node::Kind::map;
    if (!own && model.text == calvados_rna::model) return note_other_proteins(request, *openmm);
    if (!own && model.text != openmm->builder)
        fail(model,
             fmt::format("the chain has model {}, the forces have builder {}", model.text,
                         openmm->builder),
             "write the same model in both");
    if (!own) return;
    ResidueTable const& builders = *built_in_table(openmm->builder);
    for (ResidueType const* const type :
         std::set<ResidueType const*>(residues.begin(), residues.end())) {
        ResidueType const* const known = builders.find(type->name);
        bool const same = known && act_alike(*known, *type) && known->bond == type->bond;
        if (!same && openmm->topology.empty())
            openmm->topology = resolved(text(own_file(model)), request.scene.file);
        if (openmm->ph) note_phosphate(request, *type, *openmm->ph);
    }
}

void find_ends(ChainRequest& request, Residues const& residues) {
    request.protein_ends = {is_amino_acid(residues.front()->name),
                            is_amino_acid(residues.back()->name)};
    std::optional<OpenMmSpec> const& openmm = request.scene.forces.openmm;
    if (request.fields.find("charge_termini") || !openmm || openmm->builder.empty()) return;
    bool const complex = request.part != nullptr && !request.part->members.empty();
    std::string const others =
        complex ? other_ends_of_complex(*request.part, residues) : other_ends(request, residues);
    if (others.empty()) return;
    request.scene.note(
        fmt::format("chain `{}`: {} not an amino acid and carries no charge of a terminus: write "
                    "`charge_termini: none` or `both`",
                    shown(complex ? request.part->name : request.name()), others));
}

std::vector<double> link_lengths(Residues const& residues) {
    std::vector<double> lengths;
    ResidueType const* before = residues.front();
    for (ResidueType const* const residue : residues) {
        lengths.push_back((before->bond + residue->bond) / 2);
        before = residue;
    }
    return lengths;
}

void check_residues(Node const& chain, std::vector<std::string> const& residues, Scene const& scene,
                    ForceResidues const& forces) {
    Node const* const model = chain.find("model");
    std::string const& builder = scene.forces.openmm->builder;
    ResidueTable const table = model ? read_model(*model, scene.file) : *built_in_table(builder);
    for (std::size_t k = 0; k < residues.size(); ++k) {
        auto const bead = static_cast<std::int64_t>(k) + 1;
        ResidueType const* const used = forces.find(residues[k]);
        ResidueType const* const meant = table.find(std::string_view(residues[k]));
        if (meant && (!used || !act_alike(*used, *meant)))
            fail_at(chain, "bead", bead,
                    fmt::format("residue {} of {} has other parameters in {}, the table of another "
                                "chain, or is not in it",
                                residues[k], table.name(),
                                forces.own() ? forces.own()->name() : builder),
                    "take one table for both chains");
        if (!used)
            fail_at(
                chain, "bead", bead,
                fmt::format("residue `{}` has no parameters in {}", shown(residues[k]), builder),
                "give the chain as `sequence`, its beads a `residue` among the twenty amino acids, "
                "or their table (`model: {residues: FILE.csv}`)");
    }
}

}  // namespace catena::scene
