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

/// Command of a program, or why it cannot run.
struct PeerProgram {
    std::string name;
    /// Words of the command before and after the names of the two files.
    std::vector<std::string> words, options;
    /// Reason why the program cannot run; empty if it can.
    std::string missing;
};
/// Returns Pinocchio, Simbody and MuJoCo, each with its command or why it is missing.
std::vector<PeerProgram> peer_programs();

/// A running program. It stops at an error or when a limit is exceeded.
class Peer {
  public:
    struct Limits {
        std::chrono::duration<double> set_up, evaluation;
        /// Largest size of its address space, bytes.
        std::int64_t memory_bytes;
    };
    /// Starts the program on a chain's table. It writes its accelerations to `accelerations_file`.
    Peer(PeerProgram const&, std::string const& chain_file, std::string const& accelerations_file,
         Limits);
    ~Peer();
    Peer(Peer const&) = delete;
    Peer& operator=(Peer const&) = delete;

    /// Waits until the program has built the chain and evaluated it once. Returns false if it
    /// stopped.
    bool is_ready();
    /// Waits likewise for the chain that the chain's file holds now.
    bool is_ready_for_next();
    /// Returns the seconds of this many evaluations; negative if the program stopped.
    double time(int evaluations);
    /// Reason why the program stopped; empty while it runs.
    std::string const& stopped() const { return stopped_; }
    /// Self-description of the program: name, version, method, set_up_seconds, memory_bytes.
    Json const& description() const { return description_; }
    /// Reads the accelerations that the program wrote.
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
