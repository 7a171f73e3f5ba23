// Domain decomposition of OpenMM's forces on GPUs (`split: ghosts`, path `device`): positions and
// forces stay on the GPU. Only files that see OpenMM's headers include this one.
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

/// Forces on one rank's own beads, from a Context with its beads and their ghosts.
/// The Context's particles are own beads, then bonded partners, then slots for pieces of other
/// ghosts. Some slots of each kind are spares, which are placed where they act on nothing. If
/// ghosts of a kind outnumber its slots, slots of other kinds and the same length get new
/// parameters. If slots of that length run out too, a new Context is made.
class HaloForces final : public RankForces, public Halo {
  public:
    /// Skin as a fraction of the forces' reach. It is wide because the GPU waits while lists are
    /// made. The fastest of a million beads of a condensate (CALVADOS 2, 330 mg/ml, 10 fs) has
    /// moved 1 nm after about 130 steps. The fastest of 14,000 beads has moved 0.25 nm after 32
    /// steps, 0.5 nm after 80 and 1 nm after 220.
    static double constexpr skin_of_reach_on_device = 0.5;

    explicit HaloForces(RankPlan const& plan);

    // Implementation of RankForces.
    void gather(std::span<Vec3 const> own) override;
    void evaluate(std::span<Vec3> own_forces) override;
    void find_energies(DevicePath* device, std::span<double> of_group) override;
    DevicePathPlan plan(bool overlap) override;
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

    // Implementation of Halo.
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

    /// Returns the Context in use, for tests that act as the GPU.
    ForceContext* computing() const { return context_.get(); }

  private:
    /// Spare slots per kind in a new Context: one for every `spare_part` slots, plus
    /// `least_spares`.
    static std::int64_t constexpr spare_part = 8, least_spares = 16;
    /// OpenMM computes on this many consecutive particles at once: the longest pieces start at a
    /// multiple of it.
    static int constexpr block = BeadPieces::longest;

    std::vector<std::int64_t> const& own() const { return share_.own(); }
    /// Returns 0, 1, ..., count - 1.
    static std::vector<std::int64_t> every_number(std::int64_t count);
    /// Divides all beads into pieces.
    BeadPieces pieces(RankPlan const& plan) const;
    /// Counts the exchangeable pieces of other ranks by kind.
    void count_kinds_elsewhere();
    /// Index of the first slot's particle in the Context.
    int first_slot() const { return static_cast<int>(own().size() + share_.partners().size()); }
    /// Returns own beads, partners, and the beads whose parameters the slots have.
    Subset subset_of_slots() const;
    /// Fills the particles of `lists_`.
    void list_particles();
    /// Makes a Context with slots for the present ghosts and for spares.
    void make_context();
    /// True if every exchangeable piece is a ghost: then there may be no place for spares.
    bool everyone_is_a_ghost() const { return std::ssize(ghosts_.pieces()) == elsewhere_; }

    Communicator const& communicator_;
    bool every_rank_has_beads_;
    /// Context whose GPU context all others share. It is declared before them, so it outlives them,
    /// also those in `share_`.
    std::unique_ptr<ForceContext> home_;
    DomainShare share_;
    BeadPieces pieces_;
    GhostLists ghosts_;
    bool audit_;
    /// Number of exchangeable pieces of other ranks, by kind.
    std::vector<std::int64_t> of_kind_elsewhere_;
    /// Sum of `of_kind_elsewhere_`.
    std::int64_t elsewhere_ = 0;
    /// True if idle particles before the slots align the longest pieces with OpenMM's blocks.
    bool is_aligned_ = false;
    GhostSlots slots_;
    Lists lists_;
    std::shared_ptr<OpenMM::System> system_;
    std::unique_ptr<ForceContext> context_;
    /// Particles of the largest Context so far, and number of Contexts made.
    std::int64_t largest_ = 0, contexts_ = 0;
};

}  // namespace catena
