// Scenes whose beads are on the GPUs of several ranks, and what is found there beside what one
// Context of the whole System finds.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "integrate/chain_system.hpp"
#include "integrate/stepper.hpp"
#include "mpi/first_rank.hpp"
#include "reader/load_scene.hpp"
#include "tests/cuda/openmm_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {

struct Case {
    char const* name;
    char const* chains;
    char const* rest;
    double edge = 20;            // nm, the longest
    bool ghosts_change = false;  // there are beads that a rank does not feel
    int piece = 1;               // the shortest: numbers of ghosts are multiples of it
    bool layers = false;         // charges are in a Context of their own where pairs are shared
};

/// What one way of computing found, and where it stood then.
struct Found {
    std::int64_t step = 0;
    Checkpoint checkpoint;  // with the state, on every rank
    std::vector<Vec3> own,
        all;  // forces on this rank's beads, gravity among them; OpenMM's on all, on rank 0
    std::vector<EnergyTerm> energies;
    GhostTraffic traffic;
    std::int64_t contexts = 0;
    DevicePath::PairLists lists;
};

class OpenMmOnGpus : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        need_gpu(world_);
        if (IsSkipped() || HasFatalFailure()) return;
        if (world_.max(cuda::why_no_device_path().empty() ? 0 : 1) == 0) return;
        if (std::getenv("CATENA_NEEDS_GPU") != nullptr)
            FAIL() << "NOT RUN, though CATENA_NEEDS_GPU is set: " << cuda::why_no_device_path();
        GTEST_SKIP() << "NOT RUN: " << cuda::why_no_device_path();
    }
    void TearDown() override {
        given_way_.empty() ? ::unsetenv("CATENA_GPU_EXCHANGE")
                           : ::setenv("CATENA_GPU_EXCHANGE", given_way_.c_str(), 1);
    }
    std::string given_way_ =
        std::getenv("CATENA_GPU_EXCHANGE") ? std::getenv("CATENA_GPU_EXCHANGE") : "";
    static Scene scene_with(std::string const& precision, bool on_device,
                            char const* split = "ghosts") {
        Scene scene = parse_scene(openmm_scene(GetParam().chains, GetParam().rest), "scene.yaml");
        scene.solver.backend = Backend::cuda;
        scene.forces.openmm->precision = precision;
        scene.forces.openmm->path = on_device ? "device" : "host";
        scene.forces.openmm->audit = on_device && std::string(split) == "ghosts";
        if (on_device) scene.forces.openmm->split = split;
        scene.forces.openmm->layers = GetParam().layers ? "all" : "none";
        scene.forces.openmm->replicate = !on_device;  // the oracle
        return scene;
    }
    /// At step `last`, from the scene's start or from where another stood. `asks`: for energies at
    /// every step.
    Found found(Scene const& scene, std::int64_t last, Found const* start = nullptr,
                bool asks = false) {
        ChainSystem system(scene, Axes::world, world_);
        EXPECT_EQ(system.openmm()->path(), scene.forces.openmm->path);
        auto stepper = make_stepper(system, scene.dynamics);
        Found f;
        f.step = start ? start->step : 0;
        if (start) {
            system.set_state(start->checkpoint.arrays);
            stepper->restore(start->checkpoint);
        }
        for (;; ++f.step) {
            if (f.step == 100) system.openmm()->renew_ghosts();
            stepper->prepare(nullptr);
            if (f.step == last) break;
            if (asks) f.energies = system.potential_energy();
            stepper->step(f.step, nullptr);
        }
        for (AbsoluteDynamics* group : system.absolute()) {
            View<3> const forces = group->bead_forces();
            for (std::int64_t k = 0; k < forces.size; ++k) f.own.push_back(forces.load(k));
        }
        f.energies = system.potential_energy();
        f.all = system.bead_forces();
        stepper->save(f.checkpoint);
        f.checkpoint.arrays = system.state();
        f.traffic = system.openmm()->traffic();
        f.contexts = system.openmm()->contexts();
        if (DevicePath const* const path = system.openmm()->device_path())
            f.lists = path->pair_lists();
        return f;
    }
    static std::int64_t scene_beads(Scene const& scene) {
        std::int64_t beads = 0;
        for (auto const& chain : scene.chains)
            beads += static_cast<std::int64_t>(chain.bead_count());
        return beads;
    }
    double largest(std::vector<Vec3> const& of_rank) const {
        double value = 0;
        for (Vec3 const& v : of_rank) value = std::max(value, norm(v));
        return world_.max(value);
    }
    static double difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
        EXPECT_EQ(a.size(), b.size());
        double value = 0;
        for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
            value = larger(value, norm(a[k] - b[k]));
        return value;
    }
    void expect_close(Found const& a, Found const& b, double tolerance) const {
        double const size = largest(b.own);
        EXPECT_GT(size, 1);
        EXPECT_LE(difference(a.own, b.own), tolerance * size + rounding);
        EXPECT_LE(difference(a.all, b.all), tolerance * size + rounding);
        ASSERT_EQ(a.energies.size(), b.energies.size());
        for (std::size_t i = 0; i < a.energies.size(); ++i) {
            EXPECT_EQ(a.energies[i].name, b.energies[i].name);
            EXPECT_TRUE(std::isfinite(a.energies[i].value));
            EXPECT_NEAR(a.energies[i].value, b.energies[i].value,
                        tolerance * (1 + std::abs(b.energies[i].value)));
        }
    }
    /// When somebody asks for them, wherever beads are.
    void expect_lists_made_anew(char const* split) {
        Scene const scene = scene_with("double", true, split);
        ChainSystem system(scene, Axes::world, world_);
        system.evaluate();
        std::vector<Vec3> const before = system.bead_forces();
        for (int i = 0; i < 5; ++i) {
            system.openmm()->renew_ghosts();
            system.evaluate();
        }
        EXPECT_EQ(system.openmm()->traffic().rebuilds, 6);
        EXPECT_LE(difference(system.bead_forces(), before), rounding);
    }
    /// Of a run with a bead at no finite place.
    void expect_the_end_on_every_rank(char const* split) {
        Scene const scene = scene_with("mixed", true, split);
        ChainSystem system(scene, Axes::world, world_);
        system.evaluate();
        auto arrays = system.state();
        if (world_.rank() == 0) arrays["position"][3 * 10 + 1] = NAN;
        system.set_state(arrays);
        EXPECT_THROW(system.evaluate(), SharedError);
    }
    /// OpenMM's pair forces take positions x from some origin and out of some cell, which differ,
    /// with a rounding of eps x of their precision: 1e-6 nm at 20 nm in single and mixed. Overlaps
    /// of 0.05 nm make forces change by all of themselves: 2e-5 of the largest.
    static double tolerance(std::string const& precision) {
        double const eps = precision == "double" ? 0x1p-53 : 0x1p-24, overlap = 0.05,
                     at_least = 1e-12;
        return std::max(at_least, eps * GetParam().edge / overlap);
    }
    /// OpenMM adds up forces in units of 2^-32 kJ/mol/nm, and what it rounds to them depends on the
    /// order of its particles.
    static constexpr double rounding = 16.0 / 4294967296.0;
    Communicator const& world_ = catena::testing::world();
};

}  // namespace catena::test
