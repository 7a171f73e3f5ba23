// Forces of the whole System on each rank: for one rank, or for `replicate`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "force/rank_forces.hpp"
#include "systems/subset.hpp"

namespace catena {

namespace {

/// Forces on one rank's own beads, from a Context of all beads.
class ReplicatedForces final : public RankForces {
  public:
    explicit ReplicatedForces(RankPlan const& plan)
        : model_(plan.model),
          platform_(plan.platform),
          communicator_(plan.communicator),
          box_(plan.box),
          placement_(plan.placement),
          reach_(plan.beads.replicas > 1
                     ? std::max(plan.longest_reach, reach_of(*plan.model.system))
                     : 0),
          home_(plan.home) {
        BeadSystem const& beads = plan.beads;
        std::vector<int> const particle_of_bead = particles_of_beads(model_.bead_of_particle);
        for (int rank = 0; rank < communicator_.size(); ++rank) {
            std::vector<std::int64_t> const of_rank = beads.beads_of(rank);
            bytes_of_rank_.push_back(std::ssize(of_rank) * static_cast<std::int64_t>(sizeof(Vec3)));
            for (std::int64_t const bead : of_rank) particle_.push_back(particle_of_bead[bead]);
        }
        for (std::int64_t const bead : model_.bead_of_particle) {
            number_of_particle_.push_back(beads.name(bead));
            if (beads.replicas > 1)
                replica_.push_back(static_cast<std::int32_t>(bead / beads.beads_a_replica()));
        }
        first_ = beads.first_of_rank[communicator_.rank()];
        if (first_ < beads.first_of_rank[communicator_.rank() + 1]) make_context();
    }

    void gather(std::span<Vec3 const> own) override {
        std::vector<Vec3> all(particle_.size());
        communicator_.all_gather(std::as_bytes(own), std::as_writable_bytes(std::span(all)),
                                 bytes_of_rank_);
        positions_.resize(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) positions_[particle_[i]] = all[i];
        not_set_ = positions_;
    }

    void evaluate(std::span<Vec3> own_forces) override {
        if (own_forces.empty()) return;
        check_finite(positions_, number_of_particle_, "the position");
        set_positions();
        std::vector<Vec3> all;
        for (OpenMM::Vec3 const& f : context_->forces()) all.push_back({{f[0], f[1], f[2]}});
        check_finite(all, number_of_particle_, "OpenMM's force");
        for (std::size_t k = 0; k < own_forces.size(); ++k)
            own_forces[k] = all[particle_[first_ + k]];
    }

    void find_energies(DevicePath*, std::span<double> of_group) override {
        if (communicator_.rank() != 0) return;
        if (!context_) make_context();
        // No positions were gathered if they are on a GPU.
        if (!not_set_.empty()) set_positions();
        context_->find_energies(of_group);
    }
    DevicePathPlan plan(bool overlap) override {
        DevicePathPlan plan;
        plan.particle.assign(particle_.begin(), particle_.end());
        for (std::int64_t const particle : particle_)
            plan.bead.push_back(number_of_particle_[particle]);
        Placement const placement = placement_.value_or(context_->placement());
        if (placement == Placement::wrapped) plan.box = box_;
        plan.shifted = placement == Placement::shifted;
        plan.overlap = overlap;
        plan.keeps_list = why_not_by_pairs(*model_.system).empty();
        if (!replica_.empty()) {
            plan.reach = reach_;
            for (std::int64_t const particle : particle_)
                plan.replica.push_back(replica_[static_cast<std::size_t>(particle)]);
        }
        return plan;
    }
    ForceContext* device_context() override { return context_.get(); }
    std::unique_ptr<DevicePath> device_path(bool overlap) override {
        return cuda::make_device_path(context_->context(), plan(overlap));
    }
    std::vector<Vec3> forces_again() override {
        std::vector<Vec3> own_forces;
        auto const all = context_->forces();
        for (std::int64_t const particle : particle_)
            own_forces.push_back({{all[particle][0], all[particle][1], all[particle][2]}});
        return own_forces;
    }
    std::int64_t largest_context() const override { return context_ ? context_->size() : 0; }
    std::int64_t contexts() const override { return context_ ? 1 : 0; }

  private:
    void make_context() {
        context_ = std::make_unique<ForceContext>(model_.system, platform_, box_, home_);
        if (!replica_.empty()) context_->keep_apart(ReplicaPlaces(replica_, reach_));
    }
    /// Sets the gathered positions once. Shifts last for a number of calls, and a run must not
    /// depend on when its energies are asked for.
    void set_positions() {
        context_->set_positions(positions_, positions_.size());
        not_set_ = {};
    }

    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    Communicator const& communicator_;
    std::optional<Vec3> box_;
    std::optional<Placement> placement_;  // RankPlan::placement
    double reach_;        // of all forces on replicas, also those of other Contexts, nm
    ForceContext* home_;  // RankPlan::home
    /// Number of each particle's bead in the scene, for messages.
    std::vector<std::int64_t> number_of_particle_;
    std::vector<std::int32_t> replica_;  // of each particle; empty without replicas
    /// Particle of each bead in the order of by_rank, and bytes of each rank's positions.
    std::vector<std::int64_t> particle_, bytes_of_rank_;
    // index of the rank's first own bead in the order of by_rank
    std::int64_t first_ = 0;
    std::unique_ptr<ForceContext> context_;
    std::vector<Vec3> positions_;    // positions of all particles, nm, W
    std::span<Vec3 const> not_set_;  // those of them that the Context does not have yet
};

}  // namespace

void check_finite(std::span<Vec3 const> vectors, std::span<std::int64_t const> bead,
                  char const* what) {
    for (std::size_t k = 0; k < vectors.size(); ++k)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(vectors[k][c]))
                throw ComputationError(
                    fmt::format("{} of bead {} is not finite: use a smaller dynamics.step, or a "
                                "start without overlaps",
                                what, bead[k] + 1));
}

std::unique_ptr<RankForces> make_whole_forces(RankPlan const& plan) {
    return std::make_unique<ReplicatedForces>(plan);
}

}  // namespace catena
