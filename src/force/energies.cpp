// Energies of all beads, computed by rank 0.
#include "force/energies.hpp"

namespace catena {

WholeEnergies::WholeEnergies(RankPlan const& plan)
    : model_(plan.model),
      platform_(plan.platform),
      communicator_(plan.communicator),
      box_(plan.box) {
    std::vector<int> const particle_of_bead = particles_of_beads(model_.bead_of_particle);
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        std::vector<std::int64_t> const of_rank = plan.beads.beads_of(rank);
        bytes_of_rank_.push_back(std::ssize(of_rank) * static_cast<std::int64_t>(sizeof(Vec3)));
        for (std::int64_t const bead : of_rank)
            particle_.push_back(particle_of_bead[static_cast<std::size_t>(bead)]);
    }
}

void WholeEnergies::find(std::span<Vec3 const> own, ForceContext* home,
                         std::span<double> of_group) {
    std::vector<Vec3> all(communicator_.rank() == 0 ? particle_.size() : 0);
    communicator_.gather(std::as_bytes(own), std::as_writable_bytes(std::span(all)),
                         bytes_of_rank_);
    if (communicator_.rank() != 0) return;
    if (!context_) context_ = std::make_unique<ForceContext>(model_.system, platform_, box_, home);
    std::vector<Vec3> of_particles(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        of_particles[static_cast<std::size_t>(particle_[i])] = all[i];
    // Outputs are far apart in time, so there is no neighbour list that could be kept.
    context_->place_anew();
    context_->set_positions(of_particles, of_particles.size());
    context_->find_energies(of_group);
}

}  // namespace catena
