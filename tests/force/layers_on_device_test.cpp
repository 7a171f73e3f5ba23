// Layers of forces on path `device`, with plain memory in the place of a GPU: forces and energies
// are those of the whole System, whatever order the particles of each Context are in.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "force/rank_forces.hpp"
#include "neighbours/bead_tables.hpp"
#include "neighbours/layer_particles.hpp"
#include "systems/force_layers.hpp"
#include "tests/force/beads.hpp"
#include "tests/force/every_force.hpp"
#include "tests/force/ranks.hpp"

namespace catena::testing {
namespace {

using OpenMM::CustomNonbondedForce;

double constexpr unit = 4294967296.0;  // of fixed-point forces

/// The arrays of a Context on a GPU, in an order of their own.
class Arrays {
  public:
    Arrays(OpenMM::Context& context, std::uint64_t seed)
        : context_(context),
          particle_at_(static_cast<std::size_t>(context.getSystem().getNumParticles())) {
        std::iota(particle_at_.begin(), particle_at_.end(), 0);
        std::shuffle(particle_at_.begin(), particle_at_.end(), std::mt19937_64(seed));
        std::size_t const padded = 32 * ((particle_at_.size() + 31) / 32);
        position.assign(4 * padded, NAN);
        force.assign(3 * padded, 77);
        place.resize(particle_at_.size());
        for (std::size_t i = 0; i < particle_at_.size(); ++i)
            place[static_cast<std::size_t>(particle_at_[i])] = static_cast<std::int32_t>(i);
    }
    void compute() {
        std::vector<OpenMM::Vec3> x(particle_at_.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            x[static_cast<std::size_t>(particle_at_[i])] = {position[4 * i], position[4 * i + 1],
                                                            position[4 * i + 2]};
        context_.setPositions(x);
        auto const f = context_.getState(OpenMM::State::Forces).getForces();
        for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                force[i + c * force.size() / 3] = static_cast<std::int64_t>(
                    f[static_cast<std::size_t>(particle_at_[i])][static_cast<int>(c)] * unit);
    }
    std::int64_t places() const { return std::ssize(force) / 3; }
    std::vector<int> const& particle_at() const { return particle_at_; }

    std::vector<double> position;
    std::vector<std::int64_t> force;
    std::vector<std::int32_t> place;

  private:
    OpenMM::Context& context_;
    std::vector<int> particle_at_;
};

/// What cuda/openmm/gpu_layer.cpp does, on the host.
void add_layer(DeviceLayer const& layer, Arrays& all, std::uint64_t seed) {
    Arrays some(*layer.context, seed);
    std::vector<std::int32_t> from;
    for (int const p : some.particle_at())
        from.push_back(
            all.place[static_cast<std::size_t>(layer.particle[static_cast<std::size_t>(p)])]);
    LayerPositions<double> const positions{from.data(), all.position.data(), some.position.data()};
    for (std::int64_t i = 0; i < std::ssize(from); ++i) positions(i);
    some.compute();
    LayerForces const forces{{all.force.data(), all.places(), from.data()},
                             some.force.data(),
                             some.places(),
                             std::ssize(from)};
    for (std::int64_t i = 0; i < 3 * forces.count; ++i) forces(i);
}

/// What a path computes at positions `x` of the plan's beads.
std::vector<Vec3> forces_of(DevicePathPlan const& plan, OpenMM::Context& context,
                            std::vector<Vec3> const& x, std::uint64_t seed) {
    Arrays all(context, seed);
    std::vector<DeviceBead> beads;
    for (std::size_t k = 0; k < x.size(); ++k)
        beads.push_back(
            bead_at(all.place[static_cast<std::size_t>(plan.particle[k])], x[k], plan.box));
    std::int64_t trouble = -1;
    DeviceParticles particles;
    particles.bead = beads.data();
    particles.double_position = all.position.data();
    particles.force = all.force.data();
    particles.places = all.places();
    particles.trouble = &trouble;
    if (plan.box) particles.box = *plan.box;
    for (std::size_t k = 0; k < x.size(); ++k) particles.put(static_cast<std::int64_t>(k), x[k]);
    all.compute();
    for (DeviceLayer const& layer : plan.layers) add_layer(layer, all, ++seed);
    std::vector<Vec3> forces;
    for (std::size_t k = 0; k < x.size(); ++k)
        forces.push_back(particles.force_on(static_cast<std::int64_t>(k)));
    EXPECT_EQ(trouble, -1);
    return forces;
}

class LayersOnDevice : public ::testing::Test {
  protected:
    /// The bead chains, 90 beads that wind about lines far outside the box.
    static BeadSystem beads(std::optional<Vec3> const& box) {
        return proteins({random_sequence(40, 7), random_sequence(20, 8), random_sequence(30, 9)}, 1,
                        box);
    }
    static std::vector<Vec3> positions(BeadSystem const& beads) {
        std::vector<Vec3> x = wound(beads, 3);
        for (std::size_t i = 0; beads.box && i < x.size(); ++i)
            for (int c = 0; c < 3; ++c) x[i][c] += (i < 40 ? 2 : -3) * (*beads.box)[c];
        return x;
    }
    /// Compares `layers` layers, placed as `placement`, with the whole System.
    void compare(OpenMmSpec const& spec, BeadSystem const& beads, std::size_t layers,
                 Placement placement) {
        OpenMmModel const whole = model_of(spec, beads);
        OpenMmModel rest = model_of(spec, beads);
        std::vector<ForceLayer> const taken = take_layers(rest, beads, 1);
        ASSERT_EQ(taken.size(), layers);
        OpenMmPlatform const platform = choose_platform(spec, beads, *serial_, -1);
        auto const forces = make_layers_on_device({rest, platform, beads, *serial_, box_of(rest)},
                                                  taken, make_whole_forces);
        EXPECT_EQ(forces->contexts(), static_cast<std::int64_t>(layers) + 1);
        EXPECT_EQ(forces->largest_context(), beads.size());
        EXPECT_FALSE(forces->ghosts_are_due());
        DevicePathPlan const plan = forces->plan(true);
        EXPECT_EQ(plan.box.has_value(), placement == Placement::wrapped);
        EXPECT_EQ(plan.shifted, placement == Placement::shifted);
        std::vector<Vec3> const x = positions(beads);
        ForceContext one(whole.system, platform, box_of(whole));
        one.set_positions(of_particles(whole, x), x.size());
        std::vector<Vec3> expected;
        auto const of_one = one.forces();
        for (int const p : particles_of_beads(whole.bead_of_particle)) {
            OpenMM::Vec3 const& f = of_one[static_cast<std::size_t>(p)];
            expected.push_back({{f[0], f[1], f[2]}});
        }
        double const tolerance = 1e-12 * largest(expected) + 2 * 4 / unit;
        for (std::uint64_t seed : {1, 100})
            EXPECT_LE(
                difference(forces_of(plan, forces->device_context()->context(), x, seed), expected),
                tolerance);
        EXPECT_LE(difference(forces->forces_again(), expected), tolerance);
        std::vector<double> of_whole(whole.terms.size()), found(whole.terms.size());
        one.find_energies(of_whole);
        forces->find_energies(nullptr, found);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], of_whole[i], 1e-12 * std::max(1.0, std::abs(of_whole[i])))
                << whole.terms[i];
    }
    static OpenMmSpec of_system(OpenMM::System const& system, std::string const& name) {
        OpenMmSpec spec = on_reference("");
        spec.system = scratch_file(name, xml_of(system));
        return spec;
    }
    /// Charges on some of the beads; their sign changes from bead to bead.
    static CustomNonbondedForce* charges(BeadSystem const& beads, double cutoff, bool periodic,
                                         int every, int first = 0) {
        auto* force = new CustomNonbondedForce("20*q1*q2*exp(-r)/r");
        force->addPerParticleParameter("q");
        force->setNonbondedMethod(periodic ? CustomNonbondedForce::CutoffPeriodic
                                           : CustomNonbondedForce::CutoffNonPeriodic);
        force->setCutoffDistance(cutoff);
        for (std::int64_t i = 0; i < beads.size(); ++i)
            force->addParticle({i % every == first ? (i % 2 ? 1.0 : -1.0) : 0.0});
        return force;
    }

  private:
    static OpenMmModel model_of(OpenMmSpec const& spec, BeadSystem const& beads) {
        return spec.system.empty() ? calvados2_model(spec, beads) : system_model(spec, beads);
    }
    static std::vector<Vec3> of_particles(OpenMmModel const& model, std::vector<Vec3> const& x) {
        std::vector<Vec3> of_particle;
        for (std::int64_t const bead : model.bead_of_particle)
            of_particle.push_back(x[static_cast<std::size_t>(bead)]);
        return of_particle;
    }
    std::optional<Vec3> box_of(OpenMmModel const& model) const {
        return model.system->usesPeriodicBoundaryConditions() ? box_ : std::nullopt;
    }

    std::unique_ptr<Communicator> serial_ = serial_communicator();

  protected:
    Vec3 const edges_{{40, 9, 9}};
    std::optional<Vec3> const box_ = edges_;
};

TEST_F(LayersOnDevice, ChainsThatHaveLeftTheBox) {
    compare(on_reference(), beads(box_), 1, Placement::wrapped);
}

TEST_F(LayersOnDevice, WithoutABox) {
    compare(on_reference(), beads(std::nullopt), 1, Placement::shifted);
}

/// External forces depend on places: positions are those of the chains.
TEST_F(LayersOnDevice, BesideEveryForce) {
    BeadSystem const in_box = beads(box_);
    auto const system = every_force(in_box);
    compare(of_system(*system, "layers-on-device.xml"), in_box, 1, Placement::as_given);
}

TEST_F(LayersOnDevice, OfDifferentParticles) {
    BeadSystem const in_box = beads(box_);
    auto const system = bare_system(in_box);
    system->addForce(charges(in_box, 1.5, true, 1));
    system->addForce(charges(in_box, 3, true, 3));
    system->addForce(charges(in_box, 4.4, true, 7, 2));
    compare(of_system(*system, "layers-of-particles.xml"), in_box, 2, Placement::wrapped);
}

TEST_F(LayersOnDevice, WithoutOtherForces) {
    BeadSystem const in_box = beads(box_);
    auto const system = bare_system(in_box);
    system->addForce(charges(in_box, 4, true, 4));
    compare(of_system(*system, "layers-alone.xml"), in_box, 1, Placement::wrapped);
}

/// Bonds that do not look for nearest images: no bead may be moved by itself.
TEST_F(LayersOnDevice, BesideBondsAcrossAFace) {
    BeadSystem const in_box = beads(box_);
    auto const system = bare_system(in_box);
    auto* bonds = new OpenMM::HarmonicBondForce;
    for (int i = 0; i + 7 < static_cast<int>(in_box.size()); i += 3) bonds->addBond(i, i + 7, 1, 2);
    system->addForce(bonds);
    system->addForce(charges(in_box, 4, true, 4));
    compare(of_system(*system, "layers-bonds.xml"), in_box, 1, Placement::shifted);
}

/// On the host nobody has a share: each rank computes all pairs of its Contexts.
TEST_F(LayersOnDevice, WhereRanksShareOutPairs) {
    on_ranks([&](Communicator const& communicator) {
        int const ranks = communicator.size(), rank = communicator.rank();
        if (ranks == 1) return;
        BeadSystem const all = split(beads(box_), ranks);
        OpenMmSpec const spec = on_reference();
        OpenMmModel model = calvados2_model(spec, all);
        auto const serial = serial_communicator();
        auto const oracle = make_openmm_force(spec, split(all, 1), *serial);
        std::vector<Vec3> const x = positions(all);
        std::vector<Vec3> const expected = evaluate(*oracle, x);
        std::vector<EnergyTerm> const energies = oracle->energies();
        auto const layers = take_layers(model, all, 1);
        OpenMmPlatform const platform = choose_platform(spec, all, communicator, -1);
        auto const forces = make_layers_on_device({model, platform, all, communicator, all.box},
                                                  layers, make_pair_forces);
        EXPECT_TRUE(forces->shares_pairs());
        DevicePathPlan plan = forces->plan(true);
        EXPECT_NE(plan.halo, nullptr);
        EXPECT_EQ(plan.layers.size(), 1u);
        plan.particle =
            particles_of_beads(model.bead_of_particle);  // positions of all have arrived
        std::vector<Vec3> const found = forces_of(plan, forces->device_context()->context(), x, 11);
        EXPECT_LE(difference(found, expected), 1e-12 * largest(expected) + 8 / unit);
        std::vector<Vec3> again = forces->forces_again();
        EXPECT_EQ(std::ssize(again), all.first_of_rank[rank + 1] - all.first_of_rank[rank]);
        for (Vec3& f : again) f = (1.0 / ranks) * f;
        EXPECT_LE(difference(again, expected, all.first_of_rank[rank]), 1e-12 * largest(expected));
        std::vector<double> sum(energies.size());
        forces->find_energies(nullptr, sum);
        for (std::size_t i = 0; i < sum.size(); ++i)
            EXPECT_NEAR(sum[i] / ranks, energies[i].value,
                        1e-12 * std::max(1.0, std::abs(energies[i].value)));
    });
}

}  // namespace
}  // namespace catena::testing
