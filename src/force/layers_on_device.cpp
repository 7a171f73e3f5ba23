// Forces of a System whose layers have Contexts of their own, on path `device`.
#include <algorithm>
#include <utility>

#include "error.hpp"
#include "force/rank_forces.hpp"
#include "systems/force_layers.hpp"
#include "systems/subset.hpp"

namespace catena {
namespace {

/// Returns the placement that the System and all its layers allow: they take the same positions.
Placement common_placement(OpenMmModel const& rest, std::vector<ForceLayer> const& layers) {
    std::vector<std::shared_ptr<OpenMM::System const>> systems{rest.system};
    for (ForceLayer const& layer : layers) systems.emplace_back(layer.model.system);
    return placement_for(systems);
}

/// The forces of all layers and the remaining forces, summed on the GPU. The path of the remaining
/// forces, which act on all beads, computes those of the layers, too.
class LayersOnDevice final : public RankForces {
  public:
    LayersOnDevice(RankPlan plan, std::vector<ForceLayer> const& layers, MakeRankForces make) {
        plan.placement = common_placement(plan.model, layers);
        if (plan.placement == Placement::wrapped) plan.box = plan.beads.box;
        for (ForceLayer const& layer : layers)
            if (plan.beads.replicas > 1)
                plan.longest_reach = std::max(plan.longest_reach, reach_of(*layer.model.system));
        rest_ = make(plan);
        for (ForceLayer const& layer : layers) {
            RankPlan const of_layer{.model = layer.model,
                                    .platform = plan.platform,
                                    .beads = layer.beads,
                                    .communicator = plan.communicator,
                                    .box = plan.beads.box,
                                    .home = rest_->device_context()};
            layers_.push_back({make(of_layer), particles_in(layer, plan.model),
                               own_places(layer, plan.beads, plan.communicator.rank())});
        }
    }

    void gather(std::span<Vec3 const>) override {
        throw ComputationError("positions stay on the GPU");
    }
    void evaluate(std::span<Vec3>) override { throw ComputationError("forces stay on the GPU"); }
    void find_energies(DevicePath* device, std::span<double> of_group) override {
        each([&](RankForces& forces) { forces.find_energies(device, of_group); });
    }
    DevicePathPlan plan(bool overlap) override {
        DevicePathPlan plan = rest_->plan(overlap);
        for (Layer const& layer : layers_)
            plan.layers.push_back({&layer.forces->device_context()->context(), layer.particle,
                                   layer.forces->plan(overlap).keeps_list});
        return plan;
    }
    ForceContext* device_context() override { return rest_->device_context(); }
    std::unique_ptr<DevicePath> device_path(bool overlap) override {
        return cuda::make_device_path(device_context()->context(), plan(overlap));
    }
    std::vector<Vec3> forces_again() override {
        std::vector<Vec3> all = rest_->forces_again();
        for (Layer const& layer : layers_) {
            std::vector<Vec3> const some = layer.forces->forces_again();
            for (std::size_t i = 0; i < some.size(); ++i) {
                Vec3& f = all[static_cast<std::size_t>(layer.place[i])];
                f = f + some[i];
            }
        }
        return all;
    }

    // Layers exchange nothing: they take positions from the Context of the remaining forces.
    void renew_ghosts() override { rest_->renew_ghosts(); }
    bool ghosts_are_due() const override { return rest_->ghosts_are_due(); }
    GhostTraffic traffic() const override { return rest_->traffic(); }
    std::int64_t largest_context() const override { return rest_->largest_context(); }
    std::int64_t contexts() const override {
        std::int64_t all = 0;
        each([&](RankForces const& forces) { all += forces.contexts(); });
        return all;
    }
    bool shares_pairs() const override { return rest_->shares_pairs(); }

  private:
    /// Forces of one layer.
    struct Layer {
        std::unique_ptr<RankForces> forces;
        /// Particle of the remaining forces' Context of each of the layer's particles.
        std::vector<int> particle;
        /// Index of each of the layer's own beads among the rank's own beads.
        std::vector<std::int64_t> place;
    };
    /// Applies `action` to the remaining forces, then to each layer.
    template <class Action>
    void each(Action const& action) const {
        action(*rest_);
        for (Layer const& layer : layers_) action(*layer.forces);
    }

    std::unique_ptr<RankForces> rest_;  // forces that are in no layer, on all beads
    std::vector<Layer> layers_;  // declared later: they end before the Context that they share
};

}  // namespace

std::unique_ptr<RankForces> make_layers_on_device(RankPlan const& plan,
                                                  std::vector<ForceLayer> const& layers,
                                                  MakeRankForces make) {
    if (layers.empty()) return make(plan);
    return std::make_unique<LayersOnDevice>(plan, layers, make);
}

}  // namespace catena
