// Replicas in one Context feel the forces of a lone one, wherever they are.
#include <cmath>
#include <random>

#include "force/contacts.hpp"
#include "math/rotation.hpp"
#include "scene/force_changes.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

/// Two chains, named as in a scene file.
BeadSystem one_replica() {
    return proteins({"MKDEGFYRSAKDWLNQHITVCPMKDEGFYRSAKD", "KDEKDEGGSGGSGGRKRK"});
}

/// The replicas of these chains, as a scene names them.
BeadSystem replicas_of(BeadSystem const& one, std::int64_t count, int ranks = 1) {
    BeadSystem all = one;
    all.replicas = count;
    all.chain_name.clear();
    for (std::int64_t r = 0; r < count; ++r) {
        for (std::string const& name : one.chain_name)
            all.chain_name.push_back(name + "-" + std::to_string(r + 1));
        if (r == 0) continue;
        std::int64_t const first = r * one.size();
        all.mass.insert(all.mass.end(), one.mass.begin(), one.mass.end());
        all.residue.insert(all.residue.end(), one.residue.begin(), one.residue.end());
        for (auto const& link : one.links)
            all.links.push_back({first + link.inboard, first + link.outboard, link.length});
        for (std::size_t c = 1; c < one.chain_offset.size(); ++c)
            all.chain_offset.push_back(first + one.chain_offset[c]);
    }
    return split(all, ranks);
}

/// A rigid motion: a random rotation, then a shift.
struct Motion {
    explicit Motion(std::uint64_t seed, double farthest) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> place(-farthest, farthest);
        rotation = to_matrix(
            normalized(Quat{normal(random), normal(random), normal(random), normal(random)}));
        shift = {{place(random), place(random), place(random)}};
    }
    Mat3 rotation;
    Vec3 shift;
};

/// The forces of replicas that are moved as wholes, against those of a lone one.
class Replicas : public ::testing::Test {
  protected:
    void compare(OpenMmSpec const& spec, std::int64_t count, double farthest, double tolerance) {
        auto const serial = serial_communicator();
        BeadSystem const all = replicas_of(one_, count);
        auto const force = make_openmm_force(spec, all, *serial);
        auto const lone = make_openmm_force(spec, one_, *serial);
        for (int evaluation = 0; evaluation < 3; ++evaluation) {
            auto const x = wound(one_, static_cast<std::uint64_t>(evaluation) + 1);
            std::vector<Vec3> moved, expected;
            auto const forces = evaluate(*lone, x);
            for (std::int64_t r = 0; r < count; ++r) {
                Motion const motion(static_cast<std::uint64_t>(100 * evaluation + r), farthest);
                for (Vec3 const& at : x) moved.push_back(motion.rotation * at + motion.shift);
                for (Vec3 const& f : forces) expected.push_back(motion.rotation * f);
            }
            EXPECT_LE(difference(evaluate(*force, moved), expected), tolerance * largest(forces));
            expect_energies(*force, *lone, static_cast<double>(count), tolerance);
        }
    }
    static void expect_energies(OpenMmForce& all, OpenMmForce& lone, double times,
                                double tolerance) {
        auto const energies = all.energies(), of_one = lone.energies();
        ASSERT_EQ(energies.size(), of_one.size());
        for (std::size_t i = 0; i < energies.size(); ++i) {
            EXPECT_EQ(energies[i].name, of_one[i].name);
            EXPECT_NEAR(energies[i].value, times * of_one[i].value,
                        tolerance * times * (1 + std::abs(of_one[i].value)));
        }
    }
    /// A System with every kind of force that knows distances and angles alone.
    OpenMmSpec with_every_force(std::vector<std::string> const& leave_out = {
                                    "CustomExternalForce"}) const {
        OpenMmSpec spec = on_reference("");
        spec.system = scratch_file("replicas.xml", xml_of(*every_force(one_)));
        spec.topology = scratch_file("replicas.pdb", pdb_of(one_, wound(one_, 1)));
        add_changes({.extra = {}, .leave_out = leave_out, .links = {}}, spec);
        return spec;
    }
    BeadSystem one_ = one_replica();
};

TEST_F(Replicas, LieOnTopOfEachOther) { compare(on_reference(), 7, 0.1, 1e-12); }

/// A double resolves 1e-13 nm at a micrometre, and forces change by some 1e4 per nanometre.
TEST_F(Replicas, DriftAMicrometre) { compare(on_reference(), 7, 1000, 1e-10); }

TEST_F(Replicas, HaveLayers) {
    OpenMmSpec spec = on_reference();
    spec.layers = "all";
    compare(spec, 3, 1, 1e-12);
}

TEST_F(Replicas, HaveEveryForceOfASystem) { compare(with_every_force(), 5, 1, 1e-11); }

/// Places of 27 replicas are up to 60 nm from the origin.
TEST_F(Replicas, AreRoundedToSinglePrecision) {
    OpenMmSpec spec = on_reference();
    spec.platform = "CPU";
    compare(spec, 27, 1000, 14 * 60 / 0.3 * 0x1p-24);
}

TEST_F(Replicas, HaveChargesByTheNamesOfTheSceneFile) {
    OpenMmSpec spec = on_reference();
    spec.map = {{"A", {0, 0}}, {"B", {1, 0}}};  // charged ends
    compare(spec, 3, 1, 1e-12);
}

TEST_F(Replicas, FeelForcesBetweenNearBeadsAlone) {
    auto const serial = serial_communicator();
    BeadSystem const all = replicas_of(one_, 2);
    auto const force = make_openmm_contacts(on_reference(), all, *serial, 1);
    auto const lone = make_openmm_contacts(on_reference(), one_, *serial, 1);
    auto const x = wound(one_, 4);
    std::vector<Vec3> twice = x;
    twice.insert(twice.end(), x.begin(), x.end());
    auto const expected = evaluate(*lone, x), forces = evaluate(*force, twice);
    EXPECT_LE(difference(expected, forces), 1e-12 * largest(expected));
    EXPECT_LE(difference(expected, forces, one_.size()), 1e-12 * largest(expected));
}

TEST_F(Replicas, AreDealtOutToRanks) {
    on_ranks([&](Communicator const& communicator) {
        auto const serial = serial_communicator();
        BeadSystem const beads = replicas_of(one_, 12, communicator.size());
        auto const force = make_openmm_force(on_reference(), beads, communicator);
        auto const whole = make_openmm_force(on_reference(), replicas_of(one_, 12), *serial);
        std::vector<Vec3> positions;
        for (std::uint64_t r = 0; r < 12; ++r)
            for (Vec3 const& x : wound(one_, r)) positions.push_back(x);
        auto const expected = evaluate(*whole, positions);
        auto const own = evaluate(*force, beads, communicator.rank(), positions);
        EXPECT_LE(difference(own, expected, beads.first_of_rank[communicator.rank()]),
                  1e-12 * largest(expected));
        EXPECT_EQ(force->largest_context(), beads.size() / communicator.size());
        auto const energies = force->energies(), all = whole->energies();
        for (std::size_t i = 0; i < all.size(); ++i)
            EXPECT_NEAR(energies[i].value, all[i].value, 1e-12 * std::abs(all[i].value));
    });
}

TEST_F(Replicas, DoNotGoIntoRanksInPieces) {
    on_ranks([&](Communicator const& communicator) {
        if (communicator.size() == 1) return;
        BeadSystem const beads = replicas_of(one_, communicator.size() + 1, communicator.size());
        EXPECT_NE(complaint([&] {
                      make_openmm_force(on_reference(), beads, communicator);
                  }).find("replicas do not go into"),
                  std::string::npos);
    });
}

TEST_F(Replicas, RefuseForcesThatJoinThem) {
    auto const serial = serial_communicator();
    BeadSystem const all = replicas_of(one_, 2);
    EXPECT_EQ(complaint([&] { make_openmm_force(with_every_force({}), all, *serial); }),
              "the force CustomExternalForce depends on places in space, which replicas do not "
              "share (scene.yaml: replicas): leave `replicas` out and run the scene with several "
              "seeds");
    auto const complaint_about = [&](OpenMM::Force const& extra) {
        OpenMmSpec spec = on_reference();
        add_changes({.extra = {scratch_file("replicas-extra.xml", xml_of(extra))},
                     .leave_out = {},
                     .links = {}},
                    spec);
        return complaint([&] { make_openmm_force(spec, all, *serial); });
    };
    OpenMM::CustomNonbondedForce everywhere("r");
    for (std::int64_t k = 0; k < one_.size(); ++k) everywhere.addParticle();
    EXPECT_NE(complaint_about(everywhere).find("has no cutoff"), std::string::npos);
    OpenMM::CustomCompoundBondForce held(2, "x1^2+distance(p1,p2)");
    held.addBond({0, 5});
    EXPECT_NE(complaint_about(held).find("depends on places"), std::string::npos);
}

TEST_F(Replicas, MayBePulledByDistances) {
    OpenMM::CustomCentroidBondForce pull(2, "50*(distance(g1,g2)-3)^2");
    pull.addGroup({0, 1, 2});
    pull.addGroup({30, 31});
    pull.addBond({0, 1});
    OpenMmSpec spec = on_reference();
    add_changes(
        {.extra = {scratch_file("replicas-pull.xml", xml_of(pull))}, .leave_out = {}, .links = {}},
        spec);
    compare(spec, 4, 1, 1e-11);
}

}  // namespace
}  // namespace catena::testing
