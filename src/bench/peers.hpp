// The other programs that this machine has, and the folder in which they find the chains that they
// are asked about.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/peer.hpp"

namespace catena::command {

class Peers {
  public:
    explicit Peers(std::vector<PeerProgram>, Peer::Limits);
    ~Peers();
    Peers(Peers const&) = delete;
    Peers& operator=(Peers const&) = delete;

    std::vector<PeerProgram> const& programs() const { return programs_; }
    Peer::Limits const& limits() const { return limits_; }
    /// The chain that is asked about from here on.
    void write(std::vector<double> const& table) const;
    std::unique_ptr<Peer> start(PeerProgram const&) const;
    /// Keeps what one that is ready says of itself.
    void note(PeerProgram const&, Peer const&);

    /// Name, version and method of each, or `not_run`.
    Json json() const;
    /// "NOT RUN: NAME: WHY" of those that are missing.
    std::vector<std::string> not_run() const;

  private:
    std::string file(std::string const& name) const { return (folder_ / name).string(); }
    std::filesystem::path folder_;
    std::vector<PeerProgram> const programs_;
    Peer::Limits const limits_;
    std::map<std::string, Json> described_;
};

/// Half of this machine's memory.
std::int64_t memory_for_peers();

}  // namespace catena::command
