// What a rank among several computes where positions and forces stay on a GPU. For files that see
// OpenMM's headers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "force/bead_pieces.hpp"
#include "force/ghost_slots.hpp"
#include "force/rank_share.hpp"
#include "neighbours/ghost_lists.hpp"
#include "neighbours/halo.hpp"

namespace catena {

/// Particles of the Context: own beads, partners, and slots for pieces of other ghosts, some of
/// each kind to spare, which stand aside. Where more of a kind come than there are slots, the
/// parameters of others of their length change; a Context is made anew where there are too few of
/// these.
class HaloForces final : public RankForces, public Halo {
  public:
    /// While lists are made the GPU waits. The fastest of a million beads of a condensate (CALVADOS
    /// 2, 330 mg/ml, 10 fs) has gone 1 nm after some 130 steps, of 14,000 beads 0.25 nm after 32,
    /// 0.5 after 80 and 1 nm after 220.
    static double constexpr skin_of_reach_on_device = 0.5;

    explicit HaloForces(RankPlan const& plan);

    // RankForces
    void gather(std::span<Vec3 const> own) override;
    void evaluate(std::span<Vec3> own_forces) override;
    void find_energies(DevicePath* device, std::span<double> of_group) override;
    DevicePathPlan plan(bool overlap);
    std::unique_ptr<DevicePath> device_path(bool overlap) override;
    std::vector<Vec3> forces_again() override;
    void renew_ghosts() override { ghosts_.renew(); }
    bool ghosts_are_due() const override { return ghosts_.is_due(); }
    GhostTraffic traffic() const override { return ghosts_.traffic(); }
    std::int64_t largest_context() const override { return largest_; }
    std::int64_t contexts() const override { return contexts_; }
    double reach() const override { return share_.reach(); }
    std::vector<PairRange> ranges() const override { return share_.ranges(); }
    double skin() const override { return share_.skin(); }

    // Halo
    bool are_used_up(bool far, std::int64_t bead) override;
    void refuse_trouble(std::int64_t bead) const override;
    void make_lists(std::span<Vec3 const> own) override;
    Lists const& lists() const override { return lists_; }
    OpenMM::Context& context() override { return context_->context(); }
    void carry(std::span<Vec3 const> sent, std::span<Vec3> received) override;
    void note_carried() override { ghosts_.note_carried(); }
    Communicator const& communicator() const override { return communicator_; }
    bool every_rank_has_beads() const override { return every_rank_has_beads_; }
    bool is_audited() const override { return audit_; }
    void audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const override;

    /// For those who stand for the GPU.
    ForceContext* computing() const { return context_.get(); }

  private:
    /// One slot of a kind in so many is a spare when a Context is made, and so many besides.
    static std::int64_t constexpr spare_part = 8, least_spares = 16;
    /// OpenMM computes on so many particles that follow each other at once: the longest pieces
    /// begin there.
    static int constexpr block = BeadPieces::longest;

    std::vector<std::int64_t> const& own() const { return share_.own(); }
    static std::vector<std::int64_t> every_number(std::int64_t count);
    BeadPieces pieces(RankPlan const& plan) const;
    void count_kinds_elsewhere();
    int first_slot() const { return static_cast<int>(own().size() + share_.partners().size()); }
    Subset subset_of_slots() const;
    void list_particles();
    void make_context();
    /// Then there may be no place aside.
    bool everyone_is_a_ghost() const { return std::ssize(ghosts_.pieces()) == elsewhere_; }

    Communicator const& communicator_;
    bool every_rank_has_beads_;
    std::unique_ptr<ForceContext>
        home_;  // before all Contexts that are made in its GPU context, share_'s among them
    SplitShare share_;
    BeadPieces pieces_;
    GhostLists ghosts_;
    bool audit_;
    std::vector<std::int64_t> of_kind_elsewhere_;  // exchangeable pieces of other ranks
    std::int64_t elsewhere_ = 0;                   // all of them
    bool is_aligned_ = false;                      // by particles that stand aside for good
    GhostSlots slots_;
    Lists lists_;
    std::shared_ptr<OpenMM::System> system_;
    std::unique_ptr<ForceContext> context_;
    std::int64_t largest_ = 0, contexts_ = 0;
};

}  // namespace catena
