// A rank's share where positions and forces stay on a GPU.
#include <algorithm>
#include <utility>

#include "error.hpp"
#include "force/ghost_slots.hpp"
#include "force/openmm_halo.hpp"

namespace catena {

HaloForces::HaloForces(RankPlan const& plan)
    : communicator_(plan.communicator),
      every_rank_has_beads_(std::adjacent_find(plan.beads.first_of_rank.begin(), plan.beads.first_of_rank.end()) ==
                            plan.beads.first_of_rank.end()),
      share_(plan, skin_of_reach_on_device),
      ghosts_(plan.communicator, share_.lists()),
      audit_(plan.audit),
      all_(plan.beads.size()),
      slots_(kind_of_bead_) {
    if (own().empty()) return;
    std::vector<int> const kind = kinds_of_particles(share_.system());
    for (int const particle : share_.particles_of(every_number(all_))) kind_of_bead_.push_back(kind[static_cast<std::size_t>(particle)]);
    of_kind_elsewhere_.assign(kind.empty() ? 0 : static_cast<std::size_t>(*std::max_element(kind.begin(), kind.end())) + 1, 0);
    for (int const k : kind_of_bead_) ++of_kind_elsewhere_[static_cast<std::size_t>(k)];
    for (auto const* const beads : {&own(), &share_.partners()})
        for (std::int64_t const bead : *beads)
            --of_kind_elsewhere_[static_cast<std::size_t>(kind_of_bead_[static_cast<std::size_t>(bead)])];
    // A small one, so that a platform that refuses the forces is found out before the first step, and for its GPU context.
    Subset const one{share_.particles_of(std::span(own()).first(1)), 1, 1};
    home_ = share_.context_of(system_of(share_.exchanges() ? one : share_.subset_of(share_.partners()), share_.system()));
}

std::vector<std::int64_t> HaloForces::every_number(std::int64_t count) {
    std::vector<std::int64_t> all(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int64_t>(i);
    return all;
}

DevicePathPlan HaloForces::plan(bool overlap) {
    DevicePathPlan plan;
    for (int k = 0; k < static_cast<int>(own().size()); ++k) plan.particle.push_back(k);
    plan.bead = own();
    Placement const placement = placement_for(share_.system());  // of all forces: a small part may allow more
    if (placement == Placement::wrapped) plan.box = share_.box();
    plan.shifted = placement == Placement::shifted;
    plan.overlap = overlap;
    plan.halo = this;
    return plan;
}
std::unique_ptr<DevicePath> HaloForces::device_path(bool overlap) {
    return own().empty() ? make_idle_path(*this, overlap) : cuda::make_device_path(home_->context(), plan(overlap));
}

bool HaloForces::are_used_up(bool far, std::int64_t bead) { return ghosts_.are_used_up({far, bead}, in_trouble); }
void HaloForces::refuse_trouble(std::int64_t bead) const { ghosts_.refuse_trouble(bead, in_trouble); }
void HaloForces::carry(std::span<Vec3 const> sent, std::span<Vec3> received) { ghosts_.carry(sent, received); }

void HaloForces::audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const {
    std::vector<Vec3> ghosts(ghosts_.beads().size());
    for (std::size_t i = 0; i < received.size(); ++i) ghosts[static_cast<std::size_t>(ghosts_.received()[i])] = received[i];
    ghosts_.audit(own, ghosts);
}

void HaloForces::make_lists(std::span<Vec3 const> positions) {
    ghosts_.make(positions);
    lists_ = {};
    for (auto const& n : ghosts_.neighbours())
        lists_.messages.push_back({n.rank, static_cast<std::int64_t>(n.sent), static_cast<std::int64_t>(n.received)});
    lists_.sent = ghosts_.sent();
    lists_.farthest = ghosts_.farthest();
    if (own().empty()) return;
    std::span const others = std::span(ghosts_.beads()).subspan(share_.partners().size());
    bool const lasts = context_ && share_.exchanges();
    if (lasts && slots_.take(others))
        lists_.keeps_particles = true;
    else if (lasts && slots_.take_of_any_kind(others))
        exchange_particles(subset_of_slots(), share_.system(), *system_, context_->context());
    else
        make_context(others);
    auto const partners = static_cast<std::int64_t>(share_.partners().size());
    int const first_ghost = static_cast<int>(own().size()), first_slot = first_ghost + static_cast<int>(partners);
    for (std::int64_t const ghost : ghosts_.received())
        lists_.particle.push_back(ghost < partners ? first_ghost + static_cast<int>(ghost)
                                                   : first_slot + slots_.slot(ghosts_.beads()[static_cast<std::size_t>(ghost)]));
    lists_.idle = slots_.idle();
    for (int& slot : lists_.idle) slot += first_slot;
    std::int64_t const idle = std::ssize(lists_.idle);
    for (std::int64_t i = 0; i < idle; ++i) lists_.aside.push_back(ghosts_.aside(i, idle));
}

/// Own beads, partners, and whom slots are like.
Subset HaloForces::subset_of_slots() const {
    std::vector<std::int64_t> ghosts = share_.partners();
    for (std::int64_t s = 0; s < slots_.size(); ++s) ghosts.push_back(slots_.like(s));
    return share_.subset_of(ghosts);
}

/// Kind by kind, because OpenMM sorts particles in space among those of their kind alone: neighbours in its arrays then are neighbours in
/// space. With some spares, but no more than there are beads: where every bead is a ghost there is no place aside.
void HaloForces::make_context(std::span<std::int64_t const> others) {
    std::vector<std::vector<std::int64_t>> of_kind(of_kind_elsewhere_.size());
    for (std::int64_t const bead : others) of_kind[static_cast<std::size_t>(kind_of_bead_[static_cast<std::size_t>(bead)])].push_back(bead);
    std::vector<std::int64_t> like;
    for (std::size_t kind = 0; kind < of_kind.size(); ++kind) {
        std::vector<std::int64_t> const& beads = of_kind[kind];
        if (beads.empty()) continue;
        like.insert(like.end(), beads.begin(), beads.end());
        std::int64_t const here = std::ssize(beads), spares = std::min(here / spare_part + least_spares, of_kind_elsewhere_[kind] - here);
        if (share_.exchanges()) like.insert(like.end(), static_cast<std::size_t>(spares), beads.front());
    }
    context_.reset();  // before the next takes its memory
    slots_.make(std::move(like));
    slots_.take(others);
    system_ = system_of(subset_of_slots(), share_.system());
    context_ = share_.context_of(system_, home_.get());
    largest_ = std::max(largest_, context_->size());
    ++contexts_;
}

std::vector<Vec3> HaloForces::forces_again() {
    std::vector<Vec3> own_forces;
    if (own().empty()) return own_forces;
    auto const forces = context_->forces();
    for (std::size_t k = 0; k < own().size(); ++k) own_forces.push_back({{forces[k][0], forces[k][1], forces[k][2]}});
    return own_forces;
}

ForceContext* HaloForces::every_bead(DevicePath* device) { return share_.every_bead(device->positions(), home_.get()); }

void HaloForces::gather(std::span<Vec3 const>) { throw ComputationError("positions stay on the GPU"); }
void HaloForces::evaluate(std::span<Vec3>) { throw ComputationError("forces stay on the GPU"); }

std::unique_ptr<RankForces> make_halo_forces(RankPlan const& plan) { return std::make_unique<HaloForces>(plan); }

}  // namespace catena
