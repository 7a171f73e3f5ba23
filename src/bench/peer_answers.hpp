// Solves the chains of the stability suite by other programs that eliminate body by body, as
// articulated-body algorithms do.
#pragma once

#include <map>

#include "bench/peers.hpp"
#include "measure/stability.hpp"

namespace catena::command {

/// Returns Simbody and Pinocchio. MuJoCo is left out: it factors the joint-space inertia, whose
/// condition is a different question.
std::vector<PeerProgram> peers_of_suite();
/// Returns limits that are short, because a suite has many chains.
Peer::Limits limits_of_suite();

/// Keeps one process per program, which solves one chain after the other. After a stop another
/// process is started for the next case.
class PeerAnswers {
  public:
    explicit PeerAnswers(std::vector<PeerProgram>, Peer::Limits);
    /// Returns the answers of the programs that are present. If a program stopped in a family, it
    /// is not asked about longer chains of that family.
    std::vector<PeerAnswer> operator()(StabilityCase const&, Scene const&);
    Json json() const { return peers_.json(); }
    std::vector<std::string> not_run() const { return peers_.not_run(); }

  private:
    struct Stop {
        std::string peer, family, name, why;
        std::int64_t bodies = 0;
    };
    PeerAnswer ask(PeerProgram const&, StabilityCase const&, Scene const&);
    Stop const* stop_of(std::string const& peer, StabilityCase const&) const;

    Peers peers_;
    std::map<std::string, std::unique_ptr<Peer>> running_;
    std::vector<Stop> stops_;
};

}  // namespace catena::command
