// Force decomposition of OpenMM's forces on GPUs (`split: pairs`): every rank has all beads and
// computes a share of the pairs. Positions and forces stay on GPUs that reach each other's memory.
// Only files that see OpenMM's headers include this one.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "force/rank_forces.hpp"
#include "neighbours/ghost_traffic.hpp"
#include "neighbours/halo.hpp"

namespace catena {

/// Forces on one rank's own beads, from a Context of all beads on every rank.
/// With domain decomposition, a million beads on four GPUs have as many ghosts as own beads, and
/// pairs among ghosts are computed in vain. With every bead as a ghost, lists of ghosts are never
/// rebuilt and no pair is computed twice. In return, every position is sent to every rank and
/// forces are sent back. These are 12 bytes each, from GPU to GPU, in single precision.
class PairForces final : public RankForces, public Halo {
  public:
    /// Ranks other than 0 remove long-range energy corrections from the plan's System.
    explicit PairForces(RankPlan const& plan);

    // Implementation of RankForces.
    void gather(std::span<Vec3 const> own) override;
    void evaluate(std::span<Vec3> own_forces) override;
    /// Stores the sum of all ranks' energies on every rank.
    void find_energies(DevicePath*, std::span<double> of_group) override;
    DevicePathPlan plan(bool overlap) override;
    ForceContext* device_context() override { return context_.get(); }
    std::unique_ptr<DevicePath> device_path(bool overlap) override;
    std::vector<Vec3> forces_again() override;
    void renew_ghosts() override { renew_ = true; }
    bool ghosts_are_due() const override { return renew_; }
    GhostTraffic traffic() const override { return traffic_; }
    std::int64_t largest_context() const override { return context_->size(); }
    std::int64_t contexts() const override { return 1; }
    bool shares_pairs() const override { return true; }

    // Implementation of Halo.
    bool are_used_up(bool far, std::int64_t bead) override;
    void refuse_trouble(std::int64_t bead) const override;
    void make_lists(std::span<Vec3 const> own) override;
    Lists const& lists() const override { return lists_; }
    OpenMM::Context& context() override { return context_->context(); }
    void carry(std::span<Vec3 const> sent, std::span<Vec3> received) override;
    void note_carried() override { note(true); }
    Communicator const& communicator() const override { return communicator_; }
    bool every_rank_has_beads() const override { return true; }
    bool is_audited() const override { return audit_; }
    void audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const override;
    std::optional<int> groups_of_share() const override { return groups_; }
    void send_in(std::span<std::int64_t const> sequence) override;
    bool some_are_far() const override { return some_are_far_; }

    /// Returns the Context in use, for tests that act as the GPU.
    ForceContext* computing() const { return context_.get(); }

  private:
    std::int64_t own() const { return std::ssize(particle_); }
    std::int64_t beads_of(int rank) const {
        return first_of_rank_[static_cast<std::size_t>(rank) + 1] -
               first_of_rank_[static_cast<std::size_t>(rank)];
    }
    /// Sets the order in which each rank sends its beads: their local indices, rank after rank.
    void take_sequences(std::span<std::int64_t const> of_ranks);
    /// Returns the bytes of each rank's beads at `of_bead` bytes per bead.
    std::vector<std::int64_t> bytes_of_ranks(std::size_t of_bead) const;
    /// Counts one exchange of positions and forces; `direct`: from GPU to GPU.
    void note(bool direct);

    Communicator const& communicator_;
    std::optional<Vec3> box_;
    std::optional<Placement> placement_;  // RankPlan::placement
    bool audit_, in_single_;
    // size ranks + 1: rank r owns entries first_of_rank_[r] .. first_of_rank_[r + 1] - 1
    std::vector<std::int64_t> first_of_rank_;
    /// Number of each own bead in the scene, for messages.
    std::vector<std::int64_t> number_;
    /// Particle of each own bead.
    std::vector<int> particle_;
    /// Particle of each bead, rank after rank.
    std::vector<int> particle_of_all_;
    /// Index among all beads, rank after rank, of each position received.
    std::vector<std::int64_t> received_;
    // bit masks of the System's force groups, and of those that this rank computes
    int groups_of_all_, groups_;
    std::unique_ptr<ForceContext> context_;
    /// Messages with every other rank: all of its beads, in the order in which it sends them.
    Lists lists_;
    bool renew_ = true, some_are_far_ = false;
    GhostTraffic traffic_;
};

}  // namespace catena
