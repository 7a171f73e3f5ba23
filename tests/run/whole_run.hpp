// Whole runs of a scene in a folder of the test's own, by all ranks of the test or by some
// communicator of one.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "io/output.hpp"
#include "reader/load_scene.hpp"
#include "run/simulation.hpp"
#include "tests/integrate/scenes.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {

class WholeRun : public ::testing::TestWithParam<RunScene> {
  protected:
    WholeRun() {
        // Every rank must name the same folder: rank 0's.
        std::string name =
            (std::filesystem::temp_directory_path() / ("catena-run-" + std::to_string(::getpid())))
                .string();
        name.resize(200, ' ');
        catena::testing::world().broadcast(std::as_writable_bytes(std::span(name)));
        folder_ = name.substr(0, name.find(' '));
    }
    ~WholeRun() override {
        catena::testing::world().barrier();
        std::error_code ignored;
        if (catena::testing::world().rank() == 0) std::filesystem::remove_all(folder_, ignored);
        catena::testing::world().barrier();
    }
    RunOptions options_of(std::string const& name, std::int64_t steps,
                          std::string const& restart) const {
        RunOptions options;
        options.output = folder_ + "/" + name;
        options.steps = steps;
        options.restart = restart.empty() ? "" : folder_ + "/" + restart;
        options.quiet = true;
        return options;
    }
    /// `one_by_one`: not in vectors.
    nlohmann::json run(Communicator const& communicator, std::string const& name,
                       std::int64_t steps, std::string const& restart = "",
                       Backend backend = Backend::automatic, bool one_by_one = false) {
        RunOptions const options = options_of(name, steps, restart);
        Scene scene = parse_scene(GetParam().text, "scene.yaml");
        scene.solver.backend = backend;
        if (one_by_one) scene.solver.simd = SimdLevel::off;
        nlohmann::json const summary = run_simulation(std::move(scene), communicator, options);
        EXPECT_TRUE(summary["valid"].get<bool>());
        if (backend != Backend::automatic && communicator.rank() == 0) {
            EXPECT_EQ(summary["solver"]["backend"], name_of(backend));
        }
        if (communicator.rank() == 0) {
            EXPECT_EQ(summary.at("parallel").at("messages_a_step").at("ranks_that_differ"), 0);
        }
        return summary;
    }
    /// The checkpoint of run `name`, bit for bit.
    auto arrays(std::string const& name) const {
        return read_checkpoint(folder_ + "/" + name + "/checkpoint.h5").arrays;
    }

    std::string folder_;
};

}  // namespace catena::test
