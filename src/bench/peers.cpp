// Implements the folder of chains and the list of peers.
#include "bench/peers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "error.hpp"

namespace catena::command {
namespace {

namespace fs = std::filesystem;

/// Creates a temporary folder. Throws ComputationError if that fails.
fs::path temporary_folder() {
    std::string name = (fs::temp_directory_path() / "catena-peers-XXXXXX").string();
    if (!::mkdtemp(name.data()))
        throw ComputationError("no temporary folder for the peers' chains (" + name + ")");
    return name;
}

}  // namespace

Peers::Peers(std::vector<PeerProgram> programs, Peer::Limits limits)
    : folder_(temporary_folder()), programs_(std::move(programs)), limits_(limits) {}

Peers::~Peers() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

void Peers::write(std::vector<double> const& table) const {
    std::ofstream out(file("chain"), std::ios::binary);
    out.write(reinterpret_cast<char const*>(table.data()),
              static_cast<std::streamsize>(table.size() * sizeof(double)));
    if (!out.flush())
        throw ComputationError("the chain cannot be written for the peers (" + file("chain") +
                               "): is the disk full?");
}

std::unique_ptr<Peer> Peers::start(PeerProgram const& program) const {
    return std::make_unique<Peer>(program, file("chain"), file(program.name), limits_);
}

void Peers::note(PeerProgram const& program, Peer const& peer) {
    described_[program.name] = peer.description();
}

Json Peers::json() const {
    Json all = Json::array();
    for (PeerProgram const& program : programs_) {
        Json json{{"name", program.name}};
        if (!program.missing.empty()) json["not_run"] = program.missing;
        if (auto const found = described_.find(program.name); found != described_.end())
            for (char const* const key : {"version", "method"})
                json[key] = found->second.value(key, "");
        all.push_back(json);
    }
    return all;
}

std::vector<std::string> Peers::not_run() const {
    std::vector<std::string> lines;
    for (PeerProgram const& program : programs_)
        if (!program.missing.empty())
            lines.push_back(fmt::format("NOT RUN: {}: {}", program.name, program.missing));
    return lines;
}

std::int64_t memory_for_peers() {
    return std::int64_t{::sysconf(_SC_PHYS_PAGES)} * ::sysconf(_SC_PAGESIZE) / 2;
}

}  // namespace catena::command
