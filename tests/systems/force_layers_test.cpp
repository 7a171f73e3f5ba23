// Which forces get a Context of their own, and what their layer is made of.
#include "systems/force_layers.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <utility>

#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"

namespace catena::testing {
namespace {

using OpenMM::CustomNonbondedForce;

/// Charges q1 q2, those of some of the particles; a force of the same form acts on all where every
/// one has some.
std::unique_ptr<CustomNonbondedForce> charges(double cutoff, std::vector<double> const& q) {
    auto force = std::make_unique<CustomNonbondedForce>("q1*q2*exp(-r)");
    force->addPerParticleParameter("q");
    force->setNonbondedMethod(CustomNonbondedForce::CutoffNonPeriodic);
    force->setCutoffDistance(cutoff);
    for (double const each : q) force->addParticle({each});
    return force;
}

class Layers : public ::testing::Test {
  protected:
    int constexpr static beads_ = 8;
    std::vector<double> const all_ = std::vector<double>(beads_, 1.0),
                              some_{0, 1, 0, 0, -1, 0, 0, 0};

    OpenMmModel model(std::vector<std::unique_ptr<OpenMM::Force>> forces) const {
        OpenMmModel m;
        m.system = bare_system(scene_);
        for (auto& force : forces) {
            m.terms.push_back("force " + std::to_string(m.terms.size()));
            force->setForceGroup(m.system->getNumForces());
            m.system->addForce(force.release());
        }
        for (int p = 0; p < beads_; ++p) m.bead_of_particle.push_back(p);
        return m;
    }
    template <class... Force>
    OpenMmModel model_of(std::unique_ptr<Force>... force) const {
        std::vector<std::unique_ptr<OpenMM::Force>> forces;
        (forces.push_back(std::move(force)), ...);
        return model(std::move(forces));
    }
    std::size_t taken(OpenMmModel m, double most_pairs = 1) const {
        return take_layers(m, scene_, most_pairs).size();
    }

    BeadSystem scene_ = proteins({"AKAAD", "AAA"});
};

TEST_F(Layers, HoldTheBeadsThatActInForcesThatReachFarther) {
    BeadSystem scene = scene_;
    scene.by_rank = {5, 6, 7, 0, 1, 2, 3, 4};  // the other chain first
    scene.first_of_rank = {0, 4, 4, 8};        // the middle rank has none
    OpenMmModel m = model_of(charges(2, all_), charges(4, some_));
    auto& pairs = dynamic_cast<CustomNonbondedForce&>(m.system->getForce(1));
    pairs.addExclusion(1, 4);
    pairs.addExclusion(0, 1);
    auto const layers = take_layers(m, scene, 1);
    ASSERT_EQ(layers.size(), 1u);
    ForceLayer const& layer = layers.front();
    EXPECT_EQ(layer.bead, (std::vector<std::int64_t>{1, 4}));
    EXPECT_EQ(layer.beads.number, layer.bead);
    EXPECT_EQ(layer.beads.chain_offset, (std::vector<std::int64_t>{0, 2, 2}));
    EXPECT_EQ(layer.beads.first_of_rank, (std::vector<std::int64_t>{0, 0, 0, 2}));
    EXPECT_EQ(layer.beads.by_rank, (std::vector<std::int64_t>{0, 1}));
    EXPECT_EQ(own_places(layer, scene, 2), (std::vector<std::int64_t>{0, 3}));
    EXPECT_TRUE(own_places(layer, scene, 0).empty());
    EXPECT_EQ(layer.model.terms, std::vector<std::string>{"force 1"});
    EXPECT_EQ(layer.model.bead_of_particle, (std::vector<std::int64_t>{0, 1}));
    ASSERT_EQ(layer.model.system->getNumForces(), 1);
    auto const& of_layer =
        dynamic_cast<CustomNonbondedForce const&>(layer.model.system->getForce(0));
    EXPECT_EQ(of_layer.getForceGroup(), 1);
    EXPECT_EQ(of_layer.getNumParticles(), 2);
    EXPECT_EQ(of_layer.getNumExclusions(), 1);  // of the pair that is there
    ASSERT_EQ(m.system->getNumForces(), 1);
    EXPECT_EQ(m.system->getForce(0).getForceGroup(), 0);
    EXPECT_EQ(text_of(layer, scene),
              "force 1 in a Context of its own: it acts on 2 of 8 beads, up to 4 nm");
}

TEST_F(Layers, OfParticlesInAnotherOrderThanBeads) {
    OpenMmModel m = model_of(charges(2, all_), charges(4, some_));
    m.bead_of_particle = {5, 6, 7, 0, 1, 2, 3, 4};  // particles 1 and 4 are beads 6 and 1
    auto const layers = take_layers(m, scene_, 1);
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers.front().bead, (std::vector<std::int64_t>{1, 6}));
    EXPECT_EQ(layers.front().model.bead_of_particle, (std::vector<std::int64_t>{1, 0}));
    EXPECT_EQ(layers.front().beads.chain_offset, (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(particles_in(layers.front(), m), (std::vector<int>{1, 4}));
}

TEST_F(Layers, AreOneForEachReach) {
    std::vector<double> const one{0, 0, 0, 1, 0, 0, 0, 0};
    OpenMmModel m = model_of(charges(2, all_), charges(4, some_), charges(4, one), charges(9, one));
    auto const layers = take_layers(m, scene_, 1);
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[0].bead, (std::vector<std::int64_t>{3}));
    EXPECT_EQ(layers[1].bead, (std::vector<std::int64_t>{1, 3, 4}));
    EXPECT_EQ(layers[1].model.system->getNumForces(), 2);
    EXPECT_EQ(m.system->getNumForces(), 1);
}

TEST_F(Layers, ComeWhereTheyLeaveFewerPairs) {
    auto const two = [&] {
        return model_of(charges(2, all_), charges(4, some_));
    };  // 64 8 + 4 64 of 64 64: 19 %
    EXPECT_EQ(taken(two(), 0.18), 0u);
    EXPECT_EQ(taken(two(), 0.2), 1u);
    EXPECT_EQ(taken(model_of(charges(2, all_), charges(4, all_))), 0u);
    EXPECT_EQ(taken(model_of(charges(4, all_), charges(4, some_))), 0u);
    EXPECT_EQ(taken(model_of(charges(4, all_), charges(2, some_))), 0u);
    EXPECT_EQ(taken(model_of(charges(4, some_))), 1u);  // the rest has no pairs
}

TEST_F(Layers, AreNotOfForcesThatAskForMoreThanPairs) {
    auto const with = [&](std::function<void(CustomNonbondedForce&)> const& change) {
        auto far = charges(4, some_);
        change(*far);
        return taken(model_of(charges(2, all_), std::move(far)));
    };
    EXPECT_EQ(with([](CustomNonbondedForce&) {}), 1u);
    EXPECT_EQ(with([](CustomNonbondedForce& f) { f.addInteractionGroup({0, 1}, {4}); }), 0u);
    EXPECT_EQ(with([](CustomNonbondedForce& f) { f.setUseLongRangeCorrection(true); }), 0u);
    EXPECT_EQ(
        with([](CustomNonbondedForce& f) { f.setNonbondedMethod(CustomNonbondedForce::NoCutoff); }),
        0u);
    EXPECT_EQ(with([](CustomNonbondedForce& f) { f.setEnergyFunction("(q1+q2)*exp(-r)"); }),
              0u);  // all act
    // A force that cannot be split needs the System as it is, one that stays and reaches farther
    // its pairs.
    EXPECT_EQ(taken(model_of(charges(2, all_), charges(4, some_),
                             std::make_unique<OpenMM::CMMotionRemover>())),
              0u);
    auto groups = charges(5, all_);
    groups->addInteractionGroup({0}, {1});
    EXPECT_EQ(taken(model_of(charges(2, all_), charges(4, some_), std::move(groups))), 0u);
}

TEST_F(Layers, WithoutBeadsAreNone) {
    OpenMmModel m = model_of(charges(2, all_), charges(4, std::vector<double>(beads_, 0.0)));
    EXPECT_TRUE(take_layers(m, scene_, 1).empty());
    EXPECT_EQ(m.system->getNumForces(), 1);
}

TEST_F(Layers, BondedForcesStay) {
    auto bonds = std::make_unique<OpenMM::HarmonicBondForce>();
    bonds->addBond(0, 1, 0.4, 10);
    OpenMmModel m = model_of(std::move(bonds), charges(2, all_), charges(4, some_));
    EXPECT_EQ(take_layers(m, scene_, 1).size(), 1u);
    EXPECT_EQ(m.system->getNumForces(), 2);
}

}  // namespace
}  // namespace catena::testing
