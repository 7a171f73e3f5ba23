// What a rank among several computes where all of them know every bead and share out the pairs:
// positions and forces stay on GPUs that reach each other's memory. For files that see OpenMM's
// headers.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "force/rank_forces.hpp"
#include "neighbours/ghost_traffic.hpp"
#include "neighbours/halo.hpp"

namespace catena {

/// A million beads on four GPUs have as many ghosts as beads of their own, and pairs among ghosts
/// are computed in vain: with every bead as a ghost no list of them is ever made again, and no pair
/// is computed twice. What it takes is that every position and every force goes to every rank, or
/// comes from there: 12 bytes each from GPU to GPU in single precision.
class PairForces final : public RankForces, public Halo {
  public:
    /// Ranks but the first take what energies have beyond cutoffs off the plan's System.
    explicit PairForces(RankPlan const& plan);

    // RankForces
    void gather(std::span<Vec3 const> own) override;
    void evaluate(std::span<Vec3> own_forces) override;
    /// Those of each rank's share, added up on all.
    void find_energies(DevicePath*, std::span<double> of_group) override;
    DevicePathPlan plan(bool overlap);
    std::unique_ptr<DevicePath> device_path(bool overlap) override;
    std::vector<Vec3> forces_again() override;
    void renew_ghosts() override { renew_ = true; }
    bool ghosts_are_due() const override { return renew_; }
    GhostTraffic traffic() const override { return traffic_; }
    std::int64_t largest_context() const override { return context_->size(); }
    std::int64_t contexts() const override { return 1; }
    bool shares_pairs() const override { return true; }

    // Halo
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

    /// For those who stand for the GPU.
    ForceContext* computing() const { return context_.get(); }

  private:
    std::int64_t own() const { return std::ssize(particle_); }
    std::int64_t beads_of(int rank) const {
        return first_of_rank_[static_cast<std::size_t>(rank) + 1] -
               first_of_rank_[static_cast<std::size_t>(rank)];
    }
    /// In which each rank sends its beads.
    void take_sequences(std::span<std::int64_t const> of_ranks);
    std::vector<std::int64_t> bytes_of_ranks(std::size_t of_bead) const;
    void note(bool direct);

    Communicator const& communicator_;
    std::optional<Vec3> box_;
    bool audit_, in_single_;
    std::vector<std::int64_t> first_of_rank_;
    std::vector<std::int64_t> number_;    // of own beads in the scene, for messages
    std::vector<int> particle_;           // of own beads
    std::vector<int> particle_of_all_;    // of every rank's, one rank after the other
    std::vector<std::int64_t> received_;  // which of all comes with each position received
    int groups_;
    std::unique_ptr<ForceContext> context_;
    Lists lists_;  // every other rank's beads as they are sent there
    bool renew_ = true, some_are_far_ = false;
    GhostTraffic traffic_;
};

}  // namespace catena
