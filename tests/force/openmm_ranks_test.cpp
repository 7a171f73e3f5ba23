// Forces computed on several ranks are those of the whole System.
#include <OpenMM.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "scene/force_changes.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

/// Sums of the same doubles in another order: relative to the largest force.
double constexpr same = 1e-12;

/// Beads swing about where they started, each at its own pace and by less than makes lists of
/// ghosts anew; chains have gone along each other for `drifting` steps.
std::vector<Vec3> swung(BeadSystem const& beads, std::vector<Vec3> positions, int step,
                        int drifting) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> pace(0.01, 0.03), phase(0, 6.28);
    for (std::size_t c = 0; c + 1 < beads.chain_offset.size(); ++c)
        for (std::int64_t k = beads.chain_offset[c]; k < beads.chain_offset[c + 1]; ++k) {
            for (double& x : positions[k].data)
                x += 0.07 * std::sin(pace(random) * step + phase(random));
            positions[k][0] += 0.05 * static_cast<double>(c) * drifting;
        }
    return positions;
}

class Ranks : public ::testing::Test {
  protected:
    /// What must come of the lists on several ranks: made anew on the way or not, and on some rank
    /// without some bead of the scene.
    enum class Lists { last, are_made_anew, are_made_anew_of_all_beads };
    /// Forces that have Contexts of their own.
    enum class Layers { none, one };

    /// Evaluations along a walk of all beads.
    void compare(OpenMmSpec const& spec, BeadSystem const& all_beads, double stride, Lists lists,
                 Layers layers = Layers::none) {
        on_ranks([&](Communicator const& communicator) {
            BeadSystem const beads = split(all_beads, communicator.size());
            auto const serial = serial_communicator();
            auto const force = make_openmm_force(spec, beads, communicator);
            auto const whole =
                make_openmm_force(in_one_context(spec), split(all_beads, 1), *serial);
            EXPECT_EQ(layers_of(*force), layers == Layers::one ? 1 : 0);
            EXPECT_EQ(layers_of(*whole), 0);
            auto positions = wound(beads, 3);
            int const evaluations = 5;
            for (int i = 0; i < evaluations; ++i) {
                auto const expected = evaluate(*whole, positions);
                auto const own = evaluate(*force, beads, communicator.rank(), positions);
                EXPECT_LE(difference(own, expected, beads.first_of_rank[communicator.rank()]),
                          same * largest(expected))
                    << "evaluation " << i << " on " << communicator.size() << " ranks";
                if (i % 2 == 0) expect_same_energies(*force, *whole);
                shake(positions, stride, 100 + i);
            }
            std::int64_t const made = force->traffic().rebuilds;
            bool const anew = made > 1 && made < evaluations;
            EXPECT_EQ(anew, lists != Lists::last && communicator.size() > 1)
                << made << " on " << communicator.size() << " ranks";
            double const least = -communicator.max(-static_cast<double>(force->largest_context()));
            if (lists == Lists::are_made_anew && communicator.size() > 1) {
                EXPECT_LT(least, static_cast<double>(beads.size()));
            }
        });
    }

    static OpenMmSpec in_one_context(OpenMmSpec spec) {
        spec.layers = "none";
        return spec;
    }
    static OpenMmSpec layer_by_layer(OpenMmSpec spec) {
        spec.layers = "all";
        return spec;
    }
    static OpenMmSpec on_cpu() {
        OpenMmSpec spec = on_reference();
        spec.platform = "CPU";
        spec.switch_width = 0.2;  // no jumps where roundings take a pair across a cutoff
        return spec;
    }
    /// Of forces in single precision, relative to the largest: the coordinates of two beads in
    /// either Context are rounded by eps `extent` each, and overlaps of 0.05 nm make a force change
    /// by all of itself.
    static double in_single(double extent) { return 4 * 0x1p-24 * extent / 0.05; }
    static std::int64_t layers_of(OpenMmForce const& force) {
        auto const lines = force.description();
        return std::count_if(lines.begin(), lines.end(), [](std::string const& line) {
            return line.find(" in a Context of its own: ") != std::string::npos;
        });
    }
    static void expect_same_energies(OpenMmForce& force, OpenMmForce& whole,
                                     double tolerance = same) {
        auto const terms = force.energies(), expected = whole.energies();
        EXPECT_EQ(terms.size(), expected.size());
        for (std::size_t i = 0; i < std::min(terms.size(), expected.size()); ++i) {
            EXPECT_EQ(terms[i].name, expected[i].name);
            EXPECT_NEAR(terms[i].value, expected[i].value,
                        tolerance * std::max(1.0, std::abs(expected[i].value)));
        }
    }

    static OpenMmSpec of_system(OpenMM::System const& system, std::string const& name) {
        OpenMmSpec spec = on_reference("");
        spec.system = scratch_file(name, xml_of(system));
        return spec;
    }
};

TEST_F(Ranks, Calvados2) {
    compare(on_reference(),
            proteins({random_sequence(150, 1), random_sequence(90, 2), random_sequence(60, 3)}),
            0.1, Lists::are_made_anew, Layers::one);
}

TEST_F(Ranks, Calvados2InABox) {
    compare(on_reference(),
            proteins({random_sequence(200, 4), random_sequence(20, 5)}, 1, Vec3{{62, 8.5, 9}}), 0.1,
            Lists::are_made_anew, Layers::one);
}

TEST_F(Ranks, Calvados2InABoxThatHoldsNoMoreThanTheReach) {
    compare(on_reference(),
            proteins({random_sequence(27, 7), random_sequence(26, 8)}, 1, Vec3{{8.5, 8.5, 9}}), 0.1,
            Lists::are_made_anew_of_all_beads, Layers::one);
}

/// Nobody has moved but one chain, from far away to the other: its beads were no ghosts.
TEST_F(Ranks, AChainThatComesFromAfar) {
    BeadSystem const all_beads = proteins({random_sequence(30, 23), random_sequence(30, 24)});
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        auto const serial = serial_communicator();
        auto const force = make_openmm_force(on_reference(), beads, communicator);
        auto const whole =
            make_openmm_force(in_one_context(on_reference()), split(all_beads, 1), *serial);
        auto positions = wound(beads, 3);
        for (std::int64_t k = 30; k < 60; ++k) positions[k][2] += 12;
        for (double const step : {0.0, -0.2, -9.0, -2.8, 6.0}) {
            for (std::int64_t k = 30; k < 60; ++k) positions[k][2] += step;
            auto const expected = evaluate(*whole, positions);
            auto const own = evaluate(*force, beads, communicator.rank(), positions);
            EXPECT_LE(difference(own, expected, beads.first_of_rank[communicator.rank()]),
                      same * largest(expected))
                << "step " << step << " on " << communicator.size() << " ranks";
        }
    });
}

TEST_F(Ranks, OnAWorkerThread) {
    OpenMmSpec spec = on_reference();
    spec.path = "host";
    compare(spec, proteins({random_sequence(150, 9)}), 0.1, Lists::are_made_anew, Layers::one);
}

TEST_F(Ranks, FewerBeadsThanRanks) {
    compare(on_reference(), proteins({"K"}), 0.1, Lists::last);
    compare(on_reference(), proteins({"KD", "E"}), 0.1, Lists::last);
}

TEST_F(Ranks, EveryForce) {
    BeadSystem const beads =
        proteins({random_sequence(75, 10), random_sequence(74, 11), random_sequence(35, 12)});
    compare(of_system(*every_force(beads), "every.xml"), beads, 0.03, Lists::are_made_anew);
}

TEST_F(Ranks, EveryForceInABox) {
    BeadSystem const beads =
        proteins({random_sequence(75, 13), random_sequence(74, 14), random_sequence(35, 15)}, 1,
                 Vec3{{24, 7, 7}});
    compare(of_system(*every_force(beads), "every-box.xml"), beads, 0.03, Lists::are_made_anew);
}

TEST_F(Ranks, InOneContext) {
    BeadSystem const beads =
        proteins({random_sequence(200, 4), random_sequence(20, 5)}, 1, Vec3{{62, 8.5, 9}});
    compare(in_one_context(on_reference()), beads, 0.1, Lists::are_made_anew);
}

/// "every.xml": a force between charges is a layer, with exclusions among them.
TEST_F(Ranks, LayerByLayer) {
    BeadSystem const beads =
        proteins({random_sequence(75, 10), random_sequence(74, 11), random_sequence(35, 12)});
    compare(layer_by_layer(of_system(*every_force(beads), "layers.xml")), beads, 0.03,
            Lists::are_made_anew, Layers::one);
    BeadSystem const in_box =
        proteins({random_sequence(75, 13), random_sequence(74, 14), random_sequence(35, 15)}, 1,
                 Vec3{{24, 7, 7}});
    compare(layer_by_layer(of_system(*every_force(in_box), "layers-box.xml")), in_box, 0.03,
            Lists::are_made_anew, Layers::one);
}

TEST_F(Ranks, ALayerWithoutBeadsOnSomeRanks) {
    compare(layer_by_layer(on_reference()), proteins({"KDKD" + std::string(300, 'A')}), 0.1,
            Lists::are_made_anew, Layers::one);
    compare(layer_by_layer(on_reference()), proteins({std::string(60, 'G')}), 0.1,
            Lists::are_made_anew, Layers::one);  // of the two ends
}

/// They are taken off all the same, and their terms stay.
TEST_F(Ranks, ForcesInWhichNoBeadActsHaveNoLayer) {
    BeadSystem const all_beads =
        proteins({random_sequence(150, 1), random_sequence(90, 2), random_sequence(60, 3)});
    auto const system = bare_system(all_beads);
    auto const add_charges = [&](char const* name, double cutoff, double charge) {
        auto* pairs = new OpenMM::CustomNonbondedForce("q1*q2*exp(-r)");
        pairs->addPerParticleParameter("q");
        pairs->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
        pairs->setCutoffDistance(cutoff);
        pairs->setName(name);
        for (int i = 0; i < 300; ++i) pairs->addParticle({charge});
        system->addForce(pairs);
    };
    add_charges("near", 2, 1);
    add_charges("far", 4, 0);
    OpenMmSpec const spec = layer_by_layer(of_system(*system, "no-layer.xml"));
    compare(spec, all_beads, 0.05, Lists::are_made_anew);
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        auto const force = make_openmm_force(spec, beads, communicator);
        evaluate(*force, beads, communicator.rank(), wound(beads, 3));
        auto const terms = force->energies();
        EXPECT_EQ(terms.size(), 2u);
        EXPECT_EQ(terms.front().name, "near");
        EXPECT_GT(terms.front().value, 1);
        EXPECT_EQ(terms.back().name, "far");
        EXPECT_EQ(terms.back().value, 0);
    });
}

TEST_F(Ranks, LayersOfChainsInAnotherOrderThanTheirParticles) {
    BeadSystem const in_system = proteins({random_sequence(20, 20), random_sequence(60, 21)});
    BeadSystem scene = proteins({random_sequence(60, 21), random_sequence(20, 20)});
    std::swap(scene.chain_name[0], scene.chain_name[1]);
    OpenMmSpec spec = layer_by_layer(of_system(*every_force(in_system), "layers-order.xml"));
    spec.map = {{"A", {0, 19}}, {"B", {20, 79}}};
    compare(spec, scene, 0.03, Lists::are_made_anew, Layers::one);
}

/// In single precision, that shifts and cells are kept while beads leave the box, and ghosts come
/// and go, adds no more than rounding.
TEST_F(Ranks, PlacesThatAreKept) {
    int constexpr quiet = 270, steps = 330,
                  compared_every = 30;  // places are kept for 250 evaluations, unless ghosts change
    double constexpr edge = 48;
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{edge, 9, 9}}}}) {
        BeadSystem const all_beads = proteins(
            {random_sequence(60, 25), random_sequence(50, 26), random_sequence(40, 27)}, 1, box);
        on_ranks([&](Communicator const& communicator) {
            BeadSystem const beads = split(all_beads, communicator.size());
            auto const serial = serial_communicator();
            auto const force = make_openmm_force(on_cpu(), beads, communicator);
            EXPECT_EQ(layers_of(*force), 1);
            auto const start = wound(beads, 3);
            std::int64_t ghosts = 0;
            for (int step = 0; step <= steps; ++step) {
                auto const positions = swung(beads, start, step, std::max(0, step - quiet));
                auto const own = evaluate(*force, beads, communicator.rank(), positions);
                if (step == quiet && communicator.size() > 1) {
                    EXPECT_EQ(force->traffic().rebuilds, 1);
                    ghosts = force->traffic().ghosts;
                }
                if (step % compared_every != 0) continue;
                auto const fresh =
                    make_openmm_force(in_one_context(on_cpu()), split(all_beads, 1), *serial);
                auto const expected = evaluate(*fresh, positions);
                EXPECT_LE(difference(own, expected, beads.first_of_rank[communicator.rank()]),
                          in_single(edge) * largest(expected))
                    << "step " << step << " on " << communicator.size() << " ranks"
                    << (box ? ", in a box" : "");
                expect_same_energies(*force, *fresh, in_single(edge));
            }
            if (communicator.size() == 1) return;
            EXPECT_GT(force->traffic().rebuilds, 10);
            EXPECT_LT(force->contexts(),
                      force->traffic().rebuilds);  // their particles were exchanged
            EXPECT_EQ(communicator.max(force->traffic().ghosts != ghosts ? 1 : 0), 1);
        });
    }
}

/// A state that is set far away, as energies find them whose last output was long ago.
TEST_F(Ranks, BeadsThatAreFarAwayAllAtOnce) {
    BeadSystem const all_beads = proteins({random_sequence(60, 25), random_sequence(50, 26)});
    double constexpr length = 18;
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(all_beads, communicator.size());
        auto const serial = serial_communicator();
        auto const force = make_openmm_force(on_cpu(), beads, communicator);
        auto const whole =
            make_openmm_force(in_one_context(on_cpu()), split(all_beads, 1), *serial);
        auto const start = wound(beads, 3);
        auto const expected = evaluate(*whole, start);
        for (double const away : {0.0, 1024.0, -4096.0}) {
            auto positions = start;
            for (Vec3& x : positions) x = x + Vec3{{away, -away, 2 * away}};
            auto const own = evaluate(*force, beads, communicator.rank(), positions);
            EXPECT_LE(difference(own, expected, beads.first_of_rank[communicator.rank()]),
                      in_single(length) * largest(expected))
                << away << " nm away on " << communicator.size() << " ranks";
            expect_same_energies(*force, *whole, in_single(length));
        }
    });
}

TEST_F(Ranks, BondedForcesAlone) {
    BeadSystem const beads = proteins({random_sequence(60, 16)});
    auto const system = bare_system(beads);
    auto* bonds = new OpenMM::CustomBondForce("r^2");
    for (int i = 0; i + 2 < 60; ++i) bonds->addBond(i, i + 2);
    system->addForce(bonds);
    compare(of_system(*system, "bonded.xml"), beads, 0.1, Lists::last);
}

/// Pulls the middles of groups that lie on different ranks, holds one at a place, and bends triples
/// by a table.
void add_bonds_of_many(OpenMM::System& system, int n, bool periodic) {
    auto* centroids = new OpenMM::CustomCentroidBondForce(2, "k*(distance(g1,g2)-1)^2+0.1*x1^2");
    centroids->addPerBondParameter("k");
    std::vector<int> front, back, middle;
    for (int i = 0; i < 10; ++i) {
        front.push_back(i);
        back.push_back(n - 1 - i);
        middle.push_back(n / 2 + i);
    }
    centroids->addGroup(front);
    centroids->addGroup(back, std::vector<double>(10, 0.5));
    centroids->addGroup(middle);
    centroids->addBond({0, 1}, {3});
    centroids->addBond({2, 0}, {7});
    auto* triples = new OpenMM::CustomCompoundBondForce(3, "k*bend(distance(p1,p3))+0.01*z2^2");
    triples->addGlobalParameter("k", 4);
    triples->addTabulatedFunction(
        "bend", new OpenMM::Continuous1DFunction({0, 0.1, 0.4, 0.2, 0.3, 0.1, 0}, 0, 12));
    for (int i = 0; i + 4 < n; ++i) triples->addBond({i, i + 2, i + 4});
    centroids->setUsesPeriodicBoundaryConditions(periodic);
    triples->setUsesPeriodicBoundaryConditions(periodic);
    system.addForce(centroids);
    system.addForce(triples);
}

TEST_F(Ranks, CentroidsAndBondsOfManyBeads) {
    for (std::optional<Vec3> const& box :
         {std::optional<Vec3>{}, std::optional<Vec3>{Vec3{{9, 10, 11}}}}) {
        BeadSystem const beads =
            proteins({random_sequence(40, 25), random_sequence(30, 26)}, 1, box);
        auto const system = bare_system(beads);
        add_bonds_of_many(*system, 70, box.has_value());
        compare(of_system(*system, "many.xml"), beads, 0.1, Lists::last);
    }
}

/// A force that the scene adds to a builder's is split like those of a System.
TEST_F(Ranks, ExtraForcesOfABuilder) {
    BeadSystem const beads =
        proteins({random_sequence(150, 1), random_sequence(90, 2), random_sequence(60, 3)});
    auto const system = bare_system(beads);
    add_bonds_of_many(*system, 300, false);
    OpenMmSpec spec = on_reference();
    add_changes({{scratch_file("pull.xml", xml_of(system->getForce(0))),
                  scratch_file("bend.xml", xml_of(system->getForce(1)))},
                 {},
                 {}},
                spec);
    compare(spec, beads, 0.1, Lists::are_made_anew, Layers::one);
}

TEST_F(Ranks, WithoutACutoff) {
    BeadSystem const beads = proteins({random_sequence(40, 17), random_sequence(20, 18)});
    auto const system = bare_system(beads);
    auto* pairs = new OpenMM::CustomNonbondedForce("1/r");
    for (int i = 0; i < 60; ++i) pairs->addParticle();
    system->addForce(pairs);
    compare(of_system(*system, "everywhere.xml"), beads, 0.1, Lists::last);
}

TEST_F(Ranks, Replicated) {
    BeadSystem const beads = proteins({random_sequence(40, 19)}, 1, Vec3{{5, 5, 5}});
    auto const system = bare_system(beads);
    auto* charges = new OpenMM::NonbondedForce;
    charges->setNonbondedMethod(OpenMM::NonbondedForce::PME);
    charges->setCutoffDistance(2);
    charges->setEwaldErrorTolerance(1e-3);
    for (int i = 0; i < 40; ++i) charges->addParticle(i % 2 - 0.5, 0.3, 0.2);
    system->addForce(charges);
    OpenMmSpec spec = of_system(*system, "pme.xml");
    spec.replicate = true;
    compare(spec, beads, 0.05, Lists::last);
    spec.replicate = false;
    on_ranks([&](Communicator const& communicator) {
        if (communicator.size() == 1) return;
        std::string const text = complaint(
            [&] { make_openmm_force(spec, split(beads, communicator.size()), communicator); });
        EXPECT_EQ(text, "NonbondedForce (PME) cannot be split over " +
                            std::to_string(communicator.size()) +
                            " ranks (scene.yaml: forces.openmm): set forces.openmm.replicate: "
                            "true, so that every rank computes the whole System, "
                            "or run on one rank");
    });
}

TEST_F(Ranks, ChainsInAnotherOrderThanTheirParticles) {
    BeadSystem const in_system = proteins({random_sequence(20, 20), random_sequence(60, 21)});
    BeadSystem scene = proteins({random_sequence(60, 21), random_sequence(20, 20)});
    std::swap(scene.chain_name[0], scene.chain_name[1]);
    OpenMmSpec spec = of_system(*every_force(in_system), "order.xml");
    spec.map = {{"A", {0, 19}}, {"B", {20, 79}}};
    compare(spec, scene, 0.03, Lists::are_made_anew);

    // The same forces as in the System's own order.
    auto const serial = serial_communicator();
    auto positions = wound(in_system, 5);
    spec.map.clear();
    auto const expected = evaluate(*make_openmm_force(spec, in_system, *serial), positions);
    spec.map = {{"A", {0, 19}}, {"B", {20, 79}}};
    std::rotate(positions.begin(), positions.begin() + 20, positions.end());
    auto forces = evaluate(*make_openmm_force(spec, scene, *serial), positions);
    std::rotate(forces.begin(), forces.begin() + 60, forces.end());
    EXPECT_LT(difference(forces, expected), same * largest(expected));
}

TEST_F(Ranks, OneRanksTroubleIsEverybodysMessage) {
    BeadSystem const beads = proteins({"KDEKDE"});
    auto const system = bare_system(beads);
    auto* pairs = new OpenMM::CustomBondForce("r^");  // no expression
    pairs->addBond(0, 2);
    system->addForce(pairs);
    OpenMmSpec const spec = of_system(*system, "wrong.xml");
    on_ranks([&](Communicator const& communicator) {
        std::string const text = complaint(
            [&] { make_openmm_force(spec, split(beads, communicator.size()), communicator); });
        EXPECT_TRUE(text.starts_with("OpenMM refuses these forces: ")) << text;
        EXPECT_NE(text.find(" (scene.yaml: forces.openmm): "), std::string::npos) << text;
    });
}

TEST_F(Ranks, ThePathIsTheSameOnEveryRank) {
    on_ranks([&](Communicator const& communicator) {
        BeadSystem const beads = split(proteins({random_sequence(30, 22)}), communicator.size());
        OpenMmSpec spec = on_reference();
        spec.path = "auto";
        auto const force = make_openmm_force(spec, beads, communicator);
        EXPECT_EQ(force->path(), "inline");
        bool both = false;
        for (int i = 0; i < 14; ++i) {
            evaluate(*force, beads, communicator.rank(), wound(beads, 3));
            both = both || force->path() == "host";
        }
        EXPECT_TRUE(both);
        EXPECT_EQ(communicator.sum(force->path() == "host" ? 1 : 0) % communicator.size(), 0);
        bool found = false;
        for (auto const& line : force->description())
            found = found || line.find("the faster one: from begin to end ") != std::string::npos;
        EXPECT_TRUE(found);
    });
}

}  // namespace
}  // namespace catena::testing
