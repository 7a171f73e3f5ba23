// Beads of a system and an evaluation of OpenMM's forces on them.
#include "integrate/openmm_evaluation.hpp"

#include <algorithm>
#include <utility>

#include "error.hpp"
#include "integrate/scene_beads.hpp"

namespace catena {

OpenMmEvaluation::OpenMmEvaluation(Scene const& scene, Communicator const& communicator,
                                   std::vector<ChainGroup const*> groups,
                                   ChainsOnDevice const& chains)
    : communicator_(communicator), groups_(std::move(groups)) {
    if (groups_.empty())
        throw InputError("OpenMM computes forces on beads and the scene has none",
                         scene.file + ": forces.openmm",
                         "add a bead chain, beads on bodies, or remove forces.openmm");
    beads_ = bead_system_of(scene);
    order_by_rank(scene);
    std::int64_t const own =
        beads_.first_of_rank[communicator.rank() + 1] - beads_.first_of_rank[communicator.rank()];
    own_position_ = Field<3>(own);
    own_force_ = Field<3>(own);
    force_ = make_openmm_force(*scene.forces.openmm, beads_, communicator, chains);
}

bool OpenMmEvaluation::make_current() noexcept {
    DevicePath* const path = force_->device_path();
    return path == nullptr || path->make_current();
}

/// A rank owns the beads of its bodies, group by group.
void OpenMmEvaluation::order_by_rank(Scene const& scene) {
    std::vector<std::int64_t> first_of_chain;
    std::int64_t beads = 0;
    for (ChainSpec const& chain : scene.chains) {
        first_of_chain.push_back(beads);
        beads += static_cast<std::int64_t>(chain.bead_count());
    }
    // Returns the first bead of a body; for body = size, one past the chain's last bead.
    auto const bead_of = [&](int chain, std::int64_t body) {
        ChainSpec const& spec = scene.chains[chain];
        if (spec.is_beads()) return first_of_chain[chain] + body;
        return first_of_chain[chain] +
               (spec.bead_count() == 0 ? 0 : spec.carried().offset[static_cast<std::size_t>(body)]);
    };
    std::vector<std::int64_t> order;
    beads_.first_of_rank = {0};
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        for (ChainGroup const* group : groups_)
            for (dca::Piece const& piece : dca::pieces_of(group->partition, rank)) {
                int const chain = group->chains[piece.chain].in_scene;
                for (std::int64_t i = bead_of(chain, piece.body);
                     i < bead_of(chain, piece.body + piece.count); ++i)
                    order.push_back(i);
            }
        beads_.first_of_rank.push_back(static_cast<std::int64_t>(order.size()));
    }
    if (!std::is_sorted(order.begin(), order.end())) beads_.by_rank = std::move(order);
}

void OpenMmEvaluation::find_hosts(std::vector<BeadHost*> const& dynamics) {
    std::copy_if(
        dynamics.begin(), dynamics.end(), std::back_inserter(hosts_), [&](BeadHost const* host) {
            return std::find(groups_.begin(), groups_.end(), &host->group()) != groups_.end();
        });
    if (!force_->device_path()) return;
    for (BeadHost* host : hosts_) device_beads_.push_back(host->on_device());
}

ConstView<3> OpenMmEvaluation::own_positions() {
    std::int64_t next = 0;
    for (BeadHost* host : hosts_) {
        ConstView<3> const positions = host->bead_positions();
        for (std::int64_t k = 0; k < positions.size; ++k)
            own_position_.set(next++, positions.load(k));
    }
    return std::as_const(own_position_).view();
}

void OpenMmEvaluation::begin(bool timed, EvaluationTimes& times) {
    if (!on_device()) {
        Traffic const before = communicator_.traffic();
        force_->begin(own_positions());
        traffic_ += communicator_.traffic() - before;
        return;
    }
    if (clock_is_due_) read_clock(times);
    ++evaluations_since_clock_;
    clock_is_due_ = timed || !timed_before_ || evaluations_since_clock_ >= evaluations_a_clock;
    Traffic const before = communicator_.traffic();
    force_->device_path()->begin(device_beads_, clock_is_due_);
    traffic_ += communicator_.traffic() - before;
    timed_before_ = true;
}

void OpenMmEvaluation::go_on() {
    Traffic const before = communicator_.traffic();
    force_->device_path()->go_on(device_beads_);
    traffic_ += communicator_.traffic() - before;
}

DevicePath::Clock OpenMmEvaluation::read_clock(EvaluationTimes& times) {
    clock_is_due_ = false;
    // This evaluation represents those since the clock was read last.
    double const weight = static_cast<double>(std::exchange(evaluations_since_clock_, 0));
    DevicePath::Clock const clock = force_->device_path()->clock();
    auto const length = [weight](double begin, double end) {
        return weight * std::max(0.0, end - begin);
    };
    double const matrices = length(clock.chains.begin, clock.chains.end);
    bool const exchanges = communicator_.size() > 1;
    // First ghosts arrive, or the host asks how far beads have moved; then OpenMM computes. The
    // sweep runs concurrently with both.
    double const begin = clock.exchange.end > 0 ? clock.exchange.begin : clock.openmm.begin;
    times.matrices += matrices;
    times.hidden +=
        length(std::max(clock.chains.begin, begin), std::min(clock.chains.end, clock.openmm.end));
    if (exchanges) times.seconds["exchange"] += length(clock.exchange.begin, clock.exchange.end);
    times.seconds["matrix sweep"] += matrices;
    times.seconds["forces"] += length(clock.openmm.begin, clock.openmm.end);
    times.seconds["waiting for forces"] +=
        length(std::max(clock.chains.end, exchanges ? clock.exchange.end : 0.0), clock.openmm.end);
    return clock;
}

void OpenMmEvaluation::finish() {
    if (on_device()) {
        force_->device_path()->finish(device_beads_);
        return;
    }
    for (std::int64_t k = 0; k < own_force_.size(); ++k) own_force_.set(k, Vec3::zero());
    force_->finish(own_force_.view());
    std::int64_t next = 0;
    for (BeadHost* host : hosts_) {
        View<3> const forces = host->bead_forces();
        for (std::int64_t k = 0; k < forces.size; ++k)
            forces.store(k, forces.load(k) + own_force_[next++]);
    }
}

std::vector<Vec3> OpenMmEvaluation::own_forces() {
    Field<3> again;
    if (on_device()) {
        again = Field<3>(own_force_.size());
        force_->forces_again(again.view());
    }
    Field<3> const& force = on_device() ? again : own_force_;
    std::vector<Vec3> own;
    for (std::int64_t k = 0; k < force.size(); ++k) own.push_back(force[k]);
    return own;
}

}  // namespace catena
