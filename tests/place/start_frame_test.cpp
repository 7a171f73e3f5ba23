// Scenes start from frames of other runs, in DCD files.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/frames/dcd_bytes.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/place/beads_of_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

double constexpr single = 5e-6;  // nm: digits of a DCD file

class StartFrame : public testing::Test {
  protected:
    /// Two chains of eight beads and a box; the frame that a run of this scene might leave.
    std::string const yaml_ =
        "chains: [{name: p, count: 2, conformation: self_avoiding, sequence: GSKEELRK, model: "
        "calvados2}]\nbox: {periodic: [12, 12, 12]}\n";
    std::string const from_ = "start: {from: a.dcd}\n";

    Scene read(std::string const& yaml) const { return parse_scene(yaml, folder_ / "s.yaml"); }
    std::string refusal(std::string const& yaml) const {
        return refusal_of(yaml, {}, folder_ / "s.yaml");
    }
    void write(std::vector<std::vector<Vec3>> const& frames,
               std::optional<Vec3> const& box = Vec3{{12, 12, 12}}) const {
        std::ofstream(folder_ / "a.dcd", std::ios::binary) << dcd_bytes(frames, box);
    }
    /// All beads of a scene, each shifted by `by`.
    static std::vector<Vec3> frame_of(Scene const& scene, Vec3 const& by = Vec3::zero()) {
        std::vector<Vec3> frame;
        for (ChainSpec const& chain : scene.chains)
            for (Vec3 const& at : beads_of(chain)) frame.push_back(at + by);
        return frame;
    }
    static std::vector<Vec3> wrapped(std::vector<Vec3> frame, Vec3 const& box) {
        for (Vec3& at : frame)
            for (int i = 0; i < 3; ++i) at[i] -= box[i] * std::floor(at[i] / box[i]);
        return frame;
    }
    static bool notes(Scene const& scene, std::string const& part) {
        return std::any_of(scene.notes.begin(), scene.notes.end(), [&](std::string const& note) {
            return note.find(part) != std::string::npos;
        });
    }
    /// Expects the beads of a scene at the frame's, but for shifts of whole chains by whole edges.
    static void expect_at(Scene const& scene, std::vector<Vec3> const& frame, Vec3 const& box) {
        std::size_t site = 0;
        for (ChainSpec const& chain : scene.chains) {
            std::vector<Vec3> const beads = beads_of(chain);
            for (std::size_t k = 0; k < beads.size(); ++k, ++site)
                for (int i = 0; i < 3; ++i) {
                    double const apart = beads[k][i] - frame[site][i];
                    EXPECT_NEAR(apart - box[i] * std::round(apart / box[i]), 0, 2e-5)
                        << chain.name << " " << k;
                }
        }
    }
    TemporaryFolder folder_;
};

TEST_F(StartFrame, takes_the_last_frame_or_the_chosen_one) {
    std::vector<Vec3> const first = frame_of(read(yaml_)),
                            last = frame_of(read(yaml_), Vec3{{1, 2, 3}});
    write({first, last});
    Scene const scene = read(yaml_ + from_), chosen = read(yaml_ +
                                                           "start: {from: a.dcd, frame: "
                                                           "0}\n");
    EXPECT_NEAR(norm(scene.chains[1].beads.position[7] - last[15]), 0, single);
    EXPECT_NEAR(norm(chosen.chains[1].beads.position[7] - first[15]), 0, single);
    expect_links(scene);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_TRUE(notes(scene, "positions come from frame 1 of 0 to 1"));
    EXPECT_TRUE(notes(scene, "its velocities are not used, chains start at rest"));
}

TEST_F(StartFrame, draws_thermal_velocities_and_says_so) {
    write({frame_of(read(yaml_))});
    std::string const warm =
        yaml_ + "dynamics: {integrator: g-baoab, step: 0.01, temperature: 293}\n";
    Scene const scene = read(warm + from_);
    EXPECT_EQ(scene.chains[0].velocities, StartVelocities::thermal);
    EXPECT_TRUE(notes(scene, "thermal ones drawn at 293 K"));
}

/// A frame that is wrapped into its box bead by bead.
TEST_F(StartFrame, makes_wrapped_chains_whole) {
    Vec3 const box{{12, 12, 12}};
    std::vector<Vec3> const frame = frame_of(read(yaml_), Vec3{{0.3, -0.2, 0.1}});
    write({wrapped(frame, box)});
    Scene const scene = read(yaml_ + from_);
    expect_links(scene);
    expect_at(scene, frame, box);
}

/// A longer box around the frame: the frame's own box decides what is whole, and lies in the
/// middle.
TEST_F(StartFrame, goes_on_in_a_longer_box) {
    Vec3 const box{{12, 12, 12}};
    std::vector<Vec3> frame = frame_of(read(yaml_));
    for (std::size_t k = 8; k < 16; ++k) frame[k][2] += 36;  // diffused by three boxes
    write({frame});
    std::string longer = yaml_;
    longer.replace(longer.find("12, 12, 12"), 10, "12, 12, 60");
    Scene const scene = read(longer + from_);
    expect_links(scene);
    expect_at(scene, frame, box);
    for (ChainSpec const& chain : scene.chains) {
        double middle = 0;
        for (Vec3 const& at : chain.beads.position) middle += at[2] / 8;
        EXPECT_GE(middle, 24) << chain.name;
        EXPECT_LE(middle, 36) << chain.name;
    }
    EXPECT_TRUE(notes(scene, "the frame's box is 12 x 12 x 12 nm, the scene's 12 x 12 x 60 nm"));
}

/// The frame of a run with springs: links take their lengths, and the change is said.
TEST_F(StartFrame, fits_the_links) {
    std::vector<Vec3> frame = frame_of(read(yaml_));
    Vec3 const along = frame[1] - frame[0];
    frame[0] = frame[0] - 0.1 * along;
    write({frame});
    Scene const scene = read(yaml_ + from_);
    expect_links(scene);
    EXPECT_NEAR(scene.start.link, 0.1 * norm(along), 1e-5);
    EXPECT_TRUE(notes(scene, "the largest change of a link is 10 %"));
    frame[0] = frame[0] - 0.5 * along;
    write({frame});
    EXPECT_NE(refusal(yaml_ + from_).find("beads 1 and 2 of chain `p-1` are"), std::string::npos);
}

TEST_F(StartFrame, tells_once_of_cross_links_that_move_the_beads_of_copies) {
    write({frame_of(read(yaml_))});
    std::string bound = yaml_;
    bound.replace(bound.find("calvados2}"), 9, "calvados2, crosslinks: [[2, 7, 0.55]]");
    Scene const scene = read(bound + from_);
    for (ChainSpec const& chain : scene.chains)
        EXPECT_NEAR(norm(chain.beads.position[6] - chain.beads.position[1]), 0.55, 1e-9);
    EXPECT_EQ(std::count_if(scene.notes.begin(), scene.notes.end(),
                            [](std::string const& note) {
                                return note.find("to close cross-links") != std::string::npos;
                            }),
              1);
    EXPECT_TRUE(notes(scene, "chain `p-1` are"));
    EXPECT_TRUE(notes(scene, "cross-links move beads of 1 more copy by up to"));
}

/// What the scene's own positions would have been is not reported.
TEST_F(StartFrame, replaces_positions_and_what_was_said_of_them) {
    std::ofstream table(folder_ / "own.csv");
    for (int k = 0; k < 8; ++k) table << 0.42 * k << ",0," << 0.01 * (k % 2) << "\n";
    table.close();
    std::string const own =
        "chains: [{name: p, sequence: GSKEELRK, model: calvados2, positions: own.csv}]\nbox: "
        "{periodic: [12, 12, 12]}\n";
    ASSERT_TRUE(notes(read(own), "the start's positions were moved"));
    std::vector<Vec3> frame = frame_of(read(yaml_));
    frame.resize(8);
    write({frame});
    Scene const scene = read(own + from_);
    EXPECT_EQ(scene.notes.size(), 1u);
    EXPECT_LT(scene.start.link, single);
}

/// The shape of a domain is the scene's; its place and orientation are the frame's.
TEST_F(StartFrame, lays_rigid_domains_on_their_beads) {
    std::ofstream table(folder_ / "d.csv");
    for (int k = 0; k < 20; ++k)
        table << 0.23 * std::cos(1.745 * k) << "," << 0.23 * std::sin(1.745 * k) << "," << 0.15 * k
              << "\n";
    table.close();
    std::string const yaml =
        "chains: [{name: d, sequence: GGGGGGGGGGGGGGGGGGGG, model: calvados2, positions: d.csv, "
        "rigid: [[1, 8], [12, 20]]}]\nbox: {periodic: [12, 12, 12]}\n";
    Quat const turn = from_axis_angle(Vec3{{0, 0.6, 0.8}}, 2.0);
    std::vector<Vec3> frame = frame_of(read(yaml));
    for (Vec3& at : frame) at = to_matrix(turn) * at + Vec3{{5, 11.5, 6}};
    write({wrapped(frame, Vec3{{12, 12, 12}})});
    Scene const scene = read(yaml + from_);
    ASSERT_TRUE(scene.chains[0].is_linked());
    expect_at(scene, frame, Vec3{{12, 12, 12}});
    EXPECT_FALSE(notes(scene, "rigid domains"));
    for (std::size_t k = 12; k < 20; ++k) frame[k] = frame[k] + Vec3{{0, 0, k % 2 == 0 ? 0 : 0.08}};
    write({frame});
    EXPECT_TRUE(notes(read(yaml + from_), "rigid domains keep the scene's shape"));
}

TEST_F(StartFrame, of_another_system_is_refused_with_both_numbers) {
    std::vector<Vec3> frame = frame_of(read(yaml_));
    frame.pop_back();
    write({frame});
    std::string const message = refusal(yaml_ + from_);
    EXPECT_NE(message.find("has 15 beads, the scene has 16"), std::string::npos) << message;
    EXPECT_NE(message.find("start.from"), std::string::npos) << message;
}

TEST_F(StartFrame, is_refused_where_it_has_no_meaning) {
    write({frame_of(read(yaml_))});
    EXPECT_NE(refusal(yaml_ + from_ + "place: {slab: {thickness: 3}}").find("both `start` and "),
              std::string::npos);
    EXPECT_NE(refusal("chains: [{generator: {pendulum: {links: 3}}}]\n" + from_).find("has joints"),
              std::string::npos);
    EXPECT_NE(refusal(yaml_ + "start: {from: lost.dcd}").find("there is no trajectory"),
              std::string::npos);
    EXPECT_NE(refusal(yaml_ + "start: {from: a.dcd, frame: first}").find("frame"),
              std::string::npos);
    EXPECT_NE(refusal("units: si\nchains: [{generator: {freely_jointed: {beads: 16, length: "
                      "1}}}]\n" +
                      from_)
                  .find("is in nm and ps, the scene is not"),
              std::string::npos);
}

}  // namespace
}  // namespace catena::test
