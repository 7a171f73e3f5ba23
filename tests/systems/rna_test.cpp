// RNA of CALVADOS, two beads per nucleotide: as a scene has it, and as the System that the CALVADOS
// package writes. Energies are compared with OpenMM's alone, term by term.
#include <OpenMM.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/systems/energies.hpp"

namespace catena::testing {
namespace {

using Inboard = std::vector<std::int64_t>;

double constexpr edge = 40, temperature = 293, ionic = 0.15;

/// Masses, stickiness, diameters and charges of the published table: backbone and base.
struct Bead {
    double mass, lambda, sigma, charge;
};
Bead constexpr backbone{194.1, 0, 0.6954, -1}, base{126.3, 1.18, 0.6238, 0};
/// A glycine inside a chain, of CALVADOS 2.
Bead constexpr glycine{57.05, 0.7058843733666401, 0.45, 0};

/// RNA that winds along x, base beside backbone, shaken.
std::vector<Vec3> nucleotides_at(int count) {
    std::vector<Vec3> at;
    for (int k = 0; k < count; ++k) {
        double const turn = 0.8 * k;
        Vec3 const p{{0.5 * k, 2 + 0.4 * std::cos(turn), 2 + 0.4 * std::sin(turn)}};
        at.push_back(p);
        at.push_back(p + 0.54 * Vec3{{0, std::cos(turn + 1), std::sin(turn + 1)}});
    }
    shake(at, 0.05, 4);
    return at;
}

/// The System of the package's example single_RNA with `count` nucleotides and `glycines` beads of
/// a protein without charged ends behind them: forces in its order.
class PackageSystem {
  public:
    PackageSystem(int count, int glycines) {
        system->setDefaultPeriodicBoxVectors({edge, 0, 0}, {0, edge, 0}, {0, 0, edge});
        make_pairs();
        for (int k = 0; k < count; ++k) add_nucleotide(2 * k, k + 1 < count, k + 2 < count);
        for (int k = 0; k < glycines; ++k) {
            add(glycine);
            if (k == 0) continue;
            bonds->addBond(2 * count + k - 1, 2 * count + k, 0.38, 8033);
            exclude(2 * count + k - 1, 2 * count + k);
        }
        for (OpenMM::Force* const force :
             std::initializer_list<OpenMM::Force*>{charges, contacts, bonds, stacks, angles})
            system->addForce(force);
        for (auto* const force : {charges, contacts})
            force->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
        bonds->setUsesPeriodicBoundaryConditions(true);
        stacks->setUsesPeriodicBoundaryConditions(true);
        angles->setUsesPeriodicBoundaryConditions(true);
    }

    std::unique_ptr<OpenMM::System> system = std::make_unique<OpenMM::System>();

    /// Energies of charges, contacts, bonds, stacking and angles.
    std::array<double, 5> energies(std::vector<Vec3> const& positions) {
        for (int i = 0; i < 5; ++i) system->getForce(i).setForceGroup(i);
        OpenMM::VerletIntegrator integrator(0.001);
        OpenMM::Context context(*system, integrator,
                                OpenMM::Platform::getPlatformByName("Reference"));
        std::vector<OpenMM::Vec3> x;
        for (Vec3 const& p : positions) x.emplace_back(p[0], p[1], p[2]);
        context.setPositions(x);
        std::array<double, 5> found{};
        for (int i = 0; i < 5; ++i)
            found[static_cast<std::size_t>(i)] =
                context.getState(OpenMM::State::Energy, false, 1 << i).getPotentialEnergy();
        return found;
    }

    OpenMM::CustomNonbondedForce *charges = nullptr, *contacts = nullptr;
    OpenMM::HarmonicBondForce* bonds = new OpenMM::HarmonicBondForce;
    OpenMM::CustomBondForce* stacks = nullptr;
    OpenMM::HarmonicAngleForce* angles = new OpenMM::HarmonicAngleForce;

  private:
    void make_pairs() {
        double const t = temperature,
                     water =
                         5321 / t + 233.76 - 0.9297 * t + 0.1417e-2 * t * t - 0.8292e-6 * t * t * t,
                     kt = 8.3145e-3 * t,
                     bjerrum = 1.6021766 * 1.6021766 / (4 * M_PI * 8.854188 * water) * 6.02214076 *
                               1000 / kt,
                     kappa = std::sqrt(8 * M_PI * bjerrum * ionic * 6.02214076 / 10);
        charges = new OpenMM::CustomNonbondedForce(
            fmt::format("q*{:.17g}*(exp(-{:.17g}*r)/r-{:.17g}); q=q1*q2", bjerrum * kt, kappa,
                        std::exp(-4 * kappa) / 4));
        charges->addPerParticleParameter("q");
        charges->setCutoffDistance(4);
        std::string const shape = "4*{0}l*((s/r)^12-(s/r)^6-shift),4*{0}((s/r)^12-(s/r)^6-l*shift)";
        contacts = new OpenMM::CustomNonbondedForce(
            "0.8368*select(step(r-2^(1/6)*s)," + fmt::format(fmt::runtime(shape), "") +
            "+(1-l)); l=0.5*(l1+l2); shift=(s/2.0)^12-(s/2.0)^6; s=0.5*(s1+s2)");
        for (char const* const name : {"s", "l"}) contacts->addPerParticleParameter(name);
        contacts->setCutoffDistance(2);
        stacks = new OpenMM::CustomBondForce("select(step(r-2^(1/6)*s),n*" +
                                             fmt::format(fmt::runtime(shape), "eps*") +
                                             "*n+n*eps*(1-l)); shift=(s/rc)^12-(s/rc)^6");
        stacks->addGlobalParameter("eps", 0.8368);
        stacks->addGlobalParameter("rc", 2);
        for (char const* const name : {"s", "l", "n"}) stacks->addPerBondParameter(name);
    }

    void add(Bead const& bead) {
        system->addParticle(bead.mass);
        charges->addParticle({bead.charge});
        contacts->addParticle({bead.sigma, bead.lambda});
    }
    void exclude(int a, int b) { charges->addExclusion(a, b), contacts->addExclusion(a, b); }

    /// Adds the nucleotide whose backbone is particle p.
    void add_nucleotide(int p, bool has_next, bool has_two) {
        add(backbone), add(base);
        bonds->addBond(p, p + 1, 0.54, 2200), exclude(p, p + 1);
        if (!has_next) return;
        bonds->addBond(p, p + 2, 0.59, 1400), exclude(p, p + 2);
        stacks->addBond(p + 1, p + 3, {0.4, 1.18, 15}), exclude(p + 1, p + 3);
        if (has_two) angles->addAngle(p, p + 2, p + 4, 3.14, 4.2), exclude(p, p + 4);
    }
};

std::string table_of(std::vector<Vec3> const& positions) {
    std::string text;
    for (Vec3 const& x : positions)
        text += fmt::format("{:.17g},{:.17g},{:.17g}\n", x[0], x[1], x[2]);
    return text;
}

std::string forces_text(std::string const& builder = "calvados2") {
    return fmt::format(
        "box: {{periodic: [{0}, {0}, {0}]}}\nforces: {{openmm: {{builder: {1}, temperature: {2}, "
        "ionic_strength: {3}, platform: Reference, path: inline}}}}\n",
        edge, builder, temperature, ionic);
}

bool has_note(Scene const& scene, std::string const& part) {
    for (std::string const& note : scene.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

void expect_alike(double found, double expected, char const* name) {
    EXPECT_NEAR(found, expected, 1e-9 * std::abs(expected)) << name;
    EXPECT_GT(std::abs(found), 0.01) << name;
}

/// Fifty nucleotides beside a protein: the same energies as the package's System.
TEST(Rna, OfASceneHasThePackagesEnergies) {
    int constexpr nucleotides = 50, residues = 12;
    std::vector<Vec3> const rna = nucleotides_at(nucleotides),
                            protein = wound(proteins({std::string(residues, 'G')}), 3);
    std::vector<Vec3> all = rna;
    for (Vec3 const& x : protein) all.push_back(x + Vec3{{3, 2.8, 2.4}});
    std::string sequence;
    while (sequence.size() < nucleotides) sequence += "ACGUr";
    Scene const scene = parse_scene(
        fmt::format("chains:\n"
                    "  - {{sequence: {}, model: calvados_rna, links: as_given, positions: {}}}\n"
                    "  - {{sequence: {}, model: calvados2, charge_termini: none, links: as_given, "
                    "positions: {}}}\n",
                    sequence, scratch_file("rna.csv", table_of(rna)), std::string(residues, 'G'),
                    scratch_file("protein.csv", table_of({all.end() - residues, all.end()}))) +
            forces_text(),
        "rna.yaml");
    auto const found = energies_of(scene);
    PackageSystem package(nucleotides, residues);
    auto const expected = package.energies(all);
    ASSERT_EQ(found.size(), 4U);
    expect_alike(found.at("yukawa"), expected[0], "yukawa");
    expect_alike(found.at("ashbaugh-hatch"), expected[1], "ashbaugh-hatch");
    expect_alike(found.at("stacking"), expected[3], "stacking");
    expect_alike(found.at("backbone-angles"), expected[4], "angles");
}

/// Its bonds become links of a branched chain, in the System's order; the other forces stay.
TEST(Rna, OfThePackagesSystemIsABranchedChain) {
    int constexpr nucleotides = 6;
    std::vector<Vec3> const positions = nucleotides_at(nucleotides);
    PackageSystem package(nucleotides, 0);
    BeadSystem beads;
    for (int k = 0; k < 2 * nucleotides; ++k) {
        beads.mass.push_back(1);
        beads.residue.emplace_back("r");
    }
    beads.chain_name = {"A"}, beads.chain_offset = {0, 2 * nucleotides};
    std::string const text = fmt::format(
        "forces: {{openmm: {{system: {}, topology: {}, platform: Reference, path: inline}}}}\n",
        scratch_file("rna.xml", xml_of(*package.system)),
        scratch_file("rna.pdb", pdb_of(beads, positions)));
    Scene const scene = parse_scene(text, "rna.yaml");
    ASSERT_EQ(scene.chains.size(), 1U);
    ChainSpec const& chain = scene.chains[0];
    EXPECT_EQ(chain.parent, (Inboard{-1, 0, 0, 2, 2, 4, 4, 6, 6, 8, 8, 10}));
    EXPECT_EQ(chain.beads.length[1], 0.54);
    EXPECT_EQ(chain.beads.length[2], 0.59);
    EXPECT_EQ(chain.beads.mass[0], 194.1);
    for (std::size_t k = 1; k < chain.size(); ++k)
        EXPECT_NEAR(norm(chain.beads.position[k] -
                         chain.beads.position[static_cast<std::size_t>(chain.parent[k])]),
                    chain.beads.length[k], 1e-9)
            << k;
    EXPECT_TRUE(has_note(scene, "11 links of fixed length stand for soft bonds"));
    EXPECT_TRUE(has_note(scene, "Chain A is branched (particle 2 hangs on particle 0, from 0)"));
    auto const found = energies_of(scene);
    auto const expected = package.energies(chain.beads.position);
    ASSERT_EQ(found.size(), 4U);  // without the bonds
    expect_alike(found.at("yukawa"), expected[0], "yukawa");
    expect_alike(found.at("CustomBondForce"), expected[3], "stacking");
    expect_alike(found.at("HarmonicAngleForce"), expected[4], "angles");
}

/// The same System with the chain written as a sequence: lengths are the System's.
TEST(Rna, OfASceneTakesTheLengthsOfASystem) {
    PackageSystem package(3, 0);
    for (int i = 0; i < package.bonds->getNumBonds(); ++i) {
        int a, b;
        double length, k;
        package.bonds->getBondParameters(i, a, b, length, k);
        package.bonds->setBondParameters(i, a, b, length + 0.02, k);
    }
    Scene const scene = parse_scene(
        fmt::format("chains: [{{name: a, sequence: ACG, model: calvados_rna}}]\nbox: {{periodic: "
                    "[{0}, {0}, {0}]}}\nforces: {{openmm: {{system: {1}, map: {{a: [0, 5]}}}}}}\n",
                    edge, scratch_file("rna.xml", xml_of(*package.system))),
        "rna.yaml");
    EXPECT_EQ(scene.chains[0].beads.length[1], 0.56);
    EXPECT_EQ(scene.chains[0].beads.length[2], 0.61);
    EXPECT_FALSE(has_note(scene, "longer or shorter"));
}

/// Backbones with two bases are no RNA.
TEST(Rna, OfWrittenBeadsMustBeNucleotides) {
    std::string const table =
        scratch_file("rna.csv",
                     "one,three,MW,lambdas,sigmas,q,bondlength\np,RBC,194.1,0,0.6954,-1,"
                     "0.59\nr,RNA,126.3,1.18,0.6238,0,0.54\n");
    std::string const chain =
        "chains:\n  - model: {residues: " + table +
        "}\n    bodies:\n      - {mass: 194.1, position: [0, 0, 0], residue: RBC}\n"
        "      - {mass: 126.3, position: [0.54, 0, 0], residue: RNA, joint: {type: link}}\n"
        "      - {mass: 194.1, position: [0, 0.59, 0], residue: RBC, parent: 1, joint: {type: "
        "link}}\n";
    std::string const last =
        "      - {mass: 126.3, position: [0, 0.59, 0.54], residue: RNA, joint: {type: link}, "
        "parent: ";
    auto const energies =
        energies_of(parse_scene(chain + last + "3}\n" + forces_text(), "rna.yaml"));
    EXPECT_TRUE(energies.contains("stacking"));
    EXPECT_FALSE(energies.contains("backbone-angles"));
    std::string const refused = complaint(
        [&] { energies_of(parse_scene(chain + last + "1}\n" + forces_text(), "rna.yaml")); });
    EXPECT_EQ(
        refused,
        "the backbone bead 1 of RNA has links to beads 2 and 4, where CALVADOS has one "
        "(rna.yaml): hang one base on each bead RBC, let one follow it, and leave out cross-links");
}

/// One-letter codes of amino acids are names of bases, too: A, C and G. They must not become bases.
TEST(Rna, BeadsOfTheBuiltInTableMustBeOfNucleotides) {
    auto const scene = [](std::vector<std::string> const& residues) {
        std::string bodies = "chains:\n  - bodies:\n";
        for (std::size_t k = 0; k < residues.size(); ++k)
            bodies += fmt::format("      - {{mass: 100, position: [{}, 0, 0], residue: {}{}}}\n",
                                  0.6 * static_cast<double>(k), residues[k],
                                  k == 0 ? "" : ", joint: {type: link}");
        return parse_scene(bodies + forces_text(), "rna.yaml");
    };
    auto const refused = [&](std::vector<std::string> const& residues) {
        return complaint([&] { energies_of(scene(residues)); });
    };
    std::string const remedy =
        " (rna.yaml): give amino acids their three letters (ALA), and RNA as `sequence` with "
        "`model: calvados_rna`";
    EXPECT_EQ(refused({"A", "ALA"}),
              "bead 1 has residue A of RNA and links to no backbone of RNA" + remedy);
    EXPECT_EQ(refused({"ALA", "RNA"}),
              "bead 2 has residue RNA of RNA and links to no backbone of RNA" + remedy);
    EXPECT_EQ(refused({"RBC", "RBC"}),
              "bead 1 has residue RBC of RNA and links to no base of RNA" + remedy);
    EXPECT_EQ(refused({"RBC", "U", "RBC"}),
              "bead 2 has residue U of RNA and links to several backbones of RNA" + remedy);
    for (std::vector<std::string> const& good :
         {std::vector<std::string>{"RBC", "U"}, {"C", "RBC"}, {"ALA", "CYS", "GLY"}})
        EXPECT_NO_THROW(energies_of(scene(good))) << good[0];
}

}  // namespace
}  // namespace catena::testing
