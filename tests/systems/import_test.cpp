#include "systems/import.hpp"

#include <OpenMM.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "reader/load_scene.hpp"
#include "scene/force_changes.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::testing {
namespace {

class Import : public ::testing::Test {
  protected:
    BeadSystem beads = proteins({"KDEK", "GG", "W"});
    std::unique_ptr<OpenMM::System> system = bare_system(beads);
    OpenMM::HarmonicBondForce* bonds = new OpenMM::HarmonicBondForce;

    void SetUp() override {
        system->addForce(bonds);
        bonds->addBond(0, 1, 0.38, stiff);
        bonds->addBond(3, 2, 0.41, stiff);
        bonds->addBond(0, 5, 7.0, 100);  // no neighbours: no link
        system->addConstraint(1, 2, 0.39);
    }
    ImportedSystem import(std::vector<Vec3> const& positions) {
        return import_openmm_system(spec(scratch_file("import.pdb", pdb_of(beads, positions))),
                                    "scene.yaml");
    }
    OpenMmSpec spec(std::string const& topology) const {
        OpenMmSpec made;
        made.system = scratch_file("import.xml", xml_of(*system));
        made.topology = topology;
        return made;
    }
    void join_glycines() { bonds->addBond(4, 5, 0.5, stiff); }
    static double constexpr stiff = 8033;  // kJ/mol/nm2
};

TEST_F(Import, ChainsMassesAndLengths) {
    join_glycines();
    auto const positions = wound(beads, 1);
    auto const imported = import(positions);
    EXPECT_FALSE(imported.periodic);
    ASSERT_EQ(imported.chains.size(), 3u);
    EXPECT_EQ(imported.chains[0].name, "A");
    EXPECT_EQ(imported.chains[0].residue, (std::vector<std::string>{"LYS", "ASP", "GLU", "LYS"}));
    EXPECT_EQ(imported.chains[0].mass,
              std::vector<double>(beads.mass.begin(), beads.mass.begin() + 4));
    EXPECT_EQ(imported.chains[0].length, (std::vector<double>{0, 0.38, 0.39, 0.41}));
    EXPECT_EQ(imported.chains[1].length, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(imported.chains[2].length, std::vector<double>{0});
    EXPECT_LT(difference(imported.chains[1].position, positions, 4), 1e-4);
}

TEST_F(Import, Box) {
    join_glycines();
    bonds->setUsesPeriodicBoundaryConditions(true);
    system->setDefaultPeriodicBoxVectors({5, 0, 0}, {0, 6, 0}, {0, 0, 7});
    auto const imported = import(wound(beads, 1));
    EXPECT_TRUE(imported.periodic);
    EXPECT_EQ(imported.box[0], 5);
    EXPECT_EQ(imported.box[1], 6);
    EXPECT_EQ(imported.box[2], 7);
}

/// The box of periodic forces is the System's, whatever the scene denies, and has no replicas.
TEST_F(Import, AScenesBoxAndReplicasThatPeriodicForcesDoNotHave) {
    join_glycines();
    bonds->setUsesPeriodicBoundaryConditions(true);
    system->setDefaultPeriodicBoxVectors({50, 0, 0}, {0, 60, 0}, {0, 0, 70});
    OpenMmSpec const made = spec(scratch_file("import.pdb", pdb_of(beads, wound(beads, 1))));
    std::string const text =
        "forces: {openmm: {system: " + made.system + ", topology: " + made.topology + "}}\n";
    auto const refusal = [&](std::string const& more) {
        return test::message_of([&] { parse_scene(text + more, "scene.yaml"); });
    };
    EXPECT_EQ(parse_scene(text, "scene.yaml").box.value()[1], 60);
    EXPECT_EQ(refusal("box: none"),
              "`box: none` for a System whose forces are periodic (scene.yaml: box, line 2): leave "
              "it out: the box is the System's; for chains without a box write them with "
              "`builder: calvados2`");
    EXPECT_EQ(
        refusal("replicas: 2"),
        "replicas of a System whose forces are periodic (scene.yaml: replicas, line 2): leave "
        "`replicas` out and run the scene with several seeds, or write the chains with "
        "`builder: calvados2` and `box: none`");
}

/// A spring between chains that acts on coordinates as they are, in a periodic System.
TEST_F(Import, ABondBetweenChainsThatDoesNotUseTheBoxIsNoted) {
    join_glycines();
    system->setDefaultPeriodicBoxVectors({50, 0, 0}, {0, 60, 0}, {0, 0, 70});
    auto* springs = new OpenMM::HarmonicBondForce;
    springs->addBond(1, 3, 0.8, 10);
    springs->setName("Springs");
    system->addForce(springs);
    auto const notes = [&](bool within, bool between) {
        bonds->setUsesPeriodicBoundaryConditions(between);
        springs->setUsesPeriodicBoundaryConditions(within);
        return fmt::format("{}", fmt::join(import(wound(beads, 1)).notes, "|"));
    };
    std::string const ends =
        " joins chains and does not use the box: it acts on coordinates as they are, not on "
        "nearest images.";
    EXPECT_NE(notes(true, false).find("The System's HarmonicBondForce" + ends), std::string::npos);
    EXPECT_EQ(notes(false, true).find(ends), std::string::npos);
    EXPECT_EQ(notes(false, false).find(ends), std::string::npos);  // nothing is periodic
    springs->setUsesPeriodicBoundaryConditions(true);
    bonds->setUsesPeriodicBoundaryConditions(false);
    std::string const written =
        "chains:\n  - {name: a, sequence: KDEK, model: calvados2, links: as_given}\n"
        "  - {name: b, sequence: GG, model: calvados2}\n  - {name: c, sequence: W, model: "
        "calvados2}\n"
        "box: {periodic: [50, 60, 70]}\nforces: {openmm: {map: {a: [0, 3], b: [4, 5], c: [6, 6]}, "
        "system: " +
        spec("none").system + "}}\n";
    std::vector<std::string> const of_scene = parse_scene(written, "scene.yaml").notes;
    EXPECT_TRUE(std::any_of(of_scene.begin(), of_scene.end(), [&](std::string const& note) {
        return note.find(ends) != std::string::npos;
    }));
}

/// The link that closes a ring is compared with the System as the others are.
TEST_F(Import, TheClosingLinkOfARing) {
    auto const notes = [&](double closing, double k) {
        OpenMM::System ring;
        auto* springs = new OpenMM::HarmonicBondForce;
        for (int i = 0; i < 4; ++i) ring.addParticle(100);
        for (int i = 0; i < 3; ++i) springs->addBond(i, i + 1, 1, stiff);
        if (k > 0) springs->addBond(3, 0, closing, k);
        ring.addForce(springs);
        std::string const file = scratch_file("ring.xml", xml_of(ring));
        return parse_scene(
                   "chains:\n  - name: r\n    tip: ring\n    bodies:\n"
                   "      - {mass: 100, position: [0, 0, 0]}\n"
                   "      - {mass: 100, position: [1, 0, 0], joint: {type: link}}\n"
                   "      - {mass: 100, position: [1, 1, 0], joint: {type: link}}\n"
                   "      - {mass: 100, position: [0, 1, 0], joint: {type: link}}\n"
                   "forces: {openmm: {map: {r: [0, 3]}, system: " +
                       file + "}}\n",
                   "scene.yaml")
            .notes;
    };
    EXPECT_TRUE(notes(1, stiff).empty());
    ASSERT_EQ(notes(1, 0).size(), 1u);
    EXPECT_NE(notes(1, 0)[0].find("1 of 4 links joins particles that the System neither bonds nor "
                                  "constrains, the first beads 1 and 4 of chain `r`"),
              std::string::npos)
        << notes(1, 0)[0];
    ASSERT_EQ(notes(1.1, stiff).size(), 1u);
    EXPECT_NE(notes(1.1, stiff)[0].find("the first beads 1 and 4 of chain `r`: 1 nm, its bond 1.1"),
              std::string::npos)
        << notes(1.1, stiff)[0];
    EXPECT_NE(complaint([&] { notes(1, 20); }).find("is too soft for a rigid link"),
              std::string::npos);
}

/// A link from the first of two beads of a body is compared with the bond of that bead.
TEST_F(Import, LinksThatBeginAtAnotherBeadOfABody) {
    auto const notes = [&](int from) {
        OpenMM::System pair;
        auto* springs = new OpenMM::HarmonicBondForce;
        for (int i = 0; i < 3; ++i) pair.addParticle(100);
        springs->addBond(from, 2, 1, stiff);
        pair.addForce(springs);
        return parse_scene(
                   "chains:\n  - name: b\n    bodies:\n"
                   "      - {mass: 200, inertia: [100, 100, 100], position: [0.5, 0, 0], beads: "
                   "[{position: [-0.5, 0, 0]}, {position: [0.5, 0, 0]}]}\n"
                   "      - {mass: 100, position: [0, 1, 0],\n"
                   "         joint: {type: link, translation: [-0.5, 0, 0]}}\n"
                   "forces: {openmm: {map: {b: [0, 2]}, system: " +
                       scratch_file("pair.xml", xml_of(pair)) + "}}\n",
                   "scene.yaml")
            .notes;
    };
    EXPECT_TRUE(notes(0).empty()) << notes(0)[0];
    ASSERT_EQ(notes(1).size(), 1u);
    EXPECT_NE(notes(1)[0].find("the first beads 1 and 3 of chain `b`"), std::string::npos)
        << notes(1)[0];
}

TEST_F(Import, AlphaSynuclein) {
    std::string const reference =
        std::string(CATENA_TEST_DATA) + "/reference/calvados2-asyn-system-openmm7.xml";
    beads =
        proteins({std::string("MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGG"
                              "AVVTGVTAVAQKTVEGAGSIAAATGFVKKDQLGKNEEGAPQEGILEDMPVDPDNEAYEMP"
                              "SEEGYQDYEPEA")});
    OpenMmSpec published;
    published.system = reference;
    published.topology = scratch_file("asyn.pdb", pdb_of(beads, wound(beads, 1)));
    auto const imported = import_openmm_system(published, "scene.yaml");
    EXPECT_TRUE(imported.notes.empty());
    ASSERT_EQ(imported.chains.size(), 1u);
    for (std::int64_t k = 0; k < beads.size(); ++k) {
        EXPECT_NEAR(imported.chains[0].mass[k], beads.mass[k], 1e-9) << k;
        EXPECT_EQ(imported.chains[0].length[k], k > 0 ? 0.38 : 0) << k;
    }
}

TEST_F(Import, Messages) {
    auto const positions = wound(beads, 1);
    EXPECT_EQ(
        complaint([&] { import(positions); }),
        "particles 4 and 5 (from 0) are joined by no harmonic bond and no constraint "
        "(scene.yaml: forces.openmm.system, chain B, body 2): "
        "join each particle of a chain to an earlier one (a bond of stiffness 0 does not), or "
        "end the chain between them in the topology (TER)");
    join_glycines();
    std::string const short_file = scratch_file("short.pdb", pdb_of(proteins({"KD"}), positions));
    EXPECT_EQ(complaint([&] { import_openmm_system(spec(short_file), "scene.yaml"); }),
              "the topology has 2 atoms and the System 7 particles (scene.yaml: "
              "forces.openmm.topology): give one atom per particle, in the System's order");
    EXPECT_EQ(complaint([&] { import_openmm_system(spec("/nowhere/a.pdb"), "scene.yaml"); }),
              "cannot open /nowhere/a.pdb (scene.yaml: forces.openmm.topology): name a PDB or "
              "mmCIF file that can be read");
}

TEST_F(Import, AMotionRemoverIsLeftOutWithANote) {
    join_glycines();
    system->addForce(new OpenMM::CMMotionRemover);
    EXPECT_EQ(import(wound(beads, 1)).notes,
              std::vector<std::string>{"The System's CMMotionRemover, which has no energy and "
                                       "stops the centre of mass, is left out."});
}

/// 1000 kJ/mol/nm2 as in MOFF: sqrt(0.00831446 300 / 1000) / 0.5 = 0.0998916.
TEST_F(Import, SoftBondsAreNotedAndSofterOnesRefused) {
    bonds->addBond(4, 5, 0.5, 1000);
    EXPECT_EQ(import(wound(beads, 1)).notes,
              std::vector<std::string>{"1 link of fixed length stands for soft bonds: the thermal "
                                       "spread sqrt(kT/k) at 300 K is up to 9.99 % of "
                                       "the length (particles 4 and 5 from 0: 1000 kJ/mol/nm2, 0.5 "
                                       "nm); Catena keeps no springs between "
                                       "neighbours."});
    bonds->setBondParameters(bonds->getNumBonds() - 1, 4, 5, 0.5, 200);
    EXPECT_TRUE(complaint([&] {
                    import(wound(beads, 1));
                }).starts_with("the bond between particles 4 and 5 (from 0) is too soft"));
    system->addConstraint(4, 5, 0.5);  // has the last word
    EXPECT_TRUE(import(wound(beads, 1)).notes.empty());
}

TEST_F(Import, SpringsOnOnePairRestTogether) {
    bonds->addBond(4, 5, 0.4, 6000);
    bonds->addBond(5, 4, 0.5, 2000);
    bonds->addBond(4, 5, 9.9, 0);
    auto const imported = import(wound(beads, 1));
    EXPECT_NEAR(imported.chains[1].length[1], 0.425, 1e-15);
    ASSERT_EQ(imported.notes.size(), 1U);
    EXPECT_NE(imported.notes[0].find("(particles 4 and 5 from 0: 2 bonds, 0.425 nm)"),
              std::string::npos)
        << imported.notes[0];
}

/// The chain GG is cut into two at its FENE bond, unless that is named as a link.
TEST_F(Import, CustomBondsBetweenNeighboursStayForcesUnlessTheyAreNamed) {
    auto* fene = new OpenMM::CustomBondForce("-0.5*30*R0^2*log(1-(r/R0)^2); R0=1.5");
    fene->addBond(5, 4);
    fene->setName("fene");
    system->addForce(fene);
    auto const imported = import(wound(beads, 1));
    ASSERT_EQ(imported.chains.size(), 4U);
    EXPECT_EQ(imported.chains[1].name, "B");
    EXPECT_EQ(imported.chains[2].name, "B-2");
    EXPECT_EQ(imported.chains[2].mass.size(), 1U);
    ASSERT_EQ(imported.notes.size(), 1U);
    EXPECT_TRUE(imported.notes[0].starts_with(
        "1 bond of a CustomBondForce (FENE) between neighbours stays a force (the first in chain "
        "B), so 3 chains of the topology are simulated as 4 pieces of up to 4 beads on links"))
        << imported.notes[0];
    EXPECT_NE(imported.notes[0].find("`links: {fene: LENGTH}`"), std::string::npos);

    OpenMmSpec named = spec(scratch_file("import.pdb", pdb_of(beads, wound(beads, 1))));
    for (std::string const name : {"fene", "CustomBondForce"}) {
        named.map.clear();
        add_changes({{}, {}, {{name, 0.5}}}, named);
        auto const linked = import_openmm_system(named, "scene.yaml");
        EXPECT_TRUE(linked.notes.empty());
        ASSERT_EQ(linked.chains.size(), 3U);
        EXPECT_EQ(linked.chains[1].length[1], 0.5);
    }
    named.map.clear();
    add_changes({{}, {}, {{"HarmonicBondForce", 0.5}}}, named);
    EXPECT_EQ(
        complaint([&] { import_openmm_system(named, "scene.yaml"); }),
        "the System has no CustomBondForce `HarmonicBondForce` (scene.yaml: "
        "forces.openmm.links): name one of its CustomBondForces (fene); constraints and stiff "
        "harmonic bonds become links by themselves");
}

/// Across the box from 4.9 to 0.1 nm, the two beads of a bond that stays a force are 0.2 nm apart.
TEST_F(Import, ChainsAreWholeAcrossBondsThatStayForces) {
    auto* bond = new OpenMM::CustomBondForce("r^2");
    bond->addBond(4, 5);
    bond->setUsesPeriodicBoundaryConditions(true);
    system->addForce(bond);
    system->setDefaultPeriodicBoxVectors({5, 0, 0}, {0, 5, 0}, {0, 0, 5});
    auto positions = wound(beads, 1);
    positions[4] = Vec3{{4.9, 1, 1}};
    positions[5] = Vec3{{0.1, 1, 1}};
    auto const imported = import(positions);
    EXPECT_NEAR(imported.chains.at(2).position[0][0], 5.1, 1e-4);
    EXPECT_NE(imported.notes.at(0).find("made whole across the sides of the box"),
              std::string::npos);
}

TEST_F(Import, NamedForcesAreLeftOut) {
    join_glycines();
    system->addForce(new OpenMM::MonteCarloBarostat(1, 300));
    OpenMmSpec named = spec(scratch_file("import.pdb", pdb_of(beads, wound(beads, 1))));
    add_changes({{}, {"MonteCarloBarostat"}, {}}, named);
    EXPECT_EQ(
        import_openmm_system(named, "scene.yaml").notes,
        std::vector<std::string>{"The System's MonteCarloBarostat is left out by `leave_out`."});
    add_changes({{}, {"Wall"}, {}}, named);
    EXPECT_EQ(complaint([&] { import_openmm_system(named, "scene.yaml"); }),
              "the System has no force `Wall` (scene.yaml: forces.openmm.leave_out): name a force "
              "or a kind of force: HarmonicBondForce, MonteCarloBarostat");
}

TEST_F(Import, RingsAreNamed) {
    join_glycines();
    bonds->addBond(0, 3, 0.4, stiff);  // ends of the first chain
    EXPECT_EQ(import(wound(beads, 1)).notes.size(), 1U);
    EXPECT_TRUE(import(wound(beads, 1))
                    .notes.at(0)
                    .starts_with("Chain A is closed into a ring by a bond, which stays a force"));
    system->addConstraint(0, 1, 0.38);  // an infinitely stiff first link
    EXPECT_EQ(import(wound(beads, 1)).notes.size(), 1U);
    bonds->setBondParameters(4, 0, 3, 0.4, 1);  // a restraint of the ends, no link
    EXPECT_TRUE(import(wound(beads, 1)).notes.empty());
}

/// Particle 3 hangs on particle 1 in place of 2.
TEST_F(Import, BranchesHangOnEarlierBeads) {
    join_glycines();
    bonds->setBondParameters(1, 3, 1, 0.41, stiff);
    bonds->addBond(3, 2, 0.5, 1);  // too soft for a link
    ImportedSystem const imported = import(wound(beads, 1));
    EXPECT_EQ(imported.notes,
              std::vector<std::string>{
                  "Chain A is branched (particle 3 hangs on particle 1, from "
                  "0): one rank computes a whole branched chain, however many ranks there are."});
    EXPECT_EQ(imported.chains[0].parent, (std::vector<std::int64_t>{-1, 0, 1, 1}));
    EXPECT_EQ(imported.chains[0].length, (std::vector<double>{0, 0.38, 0.39, 0.41}));
    EXPECT_TRUE(imported.chains[1].parent.empty());
}

/// A branched chain whose last bead hangs on the first is no ring. Bonds beside the links are
/// named.
TEST_F(Import, BondsThatCloseCyclesOfBranchesAreNamed) {
    join_glycines();
    bonds->setBondParameters(1, 3, 0, 0.41, stiff);
    EXPECT_EQ(import(wound(beads, 1)).notes.size(), 1U);  // on the branch alone
    bonds->addBond(3, 1, 0.6, stiff);
    ImportedSystem const imported = import(wound(beads, 1));
    // Both are equally stiff for their lengths but for 0.6 nm, which is the stiffer link.
    EXPECT_EQ(imported.chains[0].parent, (std::vector<std::int64_t>{-1, 0, 1, 1}));
    EXPECT_EQ(imported.notes.at(1),
              "1 stiff bond of branched chains closes a cycle of links (particles 0 and 3 from 0) "
              "and stays a force: only constraints become cross-links.");
}

/// Nothing but a link holds what a constraint holds.
TEST_F(Import, ConstraintsThatCloseCyclesBecomeCrossLinks) {
    join_glycines();
    for (int k = 1; k < 4; ++k) system->addConstraint(k - 1, k, 0.4);
    system->addConstraint(3, 0, 0.5);
    ImportedSystem const imported = import(wound(beads, 1));
    ASSERT_TRUE(imported.chains[0].parent.empty());
    EXPECT_EQ(imported.chains[0].crosslinks, (std::vector<CrossLink>{{0, 3, 0.5}}));
    EXPECT_TRUE(imported.chains[1].crosslinks.empty());
    EXPECT_EQ(imported.notes,
              std::vector<std::string>{
                  "1 constraint of chain A closes a cycle of links and becomes a cross-link: "
                  "cross-linked chains are computed on the host, each by one rank."});
}

/// A constraint that is no link could not stay: it outranks the spring to the bead before.
TEST_F(Import, ConstraintsOutrankSprings) {
    join_glycines();
    system->addConstraint(1, 3, 0.45);
    ImportedSystem const imported = import(wound(beads, 1));
    EXPECT_EQ(imported.chains[0].parent, (std::vector<std::int64_t>{-1, 0, 1, 1}));
    EXPECT_EQ(imported.chains[0].length[3], 0.45);
    EXPECT_TRUE(imported.notes.at(1).starts_with("1 stiff bond of branched chains closes a cycle"));
}

/// Bonds of named forces become links between any beads of a chain.
TEST_F(Import, NamedBondsMakeBranches) {
    join_glycines();
    bonds->setBondParameters(1, 3, 1, 0.41, 0);
    auto* custom = new OpenMM::CustomBondForce("log(r)");
    custom->setName("FENE");
    custom->addBond(1, 3);
    system->addForce(custom);
    std::string const text = complaint([&] { import(wound(beads, 1)); });
    EXPECT_TRUE(
        text.starts_with("particle 3 (from 0) is joined to particle 1 by a CustomBondForce "
                         "alone, and to no earlier one otherwise"))
        << text;
    OpenMmSpec named = spec(scratch_file("import.pdb", pdb_of(beads, wound(beads, 1))));
    add_changes({{}, {}, {{"FENE", 0.97}}}, named);
    ImportedSystem const imported = import_openmm_system(named, "scene.yaml");
    EXPECT_EQ(imported.chains[0].parent, (std::vector<std::int64_t>{-1, 0, 1, 1}));
    EXPECT_EQ(imported.chains[0].length[3], 0.97);
}

/// A spring of a network is no link between two proteins without a TER between them.
TEST_F(Import, SpringsUnlikeTheLinksMakeNoBranches) {
    join_glycines();
    bonds->setBondParameters(1, 3, 1, 0.41, 700);
    EXPECT_EQ(complaint([&] { import(wound(beads, 1)); }),
              "particle 3 (from 0) hangs on no earlier one of its chain by a bond like that of "
              "particles 0 and 1: the stiffest, to particle 1, has 700 kJ/mol/nm2 (scene.yaml: "
              "forces.openmm.system, chain A, body 4): end the chain before it in the topology "
              "(TER): its bonds then stay springs");
    EXPECT_EQ(chains_by_bonds(spec(""), "s.yaml").sizes, (std::vector<std::int64_t>{3, 1, 2, 1}));
}

/// A star whose centre comes last has no order in which each bead hangs on an earlier one.
TEST_F(Import, BeadsThatHangOnLaterOnesAreRefused) {
    system = bare_system(beads);
    bonds = new OpenMM::HarmonicBondForce;
    system->addForce(bonds);
    for (int k = 0; k < 3; ++k) bonds->addBond(k, 3, 0.4, stiff);
    join_glycines();
    EXPECT_EQ(complaint([&] { import(wound(beads, 1)); }),
              "particle 1 (from 0) is joined to particle 3 and to no earlier one (scene.yaml: "
              "forces.openmm.system, chain A, body 2): number the particles so that each of a "
              "chain is joined to an earlier one, or end the chain before it in the topology "
              "(TER): the other bonds then stay springs");
}

/// Two strands in one chain of the topology, with a branch as nucleotides have it.
TEST_F(Import, TwoChainsInOneAreToldWhereToCutThem) {
    system = bare_system(beads);
    bonds = new OpenMM::HarmonicBondForce;
    system->addForce(bonds);
    bonds->addBond(1, 2, 0.4, stiff);
    bonds->addBond(1, 3, 0.4, stiff);
    join_glycines();
    EXPECT_EQ(complaint([&] { import(wound(beads, 1)); }),
              "no bond and no constraint joins particle 1 (from 0) or a later one to an earlier "
              "one of its chain: these are two chains, such as the strands of double-stranded RNA "
              "(scene.yaml: forces.openmm.system, chain A, body 2): write a line TER, or another "
              "chain's letter, before it in the topology");
}

/// Without a topology the bonds tell the chains apart, branched ones too.
TEST_F(Import, ChainsByBondsHoldTheirBranches) {
    bonds->setBondParameters(1, 3, 1, 0.41, stiff);
    join_glycines();
    bonds->addBond(0, 6, 2, 1);  // too soft to join two chains
    EXPECT_EQ(chains_by_bonds(spec(""), "s.yaml").sizes, (std::vector<std::int64_t>{4, 2, 1}));
}

TEST_F(Import, BondsThatAreNoneAreRefused) {
    join_glycines();
    bonds->setBondParameters(0, 0, 1, 0.38, -5);
    EXPECT_TRUE(complaint([&] { import(wound(beads, 1)); })
                    .starts_with("the harmonic bond between particles 0 and 1 (from 0) has "
                                 "stiffness -5 and length 0.38"));
    bonds->setBondParameters(0, 0, 1, 0, stiff);
    EXPECT_TRUE(complaint([&] {
                    import(wound(beads, 1));
                }).starts_with("the bond between particles 0 and 1 (from 0) has length 0 nm"));
}

}  // namespace
}  // namespace catena::testing
