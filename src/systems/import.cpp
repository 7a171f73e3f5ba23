// Implements the import of chains and links from a System.
#include "systems/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "scene/branches.hpp"
#include "scene/force_changes.hpp"
#include "scene/node.hpp"
#include "systems/bonded_forces.hpp"
#include "systems/links.hpp"
#include "systems/model.hpp"
#include "systems/pdb_topology.hpp"

namespace catena {

namespace {

constexpr double digits_of_cell = 2e-3;  // nm, of a PDB file's cell
constexpr double same_edge = 1e-6;       // nm; covers edges written in decimals

/// Rules for bonds that become links.
struct LinkRules {
    double temperature;  // K
    std::string const& where;
};

/// Imports one chain that begins with particle `first`, and adds its links to `links`.
ImportedChain import_chain(PdbChain const& from, int first, OpenMM::System const& system,
                           Joinings const& joinings, StiffLinks& links, LinkRules const& rules) {
    ImportedChain chain{from.name, from.residue, from.place, {}, from.position, {}};
    std::vector<std::int64_t> inboard;
    for (int k = 0; k < static_cast<int>(from.size()); ++k) {
        int const p = first + k, on = k > 0 ? joinings.inboard(p, first, rules.temperature) : -1;
        chain.mass.push_back(system.getParticleMass(p));
        if (k > 0 && on < 0)
            joinings.refuse_gap(
                p, first, rules.temperature,
                fmt::format("{}, chain {}, body {}", rules.where, scene::shown(from.name), k + 1));
        Joining const joining = k > 0 ? joinings.between(on, p) : Joining{};
        if (k > 0) links.add(on, p, joining);
        chain.length.push_back(k > 0 ? joining.length : 0);
        inboard.push_back(k > 0 ? on - first : -1);
    }
    chain.parent = scene::as_parents(std::move(inboard));
    return chain;
}

/// Makes cross-links of the constraints that join beads of a chain along no link. `firsts`: first
/// particle of each chain.
void add_crosslinks(std::vector<ImportedChain>& chains, std::vector<int> const& firsts,
                    OpenMM::System const& system) {
    for (int i = 0; i < system.getNumConstraints(); ++i) {
        int a, b;
        double length;
        system.getConstraintParameters(i, a, b, length);
        auto const [low, high] = std::minmax(a, b);
        auto const c = static_cast<std::size_t>(
            std::upper_bound(firsts.begin(), firsts.end(), low) - firsts.begin() - 1);
        ImportedChain& chain = chains.at(c);
        std::int64_t const inboard = low - firsts[c], outboard = high - firsts[c];
        if (outboard >= std::ssize(chain.mass)) continue;
        auto const on = static_cast<std::int64_t>(
            scene::inboard_of(chain.parent, static_cast<std::size_t>(outboard)));
        bool const known = std::any_of(
            chain.crosslinks.begin(), chain.crosslinks.end(), [&](CrossLink const& link) {
                return link.inboard == inboard && link.outboard == outboard;
            });
        if (on != inboard && !known) chain.crosslinks.push_back({inboard, outboard, length});
    }
}

/// Notes the chains that constraints cross-link, in one sentence.
std::vector<std::string> note_crosslinks(std::vector<ImportedChain> const& chains) {
    std::size_t links = 0, linked = 0;
    std::string name;
    for (ImportedChain const& chain : chains) {
        links += chain.crosslinks.size();
        if (!chain.crosslinks.empty() && linked++ == 0) name = scene::shown(chain.name);
    }
    if (links == 0) return {};
    return {
        fmt::format("{} of {} {} of links and {}: cross-linked chains are computed on the host, "
                    "each by one rank.",
                    links == 1 ? "1 constraint" : fmt::format("{} constraints", links),
                    linked == 1 ? "chain " + name : fmt::format("{} chains", linked),
                    links == 1 ? "closes a cycle" : "close cycles",
                    links == 1 ? "becomes a cross-link" : "become cross-links")};
}

/// Notes the unbranched chains whose ends are joined, in one sentence.
std::vector<std::string> note_rings(std::vector<ImportedChain> const& chains,
                                    Joinings const& joinings, double temperature) {
    int first = 0, rings = 0;
    std::string name;
    for (ImportedChain const& chain : chains) {
        int const size = static_cast<int>(chain.mass.size()), last = first + size - 1;
        if (size > 2 && chain.parent.empty() &&
            !std::isinf(joinings.between(first, last).stiffness) &&
            joinings.between(first, last).is_like(joinings.to_previous(first + 1), temperature) &&
            rings++ == 0)
            name = scene::shown(chain.name);
        first += size;
    }
    if (rings == 0) return {};
    return {
        fmt::format("{} into a ring by a bond, which stays a force (write `chains` with "
                    "`tip: {{ring: {{type: link}}}}` for a "
                    "link).",
                    rings == 1 ? fmt::format("Chain {} is closed", name)
                               : fmt::format("{} chains are closed", rings))};
}

/// Notes the branched chains, in one sentence.
std::vector<std::string> note_branches(std::vector<ImportedChain> const& chains) {
    int first = 0, branched = 0;
    std::string name, place;
    for (ImportedChain const& chain : chains) {
        for (std::size_t k = 1; k < chain.parent.size() && place.empty(); ++k)
            if (chain.parent[k] + 1 != static_cast<std::int64_t>(k))
                place = fmt::format("particle {} hangs on particle {}, from 0",
                                    first + static_cast<int>(k), first + chain.parent[k]);
        if (!chain.parent.empty() && branched++ == 0) name = scene::shown(chain.name);
        first += static_cast<int>(chain.mass.size());
    }
    if (branched == 0) return {};
    return {fmt::format(
        "{} ({}): one rank computes a whole branched chain, however many ranks there are.",
        branched == 1 ? fmt::format("Chain {} is branched", name)
                      : fmt::format("{} chains are branched, the first is {}", branched, name),
        place)};
}

/// Notes bonds of branched chains that close cycles of links, in one sentence.
std::vector<std::string> note_cycles(std::vector<ImportedChain> const& chains,
                                     Joinings const& joinings, double temperature) {
    std::vector<int> first_of;  // particle's chain begins here; -1: not in a branched chain
    std::vector<int> on;        // particle's inboard one
    for (ImportedChain const& chain : chains) {
        int const first = static_cast<int>(first_of.size());
        first_of.resize(first_of.size() + chain.mass.size(), chain.parent.empty() ? -1 : first);
        for (std::size_t k = 0; k < chain.mass.size(); ++k)
            on.push_back(chain.parent.empty() ? -1 : first + static_cast<int>(chain.parent[k]));
    }
    int cycles = 0, a = 0, b = 0;
    auto const look = [&](int low, int high, Joining const& joining) {
        auto const l = static_cast<std::size_t>(low), h = static_cast<std::size_t>(high);
        if (first_of[h] < 0 || first_of[l] != first_of[h] || on[h] == low ||
            std::isinf(joining.stiffness) || !(joining.spread(temperature) <= StiffLinks::softest))
            return;
        if (cycles++ == 0 || (high == b && low < a)) a = low, b = high;
    };
    joinings.for_each_farther(look);
    for (int p = 1; p < static_cast<int>(first_of.size()); ++p)
        if (Joining const previous = joinings.to_previous(p); previous.holds())
            look(p - 1, p, previous);
    if (cycles == 0) return {};
    return {fmt::format(
        "{} of branched chains {} of links (particles {} and {} from 0{}) and {}: "
        "only constraints become cross-links.",
        cycles == 1 ? "1 stiff bond" : fmt::format("{} stiff bonds", cycles),
        cycles == 1 ? "closes a cycle" : "close cycles", a, b, cycles == 1 ? "" : ", the first",
        cycles == 1 ? "stays a force" : "stay forces")};
}

/// Notes the chains that bonds stiff enough for a link join to the chain before, in one sentence.
std::vector<std::string> note_joined(std::vector<PdbChain> const& chains, Joinings const& joinings,
                                     double temperature) {
    int first = 0, joined = 0;
    std::string where;
    for (std::size_t c = 0; c < chains.size(); ++c) {
        Joining const bond = c > 0 ? joinings.to_previous(first) : Joining{};
        if (bond.holds() && bond.spread(temperature) <= StiffLinks::softest && joined++ == 0)
            where =
                fmt::format("particles {} and {}, from 0, of chains {} and {}", first - 1, first,
                            scene::shown(chains[c - 1].name), scene::shown(chains[c].name));
        first += static_cast<int>(chains[c].size());
    }
    if (joined == 0) return {};
    return {fmt::format(
        "{} of the topology ({}{}) and {}; bonds within a chain become rigid links. If they are "
        "one chain, remove the TER between them, or give both one letter.",
        joined == 1 ? "1 stiff bond joins two chains"
                    : fmt::format("{} stiff bonds join chains", joined),
        joined == 1 ? "" : "the first ", where, joined == 1 ? "stays a spring" : "stay springs")};
}

/// Throws InputError for a box that is not rectangular.
void refuse_triclinic(OpenMM::System const& system, std::string const& where) {
    if (!system.usesPeriodicBoundaryConditions()) return;
    OpenMM::Vec3 edge[3];
    system.getDefaultPeriodicBoxVectors(edge[0], edge[1], edge[2]);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j && std::abs(edge[i][j]) > same_edge)
                throw InputError(
                    fmt::format("the System's box is not rectangular: its vector {} is ({:.6g}, "
                                "{:.6g}, {:.6g}) nm",
                                "abc"[i], edge[i][0], edge[i][1], edge[i][2]),
                    where,
                    "Catena has rectangular boxes only: set one by "
                    "system.setDefaultPeriodicBoxVectors and serialise the System again");
}

/// True if a bond of the chain that begins with particle `first` stays a force.
bool has_cut(PdbChain const& chain, int first, Joinings const& joinings) {
    for (int p = first + 1; p < first + static_cast<int>(chain.size()); ++p)
        if (joinings.bond_stays_force(p)) return true;
    return false;
}

/// Moves the beads of a chain by whole edges of the box, each to the image nearest to the bead
/// before it. Returns true if a bead was moved.
bool make_whole(PdbChain& chain, Vec3 const& box) {
    bool moved = false;
    for (std::size_t k = 1; k < chain.size(); ++k) {
        Vec3 const step = chain.position[k] - chain.position[k - 1];
        Vec3 shift = Vec3::zero();
        for (int i = 0; i < 3; ++i) shift[i] = -box[i] * std::round(step[i] / box[i]);
        chain.position[k] = chain.position[k] + shift;
        moved = moved || norm(shift) > 0;
    }
    return moved;
}

/// Makes the chains whole that will be cut where bonds stay forces. Other chains are made whole
/// when the scene is read.
void make_cut_chains_whole(std::vector<PdbChain>& chains, Joinings const& joinings,
                           ImportedSystem& imported) {
    int first = 0, moved = 0;
    for (PdbChain& chain : chains) {
        if (has_cut(chain, first, joinings) && make_whole(chain, imported.box)) ++moved;
        first += static_cast<int>(chain.size());
    }
    if (moved > 0)
        imported.notes.push_back(fmt::format(
            "{} of the topology {} made whole across the sides of the box, bead by bead "
            "by minimum image.",
            moved == 1 ? "1 chain" : fmt::format("{} chains", moved), moved == 1 ? "is" : "are"));
}

/// Pairs of particles that custom bonds and compounds of two particles join, in ascending order.
std::vector<std::pair<std::int64_t, std::int64_t>> custom_bonds(OpenMM::System const& system) {
    std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
    std::vector<double> ignored;
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        if (auto const* bonds = dynamic_cast<OpenMM::CustomBondForce const*>(&force))
            for (int j = 0; j < bonds->getNumBonds(); ++j) {
                int a, b;
                bonds->getBondParameters(j, a, b, ignored);
                pairs.emplace_back(std::minmax(a, b));
            }
        auto const* compounds = dynamic_cast<OpenMM::CustomCompoundBondForce const*>(&force);
        if (compounds == nullptr || compounds->getNumParticlesPerBond() != 2) continue;
        std::vector<int> both;
        for (int j = 0; j < compounds->getNumBonds(); ++j) {
            compounds->getBondParameters(j, both, ignored);
            pairs.emplace_back(std::minmax(both.at(0), both.at(1)));
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Collects the particles of terms.
class Spans final : public TermFilter {
  public:
    bool keep(std::span<int* const> particles) override {
        auto const [low, high] = std::minmax_element(
            particles.begin(), particles.end(), [](int const* a, int const* b) { return *a < *b; });
        found.emplace_back(**low, **high);
        return false;
    }
    std::vector<std::pair<std::int64_t, std::int64_t>> found;
};

/// Bonded forces of a periodic System that do not use its box.
std::vector<BoxlessForce> boxless_forces(OpenMM::System const& system) {
    std::vector<BoxlessForce> forces;
    if (!system.usesPeriodicBoundaryConditions()) return forces;
    for (int i = 0; i < system.getNumForces(); ++i) {
        if (system.getForce(i).usesPeriodicBoundaryConditions()) continue;
        Spans spans;
        copy_bonded(system.getForce(i), spans);
        if (!spans.found.empty())
            forces.push_back({term_names(system, {i}).front(), std::move(spans.found)});
    }
    return forces;
}

}  // namespace

SystemLinks read_system_links(OpenMmSpec const& spec, std::string const& scene_file) {
    std::string const where = openmm_key(scene_file, "system");
    SystemLinks links;
    auto const system = read_scene_system(spec, scene_file, links.notes);
    refuse_triclinic(*system, where);
    links.screening = screening_of(*system);
    links.periodic = system->usesPeriodicBoundaryConditions();
    Joinings const joinings(*system, changes_of(spec).links, where);
    links.to_previous.resize(static_cast<std::size_t>(system->getNumParticles()));
    for (int p = 1; p < system->getNumParticles(); ++p)
        links.to_previous[static_cast<std::size_t>(p)] = joinings.to_previous(p);
    joinings.for_each_farther([&](int low, int high, Joining const& joining) {
        links.farther.emplace(std::pair(low, high), joining);
    });
    links.custom = custom_bonds(*system);
    links.boxless = boxless_forces(*system);
    return links;
}

std::optional<ScreenedChains> read_screened_chains(std::string const& file,
                                                   std::string const& where) {
    auto const system = read_openmm_system(file, where);
    auto screening = screening_of(*system);
    if (!screening) return std::nullopt;
    ScreenedChains chains{std::move(*screening), {}};
    Joinings const joinings(*system, {}, where);
    for (int p = 0; p < system->getNumParticles(); ++p)
        chains.joined.push_back(p > 0 && joinings.joins_to_previous(p));
    return chains;
}

BondedChains chains_by_bonds(OpenMmSpec const& spec, std::string const& name) {
    std::vector<std::string> ignored;
    auto const system = read_scene_system(spec, name, ignored);
    refuse_triclinic(*system, openmm_key(name, "system"));
    Joinings const joinings(*system, changes_of(spec).links, openmm_key(name, "system"));
    BondedChains chains;
    int first = 0;
    for (int p = 0; p < system->getNumParticles(); ++p) {
        if (p == 0 || !joinings.goes_on(p, first, spec.temperature))
            chains.sizes.push_back(0), first = p;
        ++chains.sizes.back();
        chains.mass.push_back(system->getParticleMass(p));
    }
    OpenMM::Vec3 a, b, c;
    system->getDefaultPeriodicBoxVectors(a, b, c);
    if (system->usesPeriodicBoundaryConditions()) chains.box = Vec3{{a[0], b[1], c[2]}};
    return chains;
}

namespace {

/// Notes that the topology's cell, as a barostat may have left it, is not the System's box.
void note_another_box(Vec3 const& cell, std::string const& topology, ImportedSystem& imported) {
    Vec3 const& box = imported.box;
    if (std::abs(cell[0] - box[0]) + std::abs(cell[1] - box[1]) + std::abs(cell[2] - box[2]) <
        digits_of_cell)
        return;
    imported.notes.push_back(fmt::format(
        "`{}` has a box of {:.6g} x {:.6g} x {:.6g} nm, the System {:.6g} x {:.6g} x {:.6g} nm, "
        "which is taken: if a barostat has changed the box, serialise the System again with the "
        "new one",
        scene::shown_path(topology), cell[0], cell[1], cell[2], box[0], box[1], box[2]));
}

}  // namespace

ImportedSystem import_openmm_system(OpenMmSpec const& spec, std::string const& scene_file) {
    std::string const where = openmm_key(scene_file, "system");
    ImportedSystem imported;
    auto const system = read_scene_system(spec, scene_file, imported.notes);
    refuse_triclinic(*system, where);
    std::optional<Vec3> cell;
    auto whole = read_pdb_topology(spec.topology, openmm_key(scene_file, "topology"),
                                   &imported.notes, &cell);
    std::size_t atoms = 0;
    for (auto const& chain : whole) atoms += chain.size();
    if (static_cast<int>(atoms) != system->getNumParticles())
        throw InputError(fmt::format("the topology has {} atoms and the System {} particles", atoms,
                                     system->getNumParticles()),
                         openmm_key(scene_file, "topology"),
                         "give one atom per particle, in the System's order");

    Joinings const joinings(*system, changes_of(spec).links, where);
    imported.periodic = system->usesPeriodicBoundaryConditions();
    OpenMM::Vec3 a, b, c;
    system->getDefaultPeriodicBoxVectors(a, b, c);
    imported.box = {{a[0], b[1], c[2]}};
    if (imported.periodic && cell) note_another_box(*cell, spec.topology, imported);
    if (imported.periodic) make_cut_chains_whole(whole, joinings, imported);
    if (auto note = note_on_short_bonds(whole, joinings, *system, spec.temperature); !note.empty())
        imported.notes.push_back(std::move(note));
    auto const chains = cut_at_bonds(whole, joinings, &imported.notes);
    StiffLinks links(spec.temperature, where);
    int first = 0;
    std::vector<int> starts;
    for (auto const& chain : chains) {
        imported.chains.push_back(
            import_chain(chain, first, *system, joinings, links, {spec.temperature, where}));
        starts.push_back(first);
        first += static_cast<int>(chain.size());
    }
    add_crosslinks(imported.chains, starts, *system);
    std::vector<std::int64_t> firsts;  // of the topology's chains
    std::int64_t next = 0;
    for (auto const& chain : whole) {
        firsts.push_back(next);
        next += static_cast<std::int64_t>(chain.size());
    }
    for (auto const& notes :
         {links.notes(), note_branches(imported.chains), note_crosslinks(imported.chains),
          note_rings(imported.chains, joinings, spec.temperature),
          note_cycles(imported.chains, joinings, spec.temperature),
          note_joined(chains, joinings, spec.temperature),
          notes_on_boxless(boxless_forces(*system), firsts)})
        imported.notes.insert(imported.notes.end(), notes.begin(), notes.end());
    imported.largest_spread = links.largest_spread();
    imported.screening = screening_of(*system);
    return imported;
}

}  // namespace catena
