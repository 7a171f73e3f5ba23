#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "plan/cache.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/plan/told_machine.hpp"

namespace catena::test {
namespace {

class Cache : public ::testing::Test {
  protected:
    void SetUp() override {
        if (char const* const before = std::getenv("XDG_CACHE_HOME")) before_ = before;
        ::setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
    }
    void TearDown() override {
        before_.empty() ? ::unsetenv("XDG_CACHE_HOME")
                        : ::setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    }
    /// A calibration with something in it.
    plan::Calibration learned() {
        plan::Planner planner(machine_, {}, 1024);
        planner.predict({{{scene::RandomJoint::planar}, 100, {}}});
        planner.plan_levels({{{scene::RandomJoint::planar}, 100, {50, 25}}});
        EXPECT_TRUE(planner.learned());
        return planner.calibration();
    }
    TemporaryFolder folder_;
    std::string before_;
    plan::Machine machine_ = told_machine(true);
};

TEST_F(Cache, KeepsEveryBit) {
    plan::Calibration const written = learned();
    ASSERT_TRUE(plan::write_cache(machine_, written));
    plan::Calibration const read = plan::read_cache(machine_);
    EXPECT_EQ(read.points(), written.points());
    EXPECT_EQ(read.json(), written.json());
    plan::Planner again(machine_, read, 1024);
    again.predict({{{scene::RandomJoint::planar}, 100, {}}});
    EXPECT_FALSE(again.learned());
}

TEST_F(Cache, AnotherMachinesIsNoneAtAll) {
    ASSERT_TRUE(plan::write_cache(machine_, learned()));
    std::string const file = plan::cache_file(machine_);
    machine_.identity = "another";
    EXPECT_EQ(plan::read_cache(machine_).points(), 0U);
    std::filesystem::rename(file, plan::cache_file(machine_));  // as after a collision of names
    EXPECT_EQ(plan::read_cache(machine_).points(), 0U);
}

TEST_F(Cache, DamageIsMeasuredAnew) {
    ASSERT_TRUE(plan::write_cache(machine_, learned()));
    std::string const file = plan::cache_file(machine_);
    nlohmann::json const good = nlohmann::json::parse(std::ifstream(file));
    nlohmann::json negative = good, short_one = good, empty = good;
    negative["phases"].begin()->at(0).at(1).at(0) = -1;
    short_one["levels"].begin()->at(0).at(1).erase(0);
    empty.erase("phases");
    for (std::string const& text :
         {std::string("{"), std::string(""), negative.dump(), short_one.dump(), empty.dump()}) {
        std::ofstream(file) << text;
        EXPECT_EQ(plan::read_cache(machine_).points(), 0U) << text;
    }
}

TEST_F(Cache, NoPlaceIsNoError) {
    ::setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
    EXPECT_FALSE(plan::write_cache(machine_, learned()));
    EXPECT_EQ(plan::read_cache(machine_).points(), 0U);
}

}  // namespace
}  // namespace catena::test
