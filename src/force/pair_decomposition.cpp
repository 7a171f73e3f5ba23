// Force decomposition: every rank has all beads and computes a share of the pairs.
#include "force/pair_decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "error.hpp"
#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"
#include "neighbours/ghost_lists.hpp"
#include "systems/subset.hpp"

namespace catena {

namespace {

/// True for the nonbonded forces, whose pairs can be shared out.
bool is_of_pairs(OpenMM::Force const& force) {
    return dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force) != nullptr ||
           dynamic_cast<OpenMM::NonbondedForce const*>(&force) != nullptr;
}

/// True if an exception has a charge or an epsilon, so that it adds forces.
bool has_exceptions(OpenMM::NonbondedForce const& force) {
    if (force.getNumExceptionParameterOffsets() > 0) return true;
    for (int i = 0; i < force.getNumExceptions(); ++i) {
        int a, b;
        double charge, sigma, epsilon;
        force.getExceptionParameters(i, a, b, charge, sigma, epsilon);
        if (charge != 0 || epsilon != 0) return true;
    }
    return false;
}

/// Returns the bit mask of a rank's force groups: rank 0 computes all forces, every rank the pair
/// forces. Force i is in group i.
int groups_of(OpenMM::System const& system, int rank) {
    int groups = 0;
    for (int i = 0; i < system.getNumForces(); ++i)
        if (rank == 0 || is_of_pairs(system.getForce(i)))
            groups |= 1 << system.getForce(i).getForceGroup();
    return groups;
}

/// Removes long-range corrections on ranks other than 0. The correction of the energy beyond the
/// cutoff belongs to no pair and adds no force, so rank 0 alone must compute it.
std::shared_ptr<OpenMM::System> of_rank(std::shared_ptr<OpenMM::System> system, int rank) {
    for (int i = 0; rank > 0 && i < system->getNumForces(); ++i) {
        if (auto* pairs = dynamic_cast<OpenMM::CustomNonbondedForce*>(&system->getForce(i)))
            pairs->setUseLongRangeCorrection(false);
        if (auto* charges = dynamic_cast<OpenMM::NonbondedForce*>(&system->getForce(i)))
            charges->setUseDispersionCorrection(false);
    }
    return system;
}

/// True if pair forces are computed in single precision: then they and positions travel in single
/// precision from GPU to GPU.
bool is_in_single(OpenMmPlatform const& platform) {
    auto const precision = platform.properties.find("Precision");
    return precision != platform.properties.end() && precision->second != "double";
}

}  // namespace

std::string why_not_by_pairs(OpenMM::System const& system) {
    bool any = false;
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        std::string const name = kind_of(force);
        if (!can_be_split(force)) return name + " cannot be split";
        if (!is_of_pairs(force)) continue;
        any = true;
        if (!std::isfinite(reach_of(force))) return name + " has no cutoff";
        if (auto const* pairs = dynamic_cast<OpenMM::CustomNonbondedForce const*>(&force);
            pairs && pairs->getNumInteractionGroups() > 0)
            return name + " has interaction groups";
        if (auto const* charges = dynamic_cast<OpenMM::NonbondedForce const*>(&force);
            charges && has_exceptions(*charges))
            return name + " has exceptions that act";
    }
    return any ? "" : "no force acts between pairs";
}

PairForces::PairForces(RankPlan const& plan)
    : communicator_(plan.communicator),
      box_(plan.box),
      placement_(plan.placement),
      audit_(plan.audit),
      in_single_(is_in_single(plan.platform)),
      first_of_rank_(plan.beads.first_of_rank),
      groups_of_all_(groups_of(*plan.model.system, 0)),
      groups_(groups_of(*plan.model.system, plan.communicator.rank())),
      context_(std::make_unique<ForceContext>(of_rank(plan.model.system, plan.communicator.rank()),
                                              plan.platform, plan.box, plan.home)) {
    std::vector<int> const particle_of_bead = particles_of_beads(plan.model.bead_of_particle);
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (std::int64_t const bead : plan.beads.beads_of(rank)) {
            int const particle = particle_of_bead[static_cast<std::size_t>(bead)];
            particle_of_all_.push_back(particle);
            if (rank != communicator_.rank()) continue;
            particle_.push_back(particle);
            number_.push_back(plan.beads.name(bead));
        }
    for (int rank = 0; rank < communicator_.size(); ++rank)
        if (rank != communicator_.rank()) lists_.messages.push_back({rank, own(), beads_of(rank)});
    lists_.one_for_all = true;
    std::vector<std::int64_t> as_they_are;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (std::int64_t k = 0; k < beads_of(rank); ++k) as_they_are.push_back(k);
    take_sequences(as_they_are);
}

void PairForces::send_in(std::span<std::int64_t const> sequence) {
    std::vector<std::int64_t> of_ranks(particle_of_all_.size());
    communicator_.all_gather(std::as_bytes(sequence), std::as_writable_bytes(std::span(of_ranks)),
                             bytes_of_ranks(sizeof(std::int64_t)));
    take_sequences(of_ranks);
}

void PairForces::take_sequences(std::span<std::int64_t const> of_ranks) {
    lists_.particle.clear();
    received_.clear();
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        std::int64_t const first = first_of_rank_[static_cast<std::size_t>(rank)];
        auto const sequence = of_ranks.subspan(static_cast<std::size_t>(first),
                                               static_cast<std::size_t>(beads_of(rank)));
        if (rank == communicator_.rank()) lists_.sent.assign(sequence.begin(), sequence.end());
        if (rank == communicator_.rank()) continue;
        for (std::int64_t const k : sequence) {
            received_.push_back(first + k);
            lists_.particle.push_back(particle_of_all_[static_cast<std::size_t>(received_.back())]);
        }
    }
}

std::vector<std::int64_t> PairForces::bytes_of_ranks(std::size_t of_bead) const {
    std::vector<std::int64_t> bytes;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        bytes.push_back(beads_of(rank) * static_cast<std::int64_t>(of_bead));
    return bytes;
}

DevicePathPlan PairForces::plan(bool overlap) {
    DevicePathPlan plan;
    plan.particle = particle_;
    plan.bead = number_;
    Placement const placement = placement_.value_or(context_->placement());
    if (placement == Placement::wrapped) plan.box = box_;
    plan.shifted = placement == Placement::shifted;
    plan.overlap = overlap;
    plan.halo = this;
    return plan;
}

std::unique_ptr<DevicePath> PairForces::device_path(bool overlap) {
    return cuda::make_device_path(context_->context(), plan(overlap));
}

bool PairForces::are_used_up(bool far, std::int64_t bead) {
    // States are ordered, so that one maximum finds the worst. `trouble` is increased by the bead's
    // number.
    double constexpr good = 0, far_away = 1, used_up = 2, trouble = 3;
    bool const renew = std::exchange(renew_, false);
    double const state = communicator_.max(bead >= 0 ? trouble + static_cast<double>(bead)
                                           : renew   ? used_up
                                           : far     ? far_away
                                                     : good);
    if (state >= trouble) throw_trouble(state - trouble, in_trouble);
    some_are_far_ = state > good;
    return state == used_up;
}

void PairForces::refuse_trouble(std::int64_t bead) const {
    double const worst = communicator_.max(static_cast<double>(bead));
    if (worst >= 0) throw_trouble(worst, in_trouble);
}

void PairForces::make_lists(std::span<Vec3 const>) {
    ++traffic_.rebuilds;
    traffic_.ghosts = traffic_.most_ghosts = std::ssize(lists_.particle);
}

void PairForces::carry(std::span<Vec3 const> sent, std::span<Vec3> received) {
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    for (Message const& m : lists_.messages) {
        out.push_back({m.rank, std::as_bytes(sent)});
        in.push_back(
            {m.rank, std::as_writable_bytes(received.first(static_cast<std::size_t>(m.received)))});
        received = received.subspan(static_cast<std::size_t>(m.received));
    }
    communicator_.exchange_all(out, in);
    note(false);
}

/// Counts the bytes of positions sent to every rank and of forces sent back. Forces that are zero
/// and therefore not sent are included. Excluded are the eight more bytes per coordinate of
/// positions sent in double precision to GPUs that compute in single precision. That happens in
/// audits and after a new order of particles.
void PairForces::note(bool direct) {
    traffic_.direct = direct;
    ++traffic_.updates;
    traffic_.messages += 2 * std::ssize(lists_.messages);
    std::int64_t const of_bead = direct && in_single_ ? 3 * sizeof(float) : sizeof(Vec3);
    for (Message const& m : lists_.messages) traffic_.bytes += (m.sent + m.received) * of_bead;
}

void PairForces::audit(std::span<Vec3 const> own_positions, std::span<Vec3 const> received) const {
    std::vector<Vec3> all(particle_of_all_.size());
    communicator_.all_gather(std::as_bytes(own_positions), std::as_writable_bytes(std::span(all)),
                             bytes_of_ranks(sizeof(Vec3)));
    bool const equal =
        std::equal(received_.begin(), received_.end(), received.begin(), received.end(),
                   [&](std::int64_t bead, Vec3 const& there) {
                       Vec3 const& here = all[static_cast<std::size_t>(bead)];
                       return here[0] == there[0] && here[1] == there[1] && here[2] == there[2];
                   });
    if (communicator_.sum(equal ? 0 : 1) > 0)
        throw SharedError("a rank uses outdated positions of other ranks' beads");
}

std::vector<Vec3> PairForces::forces_again() {
    auto const part = context_->forces(groups_);
    auto const forces_on = [&](std::vector<int> const& particles) {
        std::vector<Vec3> forces;
        for (int const p : particles) {
            OpenMM::Vec3 const& f = part[static_cast<std::size_t>(p)];
            forces.push_back({{f[0], f[1], f[2]}});
        }
        return forces;
    };
    std::vector<Vec3> forces = forces_on(particle_);
    std::vector<Vec3> const sent = forces_on(lists_.particle);
    std::vector<std::vector<Vec3>> received(lists_.messages.size(),
                                            std::vector<Vec3>(forces.size()));
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    std::size_t first = 0;
    for (std::size_t i = 0; i < lists_.messages.size(); ++i) {
        Message const& m = lists_.messages[i];
        out.push_back({m.rank, std::as_bytes(std::span(sent).subspan(
                                   first, static_cast<std::size_t>(m.received)))});
        in.push_back({m.rank, std::as_writable_bytes(std::span(received[i]))});
        first += static_cast<std::size_t>(m.received);
    }
    communicator_.exchange_all(out, in);
    for (std::vector<Vec3> const& part_of_rank : received)
        for (std::size_t i = 0; i < forces.size(); ++i) {
            Vec3& force = forces[static_cast<std::size_t>(lists_.sent[i])];
            force = force + part_of_rank[i];
        }
    return forces;
}

void PairForces::find_energies(DevicePath*, std::span<double> of_group) {
    std::vector<double> own(of_group.size());
    on_every_rank(communicator_, [&] { context_->find_energies(own, groups_); });
    std::vector<double> const all = all_gathered_alike(communicator_, own);
    std::vector<double> sum(of_group.size());
    for (std::size_t i = 0; i < all.size(); ++i) sum[i % own.size()] += all[i];
    for (std::size_t group = 0; group < sum.size(); ++group)
        if ((groups_of_all_ & 1 << group) != 0) of_group[group] = sum[group];
}

void PairForces::gather(std::span<Vec3 const>) {
    throw ComputationError("positions stay on the GPU");
}
void PairForces::evaluate(std::span<Vec3>) { throw ComputationError("forces stay on the GPU"); }

std::unique_ptr<RankForces> make_pair_forces(RankPlan const& plan) {
    return std::make_unique<PairForces>(plan);
}

}  // namespace catena
