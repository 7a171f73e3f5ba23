// Implements accelerations as CSV and JSON, and the choice of the format.
#include "measure/accelerations_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "error.hpp"
#include "io/output_file.hpp"
#include "scene/files.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t most_numbers = 6;  // numbers per body of accelerations and of forces

enum class Format { csv, hdf5, json };

/// Format that the file's ending names.
Format format_of(std::string const& file) {
    std::string const ending = scene::ending_of(file);
    if (ending == ".csv") return Format::csv;
    if (ending == ".h5" || ending == ".hdf5") return Format::hdf5;
    if (ending == ".json") return Format::json;
    throw InputError(ending.empty() ? "the name has no ending, which chooses the format"
                                    : "unknown ending " + ending,
                     "--accelerations " + file,
                     "name a file with .csv, .json or .h5 (.hdf5) at its end");
}

/// Numbers of body b in a flat array with offsets.
std::span<double const> numbers_of(std::vector<double> const& flat,
                                   std::vector<std::int64_t> const& offset, std::size_t b) {
    auto const begin = static_cast<std::size_t>(offset[b]),
               end = static_cast<std::size_t>(offset[b + 1]);
    return std::span(flat).subspan(begin, end - begin);
}

/// Calls `take(chain, k, accelerations, joint forces)` for every body in scene order.
template <class Take>
void for_each_body(Scene const& scene, Solution const& s, Take const& take) {
    std::size_t body = 0;
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size(); ++k, ++body)
            take(chain, k, numbers_of(s.acceleration, s.acceleration_offset, body),
                 numbers_of(s.joint_force, s.force_offset, body));
}

/// Text as one field of a CSV file.
std::string field(std::string const& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char const c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

/// Six fields, the last of which may be empty.
std::string fields(std::span<double const> numbers) {
    std::string text;
    for (std::size_t i = 0; i < most_numbers; ++i)
        text += i < numbers.size() ? fmt::format(",{:.17g}", numbers[i]) : ",";
    return text;
}

/// Calls action(chain, link, tension) for every cross-link.
template <class Action>
void for_each_crosslink(Scene const& scene, Solution const& s, Action const& action) {
    std::size_t next = 0;
    for (ChainSpec const& chain : scene.chains)
        for (CrossLink const& link : chain.crosslinks)
            action(chain, link, s.crosslink_tension[next++]);
}

/// Calls action(chain, loop, wrench) for every loop.
template <class Action>
void for_each_loop(Scene const& scene, Solution const& s, Action const& action) {
    std::size_t next = 0;
    for (ChainSpec const& chain : scene.chains)
        for (LoopClosure const& loop : chain.loops)
            action(chain, loop, s.loop_force[next++].wrench);
}

void write_csv(std::string const& file, Scene const& scene, Solution const& s) {
    AtomicFile out(file);
    std::string header = "chain,body,joint";
    for (char const* const name : {"acceleration", "joint_force"})
        for (std::size_t i = 1; i <= most_numbers; ++i) header += fmt::format(",{}_{}", name, i);
    out.write(header + "\n");
    for_each_body(scene, s, [&](ChainSpec const& chain, std::size_t k, auto of_body, auto forces) {
        out.write(fmt::format("{},{},{}{}{}\n", field(chain.name), k + 1, joint_name(chain, k),
                              fields(of_body), fields(forces)));
    });
    for (TipForce const& tip : s.tip_force) {
        ChainSpec const& chain = scene.chains[static_cast<std::size_t>(tip.chain)];
        out.write(fmt::format("{},tip,{}{}{}\n", field(chain.name), name_of(chain.tip_joint.type),
                              fields({}), fields({tip.wrench.data, most_numbers})));
    }
    for_each_loop(scene, s, [&](ChainSpec const& chain, LoopClosure const& loop, auto wrench) {
        out.write(fmt::format("{},{}-{},{}{}{}\n", field(chain.name), loop.inboard + 1,
                              loop.outboard + 1, name_of(loop.joint.type), fields({}),
                              fields({wrench.data, most_numbers})));
    });
    for_each_crosslink(scene, s, [&](ChainSpec const& chain, CrossLink const& link, double pull) {
        out.write(fmt::format("{},{}-{},crosslink{}{}\n", field(chain.name), link.inboard + 1,
                              link.outboard + 1, fields({}), fields({&pull, 1})));
    });
    out.publish();
}

void write_json(std::string const& file, Scene const& scene, Solution const& s) {
    Json json{{"scene", scene.file}, {"units", scene.si ? "si" : "nm, ps, amu"}};
    add_solution(json, scene, s);
    replace_text_file(file, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json vectors_json(std::vector<Vec3> const& vectors) {
    Json list = Json::array();
    for (Vec3 const& v : vectors) list.push_back({v[0], v[1], v[2]});
    return list;
}

/// Acceleration of one body: a number, a list, or two lists for six numbers.
Json acceleration_json(std::span<double const> a) {
    if (a.size() == 1) return a[0];
    if (a.size() == most_numbers)
        return {{"alpha", {a[0], a[1], a[2]}}, {"acceleration", {a[3], a[4], a[5]}}};
    Json list = Json::array();
    for (double const value : a) list.push_back(value);
    return list;
}

}  // namespace

char const* joint_name(ChainSpec const& chain, std::size_t k) {
    if (chain.is_beads()) return "bead";
    if (chain.is_linked()) return chain.linked.is_bead(k) ? "bead" : "body on links";
    return name_of(chain.bodies.joint[k]);
}

void add_solution(Json& json, Scene const& scene, Solution const& s) {
    Json accelerations = Json::array(), forces = Json::array(), tips = Json::array();
    for_each_body(scene, s, [&](ChainSpec const&, std::size_t, auto of_body, auto of_joint) {
        accelerations.push_back(acceleration_json(of_body));
        if (of_joint.size() == 1)
            forces.push_back(of_joint[0]);
        else
            forces.push_back(std::vector<double>(of_joint.begin(), of_joint.end()));
    });
    for (TipForce const& tip : s.tip_force) {
        Vector<double, 6> const& w = tip.wrench;
        tips.push_back({{"chain", scene.chains[static_cast<std::size_t>(tip.chain)].name},
                        {"torque", {w[0], w[1], w[2]}},
                        {"force", {w[3], w[4], w[5]}}});
    }
    json["joint_accelerations"] = std::move(accelerations);
    json["bead_accelerations"] = vectors_json(s.bead_acceleration);
    json["bead_forces"] = vectors_json(s.bead_force);
    json["joint_forces"] = std::move(forces);
    json["tip_forces"] = std::move(tips);
    for_each_loop(scene, s, [&](ChainSpec const& chain, LoopClosure const& loop, auto w) {
        json["loop_forces"].push_back({{"chain", chain.name},
                                       {"bodies", {loop.inboard + 1, loop.outboard + 1}},
                                       {"torque", {w[0], w[1], w[2]}},
                                       {"force", {w[3], w[4], w[5]}}});
    });
    for_each_crosslink(scene, s, [&](ChainSpec const& chain, CrossLink const& link, double pull) {
        json["crosslink_tensions"].push_back({{"chain", chain.name},
                                              {"beads", {link.inboard + 1, link.outboard + 1}},
                                              {"tension", pull}});
    });
}

void require_accelerations_writer(std::string const& file) {
    auto const kind = fs::status(file).type();
    if (kind != fs::file_type::not_found && kind != fs::file_type::regular)
        throw InputError("not a regular file", "--accelerations " + file,
                         "name a file that can be replaced");
    if (format_of(file) == Format::hdf5) require_accelerations_hdf5(file);
}

void write_accelerations(std::string const& file, Scene const& scene, Solution const& solution) {
    require_accelerations_writer(file);
    switch (format_of(file)) {
        case Format::csv:
            return write_csv(file, scene, solution);
        case Format::json:
            return write_json(file, scene, solution);
        case Format::hdf5:
            write_accelerations_hdf5(file, solution);
    }
}

}  // namespace catena
