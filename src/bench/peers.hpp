// The other programs on this machine, and the folder of the chains that they solve.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/peer.hpp"

namespace catena::command {

/// Starts peers and keeps their self-descriptions. The folder is removed at the end.
class Peers {
  public:
    explicit Peers(std::vector<PeerProgram>, Peer::Limits);
    ~Peers();
    Peers(Peers const&) = delete;
    Peers& operator=(Peers const&) = delete;

    std::vector<PeerProgram> const& programs() const { return programs_; }
    Peer::Limits const& limits() const { return limits_; }
    /// Writes the chain that the following questions are about.
    void write(std::vector<double> const& table) const;
    /// Starts a program on that chain.
    std::unique_ptr<Peer> start(PeerProgram const&) const;
    /// Keeps the self-description of a peer that is ready.
    void note(PeerProgram const&, Peer const&);

    /// Returns name, version and method of each program, or `not_run`.
    Json json() const;
    /// Returns "NOT RUN: NAME: WHY" for each missing program.
    std::vector<std::string> not_run() const;

  private:
    std::string file(std::string const& name) const { return (folder_ / name).string(); }
    std::filesystem::path folder_;
    std::vector<PeerProgram> const programs_;
    Peer::Limits const limits_;
    std::map<std::string, Json> described_;
};

/// Returns half of this machine's memory in bytes.
std::int64_t memory_for_peers();

}  // namespace catena::command
