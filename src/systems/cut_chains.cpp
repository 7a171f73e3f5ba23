// Implements the cut of chains at bonds that stay forces, and the judgement of their lengths.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "scene/node.hpp"
#include "scene/scene.hpp"
#include "scene/unique_names.hpp"
#include "systems/links.hpp"

namespace catena {

namespace {

/// The bonds at which chains are cut.
struct Cuts {
    std::int64_t bonds = 0;
    /// Kind and name of the first bond's force, and the name of its chain.
    std::string kind, name, chain;
    std::size_t longest = 0;  // piece, in beads
};

/// Appends the pieces of one chain that begins with particle `first`.
void append_pieces(PdbChain const& chain, int first, Joinings const& joinings, Cuts& cuts,
                   std::vector<PdbChain>& pieces) {
    for (std::size_t k = 0; k < chain.size(); ++k) {
        int const p = first + static_cast<int>(k);
        bool const cut = k > 0 && joinings.bond_stays_force(p);
        if (cut && cuts.bonds++ == 0) {
            cuts.kind = joinings.custom_bond(p);
            cuts.name = joinings.custom_name(p);
            cuts.chain = chain.name;
        }
        if (k == 0 || cut) pieces.emplace_back().name = chain.name;
        PdbChain& piece = pieces.back();
        piece.residue.push_back(chain.residue[k]);
        piece.place.push_back(chain.place[k]);
        piece.position.push_back(chain.position[k]);
        cuts.longest = std::max(cuts.longest, piece.size());
    }
}

/// Ratio to the mean length of a bond alone below which the median of a start deserves a note.
/// Repulsion beyond the bond's own makes bonds longer, never shorter.
constexpr double short_ratio = 0.4;
constexpr std::size_t least_bonds = 3;
/// Lengths of which the mean is taken: a logarithmic grid, nm.
constexpr double shortest_bond = 1e-3, longest_bond = 1e2;
constexpr int grid = 500;
/// Part of all weight that the longest bond must not reach.
constexpr double unbound = 1e-6;

/// A System of two particles with one bond of the force, that between particles p - 1 and p.
std::unique_ptr<OpenMM::System> lone_bond(OpenMM::CustomBondForce const& whole, int p) {
    auto bond = std::make_unique<OpenMM::CustomBondForce>(whole.getEnergyFunction());
    for (int i = 0; i < whole.getNumPerBondParameters(); ++i)
        bond->addPerBondParameter(whole.getPerBondParameterName(i));
    for (int i = 0; i < whole.getNumGlobalParameters(); ++i)
        bond->addGlobalParameter(whole.getGlobalParameterName(i),
                                 whole.getGlobalParameterDefaultValue(i));
    for (int j = 0; j < whole.getNumBonds() && bond->getNumBonds() == 0; ++j) {
        int a, b;
        std::vector<double> parameters;
        whole.getBondParameters(j, a, b, parameters);
        if (std::max(a, b) == p && std::min(a, b) == p - 1) bond->addBond(0, 1, parameters);
    }
    auto system = std::make_unique<OpenMM::System>();
    for (int i = 0; i < 2; ++i) system->addParticle(1);
    system->addForce(bond.release());
    return system;
}

/// Lengths of a bond with its finite energies.
struct BondEnergies {
    std::vector<double> length, energy;  // nm, kJ/mol
};

BondEnergies energies_of(OpenMM::System const& lone) {
    OpenMM::VerletIntegrator integrator(0.001);
    OpenMM::Context context(lone, integrator, OpenMM::Platform::getPlatformByName("Reference"));
    BondEnergies found;
    for (int i = 0; i <= grid; ++i) {
        double const r = shortest_bond * std::pow(longest_bond / shortest_bond, double(i) / grid);
        context.setPositions({{0, 0, 0}, {r, 0, 0}});
        double const energy = context.getState(OpenMM::State::Energy).getPotentialEnergy();
        if (std::isfinite(energy)) found.length.push_back(r), found.energy.push_back(energy);
    }
    return found;
}

/// Thermal mean length of the bond alone, nm; 0 if it does not hold its ends together.
double mean_of(BondEnergies const& bond, double temperature) {
    if (bond.length.empty()) return 0;
    double const kt = Scene().boltzmann() * temperature;
    double const lowest = *std::min_element(bond.energy.begin(), bond.energy.end());
    double weights = 0, sum = 0, weight = 0;
    for (std::size_t i = 0; i < bond.length.size(); ++i) {
        double const r = bond.length[i];
        weight = r * r * r * std::exp((lowest - bond.energy[i]) / kt);
        weights += weight, sum += weight * r;
    }
    bool const ends = bond.length.back() < 0.99 * longest_bond || weight < unbound * weights;
    return ends ? sum / weights : 0;
}

/// Mean length of the bond of the force between particles p - 1 and p; 0 if it cannot be computed:
/// the System's own Context tells what is wrong with the force.
double mean_length(OpenMM::CustomBondForce const& force, int p, double temperature) {
    try {
        return mean_of(energies_of(*lone_bond(force, p)), temperature);
    } catch (std::bad_alloc const&) {
        throw;
    } catch (std::exception const&) {
        return 0;
    }
}

/// Bonds between neighbours that stay forces.
struct LooseBonds {
    int first = -1;             // outboard particle of the first one; -1: none
    std::vector<double> apart;  // lengths of those of the same force, nm
};

LooseBonds loose_bonds(std::vector<PdbChain> const& chains, Joinings const& joinings) {
    LooseBonds bonds;
    int p = 0;
    for (PdbChain const& chain : chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++p) {
            if (k == 0 || !joinings.bond_stays_force(p)) continue;
            if (bonds.first < 0) bonds.first = p;
            if (joinings.custom_force(p) == joinings.custom_force(bonds.first))
                bonds.apart.push_back(norm(chain.position[k] - chain.position[k - 1]));
        }
    return bonds;
}

/// Sentence on the cuts.
std::string note_on(Cuts const& cuts, std::size_t chains, std::size_t pieces) {
    return fmt::format(
        "{} {} of a {} between neighbours {} (the first in chain {}), so {} of the topology {} "
        "simulated as {} of up to {} on links; to make such bonds rigid links, name their length: "
        "`links: {{{}: LENGTH}}` in forces.openmm (catena import --links {}=LENGTH).",
        cuts.bonds, cuts.bonds == 1 ? "bond" : "bonds", cuts.kind,
        cuts.bonds == 1 ? "stays a force" : "stay forces", scene::shown(cuts.chain),
        chains == 1 ? "1 chain" : fmt::format("{} chains", chains), chains == 1 ? "is" : "are",
        pieces == 1 ? "1 piece" : fmt::format("{} pieces", pieces),
        cuts.longest == 1 ? "1 bead" : fmt::format("{} beads", cuts.longest),
        scene::shown(cuts.name), scene::shown(cuts.name));
}

}  // namespace

std::string note_on_short_bonds(std::vector<PdbChain> const& chains, Joinings const& joinings,
                                OpenMM::System const& system, double temperature) {
    LooseBonds bonds = loose_bonds(chains, joinings);
    if (bonds.apart.size() < least_bonds || !(temperature > 0)) return "";
    auto const middle = bonds.apart.begin() + std::ssize(bonds.apart) / 2;
    std::nth_element(bonds.apart.begin(), middle, bonds.apart.end());
    auto const& force = dynamic_cast<OpenMM::CustomBondForce const&>(
        system.getForce(joinings.custom_force(bonds.first)));
    double const mean = mean_length(force, bonds.first, temperature);
    if (!(*middle < short_ratio * mean)) return "";
    return fmt::format(
        "Neighbours that a {} joins are {:.3g} nm apart (median), and such a bond alone has a mean "
        "length of {:.3g} nm at {:.6g} K: if the positions are in another unit, multiply them by "
        "10 (PDB and mmCIF files hold angstrom, OpenMM's States nm).",
        joinings.custom_bond(bonds.first), *middle, mean, temperature);
}

std::vector<PdbChain> cut_at_bonds(std::vector<PdbChain> const& chains, Joinings const& joinings,
                                   std::vector<std::string>* notes) {
    std::vector<PdbChain> pieces;
    Cuts cuts;
    int first = 0;
    for (PdbChain const& chain : chains) {
        append_pieces(chain, first, joinings, cuts, pieces);
        first += static_cast<int>(chain.size());
    }
    if (cuts.bonds == 0) return chains;
    scene::UniqueNames names;
    for (PdbChain& piece : pieces) piece.name = names.make(piece.name);
    if (notes) notes->push_back(note_on(cuts, chains.size(), pieces.size()));
    return pieces;
}

}  // namespace catena
