#include "tests/support/level_solvers.hpp"

#include <algorithm>
#include <string>

#include "tests/support/compared_solver.hpp"

namespace catena::test {

void expect_same_bits_at_every_cut(Scene const& scene, Axes axes, Handles handles,
                                   dca::LevelPartMaker const& lower,
                                   Communicator const& communicator, bool many) {
    auto const executor = serial_executor();
    for (auto const& group : make_groups(scene, axes, handles, true, communicator)) {
        int levels = 0;
        for (dca::ChainTree const& tree : group->partition.trees)
            levels = std::max(levels, tree.levels());
        std::vector<NamedSolver> cuts;
        for (int up = 0; up <= levels + 1; ++up)
            for (int down = 0; down <= levels + 1; ++down) {
                bool const chosen = up == down || up + down == levels || (up == 1 && down == 0) ||
                                    (up == 0 && down == 1);
                if (!many && !chosen) continue;
                std::string const name = "levels " + std::to_string(up) + "," +
                                         std::to_string(down) + " of " + std::to_string(levels);
                cuts.push_back({name, make_level_solver(*group, communicator, {up, down}, lower,
                                                        dca::host_levels(*executor))});
            }
        evaluate_compared(*group, scene, *executor, communicator,
                          compared_solver(*group, make_tree_solver(*group, *executor, communicator),
                                          std::move(cuts)),
                          false);
    }
}

}  // namespace catena::test
