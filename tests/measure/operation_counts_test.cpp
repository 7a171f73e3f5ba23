// The counts against what one gets by hand from dca/segment.hpp.
#include "measure/operation_counts.hpp"

#include <gtest/gtest.h>

#include "report/chapter_figures.hpp"

namespace catena::test {
namespace {

TEST(OperationCounts, AScalarCountsWhatIsDoneToIt) {
    Counted::done() = {};
    Counted const a(2), b(3);
    EXPECT_EQ((a * b + a / b - sqrt(b)).value(), 6.0 + 2.0 / 3.0 - std::sqrt(3.0));
    EXPECT_EQ(fused(a, b, -a).value(), 4);
    Operations const done = Counted::done();
    EXPECT_EQ(done.additions, 2);
    EXPECT_EQ(done.multiplications, 1);
    EXPECT_EQ(done.divisions, 1);
    EXPECT_EQ(done.square_roots, 1);
    EXPECT_EQ(done.fused, 1);
    EXPECT_EQ(done.sum(), 7);
}

/// One direction: z = b + c; 1 / z; two scaled blocks; two corrected blocks and the one across.
TEST(OperationCounts, AMergeOfLinksByHand) {
    HandleOperations const link = count_operations().front().projected;
    EXPECT_EQ(link.directions, 1);
    EXPECT_EQ(link.assembly_matrices.additions, 1);
    EXPECT_EQ(link.assembly_matrices.divisions, 1);
    EXPECT_EQ(link.assembly_matrices.multiplications, 3);
    EXPECT_EQ(link.assembly_matrices.fused, 2);
    EXPECT_EQ(link.disassembly.sum(), 2 + 2 + 1);  // two products, two sums, one scaling
}

/// K directions: sums of z and of both biases, L S L^T, the two solves, and the three blocks of the
/// joined segment.
TEST(OperationCounts, AMergeByFormula) {
    for (JointOperations const& joint : count_operations())
        for (HandleOperations const& h : {joint.projected, joint.full}) {
            std::int64_t const k = h.directions, pairs = k * (k - 1) / 2,
                               triangle = k * (k + 1) / 2, triples = (k + 1) * k * (k - 1) / 6;
            EXPECT_EQ(h.assembly_matrices.divisions, k) << joint.joint;
            EXPECT_EQ(h.assembly_matrices.additions, triangle) << joint.joint;
            // factor: `triples` products; solves: 2 k pairs; blocks: 2 k triangle and, but for its
            // first term, k^3.
            EXPECT_EQ(h.assembly_matrices.fused,
                      triples + 2 * k * pairs + 2 * k * triangle + k * k * (k - 1))
                << joint.joint;
            EXPECT_EQ(h.assembly_matrices.square_roots, 0);
        }
}

TEST(OperationCounts, EveryJointHasFewerDirectionsThanFullHandles) {
    std::int64_t last = 0;
    for (JointOperations const& joint : count_operations()) {
        EXPECT_LE(joint.projected.assembly(), joint.full.assembly()) << joint.joint;
        EXPECT_GE(joint.projected.assembly(), last) << joint.joint;
        last = joint.projected.assembly();
    }
}

TEST(ChapterFigures, AreInTheProgram) {
    ASSERT_EQ(chapter_figures().size(), 3U);
    for (auto const& [figure, rows] : chapter_figures()) EXPECT_EQ(rows.size(), 12U) << figure;
    EXPECT_EQ(chapter_figures().at("full_step").at(2048),
              (ChapterRow{402.3, 331.6, 290.7, 249, 240, 257.8}));
    EXPECT_EQ(chapter_figures().at("transfer").at(8)[1], 0);
}

}  // namespace
}  // namespace catena::test
