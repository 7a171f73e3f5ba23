// main() of the tests that run on several ranks: rank 0 reports as GoogleTest does, the others say
// only what failed on them, and all return the same status: 1 where a test failed, 77 where all
// were skipped.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "io/output.hpp"
#include "tests/mpi/world.hpp"

namespace catena::testing {
namespace {

Communicator const* current = nullptr;

class FailuresOfRank : public ::testing::EmptyTestEventListener {
  public:
    explicit FailuresOfRank(int rank) : rank_(rank) {}
    void OnTestStart(::testing::TestInfo const& test) override {
        test_ = std::string(test.test_suite_name()) + "." + test.name();
    }
    // Asking GoogleTest for the present test here would wait for the lock that it holds.
    void OnTestPartResult(::testing::TestPartResult const& result) override {
        if (!result.failed()) return;
        std::fprintf(stderr, "[rank %d] %s: %s:%d: %s\n", rank_, test_.c_str(), result.file_name(),
                     result.line_number(), result.message());
    }

  private:
    int rank_;
    std::string test_ = "-";
};

}  // namespace

Communicator const& world() { return *current; }

}  // namespace catena::testing

int main(int argc, char** argv) {
    catena::start_hdf5();
    auto const world = catena::world_communicator(&argc, &argv);
    catena::testing::current = world.get();
    ::testing::InitGoogleTest(&argc, argv);
    if (world->rank() != 0) {
        auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
        delete listeners.Release(listeners.default_result_printer());
        listeners.Append(new catena::testing::FailuresOfRank(world->rank()));
    }
    double const failed = RUN_ALL_TESTS() != 0 ? 1 : 0;
    auto const& all = *::testing::UnitTest::GetInstance();
    int const skipped = all.skipped_test_count() == all.test_to_run_count()
                            ? 77
                            : 0;  // CTest's word for it, where it is told
    return world->max(failed) > 0 ? 1 : skipped;
}
