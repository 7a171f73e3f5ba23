// ChainSystem's part that deals with OpenMM: the scene's beads and an evaluation of their forces.
#include <algorithm>
#include <utility>

#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "integrate/scene_beads.hpp"

namespace catena {

void ChainSystem::describe_beads() { bead_system_ = bead_system_of(scene_); }

/// A rank owns the beads of its bodies, group by group.
void ChainSystem::order_beads_by_rank() {
    std::vector<std::int64_t> first_of_chain;
    std::int64_t beads = 0;
    for (ChainSpec const& chain : scene_.chains) {
        first_of_chain.push_back(beads);
        beads += static_cast<std::int64_t>(chain.bead_count());
    }
    // Returns the first bead of a body; for body = size, one past the chain's last bead.
    auto const bead_of = [&](int chain, std::int64_t body) {
        ChainSpec const& spec = scene_.chains[chain];
        if (spec.is_beads()) return first_of_chain[chain] + body;
        return first_of_chain[chain] +
               (spec.bead_count() == 0 ? 0 : spec.carried().offset[static_cast<std::size_t>(body)]);
    };
    std::vector<std::int64_t> order;
    bead_system_.first_of_rank = {0};
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        for (ChainGroup const* group : bead_groups_)
            for (dca::Piece const& piece : dca::pieces_of(group->partition, rank)) {
                int const chain = group->chain[piece.chain];
                for (std::int64_t i = bead_of(chain, piece.body);
                     i < bead_of(chain, piece.body + piece.count); ++i)
                    order.push_back(i);
            }
        bead_system_.first_of_rank.push_back(static_cast<std::int64_t>(order.size()));
    }
    if (!std::is_sorted(order.begin(), order.end())) bead_system_.by_rank = std::move(order);
}

/// Groups in absolute coordinates are first.
void ChainSystem::find_bead_groups() {
    for (bool const absolute : {true, false})
        for (auto const& group : groups_)
            if (is_absolute(*group) == absolute && (group->beads || group->carried_in_scene))
                bead_groups_.push_back(group.get());
}

/// Must be called before anything of the chains is on a GPU: if OpenMM computes there, they live in
/// its context.
void ChainSystem::make_openmm() {
    find_bead_groups();
    if (bead_groups_.empty())
        throw InputError("OpenMM computes forces on beads and the scene has none",
                         scene_.file + ": forces.openmm",
                         "add a bead chain, beads on bodies, or remove forces.openmm");
    describe_beads();
    order_beads_by_rank();
    std::int64_t const own = bead_system_.first_of_rank[communicator_.rank() + 1] -
                             bead_system_.first_of_rank[communicator_.rank()];
    bead_position_ = Field<3>(own);
    openmm_force_ = Field<3>(own);
    ChainsOnDevice chains{no_gpu_asked_for, -1};
    if (backend_ == Backend::cuda) {
        bool const absolute =
            std::all_of(bead_groups_.begin(), bead_groups_.end(),
                        [this](ChainGroup const* group) { return is_absolute(*group); });
        chains = {absolute ? "" : "some beads are carried by bodies in joint coordinates",
                  cuda::chosen_device()};
    }
    openmm_ = make_openmm_force(*scene_.forces.openmm, bead_system_, communicator_, chains);
    make_current();
}

void ChainSystem::find_bead_hosts() {
    std::vector<BeadHost*> hosts;
    for (auto const& group : absolute_) hosts.push_back(group.get());
    for (auto const& group : joint_) hosts.push_back(group.get());
    std::copy_if(hosts.begin(), hosts.end(), std::back_inserter(bead_hosts_),
                 [&](BeadHost const* host) {
                     return std::find(bead_groups_.begin(), bead_groups_.end(), &host->group()) !=
                            bead_groups_.end();
                 });
    if (!openmm_->device_path()) return;
    for (BeadHost* host : bead_hosts_) device_beads_.push_back(host->on_device());
}

ConstView<3> ChainSystem::own_bead_positions() {
    std::int64_t next = 0;
    for (BeadHost* host : bead_hosts_) {
        ConstView<3> const positions = host->bead_positions();
        for (std::int64_t k = 0; k < positions.size; ++k)
            bead_position_.set(next++, positions.load(k));
    }
    return std::as_const(bead_position_).view();
}

void ChainSystem::begin_openmm(bool timed) {
    if (!on_device()) {
        Traffic const before = communicator_.traffic();
        openmm_->begin(own_bead_positions());
        openmm_traffic_ += communicator_.traffic() - before;
        return;
    }
    if (clock_is_due_) read_device_clock();
    ++evaluations_since_clock_;
    clock_is_due_ = timed || !timed_before_ || evaluations_since_clock_ >= evaluations_a_clock;
    Traffic const before = communicator_.traffic();
    openmm_->device_path()->begin(device_beads_, clock_is_due_);
    openmm_traffic_ += communicator_.traffic() - before;
    timed_before_ = true;
}

void ChainSystem::go_on_openmm() {
    Traffic const before = communicator_.traffic();
    openmm_->device_path()->go_on(device_beads_);
    openmm_traffic_ += communicator_.traffic() - before;
}

DevicePath::Clock ChainSystem::read_device_clock() {
    clock_is_due_ = false;
    // This evaluation represents those since the clock was read last.
    double const weight = static_cast<double>(std::exchange(evaluations_since_clock_, 0));
    DevicePath::Clock const clock = openmm_->device_path()->clock();
    auto const length = [weight](double begin, double end) {
        return weight * std::max(0.0, end - begin);
    };
    double const matrices = length(clock.chains.begin, clock.chains.end);
    bool const exchanges = communicator_.size() > 1;
    // First ghosts arrive, or the host asks how far beads have moved; then OpenMM computes. The
    // sweep runs concurrently with both.
    double const begin = clock.exchange.end > 0 ? clock.exchange.begin : clock.openmm.begin;
    matrix_seconds_ += matrices;
    hidden_seconds_ +=
        length(std::max(clock.chains.begin, begin), std::min(clock.chains.end, clock.openmm.end));
    if (exchanges) seconds_["exchange"] += length(clock.exchange.begin, clock.exchange.end);
    seconds_["matrix sweep"] += matrices;
    seconds_["forces"] += length(clock.openmm.begin, clock.openmm.end);
    seconds_["waiting for forces"] +=
        length(std::max(clock.chains.end, exchanges ? clock.exchange.end : 0.0), clock.openmm.end);
    return clock;
}

void ChainSystem::finish_openmm() {
    if (on_device()) {
        openmm_->device_path()->finish(device_beads_);
        return;
    }
    for (std::int64_t k = 0; k < openmm_force_.size(); ++k) openmm_force_.set(k, Vec3::zero());
    openmm_->finish(openmm_force_.view());
    std::int64_t next = 0;
    for (BeadHost* host : bead_hosts_) {
        View<3> const forces = host->bead_forces();
        for (std::int64_t k = 0; k < forces.size; ++k)
            forces.store(k, forces.load(k) + openmm_force_[next++]);
    }
}

}  // namespace catena
