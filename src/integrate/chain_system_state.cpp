// Results and energies of a ChainSystem: collection and exchange between ranks.
#include "integrate/chain_system.hpp"

#include <algorithm>
#include <limits>

#include "chain/gather.hpp"
#include "integrate/flat_arrays.hpp"
#include "mpi/collectives.hpp"
#include "scene/loops.hpp"
#include "terms/force_terms.hpp"

namespace catena {

double ChainSystem::correction() {
    double worst = 0;
    for (auto const& group : joint_) worst = larger(worst, group->correction());
    return worst;
}

double ChainSystem::residual() {
    double worst = 0;
    for (auto const& group : absolute_) worst = larger(worst, group->residual());
    for (auto const& group : joint_) worst = larger(worst, group->residual(*executor_));
    return worst;
}

// Each merge adds rounding of a few eps of its terms, and terms pass through at most `depth`
// merges. c = 32 covers the constants of 6x6 handles (factorisation, two triangular solves, leaf).
// Solving for the forces of loops adds a few eps per direction that they restrict (Higham, Accuracy
// and Stability of Numerical Algorithms, 2002, theorem 10.4).
double ChainSystem::residual_bound() const {
    std::int64_t depth = 1;
    for (SolverReport const& r : solver_reports()) depth = std::max(depth, r.depth);
    std::int64_t of_loops = 0;
    for (ChainSpec const& chain : scene_.chains)
        of_loops = std::max(of_loops, scene::directions_of_loops(chain));
    return 32.0 * static_cast<double>(depth + of_loops) * std::numeric_limits<double>::epsilon() /
           2;
}

void ChainSystem::check_forces() const {
    if (openmm_ && openmm_->on_device()) openmm_->force().device_path()->refuse_trouble();
}

void ChainSystem::measure(bool on) const {
    for (auto const& group : absolute_) group->solver().measure(on);
    for (auto const& group : joint_) group->solver().measure(on);
}

bool ChainSystem::is_free_of_potentials() const {
    return !terms::has_potential(scene_) &&
           std::all_of(groups_.begin(), groups_.end(),
                       [](auto const& group) { return group->beads; });
}

std::vector<EnergyTerm> ChainSystem::potential_energy() {
    std::vector<terms::EnergyColumn> const columns = terms::energy_columns(scene_);
    auto const width = static_cast<int>(columns.size());
    std::vector<std::vector<double>> own(groups_.size());
    auto const add = [&](ChainGroup const& group, PotentialEnergy const& e) {
        std::vector<double>& rows = own[index_of(group)];
        rows.reserve(static_cast<std::size_t>(group.size * width));
        for (auto k = std::size_t{0}; k < static_cast<std::size_t>(group.size); ++k)
            for (terms::EnergyColumn const& column : columns) rows.push_back(e[column.place][k]);
    };
    std::vector<EnergyTerm> terms;
    for (terms::EnergyColumn const& column : columns) terms.push_back({column.name, 0.0});
    if (is_free_of_potentials()) {
        for (auto const& group : absolute_) group->settle_forces();
    } else {
        for (auto const& group : absolute_) add(group->group(), group->potential());
        for (auto const& group : joint_) add(group->group(), group->potential());
        SceneWindows(communicator_, groups_)
            .pass(width, own, [&](std::int64_t, std::span<double const> values) {
                for (std::size_t i = 0; i < values.size(); ++i)
                    terms[i % static_cast<std::size_t>(width)].value += values[i];
            });
    }
    if (openmm_)
        for (EnergyTerm const& term : openmm_->force().energies()) terms.push_back(term);
    return terms;
}

std::vector<Vector<double, 6>> ChainSystem::joint_forces(
    std::vector<BodyResults> const& results) const {
    std::vector<double> all(
        communicator_.rank() == 0 ? static_cast<std::size_t>(6 * scene_.bodies()) : 0);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        std::vector<double> own;
        for (Vector<double, 6> const& w : r.joint_force) own.insert(own.end(), w.data, w.data + 6);
        gather_to_scene(communicator_, group, 6, own, all);
    };
    for (std::size_t i = 0; i < absolute_.size(); ++i) add(absolute_[i]->group(), results[i]);
    for (std::size_t i = 0; i < joint_.size(); ++i)
        add(joint_[i]->group(), results[absolute_.size() + i]);
    std::vector<Vector<double, 6>> forces(all.size() / 6);
    for (std::size_t i = 0; i < all.size(); ++i) forces[i / 6][static_cast<int>(i % 6)] = all[i];
    return forces;
}

std::vector<Vec3> ChainSystem::bead_forces() const {
    if (!openmm_) return {};
    BeadSystem const& beads = openmm_->beads();
    std::vector<std::int64_t> const& first = beads.first_of_rank;
    std::vector<std::int64_t> counts;
    for (int rank = 0; rank < communicator_.size(); ++rank)
        counts.push_back(first[rank + 1] - first[rank]);
    // Each Context computes its forces anew into the array whose sums the chains may not have read:
    // potential() lets them.
    if (openmm_->on_device())
        for (auto const& group : absolute_) group->potential();
    std::vector<Vec3> const own = openmm_->own_forces();
    std::vector<Vec3> all = gathered(communicator_, own, counts);
    if (beads.by_rank.empty()) return all;
    std::vector<Vec3> ordered(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        ordered[static_cast<std::size_t>(beads.by_rank[i])] = all[i];
    return ordered;
}

std::vector<TipForce> ChainSystem::in_scene_order(std::vector<TipForce> const& own) const {
    std::vector<TipForce> all = gathered_blocks(communicator_, own).values;
    // One rank has all of a chain, in their order.
    std::stable_sort(all.begin(), all.end(),
                     [](TipForce const& a, TipForce const& b) { return a.chain < b.chain; });
    return all;
}

std::vector<TipForce> ChainSystem::tip_forces(std::vector<BodyResults> const& results) const {
    std::vector<TipForce> own;
    for (BodyResults const& r : results)
        own.insert(own.end(), r.tip_force.begin(), r.tip_force.end());
    return in_scene_order(own);
}

std::vector<TipForce> ChainSystem::loop_forces(std::vector<BodyResults> const& results) const {
    std::vector<TipForce> own;
    for (BodyResults const& r : results)
        own.insert(own.end(), r.loop_force.begin(), r.loop_force.end());
    return in_scene_order(own);
}

std::vector<double> ChainSystem::crosslink_tensions(std::vector<BodyResults> const& results) const {
    std::vector<CrossLinkTension> own;
    for (BodyResults const& r : results)
        own.insert(own.end(), r.crosslink_tension.begin(), r.crosslink_tension.end());
    // One rank has all cross-links of a chain, in their order.
    std::vector<CrossLinkTension> all = gathered_blocks(communicator_, own).values;
    std::stable_sort(
        all.begin(), all.end(),
        [](CrossLinkTension const& a, CrossLinkTension const& b) { return a.chain < b.chain; });
    std::vector<double> tensions;
    for (CrossLinkTension const& each : all) tensions.push_back(each.tension);
    return tensions;
}

ChainSystem::Accelerations ChainSystem::accelerations() {
    std::size_t const n = communicator_.rank() == 0 ? static_cast<std::size_t>(scene_.bodies()) : 0;
    std::vector<double> joint(3 * n), body(3 * n), base(3 * n), alpha(3 * n);
    auto const add = [&](ChainGroup const& group, BodyResults const& r) {
        gather_to_scene(communicator_, group, 3, flat(r.acceleration), body);
        if (!group.beads) gather_to_scene(communicator_, group, 3, flat(r.alpha), alpha);
    };
    std::vector<BodyResults> const found = results_of(*this);
    for (std::size_t i = 0; i < absolute_.size(); ++i) {
        add(absolute_[i]->group(), found[i]);
        gather_to_scene(communicator_, absolute_[i]->group(), 3, flat(found[i].acceleration),
                        joint);
    }
    for (std::size_t i = 0; i < joint_.size(); ++i) {
        ChainGroup const& group = joint_[i]->group();
        add(group, found[absolute_.size() + i]);
        JointRates const rates = joint_[i]->rates();
        gather_to_scene(communicator_, group, 3,
                        to_array<3>("", rates.qdd.view(), *executor_).values, joint);
        gather_to_scene(communicator_, group, 3, at_starts(group, rates.base_acceleration), base);
    }
    return {triples(joint),    triples(body),       bead_forces(),     triples(alpha),
            triples(base),     joint_forces(found), tip_forces(found), crosslink_tensions(found),
            loop_forces(found)};
}

}  // namespace catena
