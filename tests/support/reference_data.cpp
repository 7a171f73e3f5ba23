#include "tests/support/reference_data.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace catena::test {
namespace {

using Json = nlohmann::json;

Json read(std::string const& name) {
    std::string const path = std::string(CATENA_TEST_DATA) + "/reference/" + name;
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    return Json::parse(file);
}

Vec3 vector3(Json const& v) {
    return {{v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()}};
}
/// A revolute joint's number as {x, 0, 0}, a spherical joint's three as they are, and those of a
/// free body's rotation.
Vec3 joint_value(Json const& v) {
    if (v.is_object()) return vector3(v.contains("alpha") ? v.at("alpha") : v.at("omega"));
    return v.is_number() ? Vec3{{v.get<double>(), 0, 0}} : vector3(v);
}
std::vector<Vec3> vectors(Json const& list) {
    std::vector<Vec3> result;
    for (Json const& v : list) result.push_back(joint_value(v));
    return result;
}
Mat3 matrix3(Json const& rows) {
    Mat3 m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m(i, j) =
                rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
    return m;
}
Sym3 symmetric3(Json const& rows) {
    Mat3 const m = matrix3(rows);
    return {{m(0, 0), m(1, 0), m(1, 1), m(2, 0), m(2, 1), m(2, 2)}};
}

/// Appends the state of body 1 of a free base.
void append_free(BodyArrays& bodies, Json const& body) {
    bodies.joint.push_back(JointType::free);
    bodies.axis.push_back({{0, 0, 1}});
    bodies.rotation.push_back(Mat3::identity());
    bodies.translation.push_back(Vec3::zero());
    bodies.q.push_back(body.at("q").at("quaternion").get<std::array<double, 4>>());
    bodies.torque.push_back(Vec3::zero());
    bodies.free_base.position = vector3(body.at("q").at("position"));
    bodies.free_base.velocity = vector3(body.at("qd").at("velocity"));
}

void append_joint(BodyArrays& bodies, Json const& body) {
    Json const& joint = body.at("joint");
    bool const revolute = joint.at("type") == "revolute";
    bodies.joint.push_back(revolute ? JointType::revolute : JointType::spherical);
    bodies.axis.push_back(revolute ? vector3(joint.at("axis")) : Vec3{{0, 0, 1}});
    bodies.rotation.push_back(matrix3(joint.at("parent_pose").at("rotation")));
    bodies.translation.push_back(vector3(joint.at("parent_pose").at("translation")));
    if (revolute)
        bodies.q.push_back({body.at("q").get<double>(), 0, 0, 0});
    else
        bodies.q.push_back(body.at("q").get<std::array<double, 4>>());
    bodies.torque.push_back(joint_value(body.at("tau")));
}

void append_body(BodyArrays& bodies, Json const& body) {
    Json const& wrench = body.at("wrench");
    bodies.mass.push_back(body.at("mass"));
    bodies.com.push_back(vector3(body.at("com")));
    bodies.inertia.push_back(symmetric3(body.at("inertia")));
    body.at("joint").at("type") == "free" ? append_free(bodies, body) : append_joint(bodies, body);
    bodies.qd.push_back(joint_value(body.at("qd")));
    bodies.wrench.push_back(
        {vector3(wrench),
         {{wrench.at(3).get<double>(), wrench.at(4).get<double>(), wrench.at(5).get<double>()}}});
}

ReferenceChain pinocchio(std::string const& file) {
    Json const json = read(file);
    Json const& expected = json.at("expected");
    ReferenceChain r;
    r.name = r.chain.name = json.at("name");
    r.chain.base = json.at("base") == "fixed" ? Base::fixed : Base::free;
    r.gravity = vector3(json.at("gravity"));
    for (Json const& body : json.at("bodies")) append_body(r.chain.bodies, body);
    r.qdd = vectors(expected.at("qdd"));
    r.com_position = vectors(expected.at("com_position_world"));
    r.com_velocity = vectors(expected.at("com_velocity_world"));
    r.omega = vectors(expected.at("omega_world"));
    r.com_acceleration = vectors(expected.at("com_acceleration_world"));
    r.alpha = vectors(expected.at("alpha_world"));
    r.kinetic_energy = expected.at("kinetic_energy").get<double>();
    r.potential_energy = expected.at("potential_energy").get<double>();
    for (auto const& [key, value] : json.at("agreement").items())
        if (value.is_number()) r.agreement[key] = value.get<double>();
    r.condition = r.agreement.at("condition_number_of_joint_space_inertia");
    return r;
}

ReferenceChain tree(std::string const& file) {
    ReferenceChain r = pinocchio(file);
    Json const json = read(file);
    Json const &expected = json.at("expected"), &first = expected.at("qdd").at(0);
    for (Json const& body : json.at("bodies"))
        r.chain.parent.push_back(body.at("parent").get<std::int64_t>() - 1);
    if (first.is_object()) r.base_acceleration = vector3(first.at("acceleration"));
    r.joint_wrench = expected.at("joint_wrench_on_outboard_body_world")
                         .get<std::vector<std::array<double, 6>>>();
    return r;
}

/// Rods along x of their bodies; the inertia about x is free to choose where all motion is about z.
void append_rod(BodyArrays& bodies, Json const& data, std::size_t k) {
    double const length = data.at("length"), izz = data.at("inertia_zz_about_com").at(k);
    bodies.mass.push_back(data.at("mass").at(k));
    bodies.com.push_back({{length / 2, 0, 0}});
    bodies.inertia.push_back({{izz / 2, 0, izz, 0, 0, izz}});
    bodies.joint.push_back(JointType::revolute);
    bodies.axis.push_back({{0, 0, 1}});
    bodies.rotation.push_back(Mat3::identity());
    bodies.translation.push_back({{k == 0 ? 0 : length, 0, 0}});
    bodies.q.push_back({data.at("q").at(k).get<double>(), 0, 0, 0});
    bodies.qd.push_back({{data.at("qd").at(k).get<double>(), 0, 0}});
}

ReferenceChain rods(Json const& data) {
    ReferenceChain r;
    std::size_t const n = data.at("n");
    bool const rest = data.at("label").get<std::string>().starts_with("rest");
    r.name = r.chain.name = "rods-" + std::to_string(n) + (rest ? " rest" : " moving");
    r.chain.base = Base::fixed;
    r.gravity = vector3(data.at("gravity"));
    for (std::size_t k = 0; k < n; ++k) append_rod(r.chain.bodies, data, k);
    r.qdd = vectors(data.at("qdd"));
    r.qdd_digits = data.at("qdd_50_digits").get<std::vector<std::string>>();
    r.alpha_digits = data.at("absolute_alpha_50_digits").get<std::vector<std::string>>();
    for (std::string const& digits : r.alpha_digits) r.alpha.push_back({{0, 0, std::stod(digits)}});
    for (Json const& f : data.at("pin_force_on_link_at_its_inboard_pin"))
        r.pin_force.push_back({{f.at(0).get<double>(), f.at(1).get<double>(), 0}});
    for (auto const& [key, value] : data.at("agreement").items())
        if (value.is_number()) r.agreement[key] = value.get<double>();
    r.condition = r.agreement.at("condition_number_joint_space_inertia");
    return r;
}

}  // namespace

std::vector<ReferenceChain> const& reference_chains() {
    static std::vector<ReferenceChain> const chains = [] {
        std::vector<ReferenceChain> all{pinocchio("pinocchio-chain3.json"),
                                        pinocchio("pinocchio-chain50.json")};
        for (char const* file : {"pendulum-rods-n8.json", "pendulum-rods-n32.json"}) {
            Json const json = read(file);
            for (Json const& data : json.at("cases")) all.push_back(rods(data));
        }
        return all;
    }();
    return chains;
}

ReferenceChain const& reference_chain(std::string const& name) {
    for (ReferenceChain const& r : reference_chains())
        if (r.name == name) return r;
    throw std::runtime_error("no reference chain is called " + name);
}

std::vector<ReferenceChain> const& reference_trees() {
    static std::vector<ReferenceChain> const all{tree("pinocchio-tree12.json"),
                                                 tree("pinocchio-tree60free.json")};
    return all;
}

}  // namespace catena::test
