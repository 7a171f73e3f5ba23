// Compares Catena's backends and other programs on one chain: times in turns, and errors.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/peer.hpp"
#include "console/outcome.hpp"
#include "console/text.hpp"
#include "measure/growth.hpp"
#include "measure/solution.hpp"
#include "measure/timing.hpp"

namespace catena::command {

/// Chain at which a peer stopped, and why.
struct PeerStop {
    std::string peer, joint, why;
    std::int64_t bodies = 0;
};

/// Ways in which Catena evaluates. `joint`: joint coordinates to joint accelerations, as the peers
/// do. `absolute`: poses to accelerations of bodies, as rattle and g-baoab do. `solver`: the solver
/// of the latter alone with loads in place, as `bench evaluation` does.
enum class Way { joint, absolute, solver };

/// Approximate seconds of the blocks of evaluations in which the engines take turns.
inline constexpr double block_seconds = 0.05;

/// Times and errors of all engines on one chain.
class PeerBenchmark {
  public:
    PeerBenchmark(Scene, std::string joint);
    ~PeerBenchmark();

    /// Adds every way in which the backends evaluate such chains.
    void add(std::vector<Backend> const&, Communicator const&);
    /// Adds a peer that is ready. The backends must have been added before.
    void add(std::string const& name, std::unique_ptr<Peer>);
    /// Runs blocks in turn and returns the peers that stopped meanwhile.
    std::vector<PeerStop> take_turns(int blocks);
    /// Adds a row per engine. The outcome stays valid if Catena's own engines are valid.
    void conclude(Outcome&, Table&) const;

    /// Returns the table that describes the chain to the peers.
    std::vector<double> table() const;

  private:
    class Own;
    /// An evaluator of the chain with its times and errors.
    struct Engine {
        std::string name;
        int threads = 1;
        std::function<double(int)>
            time;  // seconds of so many evaluations; negative where it gave up
        int of_block = 1;
        std::vector<double> seconds = {};
        double error = 0, bound = 0;
        /// Residual; empty for a peer, which returns joint accelerations only.
        std::optional<double> residual = {};
        /// False for the solver alone.
        bool whole = true;
        bool valid = false, goes_on = true;
        /// Self-description of a peer; null for one of Catena's backends.
        Json peer = nullptr;

        void warm_up();
        void block();
    };
    void add(Backend, Way, Communicator const&);
    double fastest_on_one_core() const;
    void judge(Engine&, std::vector<double> acceleration) const;

    Scene scene_;
    std::string joint_;
    Solution layout_;
    ExactSolution exact_;
    std::vector<std::unique_ptr<Own>> own_;
    std::vector<std::unique_ptr<Peer>> peers_;
    std::vector<Engine> engines_;
};

}  // namespace catena::command
