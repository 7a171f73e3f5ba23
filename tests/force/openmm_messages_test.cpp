// What cannot be had is said in one line: what is wrong (where): what to do.
#include <OpenMM.h>

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

std::string const version = OpenMM::Platform::getOpenMMVersion();

class Messages : public ::testing::Test {
  protected:
    BeadSystem beads = proteins({"KDEK", "GG"});
    std::unique_ptr<Communicator> serial = serial_communicator();

    std::string of(OpenMmSpec const& spec) {
        return complaint([&] { make_openmm_force(spec, beads, *serial); });
    }
    OpenMmSpec with_system(std::function<void(OpenMM::System&)> const& change) {
        auto const system = bare_system(beads);
        change(*system);
        return with_text(xml_of(*system));
    }
    static OpenMmSpec with_text(std::string const& xml) {
        OpenMmSpec spec = on_reference("");
        spec.system = scratch_file("messages.xml", xml);
        return spec;
    }
    std::string of_system(std::function<void(OpenMM::System&)> const& change) {
        return of(with_system(change));
    }
};

TEST_F(Messages, Platform) {
    OpenMmSpec spec = on_reference();
    spec.platform = "Abacus";
    EXPECT_TRUE(of(spec).starts_with(
        "OpenMM " + version +
        " has no platform Abacus (scene.yaml: forces.openmm.platform): use one of Reference, CPU"))
        << of(spec);
    spec = on_reference();
    spec.precision = "half";
    EXPECT_EQ(of(spec),
              "`half` is not a precision of OpenMM (scene.yaml: forces.openmm.precision): use "
              "single, mixed or double");
    spec = on_reference();
    spec.path = "device";
    EXPECT_EQ(of(spec),
              "positions and forces cannot stay on a GPU: the backend is not cuda (scene.yaml: "
              "forces.openmm.path): use auto, or chains of beads and of rigid domains, "
              "--backend cuda and forces.openmm.platform: CUDA on a machine with a GPU");
}

TEST_F(Messages, Builder) {
    EXPECT_EQ(of(on_reference("martini")),
              "`martini` is not a builder of OpenMM's forces (scene.yaml: forces.openmm): use "
              "builder: calvados2, or system: and topology:");
    EXPECT_EQ(of(on_reference("")),
              "`` is not a builder of OpenMM's forces (scene.yaml: forces.openmm): use builder: "
              "calvados2, or system: and topology:");
    beads = proteins({});
    EXPECT_EQ(of(on_reference()),
              "OpenMM has no beads to act on (scene.yaml: forces.openmm): give the scene a chain "
              "of beads, or leave forces.openmm out");
}

TEST_F(Messages, Calvados2) {
    OpenMmSpec spec = on_reference();
    spec.temperature = 0;
    EXPECT_EQ(of(spec),
              "temperature 0 K is not positive (scene.yaml: forces.openmm.temperature): give it in "
              "kelvin");
    spec.temperature = 643.5;
    EXPECT_EQ(of(spec),
              "the permittivity of water, which scales the electrostatics, is not known at 643.5 K "
              "(scene.yaml: forces.openmm.temperature): give at most 643 K (the default is "
              "dynamics.temperature)");
    spec = on_reference();
    spec.ionic_strength = -0.1;
    EXPECT_EQ(of(spec),
              "ionic strength -0.1 mol/l is negative (scene.yaml: forces.openmm.ionic_strength): "
              "give it in mol/l");
    spec = on_reference();
    spec.switch_width = 2;
    EXPECT_EQ(of(spec),
              "switch width 2 nm is not between 0 and the shortest cutoff, 2 nm (scene.yaml: "
              "forces.openmm.switch_width): use about 0.2");
    beads.box = Vec3{{9, 7.5, 9}};
    EXPECT_EQ(of(on_reference()),
              "box edge 7.5 nm is less than twice the cutoff of 4 nm (scene.yaml: box.periodic): "
              "use a larger box or none");
    beads.box.reset();
    beads.residue[5] = "UNK";
    EXPECT_EQ(of(on_reference()),
              "CALVADOS 2 has no residue UNK (scene.yaml: chain B, body 2): use the twenty amino "
              "acids (sequence and model: calvados2) or nucleotides (model: calvados_rna), or "
              "give the forces "
              "as a System (forces.openmm.system)");
}

TEST_F(Messages, UnreadableSystem) {
    OpenMmSpec spec = on_reference("");
    spec.system = "/nowhere/system.xml";
    EXPECT_EQ(of(spec),
              "cannot open /nowhere/system.xml (scene.yaml: forces.openmm.system): name a "
              "serialised System that can be read");
    EXPECT_NE(of(with_text("hello"))
                  .find(" is not a serialised System (scene.yaml: forces.openmm.system): "),
              std::string::npos);
    EXPECT_NE(
        of(with_text("<?xml version=\"1.0\" ?>\n<State type=\"State\" version=\"1\"></State>"))
            .find(" is not a serialised System ("),
        std::string::npos);

    std::string xml = xml_of(*every_force(proteins({random_sequence(60, 1)})));
    EXPECT_NE(of(with_text(xml.substr(0, xml.size() / 2))).find(" is not well-formed: "),
              std::string::npos);
    auto const at =
        xml.find('"', xml.find("version=", xml.find("type=\"CustomNonbondedForce\""))) + 1;
    xml.replace(at, 1, "9");
    std::string const text = of(with_text(xml));
    EXPECT_TRUE(text.starts_with("OpenMM " + version + " cannot read ")) << text;
    EXPECT_NE(
        text.find("messages.xml, written by OpenMM " + version +
                  ": Unsupported version number (scene.yaml: forces.openmm.system): build Catena"),
        std::string::npos)
        << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST_F(Messages, ReferenceSystemOnOpenMm7) {
    if (!version.starts_with("7")) GTEST_SKIP() << "NOT RUN: for OpenMM 7, this is " << version;
    OpenMmSpec spec = on_reference("");
    spec.system = std::string(CATENA_TEST_DATA) + "/reference/calvados2-asyn-system.xml";
    std::string const text = of(spec);
    EXPECT_TRUE(text.starts_with("OpenMM 7.7 cannot read ")) << text;
    EXPECT_NE(text.find("written by OpenMM 8.6.1: Unsupported version number"), std::string::npos)
        << text;
}

std::string way_out(std::string const& kind) {
    return fmt::format(
        "remove it, or leave it out by `leave_out: [{0}]` (catena import --leave-out {0}): ", kind);
}

TEST_F(Messages, WhatMovesParticles) {
    std::string const where = " (scene.yaml: forces.openmm.system): ";
    EXPECT_EQ(of_system([](auto& s) { s.addForce(new OpenMM::AndersenThermostat(310, 1)); }),
              "the System holds an AndersenThermostat, which holds 310 K by collisions" + where +
                  way_out("AndersenThermostat") +
                  "Catena's own integrators hold the temperature (dynamics.integrator: g-baoab)");
    std::string const volume = "Catena runs at constant volume, in the System's box";
    EXPECT_EQ(of_system([](auto& s) { s.addForce(new OpenMM::MonteCarloBarostat(1.5, 310)); }),
              "the System holds a MonteCarloBarostat, which changes the box's volume to hold 1.5 "
              "bar at 310 K" +
                  where + way_out("MonteCarloBarostat") + volume);
    EXPECT_EQ(of_system([](auto& s) {
                  s.addForce(new OpenMM::MonteCarloAnisotropicBarostat({1, 1, 1}, 300));
              }),
              "the System holds a MonteCarloAnisotropicBarostat, which changes the box's edges to "
              "hold a pressure" +
                  where + way_out("MonteCarloAnisotropicBarostat") + volume);
    EXPECT_EQ(of_system([](auto& s) {
                  s.setVirtualSite(2, new OpenMM::TwoParticleAverageSite(1, 3, 0.5, 0.5));
              }),
              "particle 2 (from 0) is a virtual site" + where +
                  "leave virtual sites out: every particle is a bead with a mass");
    EXPECT_EQ(of_system([](auto& s) { s.setParticleMass(1, 0); }),
              "particle 1 (from 0) has no mass" + where +
                  "give it one: every particle is a bead that moves");
}

TEST_F(Messages, WhatMovesParticlesIsLeftOutWhereItIsNotAskedFor) {
    OpenMmSpec spec = with_system([](auto& s) {
        auto* barostat = new OpenMM::MonteCarloBarostat(1, 300);
        barostat->setForceGroup(3);
        s.addForce(barostat);
        s.addForce(new OpenMM::CMMotionRemover);
    });
    spec.force_groups = {0};
    std::string const text =
        fmt::format("{}", fmt::join(make_openmm_force(spec, beads, *serial)->description(), "\n"));
    EXPECT_NE(text.find("The System's MonteCarloBarostat, which changes the box's volume to hold 1 "
                        "bar at 300 K, is left out."),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("The System's CMMotionRemover, which has no energy and stops the centre of "
                        "mass, is left out."),
              std::string::npos)
        << text;
}

TEST_F(Messages, TermsAreNamedForTablesAndPeople) {
    auto const pairs = [&](auto& s, std::string const& energy, std::string const& name) {
        auto* force = new OpenMM::CustomNonbondedForce(energy);
        if (!name.empty()) force->setName(name);
        for (char const* const parameter : {"q", "s", "l"})
            force->addPerParticleParameter(parameter);
        for (int i = 0; i < s.getNumParticles(); ++i) force->addParticle({0.5 * i - 1, 0.5, 0.5});
        s.addForce(force);
    };
    // Expressions as the CALVADOS package and OpenABC write them.
    std::string const yukawa = "q*1.73*(exp(-1.27*r)/r-0.0016); q=q1*q2";
    std::string const sticky =
        "0.8368*select(step(r-2^(1/6)*s),4*l*((s/r)^12-(s/r)^6),4*((s/r)^12-(s/r)^6)+(1-l)); "
        "s=0.5*(s1+s2); l=0.5*(l1+l2)";
    auto const force = make_openmm_force(with_system([&](auto& s) {
                                             pairs(s, yukawa, "");
                                             pairs(s, "q1 * q2 * exp(-r / 0.8) / r", "");
                                             pairs(s, sticky, "");
                                             pairs(s, "q1*q2/r", "");
                                             pairs(s, "q1*q2/r", "a, \"b\"\n<c>");
                                             pairs(s, "q1*q2/r", "total");
                                             pairs(s, yukawa, "mine");
                                             pairs(s, "q1*q2/r", "mine 2");
                                             pairs(s, "q1*q2/r", "mine");
                                         }),
                                         beads, *serial);
    evaluate(*force, wound(beads, 1));
    std::vector<std::string> names;
    for (auto const& term : force->energies()) names.push_back(term.name);
    EXPECT_EQ(names, (std::vector<std::string>{"yukawa", "yukawa 2", "ashbaugh-hatch",
                                               "CustomNonbondedForce", "a_ _b_ _c_", "total 2",
                                               "mine", "mine 2", "mine 3"}));
    std::string const text =
        fmt::format("{}", fmt::join(force->description(), "\n"));  // -1, -0.5, 0, 0.5 and 1, 1.5
    EXPECT_NE(text.find("net charge: A -1.000 e, B 2.500 e; together 1.500 e (yukawa)"),
              std::string::npos)
        << text;
}

TEST_F(Messages, ConstraintsThatAreNoLinks) {
    std::string const where = " (scene.yaml: forces.openmm.system): ";
    EXPECT_EQ(
        of_system([](auto& s) { s.addConstraint(0, 2, 0.5); }),
        "the constraint between particles 0 and 2 (from 0) is not a link of the scene" + where +
            "join the two beads by a link or by `crosslinks` of their chain, or make it a bond");
    EXPECT_EQ(
        of_system([](auto& s) { s.addConstraint(3, 4, 0.38); }),
        "the constraint between particles 3 and 4 (from 0) is not a link of the scene" + where +
            "join the two beads by a link or by `crosslinks` of their chain, or make it a bond");
    EXPECT_EQ(of_system([](auto& s) { s.addConstraint(1, 2, 0.5); }),
              "the constraint between particles 1 and 2 (from 0) has length 0.5, its link 0.38" +
                  where + "give both the same length");
    auto const force = make_openmm_force(
        with_system([](auto& s) { s.addConstraint(2, 1, 0.38), s.addConstraint(2, 3, 0.38); }),
        beads, *serial);
    EXPECT_NE(fmt::format("{}", fmt::join(force->description(), "\n"))
                  .find("2 constraints along rigid links left out (length 0.38 nm)"),
              std::string::npos);
}

TEST_F(Messages, BondsOfOtherLengthsThanTheirLinks) {
    auto const spec = with_system([](auto& s) {
        auto* bonds = new OpenMM::HarmonicBondForce;
        bonds->addBond(0, 1, 0.38, 100);
        bonds->addBond(2, 1, 0.4, 100);
        bonds->addBond(0, 3, 1.0, 100);
        s.addForce(bonds);
    });
    auto const force = make_openmm_force(spec, beads, *serial);
    std::string const text = fmt::format("{}", fmt::join(force->description(), "\n"));
    EXPECT_NE(text.find("2 harmonic bonds along rigid links left out (lengths 0.38 to 0.4 nm); "
                        "their links differ from them by up to 0.02 nm"),
              std::string::npos)
        << text;
    auto const forces = evaluate(
        *force, {Vec3::zero(), {{9, 0, 0}}, {{9, 9, 0}}, {{1.5, 0, 0}}, {{5, 5, 5}}, {{6, 5, 5}}});
    EXPECT_NEAR(forces[0][0], 50, 1e-12);
    EXPECT_EQ(norm(forces[1]), 0);
    EXPECT_EQ(norm(forces[2]), 0);
    EXPECT_NEAR(forces[3][0], -50, 1e-12);
    ASSERT_EQ(force->energies().size(), 1u);
    EXPECT_NEAR(force->energies()[0].value, 12.5, 1e-12);
}

TEST_F(Messages, CountsAndMasses) {
    std::string const where = " (scene.yaml: forces.openmm.system): ";
    OpenMmSpec const longer = with_system([](auto& s) { s.addParticle(1); });
    EXPECT_EQ(of(longer), "the System has 7 particles and the scene 6 beads" + where +
                              "make every particle of " + longer.system + " a bead of the scene");
    EXPECT_EQ(of_system([](auto& s) { s.setParticleMass(4, 60); }),
              "particle 4 (from 0) has mass 60 in the System and 59.05 in the scene" + where +
                  "masses come from the System: give the same in the scene");
    make_openmm_force(with_system([](auto& s) { s.setParticleMass(4, 59.05 * (1 + 1e-9)); }), beads,
                      *serial);
}

TEST_F(Messages, Topology) {
    OpenMmSpec spec = with_system([](auto&) {});
    std::vector<Vec3> const anywhere(6, Vec3::zero());
    spec.topology = scratch_file("short.pdb", pdb_of(proteins({"KDE", "GG"}), anywhere));
    EXPECT_EQ(of(spec),
              "the topology has 5 atoms and the System 6 particles (scene.yaml: "
              "forces.openmm.topology): give " +
                  spec.topology + " one atom per particle, in the System's order");
    spec.topology = scratch_file("other.pdb", pdb_of(proteins({"KDE", "GGG"}), anywhere));
    EXPECT_EQ(of(spec),
              "chain 1 has 4 beads in the scene and 3 atoms in the topology (scene.yaml: "
              "forces.openmm.topology): give the chains in the topology's order, or assign the "
              "particles with forces.openmm.map");
    spec.topology = scratch_file("one.pdb", pdb_of(proteins({"KDEKGG"}), anywhere));
    EXPECT_TRUE(
        of(spec).starts_with("chain 1 has 4 beads in the scene and 6 atoms in the topology"));
    spec.topology = scratch_file("right.pdb", pdb_of(beads, anywhere));
    make_openmm_force(spec, beads, *serial);
}

TEST_F(Messages, Map) {
    std::string const where = " (scene.yaml: forces.openmm.map): ";
    OpenMmSpec spec = with_system([](auto&) {});
    spec.map = {{"A", {0, 3}}};
    EXPECT_EQ(of(spec), "chain B is not in the map" + where +
                            "give every chain of beads its first and last particle");
    spec.map = {{"A", {0, 3}}, {"B", {3, 4}}};
    EXPECT_EQ(of(spec),
              "particle 3 (from 0) belongs to two chains" + where + "make the ranges disjoint");
    spec.map = {{"A", {0, 3}}, {"B", {5, 6}}};
    EXPECT_EQ(of(spec), "chain B has 2 beads, and its particles are 5 to 6 of 0 to 5" + where +
                            "name its first and last particle, counted from 0");
    spec.map = {{"A", {0, 2}}, {"B", {4, 5}}};
    EXPECT_EQ(of(spec), "chain A has 4 beads, and its particles are 0 to 2 of 0 to 5" + where +
                            "name its first and last particle, counted from 0");
    spec.map = {{"A", {0, 3}}, {"C", {0, 1}}, {"B", {4, 5}}};
    EXPECT_EQ(of(spec), "the scene has no chain of beads named C" + where + "use one of A, B");
    spec.map = {{"B", {4, 5}}, {"A", {0, 3}}};
    make_openmm_force(spec, beads, *serial);
}

TEST_F(Messages, Box) {
    auto const periodic = [](auto& s) {
        s.setDefaultPeriodicBoxVectors({5, 0, 0}, {0, 6, 0}, {0, 0, 7});
        auto* pairs = new OpenMM::CustomNonbondedForce("1/r");
        pairs->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffPeriodic);
        pairs->setCutoffDistance(2);
        for (int i = 0; i < 6; ++i) pairs->addParticle();
        s.addForce(pairs);
    };
    std::string const expected =
        "the System's forces are periodic and its box is not the scene's (scene.yaml: "
        "box.periodic): give the System's, [5, 6, 7]; it must "
        "be rectangular";
    EXPECT_EQ(of_system(periodic), expected);
    beads.box = Vec3{{5, 6, 7.5}};
    EXPECT_EQ(of_system(periodic), expected);
    beads.box = Vec3{{5, 6, 7}};
    make_openmm_force(with_system(periodic), beads, *serial);
    EXPECT_EQ(of_system([&](auto& s) {
                  periodic(s), s.setDefaultPeriodicBoxVectors({5, 0, 0}, {1, 6, 0}, {0, 0, 7});
              }),
              expected);

    auto const open = make_openmm_force(
        with_system([](auto& s) { s.addForce(new OpenMM::HarmonicBondForce); }), beads, *serial);
    EXPECT_NE(fmt::format("{}", fmt::join(open->description(), "\n"))
                  .find("no force of the System uses the scene's box"),
              std::string::npos);
}

TEST_F(Messages, TooManyForces) {
    for (int const count : {33, 10000})  // soon, before each is given a name of its own
        EXPECT_EQ(of_system([&](auto& s) {
                      for (int i = 0; i < count; ++i) s.addForce(new OpenMM::CustomBondForce("r"));
                  }),
                  fmt::format("the System has {} forces (scene.yaml: forces.openmm.system): merge "
                              "forces of one kind: OpenMM distinguishes 32 groups",
                              count));
    auto const force = make_openmm_force(with_system([](auto& s) {
                                             for (int i = 0; i < 32; ++i) {
                                                 auto* bonds = new OpenMM::CustomBondForce("r");
                                                 bonds->addBond(0, 2);
                                                 s.addForce(bonds);
                                             }
                                         }),
                                         beads, *serial);
    evaluate(*force, wound(beads, 1));
    auto const energies = force->energies();
    ASSERT_EQ(energies.size(), 32u);
    EXPECT_EQ(energies[0].name, "CustomBondForce");
    EXPECT_EQ(energies[31].name, "CustomBondForce 32");
    EXPECT_EQ(energies[0].value, energies[31].value);
    EXPECT_GT(energies[0].value, 0);
}

/// As many ranks as one likes without anybody to speak to: enough where make_openmm_force refuses
/// on every rank.
class Alone final : public Communicator {
  public:
    int rank() const override { return 0; }
    int size() const override { return 2; }
    int ranks_on_host() const override { return 2; }
    int ranks_on_cores() const override { return 2; }
    int rank_on_host() const override { return 0; }
    void all_gather(std::span<std::byte const> own, std::span<std::byte> all,
                    std::vector<std::int64_t> const& bytes) const override {
        std::fill(all.begin(), all.end(), std::byte{0});
        std::copy(own.begin(), own.end(), all.begin());
        EXPECT_EQ(std::ssize(own), bytes[0]);
    }
    void gather(std::span<std::byte const>, std::span<std::byte>,
                std::vector<std::int64_t> const&) const override {}
    void broadcast(std::span<std::byte>) const override {}
    void exchange(std::span<std::byte const>, int, std::span<std::byte>, int) const override {}
    double max(double value) const override { return value; }
    std::int64_t sum(std::int64_t value) const override { return value; }
    void barrier() const override {}
    std::int64_t rounds() const override { return 0; }
    [[noreturn]] void abort(int status) const override { std::_Exit(status); }
};

TEST_F(Messages, ForcesThatCannotBeSplit) {
    beads = split(beads, 2);
    auto const refused = [&](OpenMM::Force* force) {
        OpenMmSpec const spec = with_system([&](auto& s) { s.addForce(force); });
        return complaint([&] { make_openmm_force(spec, beads, Alone()); });
    };
    std::string const rest =
        " cannot be split over 2 ranks (scene.yaml: forces.openmm): set forces.openmm.replicate: "
        "true, so that every rank computes the "
        "whole System, or run "
        "on one rank";
    EXPECT_EQ(refused(new OpenMM::CustomCVForce("1")), "CustomCVForce" + rest);
    EXPECT_EQ(refused(new OpenMM::CustomGBForce), "CustomGBForce" + rest);
    EXPECT_EQ(refused(new OpenMM::GBSAOBCForce), "GBSAOBCForce" + rest);
    EXPECT_EQ(refused(new OpenMM::GayBerneForce), "GayBerneForce" + rest);
    EXPECT_EQ(refused(new OpenMM::CustomHbondForce("0")), "CustomHbondForce" + rest);
    EXPECT_EQ(refused(new OpenMM::CustomManyParticleForce(3, "1")),
              "CustomManyParticleForce" + rest);
    for (auto const& [method, name] : {std::pair{OpenMM::NonbondedForce::Ewald, "Ewald"},
                                       {OpenMM::NonbondedForce::PME, "PME"},
                                       {OpenMM::NonbondedForce::LJPME, "LJPME"}}) {
        beads.box = Vec3{{4, 4, 4}};
        auto* charges = new OpenMM::NonbondedForce;
        charges->setNonbondedMethod(method);
        EXPECT_EQ(refused(charges), fmt::format("NonbondedForce ({})", name) + rest);
    }
}

TEST_F(Messages, RefusedByOpenMm) {
    std::string const text = of_system([](auto& s) {
        s.addForce(new OpenMM::CustomNonbondedForce("1/r"));
    });  // without its particles
    EXPECT_TRUE(text.starts_with("OpenMM refuses these forces: ")) << text;
    EXPECT_TRUE(
        text.ends_with(" (scene.yaml: forces.openmm): correct the System, or use another platform"))
        << text;
}

}  // namespace
}  // namespace catena::testing
