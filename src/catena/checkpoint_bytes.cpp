// Implements checkpoints as bytes.
#include "catena/checkpoint_bytes.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "error.hpp"
#include "io/checksum.hpp"

namespace catena {
namespace {

using nlohmann::json;

/// First bytes of a checkpoint; the number is the version of the layout.
constexpr std::string_view mark = "catena checkpoint 1\n";
constexpr std::size_t size_of_sum = sizeof(std::uint64_t);

std::uint64_t sum_of(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

[[noreturn]] void refuse(std::string const& what) {
    throw InputError(what, "Simulation::restore", "give the bytes of Simulation::checkpoint()");
}

json binary_of(std::vector<double> const& numbers) {
    std::vector<std::uint8_t> bytes(numbers.size() * sizeof(double));
    if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return json::binary(std::move(bytes));
}
std::vector<double> numbers_of(json const& value) {
    json::binary_t const& bytes = value.get_binary();
    std::vector<double> numbers(bytes.size() / sizeof(double));
    if (!numbers.empty())
        std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
    return numbers;
}

/// Returns what a sealed body holds.
Checkpoint contents_of(std::string_view body) {
    json const all = json::from_cbor(body.begin(), body.end());
    Checkpoint c;
    all.at("step").get_to(c.step);
    all.at("time").get_to(c.time);
    all.at("scene").get_to(c.scene_hash);
    all.at("notes").get_to(c.notes);
    all.at("integers").get_to(c.integers);
    for (auto const& [name, value] : all.at("arrays").items()) c.arrays[name] = numbers_of(value);
    return c;
}

}  // namespace

std::string bytes_of(Checkpoint const& c) {
    json all = {{"step", c.step},   {"time", c.time},         {"scene", c.scene_hash},
                {"notes", c.notes}, {"integers", c.integers}, {"arrays", json::object()}};
    for (auto const& [name, numbers] : c.arrays) all["arrays"][name] = binary_of(numbers);
    std::string body;
    json::to_cbor(all, body);
    std::uint64_t const sum = sum_of(body);
    std::string bytes(mark);
    bytes.append(reinterpret_cast<char const*>(&sum), size_of_sum);
    return bytes + body;
}

Checkpoint checkpoint_of(std::string const& bytes) {
    std::string_view rest(bytes);
    if (!rest.starts_with(mark)) refuse("these bytes are not a checkpoint of this version");
    rest.remove_prefix(mark.size());
    std::uint64_t sum = 0;
    if (rest.size() < size_of_sum) refuse("the checkpoint is cut off");
    std::memcpy(&sum, rest.data(), size_of_sum);
    rest.remove_prefix(size_of_sum);
    if (sum != sum_of(rest)) refuse("the checkpoint is damaged, its checksum differs");
    try {
        return contents_of(rest);
    } catch (json::exception const&) {
        refuse("the checkpoint is damaged, a value is missing");
    }
}

}  // namespace catena
