#include "console/long_task.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace catena::command {
namespace {

using namespace std::chrono_literals;

std::string said_in(std::chrono::milliseconds time, bool speaks, std::chrono::milliseconds every) {
    ::testing::internal::CaptureStderr();
    {
        LongTask const task(speaks, "reading a\nb.yaml", every);
        std::this_thread::sleep_for(time);
    }
    return ::testing::internal::GetCapturedStderr();
}

TEST(LongTask, IsNamedWithItsTime) {
    std::string const said = said_in(250ms, true, 100ms);
    EXPECT_EQ(said.find("catena: reading a b.yaml: 0.1 s\ncatena: reading a b.yaml: 0.2 s\n"), 0U)
        << said;
}

TEST(LongTask, IsNotNamedIfItEndsBeforeOrIsToBeSilent) {
    EXPECT_EQ(said_in(1ms, true, 1h), "");
    EXPECT_EQ(said_in(50ms, false, 10ms), "");
}

}  // namespace
}  // namespace catena::command
