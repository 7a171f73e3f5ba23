// One chain, evaluated in turns by Catena's backends and by other programs, and how right each of
// them is.
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

/// Where a peer went no further, and why.
struct PeerStop {
    std::string peer, joint, why;
    std::int64_t bodies = 0;
};

/// How Catena evaluates: from the joints' coordinates to their accelerations, as the peers do; from
/// poses to accelerations of bodies, as rattle and g-baoab do; of that the solver alone, loads in
/// place, as `bench evaluation` does.
enum class Way { joint, absolute, solver };

/// Engines take turns by blocks of evaluations that last about so long.
inline constexpr double block_seconds = 0.05;

class PeerBenchmark {
  public:
    PeerBenchmark(Scene, std::string joint);
    ~PeerBenchmark();

    /// Every way in which the backends evaluate such chains.
    void add(std::vector<Backend> const&, Communicator const&);
    /// One that is ready; the backends are there.
    void add(std::string const& name, std::unique_ptr<Peer>);
    /// Blocks in turn; returns the peers that gave up meanwhile.
    std::vector<PeerStop> take_turns(int blocks);
    /// A row each; the outcome is valid where Catena's own are.
    void conclude(Outcome&, Table&) const;

    /// For the peers.
    std::vector<double> table() const;

  private:
    class Own;
    /// Whatever evaluates a chain, and how long it takes.
    struct Engine {
        std::string name;
        int threads = 1;
        std::function<double(int)>
            time;  // seconds of so many evaluations; negative where it gave up
        int of_block = 1;
        std::vector<double> seconds = {};
        double error = 0, bound = 0;
        std::optional<double> residual = {};  // a peer gives joint accelerations alone
        bool whole = true;                    // not the solver alone
        bool valid = false, goes_on = true;
        Json peer = nullptr;  // what it says of itself; null: one of Catena's backends

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
