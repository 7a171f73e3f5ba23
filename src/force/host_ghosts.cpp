// Domain decomposition of OpenMM's forces with positions and forces passing through the host.
#include <algorithm>
#include <utility>

#include "force/rank_share.hpp"
#include "neighbours/ghost_exchange.hpp"

namespace catena {

namespace {

/// Forces on one rank's own beads, from a Context with its beads and their ghosts.
/// The Context's particles are own beads, partners, other ghosts, and spares, which are placed
/// where they act on nothing. If ghosts change, particles get other parameters. A new Context is
/// made only if spares run out or are too many, or particles cannot be exchanged.
class SplitForces final : public RankForces {
  public:
    explicit SplitForces(RankPlan const& plan)
        : share_(plan, skin_of_reach),
          audit_(plan.audit),
          beads_(plan.beads.size()),
          ghosts_(plan.communicator, share_.lists()) {
        // The Context is made now, so that a platform that refuses the forces fails before the
        // first time step.
        make_context(share_.partners(), 0);
    }

    void gather(std::span<Vec3 const> own) override {
        ghosts_.update(own);
        if (audit_) ghosts_.audit(own);
        positions_.assign(own.begin(), own.end());
        positions_.insert(positions_.end(), ghosts_.positions().begin(), ghosts_.positions().end());
    }

    void evaluate(std::span<Vec3> own_forces) override {
        if (own().empty()) return;
        if (std::exchange(listed_, ghosts_.traffic().rebuilds) != ghosts_.traffic().rebuilds)
            take_ghosts();
        std::int64_t const spares = context_->size() - std::ssize(positions_);
        for (std::int64_t i = 0; i < spares; ++i) positions_.push_back(ghosts_.aside(i, spares));
        context_->set_positions(positions_, own().size());
        auto const forces = context_->forces();
        for (std::size_t k = 0; k < own().size(); ++k)
            own_forces[k] = {{forces[k][0], forces[k][1], forces[k][2]}};
        check_finite(own_forces, share_.own_numbers(), "OpenMM's force");
    }

    void find_energies(DevicePath*, std::span<double> of_group) override {
        share_.find_energies(std::span(positions_).first(own().size()), nullptr, of_group);
    }
    void renew_ghosts() override { ghosts_.renew(); }
    bool ghosts_are_due() const override { return ghosts_.is_due(); }
    GhostTraffic traffic() const override { return ghosts_.traffic(); }
    std::int64_t largest_context() const override { return largest_; }
    std::int64_t contexts() const override { return contexts_; }
    double reach() const override { return share_.reach(); }
    std::vector<PairRange> ranges() const override { return share_.ranges(); }
    double skin() const override { return share_.skin(); }

  private:
    std::vector<std::int64_t> const& own() const { return share_.own(); }

    /// Returns the subset with `spares` spare particles, which have particle 0's parameters.
    Subset subset_of(std::vector<std::int64_t> const& ghosts, std::int64_t spares) const {
        Subset subset = share_.subset_of(ghosts);
        subset.particles.resize(subset.particles.size() + static_cast<std::size_t>(spares), 0);
        return subset;
    }

    void make_context(std::vector<std::int64_t> const& ghosts, std::int64_t spares) {
        if (own().empty()) return;
        context_.reset();  // frees memory for the next Context
        system_ = system_of(subset_of(ghosts, spares), share_.system());
        context_ = share_.context_of(system_);
        largest_ = std::max(largest_, context_->size());
        ++contexts_;
    }

    /// Adapts the Context to the ghosts of the new lists.
    void take_ghosts() {
        std::int64_t const needed = std::ssize(own()) + std::ssize(ghosts_.beads());
        std::int64_t const enough = std::min(beads_, needed + needed / spare_part + least_spares);
        bool const fits = needed <= context_->size() && context_->size() <= 2 * enough;
        if (share_.exchanges() && fits) {
            exchange_particles(subset_of(ghosts_.beads(), context_->size() - needed),
                               share_.system(), *system_, context_->context());
            context_->place_anew();
        } else {
            make_context(ghosts_.beads(), share_.exchanges() ? enough - needed : 0);
        }
    }

    /// Spare particles of a new Context: one for every `spare_part` particles, plus `least_spares`.
    static std::int64_t constexpr spare_part = 16, least_spares = 16;

    DomainShare share_;
    bool audit_;
    std::int64_t beads_;  // number of beads of all ranks
    GhostExchange ghosts_;
    std::shared_ptr<OpenMM::System> system_;
    std::unique_ptr<ForceContext> context_;
    std::vector<Vec3> positions_;  // positions of the Context's particles, nm, W
    // rebuilds of the lists that the Context has; largest Context, particles; number of Contexts
    std::int64_t listed_ = 0, largest_ = 0, contexts_ = 0;
};

}  // namespace

std::unique_ptr<RankForces> make_split_forces(RankPlan const& plan) {
    return std::make_unique<SplitForces>(plan);
}

}  // namespace catena
