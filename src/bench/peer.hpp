// Another program for multibody dynamics, in a process of its own that answers questions
// (tests/bench/peers/peer.py).
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "console/outcome.hpp"

namespace catena::command {

/// What to start, or why that cannot be.
struct PeerProgram {
    std::string name;
    std::vector<std::string> words, options;  // before and after the two files
    std::string missing;                      // empty: it is there
};
/// Pinocchio, Simbody and MuJoCo, as far as this machine has them.
std::vector<PeerProgram> peer_programs();

class Peer {
  public:
    struct Limits {
        std::chrono::duration<double> set_up, evaluation;
        std::int64_t memory_bytes;  // of its address space
    };
    /// Starts the program on a chain's table; its accelerations go to `accelerations_file`.
    Peer(PeerProgram const&, std::string const& chain_file, std::string const& accelerations_file,
         Limits);
    ~Peer();
    Peer(Peer const&) = delete;
    Peer& operator=(Peer const&) = delete;

    /// Waits until the chain is built and evaluated once. False where it stopped instead.
    bool is_ready();
    /// The same for what the chain's file holds by now.
    bool is_ready_for_next();
    /// Seconds of so many evaluations; negative where it stopped.
    double time(int evaluations);
    /// Why it stopped; empty: it goes on.
    std::string const& stopped() const { return stopped_; }
    /// What it says of itself: name, version, method, set_up_seconds, memory_bytes.
    Json const& description() const { return description_; }
    std::vector<double> accelerations() const;

  private:
    std::string line(std::chrono::duration<double> patience, std::string const& doing);
    void ask(std::string const& question);
    void stop(std::string const& why);
    std::string how_it_ended();

    Limits limits_;
    std::string accelerations_file_, errors_file_, rest_, stopped_;
    Json description_;
    pid_t child_ = -1;
    int talk_ = -1;
};

}  // namespace catena::command
