// Domain decomposition of OpenMM's forces with positions and forces on a GPU.
#include <algorithm>
#include <numeric>
#include <utility>

#include "error.hpp"
#include "force/device_ghosts.hpp"
#include "force/ghost_slots.hpp"

namespace catena {

HaloForces::HaloForces(RankPlan const& plan)
    : communicator_(plan.communicator),
      every_rank_has_beads_(
          std::adjacent_find(plan.beads.first_of_rank.begin(), plan.beads.first_of_rank.end()) ==
          plan.beads.first_of_rank.end()),
      share_(plan, skin_of_reach_on_device),
      pieces_(pieces(plan)),
      ghosts_(plan.communicator, share_.lists(pieces_.length)),
      audit_(plan.audit),
      slots_(pieces_) {
    if (own().empty()) return;
    count_kinds_elsewhere();
    // A small Context makes a platform that refuses the forces fail before the first time step. It
    // also supplies the GPU context.
    Subset const one{share_.particles_of(std::span(own()).first(1)), 1, 1};
    home_ = share_.context_of(
        system_of(share_.exchanges() ? one : share_.subset_of(share_.partners()), share_.system()));
}

std::vector<std::int64_t> HaloForces::every_number(std::int64_t count) {
    std::vector<std::int64_t> all(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int64_t>(i);
    return all;
}

/// If particles cannot be exchanged, forces refer to them by their own numbers, so no piece is like
/// another one.
BeadPieces HaloForces::pieces(RankPlan const& plan) const {
    std::vector<int> const kind_of_particle = kinds_of_particles(share_.system()),
                           particle = share_.particles_of(every_number(plan.beads.size()));
    std::vector<int> kind_of_bead, rank_of_particle(particle.size());
    for (int const p : particle)
        kind_of_bead.push_back(kind_of_particle[static_cast<std::size_t>(p)]);
    if (!share_.exchanges()) return single_beads(std::move(kind_of_bead));
    for (int rank = 0; rank < communicator_.size(); ++rank)
        for (int const p : share_.particles_of(plan.beads.beads_of(rank)))
            rank_of_particle[static_cast<std::size_t>(p)] = rank;
    std::vector<char> const joined = joined_across_ranks(share_.system(), rank_of_particle);
    std::vector<char> of_bead;
    for (int const p : particle) of_bead.push_back(joined[static_cast<std::size_t>(p)]);
    return pieces_of(plan.beads, kind_of_bead, of_bead);
}

void HaloForces::count_kinds_elsewhere() {
    of_kind_elsewhere_.assign(
        static_cast<std::size_t>(*std::max_element(pieces_.kind.begin(), pieces_.kind.end())) + 1,
        0);
    auto const add = [&](std::int64_t bead, int count) {
        if (pieces_.of(bead) > 0)
            of_kind_elsewhere_[static_cast<std::size_t>(
                pieces_.kind[static_cast<std::size_t>(bead)])] += count;
    };
    for (std::int64_t bead = 0; bead < std::ssize(pieces_.kind); ++bead) add(bead, 1);
    for (auto const* const beads : {&own(), &share_.partners()})
        for (std::int64_t const bead : *beads) add(bead, -1);
    elsewhere_ =
        std::accumulate(of_kind_elsewhere_.begin(), of_kind_elsewhere_.end(), std::int64_t{0});
}

DevicePathPlan HaloForces::plan(bool overlap) {
    DevicePathPlan plan;
    for (int k = 0; k < static_cast<int>(own().size()); ++k) plan.particle.push_back(k);
    plan.bead = share_.own_numbers();
    // The placement must suit all forces: those of a small part may allow more.
    Placement const placement = placement_for(share_.system());
    if (placement == Placement::wrapped) plan.box = share_.box();
    plan.shifted = placement == Placement::shifted;
    plan.overlap = overlap;
    plan.halo = this;
    return plan;
}
std::unique_ptr<DevicePath> HaloForces::device_path(bool overlap) {
    return own().empty() ? make_idle_path(*this, overlap)
                         : cuda::make_device_path(home_->context(), plan(overlap));
}

bool HaloForces::are_used_up(bool far, std::int64_t bead) {
    return ghosts_.are_used_up({far, bead}, in_trouble);
}
void HaloForces::refuse_trouble(std::int64_t bead) const {
    ghosts_.refuse_trouble(bead, in_trouble);
}
void HaloForces::carry(std::span<Vec3 const> sent, std::span<Vec3> received) {
    ghosts_.carry(sent, received);
}

void HaloForces::audit(std::span<Vec3 const> own, std::span<Vec3 const> received) const {
    std::vector<Vec3> ghosts(ghosts_.beads().size());
    for (std::size_t i = 0; i < received.size(); ++i)
        ghosts[static_cast<std::size_t>(ghosts_.received()[i])] = received[i];
    ghosts_.audit(own, ghosts);
}

void HaloForces::make_lists(std::span<Vec3 const> positions) {
    ghosts_.make(positions);
    lists_ = {};
    for (auto const& n : ghosts_.neighbours())
        lists_.messages.push_back(
            {n.rank, static_cast<std::int64_t>(n.sent), static_cast<std::int64_t>(n.received)});
    lists_.sent = ghosts_.sent();
    lists_.farthest = ghosts_.farthest();
    if (own().empty()) return;
    bool const lasts = context_ && share_.exchanges() && !(is_aligned_ && everyone_is_a_ghost());
    if (lasts && slots_.take(ghosts_.pieces()))
        lists_.keeps_particles = true;
    else if (lasts && slots_.take_of_any_kind(ghosts_.pieces()))
        exchange_particles(subset_of_slots(), share_.system(), *system_, context_->context());
    else
        make_context();
    list_particles();
}

/// Finds the particle of each position received, and the places of idle particles.
void HaloForces::list_particles() {
    // Particle of each ghost.
    std::vector<int> particle(ghosts_.beads().size());
    std::size_t next = share_.partners().size();
    std::iota(particle.begin(), particle.begin() + static_cast<std::ptrdiff_t>(next),
              static_cast<int>(own().size()));
    for (std::int64_t const piece : ghosts_.pieces())
        for (int i = 0; i < pieces_.of(piece); ++i)
            particle[next++] = first_slot() + slots_.particle(piece) + i;
    for (std::int64_t const ghost : ghosts_.received())
        lists_.particle.push_back(particle[static_cast<std::size_t>(ghost)]);
    lists_.idle = slots_.idle();
    for (int& p : lists_.idle) p += first_slot();
    std::int64_t const idle = std::ssize(lists_.idle);
    for (std::int64_t i = 0; i < idle; ++i) lists_.aside.push_back(ghosts_.aside(i, idle));
}

/// The subset holds own beads, partners, and beads with the slots' parameters.
Subset HaloForces::subset_of_slots() const {
    std::vector<std::int64_t> ghosts = share_.partners();
    std::vector<std::int64_t> const like = slots_.like();
    ghosts.insert(ghosts.end(), like.begin(), like.end());
    Subset subset = share_.subset_of(ghosts);
    subset.after = slots_.after();
    for (int& p : subset.after) p += first_slot();
    return subset;
}

/// Slots are made kind by kind, longest pieces first. OpenMM sorts molecules in space among those
/// of their kind alone, so neighbours in its arrays are then neighbours in space. Spares never
/// exceed the pieces that exist elsewhere: if every bead is a ghost, there is no place for spares.
void HaloForces::make_context() {
    std::vector<std::vector<std::int64_t>> of_kind(of_kind_elsewhere_.size());
    for (std::int64_t const piece : ghosts_.pieces())
        of_kind[static_cast<std::size_t>(pieces_.kind[static_cast<std::size_t>(piece)])].push_back(
            piece);
    std::stable_sort(of_kind.begin(), of_kind.end(), [&](auto const& a, auto const& b) {
        return (a.empty() ? 0 : pieces_.of(a.front())) > (b.empty() ? 0 : pieces_.of(b.front()));
    });
    std::vector<std::int64_t> like;
    for (std::vector<std::int64_t> const& of_one : of_kind) {
        like.insert(like.end(), of_one.begin(), of_one.end());
        if (of_one.empty() || !share_.exchanges()) continue;
        int const kind = pieces_.kind[static_cast<std::size_t>(of_one.front())];
        std::int64_t const here = std::ssize(of_one),
                           most = of_kind_elsewhere_[static_cast<std::size_t>(kind)] - here;
        like.insert(like.end(),
                    static_cast<std::size_t>(std::min(here / spare_part + least_spares, most)),
                    of_one.front());
    }
    context_.reset();  // frees memory for the next Context
    is_aligned_ = !like.empty() && pieces_.of(like.front()) > 1 && !everyone_is_a_ghost();
    slots_.make(std::move(like), is_aligned_ ? (block - first_slot() % block) % block : 0);
    slots_.take(ghosts_.pieces());
    system_ = system_of(subset_of_slots(), share_.system());
    context_ = share_.context_of(system_, home_.get());
    largest_ = std::max(largest_, context_->size());
    ++contexts_;
}

std::vector<Vec3> HaloForces::forces_again() {
    std::vector<Vec3> own_forces;
    if (own().empty()) return own_forces;
    auto const forces = context_->forces();
    for (std::size_t k = 0; k < own().size(); ++k)
        own_forces.push_back({{forces[k][0], forces[k][1], forces[k][2]}});
    return own_forces;
}

void HaloForces::find_energies(DevicePath* device, std::span<double> of_group) {
    share_.find_energies(device->positions(), home_.get(), of_group);
}

void HaloForces::gather(std::span<Vec3 const>) {
    throw ComputationError("positions stay on the GPU");
}
void HaloForces::evaluate(std::span<Vec3>) { throw ComputationError("forces stay on the GPU"); }

std::unique_ptr<RankForces> make_halo_forces(RankPlan const& plan) {
    return std::make_unique<HaloForces>(plan);
}

}  // namespace catena
