// OpenMM's forces on beads that stay on the GPU, in one Context or in layers, are those that pass
// through the host from one Context.
#include <OpenMM.h>
#include <gtest/gtest.h>
#include <openmm/serialization/XmlSerializer.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "integrate/stepper.hpp"
#include "reader/load_scene.hpp"
#include "scene/force_changes.hpp"
#include "tests/cuda/openmm_scene.hpp"
#include "tests/support/gpu.hpp"

#define CATENA_TEST_DOMAINS                                                                    \
    "pdb: " CATENA_SOURCE_DIR                                                                  \
    "/inputs/multi-domain.cif, chain: A, model: calvados2, gaps: model, velocities: thermal, " \
    "rigid: ['A:1-34', 'A:47-80', 'A:93-126']"

namespace catena::test {
namespace {

struct Case {
    char const* name;
    char const* chains;
    char const* rest;
    bool layers = false;  // forces.openmm.layers: all
    bool extra = false;   // a force on a seventh of the beads acts in addition
};

/// Repulsion between some of the beads, up to 3.2 nm, in a file that OpenMM has written. It
/// excludes the pairs that CALVADOS excludes: OpenMM on GPUs demands that of forces in one Context.
class ExtraForce {
  public:
    explicit ExtraForce(Scene const& scene) {
        OpenMM::CustomNonbondedForce force("2*s1*s2*(1-r/3.2)^2");
        force.addPerParticleParameter("s");
        force.setNonbondedMethod(scene.box ? OpenMM::CustomNonbondedForce::CutoffPeriodic
                                           : OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
        force.setCutoffDistance(3.2);
        for (ChainSpec const& chain : scene.chains)
            for (std::size_t k = 0; k < chain.bead_count(); ++k) {
                int const i = force.addParticle({k % 7 == 3 ? 1.0 : 0.0});
                if (k > 0) force.addExclusion(i - 1, i);
            }
        std::ofstream text(file_);
        OpenMM::XmlSerializer::serialize<OpenMM::Force>(&force, "Force", text);
    }
    ~ExtraForce() { std::filesystem::remove(file_); }
    ExtraForce(ExtraForce const&) = delete;
    ExtraForce& operator=(ExtraForce const&) = delete;
    std::string const& file() const { return file_; }

  private:
    std::string file_ = (std::filesystem::temp_directory_path() /
                         ("catena-extra-" + std::to_string(::getpid()) + ".xml"))
                            .string();
};

/// What one way of computing found, and where it stood then.
struct Found {
    std::int64_t step = 0;
    Checkpoint checkpoint;
    std::vector<Vec3> forces, again, positions;
    std::vector<EnergyTerm> energies;
    std::map<std::string, std::vector<double>> state;
    DevicePath::PairLists lists;
    std::vector<DevicePath::PairLists> lists_of_layers;
};

class OpenMmOnGpu : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        need_gpu();
        if (IsSkipped() || HasFatalFailure()) return;
        if (cuda::why_no_device_path().empty()) return;
        if (std::getenv("CATENA_NEEDS_GPU") != nullptr)
            FAIL() << "NOT RUN, though CATENA_NEEDS_GPU is set: " << cuda::why_no_device_path();
        GTEST_SKIP() << "NOT RUN: " << cuda::why_no_device_path();
    }
    /// Layers are on path `device` alone: the host has one Context.
    Scene scene_with(std::string const& path, std::string const& precision) {
        Scene scene = parse_scene(
            openmm_scene(GetParam().chains, GetParam().rest, ", precision: " + precision),
            "scene.yaml");
        scene.solver.backend = Backend::cuda;
        scene.forces.openmm->path = path;
        scene.forces.openmm->layers = GetParam().layers && path == "device" ? "all" : "none";
        if (!GetParam().extra) return scene;
        if (!extra_) extra_ = std::make_unique<ExtraForce>(scene);
        add_changes({.extra = {extra_->file()}, .leave_out = {}, .links = {}},
                    *scene.forces.openmm);
        return scene;
    }
    std::size_t terms() const { return GetParam().extra ? 5 : 4; }
    std::int64_t contexts() const {
        return 1 + (GetParam().layers ? 1 : 0) + (GetParam().layers && GetParam().extra ? 1 : 0);
    }
    /// At step `last`, from the scene's start or from where another stood.
    Found found(std::string const& path, std::string const& precision, std::int64_t last,
                Found const* start = nullptr) {
        Scene const scene = scene_with(path, precision);
        ChainSystem system(scene, Axes::world, *communicator_);
        EXPECT_EQ(system.openmm()->path(), path);
        EXPECT_EQ(system.openmm()->contexts(), path == "device" ? contexts() : 1);
        auto stepper = make_stepper(system, scene.dynamics);
        Found f;
        f.step = start ? start->step : 0;
        if (start) {
            system.set_state(start->state);
            stepper->restore(start->checkpoint);
        }
        std::int64_t const steps = last - f.step;
        for (;; ++f.step) {
            stepper->prepare(nullptr);
            if (f.step == last) break;
            stepper->step(f.step, nullptr);
        }
        stepper->save(f.checkpoint);
        for (AbsoluteDynamics* group : system.absolute()) {
            View<3> const forces = group->bead_forces();
            ConstView<3> const positions = group->bead_positions();
            for (std::int64_t k = 0; k < forces.size; ++k) {
                f.forces.push_back(forces.load(k));
                f.positions.push_back(positions.load(k));
            }
        }
        f.energies = system.potential_energy();
        f.again = system.bead_forces();
        f.state = system.state();
        if (DevicePath const* const device = system.openmm()->device_path())
            f.lists = device->pair_lists(), f.lists_of_layers = device->pair_lists_of_layers();
        if (steps > 0) {
            EXPECT_GT(system.matrix_seconds(), 0);
            EXPECT_LE(system.hidden_seconds(), system.matrix_seconds() * (1 + 1e-12));
        }
        return f;
    }
    static double largest(std::vector<Vec3> const& all) {
        double value = 0;
        for (Vec3 const& v : all) value = std::max(value, norm(v));
        return value;
    }
    static double difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
        EXPECT_EQ(a.size(), b.size());
        double value = 0;
        for (std::size_t k = 0; k < a.size(); ++k) value = larger(value, norm(a[k] - b[k]));
        return value;
    }
    static void expect_close(Found const& a, Found const& b, double tolerance) {
        EXPECT_GT(largest(b.forces), 1);
        EXPECT_LE(difference(a.forces, b.forces), tolerance * largest(b.forces) + rounding);
        EXPECT_LE(difference(a.again, b.again), tolerance * largest(b.again) + rounding);
        ASSERT_EQ(a.energies.size(), b.energies.size());
        for (std::size_t i = 0; i < a.energies.size(); ++i) {
            EXPECT_EQ(a.energies[i].name, b.energies[i].name);
            EXPECT_NEAR(a.energies[i].value, b.energies[i].value,
                        tolerance * (1 + std::abs(b.energies[i].value)));
        }
    }
    /// OpenMM adds up forces in units of 2^-32 kJ/mol/nm, and what it rounds to them depends on the
    /// order of its particles.
    static constexpr double rounding = 16.0 / 4294967296.0;
    /// In mixed and single precision beads 0.4 nm apart have places rounded to 2^-24 of up to 40
    /// nm, and their force goes with the 13th power of the distance.
    static constexpr double of_places = 14 * 40 / 0.4 * 0x1p-24;
    std::unique_ptr<ExtraForce> extra_;
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_P(OpenMmOnGpu, ForcesAndEnergiesAreThoseThroughTheHost) {
    expect_close(found("device", "double", 0), found("host", "double", 0), 1e-12);
    // In a narrow box, OpenMM wraps blocks of beads about their centres if the cutoff is short, as
    // in a layer, and rounds their places anew.
    bool const layers = GetParam().layers;
    expect_close(found("device", "mixed", 0), found("host", "mixed", 0), layers ? of_places : 1e-6);
    expect_close(found("device", "single", 0), found("host", "single", 0),
                 layers ? of_places : 1e-5);
}

TEST_P(OpenMmOnGpu, AHundredSteps) {
    Found const device = found("device", "double", 100), host = found("host", "double", 100);
    EXPECT_LE(difference(device.positions, host.positions),
              1e-7);  // rounding, grown by the chains' own chaos
    expect_close(device, host, 1e-5);
}

TEST_P(OpenMmOnGpu, ARestartGoesOn) {
    Found const whole = found("device", "double", 40), half = found("device", "double", 20);
    Found const rest = found("device", "double", 40, &half);
    EXPECT_LE(difference(rest.positions, whole.positions), 1e-9);
    expect_close(rest, whole, 1e-8);
}

/// OpenMM's order and the cells are those of an earlier step, each bead in another cell than
/// afresh.
TEST_P(OpenMmOnGpu, AfterAnotherOrder) {
    for (auto const& [precision, tolerance] : {std::pair{"double", 1e-12}, {"mixed", of_places}}) {
        int constexpr steps = 1700;  // an order lasts 1,000 evaluations, or 400 lists of pairs
        Found const device = found("device", precision, steps);
        expect_close(device, found("host", precision, steps, &device), tolerance);
        expect_close(device, found("device", precision, steps, &device), tolerance);
        if (device.positions.size() < 2100) continue;  // OpenMM has no list of their pairs
        EXPECT_EQ(device.lists.made + device.lists.kept, steps);
        // What falls moves fast, and half as far for lists of half the reach.
        EXPECT_GT(device.lists.kept, GetParam().layers ? 0 : device.lists.made / 2);
        EXPECT_GT(device.lists.made, GetParam().layers ? 670 : 400);
        for (DevicePath::PairLists const& lists : device.lists_of_layers) {
            if (lists.made == 0) continue;  // of too few particles
            EXPECT_EQ(lists.made + lists.kept, steps);
            EXPECT_LE(lists.made, device.lists.made);
            EXPECT_GT(lists.kept, lists.made / 2);
        }
    }
}

/// Where they stand after many steps comes between two evaluations: no list of pairs is kept across
/// that.
TEST_P(OpenMmOnGpu, BeadsThatAreSetElsewhere) {
    Found const there = found("host", "double", 300),
                expected = found("host", "double", 300, &there);
    Scene const scene = scene_with("device", "double");
    ChainSystem system(scene, Axes::world, *communicator_);
    auto const start = system.state();
    for (int i = 0; i < 4; ++i) system.evaluate();
    system.set_state(there.state);
    system.evaluate();
    EXPECT_LE(difference(system.bead_forces(), expected.again),
              1e-12 * largest(expected.again) + rounding);
    system.set_state(start);
    system.evaluate();
    EXPECT_GT(difference(system.bead_forces(), expected.again), 1e-3 * largest(expected.again));
}

TEST_P(OpenMmOnGpu, ABeadAtNoFinitePlaceEndsTheRun) {
    Scene const scene = scene_with("device", "mixed");
    ChainSystem system(scene, Axes::world, *communicator_);
    system.evaluate();
    auto state = system.state();
    state["position"][31] = NAN;
    system.set_state(state);
    EXPECT_THROW(
        {
            system.evaluate();
            system.wait();
            system.check_forces();
        },
        ComputationError);
}

/// Nor does its list of pairs.
TEST_P(OpenMmOnGpu, ARunDoesNotDependOnEnergiesAskedFor) {
    Scene const scene = scene_with("device", "double");
    auto const run = [&](bool with_energies) {
        ChainSystem system(scene, Axes::world, *communicator_);
        auto stepper = make_stepper(system, scene.dynamics);
        for (std::int64_t n = 0; n < 60; ++n) {
            stepper->prepare(nullptr);
            if (with_energies) {
                EXPECT_EQ(system.potential_energy().size(), terms());
            }
            stepper->step(n, nullptr);
        }
        return std::pair(system.state(), system.openmm()->device_path()->pair_lists().kept);
    };
    EXPECT_EQ(run(true), run(false));
}

TEST_P(OpenMmOnGpu, TheSameBitsAgain) {
    Found const once = found("device", "mixed", 40), again = found("device", "mixed", 40);
    EXPECT_EQ(once.state, again.state);
    EXPECT_EQ(difference(once.forces, again.forces), 0);
    EXPECT_EQ(difference(once.again, again.again), 0);
}

class LayersOnGpu : public OpenMmOnGpu {};

/// `auto` takes layers in large, dense systems.
TEST_F(LayersOnGpu, AreThereWhereTheyPayAndWhereTheSceneAsksForThem) {
    auto const expect = [&](int chains, char const* layers, bool taken) {
        Scene scene = parse_scene(
            openmm_scene("{name: a, count: " + std::to_string(chains) +
                             ", sequence: SEQ, model: calvados2, conformation: self_avoiding}",
                         "box: {periodic: [32, 32, 32]}"),
            "scene.yaml");
        scene.solver.backend = Backend::cuda;
        scene.forces.openmm->layers = layers;
        ChainSystem const system(scene, Axes::world, *communicator_);
        EXPECT_EQ(system.openmm()->path(), "device");
        std::string said;
        for (std::string const& line : system.openmm()->description()) said += line + "\n";
        EXPECT_EQ(said.find("yukawa in a Context of its own: it acts on ") != std::string::npos,
                  taken);
        EXPECT_EQ(system.openmm()->contexts(), taken ? 2 : 1) << layers << ", " << chains;
    };
    expect(20, "auto", false);
    expect(20, "none", false);
    expect(20, "all", true);
    expect(520, "auto", true);
    expect(520, "none", false);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, OpenMmOnGpu,
    ::testing::Values(
        Case{"periodic",
             "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
             "box: {periodic: [16, 17, 18]}"},
        // So many that OpenMM keeps a list of pairs.
        Case{"many",
             "{name: a, count: 40, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [36, 30, 28]}"},
        // Half an edge is a cutoff and half of a block of 32 beads: what has moved must not be
        // taken from another cell.
        Case{"narrow",
             "{name: a, count: 110, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [11.2, 11, 42]}"},
        Case{"open",
             "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: thermal}",
             ""},
        Case{"held",
             "{name: a, base: fixed, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}",
             "box: {periodic: [40, 40, 40]}"},
        // Beads carried by rigid domains, and beads of linkers between them.
        Case{"domains", "{name: a, " CATENA_TEST_DOMAINS "}", "box: {periodic: [40, 40, 40]}"},
        Case{"many_domains", "{name: a, count: 20, " CATENA_TEST_DOMAINS "}",
             "box: {periodic: [60, 60, 60]}"},
        Case{"domains_in_layers", "{name: a, count: 2, " CATENA_TEST_DOMAINS "}",
             "box: {periodic: [40, 40, 40]}", true},
        // Two chains a replica, and so many replicas that OpenMM keeps a list of pairs.
        Case{"replicas",
             "{name: a, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
             "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
             "replicas: 5"},
        Case{"many_replicas",
             "{name: a, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
             "thermal}",
             "replicas: 40"},
        Case{"replicas_of_domains", "{name: a, " CATENA_TEST_DOMAINS "}", "replicas: 3"},
        Case{"replicas_in_layers",
             "{name: a, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
             "thermal}",
             "replicas: 5", true},
        Case{"layers",
             "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
             "box: {periodic: [16, 17, 18]}", true},
        // So many that OpenMM keeps a list of the pairs of each layer but the extra force's.
        Case{"many_in_layers",
             "{name: a, count: 120, sequence: GKEKSDESKEKSDEKRSKEDKG, model: calvados2, "
             "conformation: self_avoiding, velocities: thermal}",
             "box: {periodic: [36, 30, 28]}", true, true},
        Case{"narrow_in_layers",
             "{name: a, count: 110, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [11.2, 11, 42]}", true},
        Case{"open_in_layers",
             "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: thermal}",
             "", true, true}),
    [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
