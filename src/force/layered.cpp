// Forces of a System whose layers have Contexts of their own.
#include <algorithm>
#include <exception>
#include <utility>

#include "force/rank_forces.hpp"
#include "systems/force_layers.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

/// Sum of the forces of all layers and of the remaining forces.
class LayeredForces final : public RankForces {
  public:
    LayeredForces(RankPlan plan, std::vector<ForceLayer> const& layers, MakeRankForces make) {
        for (ForceLayer const& layer : layers)
            plan.longest_reach = std::max(plan.longest_reach, reach_of(*layer.model.system));
        rest_ = make(plan);
        for (ForceLayer const& layer : layers) {
            auto const box = layer.model.system->usesPeriodicBoundaryConditions() ? plan.beads.box
                                                                                  : std::nullopt;
            std::vector<std::int64_t> place =
                own_places(layer, plan.beads, plan.communicator.rank());
            std::vector<Vec3> own(place.size());
            layers_.push_back({make({layer.model, plan.platform, layer.beads, plan.communicator,
                                     box, plan.audit, plan.longest_reach}),
                               std::move(place), std::move(own)});
        }
    }

    void gather(std::span<Vec3 const> own) override {
        rest_->gather(own);
        for (Layer& layer : layers_) {
            for (std::size_t i = 0; i < layer.own.size(); ++i)
                layer.own[i] = own[static_cast<std::size_t>(layer.place[i])];
            layer.forces->gather(layer.own);
        }
    }
    void evaluate(std::span<Vec3> own_forces) override {
        rest_->evaluate(own_forces);
        for (Layer& layer : layers_) {
            layer.forces->evaluate(layer.own);
            for (std::size_t i = 0; i < layer.own.size(); ++i) {
                Vec3& f = own_forces[static_cast<std::size_t>(layer.place[i])];
                f = f + layer.own[i];
            }
        }
    }
    void find_energies(DevicePath* device, std::span<double> of_group) override {
        // Error of rank 0, which the other ranks do not know of yet.
        std::exception_ptr error;
        each([&](RankForces& forces) {
            try {
                forces.find_energies(device, of_group);
            } catch (...) {
                if (!error) error = std::current_exception();
            }
        });
        if (error) std::rethrow_exception(error);
    }

    void renew_ghosts() override {
        each([](RankForces& forces) { forces.renew_ghosts(); });
    }
    bool ghosts_are_due() const override {
        bool due = false;
        each([&](RankForces const& forces) { due = due || forces.ghosts_are_due(); });
        return due;
    }
    /// Sums over all layers: a bead counts once in each layer in which it is a ghost. Each layer
    /// rebuilds its lists when its own beads have moved far, so `rebuilds` is the largest count of
    /// a layer.
    GhostTraffic traffic() const override {
        GhostTraffic all;
        each([&](RankForces const& forces) {
            GhostTraffic const one = forces.traffic();
            all.updates = std::max(all.updates, one.updates);
            all.rebuilds = std::max(all.rebuilds, one.rebuilds);
            all.messages += one.messages;
            all.bytes += one.bytes;
            all.seconds_of_lists += one.seconds_of_lists;
            all.ghosts += one.ghosts;
            all.most_ghosts += one.most_ghosts;
        });
        return all;
    }
    std::int64_t largest_context() const override {
        std::int64_t largest = 0;
        each([&](RankForces const& forces) {
            largest = std::max(largest, forces.largest_context());
        });
        return largest;
    }
    std::int64_t contexts() const override {
        std::int64_t all = 0;
        each([&](RankForces const& forces) { all += forces.contexts(); });
        return all;
    }
    double reach() const override {
        double reach = 0;
        each([&](RankForces const& forces) { reach = std::max(reach, forces.reach()); });
        return reach;
    }
    double skin() const override { return rest_->skin(); }
    std::vector<PairRange> ranges() const override {
        std::vector<PairRange> all;
        each([&](RankForces const& forces) {
            std::vector<PairRange> const some = forces.ranges();
            all.insert(all.end(), some.begin(), some.end());
        });
        std::stable_sort(all.begin(), all.end(),
                         [](PairRange const& a, PairRange const& b) { return a.reach > b.reach; });
        return all;
    }

  private:
    /// Forces of one layer, with a buffer.
    struct Layer {
        std::unique_ptr<RankForces> forces;
        /// Index of each of the layer's own beads among the rank's own beads.
        std::vector<std::int64_t> place;
        /// Positions of the layer's own beads, nm, then the forces on them, kJ/mol/nm.
        std::vector<Vec3> own;
    };
    /// Applies `action` to the remaining forces, then to each layer.
    template <class Action>
    void each(Action const& action) const {
        action(*rest_);
        for (Layer const& layer : layers_) action(*layer.forces);
    }

    std::unique_ptr<RankForces> rest_;  // forces that are in no layer, on all beads
    std::vector<Layer> layers_;
};

}  // namespace

std::unique_ptr<RankForces> make_layered_forces(RankPlan const& plan,
                                                std::vector<ForceLayer> const& layers,
                                                MakeRankForces make) {
    if (layers.empty()) return make(plan);
    return std::make_unique<LayeredForces>(plan, layers, make);
}

}  // namespace catena
