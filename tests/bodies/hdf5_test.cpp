// Bodies from an HDF5 file: the same arrays as from a list, the same checks.
#include <cstdio>
#include <filesystem>
#include <map>

#include "io/hdf5_data.hpp"
#include "keys/maps.hpp"
#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

using Numbers = std::vector<double>;
using Shape = std::vector<hsize_t>;

class Hdf5Bodies : public testing::Test {
  protected:
    ~Hdf5Bodies() override { std::filesystem::remove(file_); }

    /// Three bodies: universal, helical, spherical.
    std::map<std::string, std::pair<Shape, Numbers>> data_{
        {"mass", {{3}, {1, 2, 3}}},
        {"com", {{3, 3}, {0, 0, 0, 0.5, 0, 0, 0, 0, 1}}},
        {"inertia", {{3, 6}, {1, 0, 2, 0, 0, 2.5, 1, 0.1, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1}}},
        {"axis", {{3, 3}, {0, 2, 0, 0, 0, 3, 0, 0, 0}}},
        {"first_axis", {{3, 3}, {1, 0, 0, 0, 0, 0, 0, 0, 0}}},
        {"pitch", {{3}, {0, 0.5, 0}}},
        {"translation", {{3, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0}}},
        {"q", {{3, 4}, {0.1, 0.2, 0, 0, 0.3, 0, 0, 0, 0.6, 0, 0.8, 0}}},
        {"qd", {{3, 3}, {1, 2, 0, 3, 0, 0, 4, 5, 6}}},
        {"stiffness", {{3, 3}, {1, 2, 0, 3, 0, 0, 4, 5, 6}}},
        {"wrench", {{3, 6}, {0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 0, 0}}},
    };
    std::vector<std::string> types_{"universal", "helical", "spherical"};
    Numbers type_numbers_;  // instead of the texts
    std::string base_ = "fixed";

    std::string write() {
        hdf5::Quiet const quiet;
        hdf5::File file(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
        std::string const doing = "write a test";
        hdf5::Place const place{file.get(), file_, doing};
        for (auto const& [name, values] : data_)
            hdf5::put_array(place, name, H5T_NATIVE_DOUBLE, values.second.data(), values.first);
        if (!type_numbers_.empty())
            hdf5::put_array(place, "joint_type", std::span<double const>(type_numbers_));
        else if (!types_.empty())
            hdf5::put_array(place, "joint_type", std::span<std::string const>(types_));
        return "chains: [{base: " + base_ + ", bodies: {hdf5: " + file_ + "}}]";
    }
    std::string refusal() { return refusal_of(write()); }
    std::string at(std::string const& name, int body = 0) const {
        return " (" + file_ + ": dataset `" + name + "`" +
               (body > 0 ? ", body " + std::to_string(body) : "") + "): ";
    }

    /// Of this test alone: others may run beside it.
    std::string file_ = std::string("hdf5_") +
                        testing::UnitTest::GetInstance()->current_test_info()->name() + ".h5";
};

TEST_F(Hdf5Bodies, are_those_of_the_list) {
    Scene const from_file = parse_scene(write(), "s.yaml");
    Scene const from_list = parse_scene(
        "chains: [{base: fixed, bodies: ["
        "{mass: 1, inertia: [1, 2, 2.5], joint: {type: universal, axes: [[1, 0, 0], [0, 2, 0]], q: "
        "[0.1, 0.2], qd: [1, 2], stiffness: [1, "
        "2]}},"
        "{mass: 2, com: [0.5, 0, 0], inertia: [[1, 0.1, 0], [0.1, 1, 0], [0, 0, 1]], wrench: "
        "{torque: [1, 2, 3], force: [4, 5, 6]},"
        " joint: {type: helical, axis: [0, 0, 3], pitch: 0.5, translation: [1, 0, 0], q: 0.3, qd: "
        "3, stiffness: 3}},"
        "{mass: 3, com: [0, 0, 1], inertia: [1, 1, 1], joint: {type: spherical, translation: [0, "
        "1, 0], q: [0.6, 0, 0.8, 0], qd: [4, 5, "
        "6], "
        "stiffness: [4, 5, 6]}}]}]",
        "s.yaml");
    EXPECT_EQ(from_file.hash, from_list.hash);
    EXPECT_EQ(from_file.chains[0].velocities, StartVelocities::given);
}

TEST_F(Hdf5Bodies, cylindrical_and_planar3_are_those_of_the_list) {
    type_numbers_ = {9, 8, 2};
    data_.erase("pitch");
    data_["q"] = {{3, 4}, {0.1, 0.2, 0.3, 0, 0.3, 0.4, 0, 0, 0.6, 0, 0.8, 0}};
    data_["qd"] = {{3, 3}, {1, 2, 7, 3, 7, 0, 4, 5, 6}};
    data_["stiffness"] = {{3, 3}, {1, 2, 7, 3, 7, 0, 4, 5, 6}};
    data_["wrench"].second.assign(18, 0);
    Scene const from_file = parse_scene(write(), "s.yaml");
    Scene const from_list = parse_scene(
        "chains: [{base: fixed, bodies: ["
        "{mass: 1, inertia: [1, 2, 2.5], joint: {type: planar3, axes: [[1, 0, 0], [0, 2, 0]], q: "
        "[0.1, 0.2, 0.3], qd: [1, 2, 7], stiffness: [1, 2, 7]}},"
        "{mass: 2, com: [0.5, 0, 0], inertia: [[1, 0.1, 0], [0.1, 1, 0], [0, 0, 1]], wrench: {}, "
        "joint: {type: cylindrical, axis: [0, 0, 3], translation: [1, 0, 0], q: [0.3, 0.4], qd: "
        "[3, 7], stiffness: [3, 7]}},"
        "{mass: 3, com: [0, 0, 1], inertia: [1, 1, 1], joint: {type: spherical, translation: [0, "
        "1, 0], q: [0.6, 0, 0.8, 0], qd: [4, 5, 6], stiffness: [4, 5, 6]}}]}]",
        "s.yaml");
    EXPECT_EQ(from_file.hash, from_list.hash);
    data_["first_axis"].second[1] = 0.1;
    EXPECT_EQ(refusal(), "the two axes are not perpendicular" + at("first_axis", 1) +
                             "give a direction in the plane, then its normal");
}

TEST_F(Hdf5Bodies, hang_on_the_bodies_of_the_list) {
    data_["parent"] = {{3}, {0, 1, 1}};
    EXPECT_EQ(parse_scene(write(), "s.yaml").chains[0].parent,
              (std::vector<std::int64_t>{-1, 0, 0}));
    data_["parent"].second[2] = 2;
    EXPECT_FALSE(parse_scene(write(), "s.yaml").chains[0].is_branched());
    for (double const wrong : {3.0, 0.0, 1.5, -1.0, 1e30}) {
        data_["parent"].second[2] = wrong;
        std::string const message = refusal();
        EXPECT_NE(message.find(at("parent", 3) + "give the number of an earlier body, 1 to 2"),
                  std::string::npos)
            << message;
    }
    data_["parent"].second = {1, 1, 1};
    EXPECT_EQ(refusal(),
              "body 1 hangs on body 1" + at("parent", 1) + "give 0: body 1 hangs on none");
}

TEST_F(Hdf5Bodies, types_by_number_and_defaults) {
    type_numbers_ = {0, 3, 5};
    base_ = "free";
    for (char const* const name :
         {"com", "first_axis", "pitch", "translation", "q", "qd", "stiffness", "wrench"})
        data_.erase(name);
    data_["inertia"] = {{3, 3, 3}, {1, 0, 0, 0, 2, 0, 0, 0, 2.5, 1, 0.1, 0, 0.1, 1,
                                    0, 0, 0, 1, 1, 0, 0, 0, 1,   0, 0,   0, 1}};
    data_["free_position"] = {{3}, {1, 2, 3}};
    BodyArrays const b = parse_scene(write(), "s.yaml").chains[0].bodies;
    EXPECT_EQ(b.joint,
              (std::vector<JointType>{JointType::free, JointType::revolute, JointType::weld}));
    EXPECT_EQ(b.q[0], (std::array<double, 4>{1, 0, 0, 0}));
    EXPECT_EQ(b.q[1], (std::array<double, 4>{0, 0, 0, 0}));
    EXPECT_EQ(b.free_base.position[2], 3);
    EXPECT_EQ(b.inertia[1](1, 0), 0.1);
    EXPECT_EQ(b.axis[1][2], 1);
    EXPECT_TRUE(b.torque.empty() && b.stiffness.empty() && b.wrench.empty() &&
                b.first_axis.empty() && b.pitch.empty() && b.drag.empty());
}

/// A few hundred bytes that would take 2 GB of memory.
TEST_F(Hdf5Bodies, a_chunk_of_texts_beyond_a_gigabyte) {
    types_.clear();
    std::string const scene = write();
    {
        hdf5::File const file(H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
        hsize_t const rows = 3, most = H5S_UNLIMITED, chunk = hsize_t{1} << 27;
        hdf5::Type const text(H5Tcopy(H5T_C_S1));
        H5Tset_size(text.get(), 16);
        hdf5::Space const space(H5Screate_simple(1, &rows, &most));
        hdf5::Properties const how(H5Pcreate(H5P_DATASET_CREATE));
        H5Pset_chunk(how.get(), 1, &chunk);
        H5Pset_deflate(how.get(), 1);
        hdf5::Dataset const data(H5Dcreate2(file.get(), "joint_type", text.get(), space.get(),
                                            H5P_DEFAULT, how.get(), H5P_DEFAULT));
        ASSERT_TRUE(data);
    }
    EXPECT_EQ(refusal_of(scene),
              "a chunk of the dataset is larger than a gigabyte, which is read at once" +
                  at("joint_type") + "write it in smaller chunks");
}

TEST_F(Hdf5Bodies, refusals_of_the_file) {
    EXPECT_EQ(refusal_of("chains: [{base: fixed, bodies: {hdf5: nowhere.h5}}]")
                  .rfind("the file does not exist or is not an HDF5 file: ", 0),
              0u);
    data_["dampening"] = {{3}, {0, 0, 0}};
    EXPECT_EQ(refusal(), "unknown dataset" + at("dampening") + "did you mean `damping`?");
    data_.erase("dampening");
    data_["com"].first = {3, 1, 3};
    EXPECT_EQ(refusal(),
              "the dataset has shape [3, 1, 3], not [3, 3]" + at("com") + "give one row per body");
    data_["com"] = {{2, 3}, {0, 0, 0, 0, 0, 0}};
    EXPECT_EQ(refusal(),
              "the dataset has shape [2, 3], not [3, 3]" + at("com") + "give one row per body");
    data_.erase("com");
    auto const inertia = data_["inertia"];
    data_["inertia"] = {{3, 3}, {1, 1, 1, 1, 1, 1, 1, 1, 1}};
    EXPECT_EQ(refusal(), "the dataset has shape [3, 3], not [3, 3, 3] or [3, 6]" + at("inertia") +
                             "give one row per body");
    data_.erase("inertia");
    EXPECT_EQ(refusal(), "the dataset is missing" + at("inertia") +
                             "add it: one tensor per body, about its centre of mass");
    data_["inertia"] = inertia;
    data_.erase("axis");
    EXPECT_EQ(refusal(),
              "the dataset is missing" + at("axis") + "add it: body 1 has a universal joint");
    data_.erase("mass");
    EXPECT_EQ(refusal(), "the dataset is missing" + at("mass") + "add it: its rows are the bodies");
    EXPECT_EQ(refusal_of("chains: [{bodies: {hdf: a.h5}}]"),
              "unknown key `hdf` (s.yaml: chains[0].bodies.hdf, line 1): did you mean `hdf5`?");
}

TEST_F(Hdf5Bodies, each_declared_dataset_is_read) {
    auto const right = data_;
    for (scene::Key const& dataset : scene::keys::datasets.keys) {
        std::string const name(dataset.name);
        if (name == "joint_type") continue;  // refusals_of_values
        data_[name] = {{3, 7}, Numbers(21, 0)};
        EXPECT_NE(refusal().find("dataset `" + name + "`"), std::string::npos)
            << name << ": " << refusal();
        data_ = right;
    }
}

TEST_F(Hdf5Bodies, refusals_of_values) {
    auto const with = [&](std::string const& name, std::size_t entry, double value) {
        auto const before = data_[name];
        data_[name].second[entry] = value;
        std::string const message = refusal();
        data_[name] = before;
        return message;
    };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(with("mass", 1, -2),
              "mass -2 is not positive" + at("mass", 2) + "give a number above 0");
    EXPECT_EQ(with("mass", 2, nan), "nan is not finite" + at("mass", 3) + "give finite numbers");
    EXPECT_EQ(with("inertia", 0, 5),
              "the principal moments 2, 2.5, 5 violate the triangle inequality of rigid bodies" +
                  at("inertia", 1) + "the largest may not exceed the sum of the other two");
    EXPECT_EQ(with("axis", 5, 0),
              "the axis is zero" + at("axis", 2) + "give a direction such as [0, 0, 1]");
    EXPECT_EQ(with("first_axis", 1, 1e9),
              "the two axes are parallel" + at("first_axis", 1) +
                  "give two directions, best at right angles, or use a revolute joint");
    EXPECT_EQ(with("pitch", 1, 0), "a helical joint without pitch" + at("pitch", 2) +
                                       "give its shift per radian, or use a revolute joint");
    EXPECT_EQ(with("q", 8, 1), "the quaternion is not a unit quaternion: its norm is 1.28062485" +
                                   at("q", 3) +
                                   "normalise it: divide its four numbers by their norm");
    EXPECT_EQ(with("stiffness", 3, -1),
              "stiffness -1 is negative" + at("stiffness", 2) + "give 0 or positive numbers");
    EXPECT_EQ(with("stiffness", 5, 2), "number 3 of stiffness is 2, and a helical joint has 1" +
                                           at("stiffness", 2) + "write 0 there");
    EXPECT_EQ(with("qd", 2, 7),
              "number 3 of qd is 7, and a universal joint has 2" + at("qd", 1) + "write 0 there");
    EXPECT_EQ(with("q", 3, 7),
              "number 4 of q is 7, and a universal joint has 2" + at("q", 1) + "write 0 there");
    EXPECT_EQ(with("q", 4, 1e30), "a joint's position of 1e+30 is beyond the range of coordinates" +
                                      at("q", 2) + "correct it: the largest is 1e+09");
    data_["rest"] = data_["q"];
    EXPECT_EQ(refusal(), "accepted");
    auto const stiffness = data_["stiffness"];
    data_.erase("stiffness");
    EXPECT_EQ(refusal(), "the dataset is missing" + at("stiffness") +
                             "add it: springs that are relaxed at `rest` have one");
    data_["stiffness"] = stiffness;
    data_["rotation"] = {{3, 3, 3}, Numbers(27, 0)};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i : {0, 4, 8}) data_["rotation"].second[9 * k + i] = 1;
    EXPECT_EQ(refusal(), "accepted");
    EXPECT_EQ(with("rotation", 17, -1), "the rotation is left-handed: its determinant is -1" +
                                            at("rotation", 2) + "change the sign of one column");
    data_["drag"] = {{3, 2}, {1, 1, 1, 1, 1, 1}};
    EXPECT_EQ(with("drag", 5, -1),
              "drag 1, -1 is negative" + at("drag", 3) + "give 0 or positive numbers");
    types_[1] = "revolut";
    EXPECT_EQ(refusal(), "`revolut` is not a joint type" + at("joint_type", 2) +
                             "use the names of `joint.type`");
    types_[1] = "link";
    EXPECT_EQ(refusal(), "a link in a file of rigid bodies on joints" + at("joint_type", 2) +
                             "write chains of links as a list or a generator");
    types_[1] = "free";
    EXPECT_EQ(refusal(), "a free joint inside a chain" + at("joint_type", 2) +
                             "use it for body 1 of a chain with `base: free`");
    type_numbers_ = {4, 7, 10};
    EXPECT_EQ(
        refusal(),
        "10 is not a joint type" + at("joint_type", 3) +
            "use 0 free, 2 spherical, 3 revolute, 4 universal, 5 weld, 6 prismatic, 7 helical, 8 "
            "cylindrical, 9 planar3");
    type_numbers_ = {0, 7, 2};
    EXPECT_EQ(refusal(), "a free joint on a fixed base" + at("joint_type", 1) +
                             "write `base: free`, or give joint 1 another type");
    type_numbers_ = {2, 7, 2};
    base_ = "free";
    EXPECT_EQ(refusal(), "a spherical joint 1 on a free base, which has no joint 1" +
                             at("joint_type", 1) + "write `base: fixed`, or make joint 1 free");
}

}  // namespace
}  // namespace catena::test
