// DCD files are read frame by frame, or refused with what is wrong.
#include "frames/dcd_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "frames/chosen_frame.hpp"
#include "tests/frames/dcd_bytes.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::vector<std::vector<Vec3>> const two_frames{{{{1, 2, 3}}, {{4, 5, 6}}},
                                                {{{1.5, 2.5, 3.5}}, {{-4, -5, -6}}}};
Vec3 const box{{7, 8, 9}};

class DcdFiles : public testing::Test {
  protected:
    std::string write(std::string const& bytes) const {
        std::ofstream(folder_ / "a.dcd", std::ios::binary) << bytes;
        return folder_ / "a.dcd";
    }
    std::string refusal(std::string const& bytes) const {
        std::string const file = write(bytes);
        return message_of([&] { DcdFile(file).read(0); });
    }
    TemporaryFolder folder_;
};

TEST_F(DcdFiles, hold_positions_and_boxes_in_nanometres) {
    DcdFile const file(write(dcd_bytes(two_frames, box)));
    ASSERT_EQ(file.sites(), 2u);
    ASSERT_EQ(file.frames(), 2u);
    Snapshot const last = file.read(1);
    ASSERT_TRUE(last.box);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR((*last.box)[i], box[i], 1e-12);
        EXPECT_NEAR(last.position[0][i], 1.5 + i, 1e-6);
        EXPECT_NEAR(last.position[1][i], -4 - i, 1e-6);
    }
    EXPECT_FALSE(DcdFile(write(dcd_bytes(two_frames, std::nullopt))).read(0).box);
}

/// A run that was killed leaves a part of a frame.
TEST_F(DcdFiles, count_whole_frames_only) {
    std::string const bytes = dcd_bytes(two_frames, box);
    EXPECT_EQ(DcdFile(write(bytes.substr(0, bytes.size() - 3))).frames(), 1u);
}

TEST_F(DcdFiles, may_give_angles_as_cosines) {
    EXPECT_TRUE(DcdFile(write(dcd_bytes(two_frames, box, {"CORD", 0, 0}))).read(0).box);
}

TEST_F(DcdFiles, are_refused_with_what_is_wrong) {
    std::string const bytes = dcd_bytes(two_frames, box);
    std::string broken = bytes;
    broken[broken.size() - 2] = 'x';
    std::vector<std::vector<Vec3>> lost = two_frames;
    lost[0][1][2] = NAN;
    EXPECT_NE(refusal("CORD").find("shorter than a head"), std::string::npos);
    EXPECT_NE(refusal(std::string(200, 'x')).find("byte order"), std::string::npos);
    EXPECT_NE(refusal(dcd_bytes(two_frames, box, {"VELD"})).find("no positions"),
              std::string::npos);
    EXPECT_NE(refusal(dcd_bytes(two_frames, box, {"A\x1b\n\xff"})).find("its head says `A???`"),
              std::string::npos);
    EXPECT_NE(refusal(dcd_bytes(two_frames, box, {"CORD", 1})).find("fixed atoms"),
              std::string::npos);
    EXPECT_NE(refusal(dcd_bytes(two_frames, box, {"CORD", 0, 60})).find("not rectangular"),
              std::string::npos);
    EXPECT_NE(refusal(dcd_bytes(lost, box)).find("not finite"), std::string::npos);
    EXPECT_NE(refusal(bytes.substr(0, 250)).find("no frames"), std::string::npos);
    write(broken);
    EXPECT_NE(message_of([&] { DcdFile(folder_ / "a.dcd").read(1); }).find("damaged"),
              std::string::npos);
}

TEST_F(DcdFiles, have_the_last_frame_unless_one_is_chosen) {
    std::string const file = write(dcd_bytes(two_frames, box));
    EXPECT_EQ(read_frame(file, std::nullopt).frame, 1u);
    EXPECT_EQ(read_frame(file, 0).position[0][0], DcdFile(file).read(0).position[0][0]);
    std::string const none = message_of([&] { read_frame(file, 2); });
    EXPECT_NE(none.find("there is no frame 2, the trajectory has 2"), std::string::npos) << none;
    EXPECT_NE(none.find("from 0 to 1"), std::string::npos) << none;
}

}  // namespace
}  // namespace catena::test
