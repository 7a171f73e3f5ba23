// Chains of the stability suite, solved by other programs that eliminate body by body, as
// articulated bodies do.
#pragma once

#include <map>

#include "bench/peers.hpp"
#include "measure/stability.hpp"

namespace catena::command {

/// Simbody and Pinocchio. MuJoCo factors the joint-space inertia, whose condition is another
/// question.
std::vector<PeerProgram> peers_of_suite();
/// A suite has many chains.
Peer::Limits limits_of_suite();

/// One process a program, that takes one chain after the other; where it stops, another is started
/// for the next case.
class PeerAnswers {
  public:
    explicit PeerAnswers(std::vector<PeerProgram>, Peer::Limits);
    /// Those that are here; of a family in which one stopped, it is asked about no longer chain.
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
