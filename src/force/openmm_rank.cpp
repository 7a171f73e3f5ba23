#include "force/openmm_rank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "error.hpp"
#include "force/ghosts.hpp"
#include "force/openmm_subset.hpp"

namespace catena {

namespace {

/// `beads`: which they are; empty: all, in their order.
void check_finite(std::span<Vec3 const> vectors, std::span<std::int64_t const> beads, char const* what) {
    for (std::size_t k = 0; k < vectors.size(); ++k)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(vectors[k][c]))
                throw ComputationError(fmt::format("{} of bead {} is not finite: take a smaller step, or a start without overlaps", what,
                                                   (beads.empty() ? static_cast<std::int64_t>(k) : beads[k]) + 1));
}

}  // namespace

RankForces::RankForces(OpenMmModel const& model, OpenMmPlatform const& platform, std::vector<std::int64_t> own, bool whole,
                       std::optional<Vec3> const& box)
    : model_(model), platform_(platform), own_(std::move(own)), whole_(whole), box_(box), particle_of_bead_(model.bead_of_particle.size()) {
    for (std::size_t p = 0; p < particle_of_bead_.size(); ++p) particle_of_bead_[model.bead_of_particle[p]] = static_cast<int>(p);
    if (own_.empty()) return;
    if (whole) {
        context_ = std::make_unique<ForceContext>(model.system, model.bead_of_particle, platform, box);
        largest_ = context_->size();
        rebuilds_ = 1;
        return;
    }
    reach_ = reach_of(*model.system);
    skin_ = std::isfinite(reach_) ? skin_of_reach * reach_ : 0;
    std::vector<int> particles;
    for (std::int64_t const bead : own_) particles.push_back(particle_of_bead_[bead]);
    for (int p : bonded_partners(*model.system, particles)) partners_.push_back(model.bead_of_particle[p]);
    std::sort(partners_.begin(), partners_.end());
    std::vector<std::int64_t> smallest = own_;
    smallest.insert(smallest.end(), partners_.begin(), partners_.end());
    context_for(smallest);  // so that a platform that refuses the forces is found out before the first step
}

std::unique_ptr<ForceContext> RankForces::context_for(std::vector<std::int64_t> beads) const {
    std::vector<int> particles;
    for (std::int64_t bead : beads) particles.push_back(particle_of_bead_[bead]);
    return std::make_unique<ForceContext>(subset_of(*model_.system, particles, static_cast<int>(own_.size())), std::move(beads), platform_,
                                          box_);
}

std::vector<std::int64_t> RankForces::ghost_beads(std::span<Vec3 const> all) const {
    if (!std::isfinite(reach_)) {
        std::vector<std::int64_t> own = own_, everything(all.size()), ghosts;
        std::sort(own.begin(), own.end());
        std::iota(everything.begin(), everything.end(), std::int64_t{0});
        std::set_difference(everything.begin(), everything.end(), own.begin(), own.end(), std::back_inserter(ghosts));
        return ghosts;
    }
    if (reach_ == 0) return partners_;
    auto const near = ghosts_of(all, own_, reach_ + skin_, box_);
    std::vector<std::int64_t> ghosts;
    std::set_union(near.begin(), near.end(), partners_.begin(), partners_.end(), std::back_inserter(ghosts));
    return ghosts;
}

void RankForces::rebuild(std::span<Vec3 const> all) {
    std::vector<std::int64_t> beads = own_;
    auto const ghosts = ghost_beads(all);
    beads.insert(beads.end(), ghosts.begin(), ghosts.end());
    context_.reset();  // before the next takes its memory
    context_ = context_for(std::move(beads));
    listed_.assign(all.begin(), all.end());
    largest_ = std::max(largest_, context_->size());
    ++rebuilds_;
}

bool RankForces::list_is_good(std::span<Vec3 const> all) const {
    if (!context_) return false;
    if (whole_ || context_->size() == std::ssize(all) || reach_ == 0) return true;
    return largest_displacement(listed_, all) < skin_ / 2;
}

void RankForces::evaluate(std::span<Vec3 const> all, std::span<Vec3> own_forces) {
    if (own_.empty()) return;
    check_finite(all, {}, "the position");
    if (!list_is_good(all)) rebuild(all);
    context_->set_positions(all);
    auto const forces = context_->forces();
    for (std::size_t k = 0; k < own_.size(); ++k) {
        OpenMM::Vec3 const& f = forces[whole_ ? static_cast<std::size_t>(particle_of_bead_[own_[k]]) : k];
        own_forces[k] = {{f[0], f[1], f[2]}};
    }
    check_finite(own_forces, own_, "OpenMM's force");
}

}  // namespace catena
