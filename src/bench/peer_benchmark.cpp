// Implements the comparison of engines on one chain.
#include "bench/peer_benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/peer_chain.hpp"

namespace catena::command {
namespace {

/// Rounding error per level of the tree, as in ChainSystem::residual_bound().
constexpr double rounding = 32 * 0x1p-53;
/// Largest chain whose exact solution is computed in 113 bits, and the size from which one
/// perturbation of the data estimates the growth of roundings instead of three.
constexpr std::int64_t largest_quad_here = 5000, few_nudges_above = 10000;

/// Returns an entry of a peer's self-description; null if it is missing.
Json said(Json const& peer, char const* key) {
    return peer.is_object() ? peer.value(key, Json()) : Json();
}

/// Suffixes of backend names, by Way.
constexpr char const* suffix_of[] = {"", ", absolute", ", solver alone"};

/// Returns the ways in which a backend evaluates chains of a joint.
std::vector<Way> ways_of(std::string const& joint, Backend backend, Handles handles) {
    if (joint != "link" && joint != "spherical") return {Way::joint};
    std::vector<Way> ways{Way::joint};
    // Beads have only one set of coordinates.
    if (joint == "spherical") ways.push_back(Way::absolute);
    bool const in_one_sweep = backend != Backend::serial && backend != Backend::cuda_levels &&
                              handles == Handles::projected;
    if (in_one_sweep) ways.push_back(Way::solver);
    return ways;
}

}  // namespace

/// One backend with a scene of its own.
class PeerBenchmark::Own {
  public:
    Own(Scene scene, Backend backend, Way way, Communicator const& communicator)
        : scene_(with(std::move(scene), backend)),
          system_(scene_, way == Way::joint ? Axes::joint : Axes::world, communicator),
          way_(way) {
        system_.evaluate();
        system_.evaluate(false);
    }
    /// Returns the seconds of this many evaluations.
    double time(int evaluations) {
        if (way_ == Way::solver)
            return evaluations * system_.absolute().front()->time_at_once(evaluations, 1).front();
        double const start = seconds_now();
        for (int i = 0; i < evaluations; ++i) system_.evaluate(false);
        system_.wait();
        return seconds_now() - start;
    }
    ChainSystem& system() { return system_; }
    /// Returns the accelerations in the form in which peers give them.
    Solution solution() {
        Solution found = solution_of(system_);
        if (scene_.chains.front().is_beads() || way_ == Way::joint) return found;
        ChainSystem::Accelerations const a = system_.accelerations();
        SceneMotion const at = system_.snapshot();
        // Angular acceleration and velocity of the previous body.
        Vec3 alpha = Vec3::zero(), omega = Vec3::zero();
        for (std::size_t k = 0; k < at.omega.size(); ++k) {
            Mat3 const r = to_matrix(at.orientation[k]);
            Vec3 const own = r * at.omega[k],
                       relative = transposed_times(r, a.alpha[k] - alpha + cross(own, omega));
            std::copy_n(
                relative.data, 3,
                &found.acceleration[static_cast<std::size_t>(found.acceleration_offset[k])]);
            alpha = a.alpha[k];
            omega = own;
        }
        return found;
    }

  private:
    static Scene with(Scene scene, Backend backend) {
        scene.solver.backend = backend;
        return scene;
    }
    Scene scene_;
    ChainSystem system_;
    Way way_;
};

PeerBenchmark::PeerBenchmark(Scene scene, std::string joint)
    : scene_(std::move(scene)), joint_(std::move(joint)) {}
PeerBenchmark::~PeerBenchmark() = default;

void PeerBenchmark::Engine::warm_up() {
    double const one = time(1);
    goes_on = one >= 0;
    of_block = static_cast<int>(std::clamp(block_seconds / std::max(one, 1e-9), 1.0, 10000.0));
}

void PeerBenchmark::Engine::block() {
    double const taken = goes_on ? time(of_block) : -1;
    goes_on = taken >= 0;
    if (goes_on) seconds.push_back(taken / of_block);
}

void PeerBenchmark::add(std::vector<Backend> const& backends, Communicator const& communicator) {
    for (Backend const backend : backends)
        for (Way const way : ways_of(joint_, backend, scene_.solver.handles))
            add(backend, way, communicator);
}

void PeerBenchmark::add(Backend backend, Way way, Communicator const& communicator) {
    own_.push_back(std::make_unique<Own>(scene_, backend, way, communicator));
    ChainSystem& system = own_.back()->system();
    Solution const found = own_.back()->solution();
    if (own_.size() == 1) {
        layout_ = found;
        exact_ = exact_solution(scene_, layout_, largest_quad_here,
                                scene_.bodies() > few_nudges_above ? 1 : 3);
    }
    Engine engine{name_of(backend) + std::string(suffix_of[static_cast<int>(way)]),
                  system.executor().threads(),
                  [own = own_.back().get()](int n) { return own->time(n); }};
    engine.whole = way != Way::solver;
    engine.bound = system.residual_bound() * exact_.growth;
    engine.residual = system.residual();
    judge(engine, found.acceleration);
    engine.valid = engine.valid && *engine.residual <= system.residual_bound();
    engines_.push_back(std::move(engine));
}

void PeerBenchmark::add(std::string const& name, std::unique_ptr<Peer> peer) {
    Engine engine{name, 1, [p = peer.get()](int n) { return p->time(n); }};
    engine.peer = peer->description();
    // Rounding errors pass through as many bodies there as through levels of a tree here.
    engine.bound = rounding * static_cast<double>(scene_.bodies()) * exact_.growth;
    judge(engine, accelerations_of_peer(scene_.chains.front(), peer->accelerations()));
    engines_.push_back(std::move(engine));
    peers_.push_back(std::move(peer));
}

std::vector<PeerStop> PeerBenchmark::take_turns(int blocks) {
    for (Engine& engine : engines_) engine.warm_up();
    for (int b = 0; b < blocks; ++b)
        for (Engine& engine : engines_) engine.block();
    std::vector<PeerStop> stops;
    for (std::size_t i = 0; i < peers_.size(); ++i)
        if (!peers_[i]->stopped().empty())
            stops.push_back(
                {engines_[own_.size() + i].name, joint_, peers_[i]->stopped(), scene_.bodies()});
    std::erase_if(engines_, [](Engine const& e) { return !e.goes_on; });
    return stops;
}

std::vector<double> PeerBenchmark::table() const {
    return peer_table(scene_.chains.front(), scene_.forces.gravity);
}

double PeerBenchmark::fastest_on_one_core() const {
    double fastest = spread_of(engines_.front().seconds).median;
    for (Engine const& e : engines_)
        if (e.peer.is_null() && e.whole && e.threads == 1)
            fastest = std::min(fastest, spread_of(e.seconds).median);
    return fastest;
}

void PeerBenchmark::conclude(Outcome& outcome, Table& table) const {
    double const fastest = fastest_on_one_core();
    for (Engine const& e : engines_) {
        outcome.valid = outcome.valid && (!e.peer.is_null() || e.valid);
        Spread const s = spread_of(e.seconds);
        double const to_ns = 1e9 / static_cast<double>(scene_.bodies());
        table.add(
            {joint_, std::to_string(scene_.bodies()), e.name, std::to_string(e.threads),
             fmt::format("{:.1f}", to_ns * s.median), fmt::format("{:.2f}", s.median / fastest),
             fmt::format("{:.1e}", e.error), fmt::format("{:.1e}", e.bound),
             e.residual ? fmt::format("{:.1e}", *e.residual) : "-", e.valid ? "VALID" : "INVALID"});
        outcome.json["results"].push_back(
            {{"joint", joint_},
             {"bodies", scene_.bodies()},
             {e.peer.is_null() ? "backend" : "peer", e.name},
             {"threads", e.threads},
             {"repeat", s.count},
             {"evaluations_a_repeat", e.of_block},
             {"ns_per_body",
              {{"evaluation",
                {{"median", to_ns * s.median}, {"min", to_ns * s.min}, {"max", to_ns * s.max}}}}},
             {"over_catena", s.median / fastest},
             {"reference", exact_.by},
             {"growth", exact_.growth},
             {"forward_error", e.error},
             {"forward_error_bound", e.bound},
             {"residual", e.residual ? Json(*e.residual) : Json()},
             {"residual_bound",
              e.residual ? Json(own_.front()->system().residual_bound()) : Json()},
             {"set_up_seconds", said(e.peer, "set_up_seconds")},
             {"memory_bytes", said(e.peer, "memory_bytes")},
             {"valid", e.valid}});
    }
}

void PeerBenchmark::judge(Engine& engine, std::vector<double> acceleration) const {
    bool const whole = acceleration.size() == exact_.acceleration.size();
    Solution found = layout_;
    found.acceleration = std::move(acceleration);
    engine.error = whole ? largest_difference(scene_, found, exact_.acceleration) : NAN;
    engine.valid = engine.error <= engine.bound;
}

}  // namespace catena::command
