// Scenes start from frames of Catena's own runs.
#include <gtest/gtest.h>

#include <fstream>

#include "io/output.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/place/beads_of_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

class StartRun : public testing::Test {
  protected:
    std::string const yaml_ =
        "chains: [{name: p, count: 2, conformation: self_avoiding, sequence: GSKEELRK, model: "
        "calvados2}]\nbox: {periodic: [12, 12, 12]}\n";

    Scene read(std::string const& yaml) const { return parse_scene(yaml, folder_ / "s.yaml"); }
    std::string refusal(std::string const& yaml) const {
        return refusal_of(yaml, {}, folder_ / "s.yaml");
    }
    /// Writes the folder of a run with two frames, the second shifted by 1 nm along x.
    void write_run(Scene const& scene) const {
        Topology topology;
        topology.box = scene.box;
        std::vector<Vec3> positions;
        for (ChainSpec const& chain : scene.chains) {
            topology.chains.push_back({chain.name, std::ssize(positions),
                                       static_cast<std::int64_t>(chain.size()), true, false, 0,
                                       chain.parent});
            positions.insert(positions.end(), chain.beads.position.begin(),
                             chain.beads.position.end());
            topology.mass.insert(topology.mass.end(), chain.beads.mass.begin(),
                                 chain.beads.mass.end());
            topology.residue.insert(topology.residue.end(), chain.beads.residue.begin(),
                                    chain.beads.residue.end());
        }
        std::filesystem::create_directories(folder_ / "run");
        auto const writer =
            make_trajectory(folder_ / "run/trajectory.h5md", topology, false, false, std::nullopt);
        Frame frame;
        frame.positions = positions;
        write_topology(folder_ / "run", topology, frame);
        writer->write(frame);
        frame.step = 50, frame.time = 0.5;
        for (Vec3& at : frame.positions) at[0] += 1;
        writer->write(frame);
        writer->close();
    }
    TemporaryFolder folder_;
};

TEST_F(StartRun, continues_from_the_last_frame_bit_for_bit) {
    Scene const was = read(yaml_);
    write_run(was);
    for (std::string const from : {"run", "run/trajectory.h5md"}) {
        Scene const scene = read(yaml_ + "start: {from: " + from + "}\n");
        for (std::size_t c = 0; c < 2; ++c)
            for (std::size_t k = 0; k < 8; ++k) {
                Vec3 const moved =
                    scene.chains[c].beads.position[k] - was.chains[c].beads.position[k];
                EXPECT_NEAR(moved[0], 1, 1e-12);
                EXPECT_NEAR(moved[1], 0, 1e-12);
            }
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_NE(scene.notes[0].find("frame 1 of 0 to 1 (step 50, 0.5 ps)"), std::string::npos)
            << scene.notes[0];
    }
}

/// Own positions that fit no links are no reason to refuse those of a frame.
TEST_F(StartRun, replaces_positions_that_would_be_refused) {
    write_run(read(yaml_));
    std::ofstream table(folder_ / "short.csv");
    for (int k = 0; k < 8; ++k) table << 0.2 * k << "," << 0.01 * (k % 2) << ",0\n";
    table.close();
    std::string const own =
        "chains: [{name: a, sequence: GSKEELRK, model: calvados2, positions: short.csv}, {name: b, "
        "sequence: GSKEELRK, model: calvados2}]\nbox: {periodic: [12, 12, 12]}\n";
    EXPECT_NE(refusal(own), "accepted");
    EXPECT_EQ(refusal(own + "start: {from: run}\n"), "accepted");
}

TEST_F(StartRun, of_other_branches_is_refused) {
    auto const star = [](int parent) {
        return "chains: [{name: s, bodies: [{mass: 10, position: [1, 1, 1]}, {mass: 10, position: "
               "[1.4, 1, 1], joint: {type: link}}, {mass: 10, position: [1, 1.4, 1], parent: 1, "
               "joint: {type: link}}, {mass: 10, position: [1, 1, 1.4], parent: " +
               std::to_string(parent) +
               ", joint: {type: link}}]}]\nbox: {periodic: [12, 12, 12]}\n";
    };
    write_run(read(star(1)));
    EXPECT_EQ(refusal(star(1) + "start: {from: run}\n"), "accepted");
    EXPECT_NE(refusal(star(2) + "start: {from: run}\n").find("chain 1, `s`, branches otherwise in"),
              std::string::npos);
}

TEST_F(StartRun, of_other_chains_is_refused_with_both) {
    write_run(read(yaml_));
    std::string const start = "start: {from: run}\n";
    std::string three = yaml_, longer = yaml_, other = yaml_, renamed = yaml_;
    three.replace(three.find("count: 2"), 8, "count: 3");
    EXPECT_NE(refusal(three + start).find("has 2 chains, the scene has 3"), std::string::npos);
    longer.replace(longer.find("GSKEELRK"), 8, "GSKEELRKA");
    std::string const beads = refusal(longer + start);
    EXPECT_NE(beads.find("chain 1, `p-1`, has 8 beads in `"), std::string::npos) << beads;
    EXPECT_NE(beads.find("the scene's `p-1` has 9"), std::string::npos) << beads;
    other.replace(other.find("GSKEELRK"), 8, "GSKDELRK");
    std::string const residue = refusal(other + start);
    EXPECT_NE(residue.find("bead 4 of chain `p-1` is ASP in the scene and GLU in `"),
              std::string::npos)
        << residue;
    renamed.replace(renamed.find("name: p"), 7, "name: q");
    Scene const scene = read(renamed + start);
    EXPECT_NE(scene.notes[0].find("names 2 of 2 chains otherwise, the first `p-1` for the scene's "
                                  "`q-1`"),
              std::string::npos)
        << scene.notes[0];
}

}  // namespace
}  // namespace catena::test
