// Implements the questions of the stability suite to other programs.
#include "bench/peer_answers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/peer_chain.hpp"

namespace catena::command {

std::vector<PeerProgram> peers_of_suite() {
    std::vector<PeerProgram> all = peer_programs();
    std::erase_if(all, [](PeerProgram const& p) { return p.name == "mujoco"; });
    return all;
}

Peer::Limits limits_of_suite() {
    return {std::chrono::seconds(20), std::chrono::seconds(2), memory_for_peers()};
}

PeerAnswers::PeerAnswers(std::vector<PeerProgram> programs, Peer::Limits limits)
    : peers_(std::move(programs), limits) {}

std::vector<PeerAnswer> PeerAnswers::operator()(StabilityCase const& which, Scene const& scene) {
    std::string const why_not = not_for_peers(scene);
    if (why_not.empty()) peers_.write(peer_table(scene.chains.front(), scene.forces.gravity));
    std::vector<PeerAnswer> answers;
    for (PeerProgram const& program : peers_.programs())
        if (program.missing.empty())
            answers.push_back(why_not.empty()
                                  ? ask(program, which, scene)
                                  : PeerAnswer{program.name, {}, "not asked: " + why_not});
    return answers;
}

PeerAnswer PeerAnswers::ask(PeerProgram const& program, StabilityCase const& which,
                            Scene const& scene) {
    if (Stop const* const stop = stop_of(program.name, which))
        return {program.name, {}, fmt::format("at {}: {}", stop->name, stop->why)};
    std::unique_ptr<Peer>& peer = running_[program.name];
    bool const starts = !peer;
    if (starts) peer = peers_.start(program);
    if (starts ? peer->is_ready() : peer->is_ready_for_next()) {
        peers_.note(program, *peer);
        return {program.name, accelerations_of_peer(scene.chains.front(), peer->accelerations())};
    }
    stops_.push_back({program.name, which.family, which.name, peer->stopped(), which.bodies});
    peer.reset();
    return {program.name, {}, stops_.back().why};
}

PeerAnswers::Stop const* PeerAnswers::stop_of(std::string const& peer,
                                              StabilityCase const& which) const {
    auto const here = std::find_if(stops_.begin(), stops_.end(), [&](Stop const& s) {
        return s.peer == peer && s.family == which.family &&
               (s.bodies < which.bodies || s.name == which.name);
    });
    return here == stops_.end() ? nullptr : &*here;
}

}  // namespace catena::command
