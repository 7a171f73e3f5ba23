#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "force/openmm_rank.hpp"
#include "force/openmm_subset.hpp"

namespace catena {

namespace {

/// All beads but those, ascending.
std::vector<std::int64_t> all_but(std::vector<std::int64_t> beads, std::int64_t count) {
    std::sort(beads.begin(), beads.end());
    std::vector<std::int64_t> all(static_cast<std::size_t>(count)), rest;
    std::iota(all.begin(), all.end(), std::int64_t{0});
    std::set_difference(all.begin(), all.end(), beads.begin(), beads.end(), std::back_inserter(rest));
    return rest;
}

/// Particles of the Context: own beads, partners, other ghosts, and spares for more ghosts, which stand aside. Where ghosts change, the
/// parameters of particles do: a Context is made anew only where spares run out, or particles cannot be exchanged.
class SplitForces final : public RankForces {
  public:
    explicit SplitForces(RankPlan const& plan)
        : model_(plan.model),
          platform_(plan.platform),
          communicator_(plan.communicator),
          box_(plan.box),
          audit_(plan.audit),
          own_(plan.beads.beads_of(plan.communicator.rank())),
          particle_of_bead_(plan.model.bead_of_particle.size()),
          reach_(reach_of(*plan.model.system)),
          skin_(std::isfinite(reach_) ? skin_of_reach * reach_ : 0),
          exchanges_(can_exchange_particles(*plan.model.system)),
          ghosts_(plan.communicator, ghost_plan(plan)) {
        make_context(partners_, 0);  // so that a platform that refuses the forces is found out before the first step
    }

    void gather(std::span<Vec3 const> own) override {
        ghosts_.update(own);
        if (audit_) ghosts_.audit(own);
        positions_.assign(own.begin(), own.end());
        positions_.insert(positions_.end(), ghosts_.positions().begin(), ghosts_.positions().end());
    }

    void evaluate(std::span<Vec3> own_forces) override {
        if (own_.empty()) return;
        if (std::exchange(listed_, ghosts_.traffic().rebuilds) != ghosts_.traffic().rebuilds) take_ghosts();
        std::int64_t const spares = context_->size() - std::ssize(positions_);
        for (std::int64_t i = 0; i < spares; ++i) positions_.push_back(ghosts_.aside(i, spares));
        context_->set_positions(positions_, own_.size());
        auto const forces = context_->forces();
        for (std::size_t k = 0; k < own_.size(); ++k) own_forces[k] = {{forces[k][0], forces[k][1], forces[k][2]}};
        check_finite(own_forces, own_, "OpenMM's force");
    }

    ForceContext* every_bead() override {
        std::vector<Vec3> all(communicator_.rank() == 0 ? particle_of_bead_.size() : 0);
        communicator_.gather(std::as_bytes(std::span(positions_).first(own_.size())), std::as_writable_bytes(std::span(all)),
                             bytes_of_rank_);
        if (communicator_.rank() != 0) return nullptr;
        if (!energies_) energies_ = std::make_unique<ForceContext>(model_.system, platform_, box_);
        std::vector<Vec3> of_particles(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) of_particles[particle_of_bead_[bead_at_[i]]] = all[i];
        energies_->set_positions(of_particles, of_particles.size());
        return energies_.get();
    }

    void renew_ghosts() override { ghosts_.renew(); }
    bool ghosts_are_due() const override { return ghosts_.is_due(); }
    GhostTraffic traffic() const override { return ghosts_.traffic(); }
    std::int64_t largest_context() const override { return largest_; }
    std::int64_t contexts() const override { return contexts_; }
    double reach() const override { return reach_; }
    double skin() const override { return skin_; }

  private:
    GhostExchange::Plan ghost_plan(RankPlan const& plan) {
        for (std::size_t p = 0; p < particle_of_bead_.size(); ++p) particle_of_bead_[model_.bead_of_particle[p]] = static_cast<int>(p);
        for (int rank = 0; rank < communicator_.size(); ++rank) {
            std::vector<std::int64_t> const of_rank = plan.beads.beads_of(rank);
            bytes_of_rank_.push_back(std::ssize(of_rank) * static_cast<std::int64_t>(sizeof(Vec3)));
            bead_at_.insert(bead_at_.end(), of_rank.begin(), of_rank.end());
        }
        if (!own_.empty()) {
            if (std::isfinite(reach_)) {
                for (int const p : bonded_partners(*model_.system, particles_of(own_))) partners_.push_back(model_.bead_of_particle[p]);
                std::sort(partners_.begin(), partners_.end());
            } else {
                partners_ = all_but(own_, plan.beads.size());
            }
        }
        return {plan.beads.first_of_rank, plan.beads.by_rank, partners_, std::isfinite(reach_) ? reach_ : 0, skin_, box_};
    }

    std::vector<int> particles_of(std::vector<std::int64_t> const& beads) const {
        std::vector<int> particles;
        for (std::int64_t const bead : beads) particles.push_back(particle_of_bead_[bead]);
        return particles;
    }

    /// Own beads and ghosts, and spares that stand for whatever.
    Subset subset_of(std::vector<std::int64_t> const& ghosts, std::int64_t spares) const {
        Subset subset{particles_of(own_), static_cast<int>(own_.size()), 0};
        auto const particles = particles_of(ghosts);
        subset.particles.insert(subset.particles.end(), particles.begin(), particles.end());
        subset.fixed = exchanges_ ? static_cast<int>(own_.size() + partners_.size()) : static_cast<int>(subset.particles.size());
        subset.particles.resize(subset.particles.size() + static_cast<std::size_t>(spares), 0);
        return subset;
    }

    void make_context(std::vector<std::int64_t> const& ghosts, std::int64_t spares) {
        if (own_.empty()) return;
        context_.reset();  // before the next takes its memory
        system_ = system_of(subset_of(ghosts, spares), *model_.system);
        context_ = std::make_unique<ForceContext>(system_, platform_, box_);
        largest_ = std::max(largest_, context_->size());
        ++contexts_;
    }

    /// Gives the Context the ghosts of the new lists.
    void take_ghosts() {
        std::int64_t const needed = std::ssize(own_) + std::ssize(ghosts_.beads()), all = std::ssize(particle_of_bead_);
        std::int64_t const enough = std::min(all, needed + needed / spare_part + least_spares);
        bool const fits = needed <= context_->size() && context_->size() <= 2 * enough;
        if (exchanges_ && fits)
            exchange_particles(subset_of(ghosts_.beads(), context_->size() - needed), *model_.system, *system_, context_->context());
        else
            make_context(ghosts_.beads(), exchanges_ ? enough - needed : 0);
    }

    /// One particle in so many is a spare when a Context is made, and so many besides.
    static std::int64_t constexpr spare_part = 16, least_spares = 16;

    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    Communicator const& communicator_;
    std::optional<Vec3> box_;
    bool audit_;
    std::vector<std::int64_t> own_;
    std::vector<int> particle_of_bead_;
    double reach_, skin_;
    bool exchanges_;
    std::vector<std::int64_t> partners_;                 // beads of other ranks that share a bonded term with own ones
    std::vector<std::int64_t> bead_at_, bytes_of_rank_;  // beads of all ranks, one rank after the other
    GhostExchange ghosts_;
    std::shared_ptr<OpenMM::System> system_;
    std::unique_ptr<ForceContext> context_, energies_;  // energies_: every bead, on rank 0
    std::vector<Vec3> positions_;                       // of the Context's particles
    std::int64_t listed_ = 0, largest_ = 0, contexts_ = 0;
};

}  // namespace

std::unique_ptr<RankForces> make_split_forces(RankPlan const& plan) { return std::make_unique<SplitForces>(plan); }

}  // namespace catena
