// Models of groups that a group's solver and its dynamics share.
#pragma once

#include <map>
#include <memory>

#include "chain/chain_group.hpp"

namespace catena::cuda {

/// Base of Spaces that hand out one model per group as long as somebody holds it. Copies of a Space
/// hand out the same ones. `Model` is a handle of `Arrays`.
template <class Model, class Arrays>
class SharedModels {
  public:
    /// Returns the model that solver and dynamics of a group share. The group must outlive it.
    Model model(ChainGroup const& group) const {
        std::weak_ptr<Arrays const>& known = (*models_)[&group];
        std::shared_ptr<Arrays const> arrays = known.lock();
        if (!arrays) {
            bool const in_joints = group.axes == Axes::joint && !group.beads && !group.linked;
            arrays = std::make_shared<Arrays const>(group, in_joints);
            known = arrays;
        }
        return Model(std::move(arrays));
    }

  private:
    using Known = std::map<ChainGroup const*, std::weak_ptr<Arrays const>>;
    std::shared_ptr<Known> models_ = std::make_shared<Known>();
};

}  // namespace catena::cuda
