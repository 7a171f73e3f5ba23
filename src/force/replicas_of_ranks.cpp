// Implements the forces of replicas that are dealt out to ranks.
#include "force/replicas_of_ranks.hpp"

#include <fmt/format.h>

#include <utility>

#include "mpi/collectives.hpp"
#include "mpi/first_rank.hpp"

namespace catena {
namespace {

/// The rank's own forces, with energies of all ranks.
class ReplicasOfRanks final : public OpenMmForce {
  public:
    ReplicasOfRanks(std::unique_ptr<Communicator> alone, std::unique_ptr<OpenMmForce> own,
                    Communicator const& all)
        : alone_(std::move(alone)), own_(std::move(own)), communicator_(all) {}

    void begin(ConstView<3> positions) override { own_->begin(positions); }
    DevicePath* device_path() override { return own_->device_path(); }
    void forces_again(View<3> forces) override { own_->forces_again(forces); }
    void finish(View<3> forces) override { own_->finish(forces); }
    std::vector<EnergyTerm> energies() override;
    Interval last_evaluation() const override { return own_->last_evaluation(); }
    bool leaves_a_core() const override { return own_->leaves_a_core(); }
    std::vector<std::string> description() const override;
    std::string platform() const override { return own_->platform(); }
    std::string path() const override { return own_->path(); }
    void renew_ghosts() override {}
    bool ghosts_are_due() const override { return false; }
    GhostTraffic traffic() const override { return {}; }
    Interval last_gathering() const override { return {}; }
    std::int64_t largest_context() const override { return own_->largest_context(); }
    std::int64_t contexts() const override { return own_->contexts(); }

  private:
    std::unique_ptr<Communicator> alone_;  // outlives own_, which refers to it
    std::unique_ptr<OpenMmForce> own_;
    Communicator const& communicator_;
};

std::vector<EnergyTerm> ReplicasOfRanks::energies() {
    std::vector<EnergyTerm> terms;
    on_every_rank(communicator_, [&] { terms = own_->energies(); });
    std::vector<double> own;
    for (EnergyTerm const& term : terms) own.push_back(term.value);
    std::vector<double> const all = all_gathered_alike(communicator_, own);
    for (std::size_t t = 0; t < terms.size(); ++t) {
        terms[t].value = 0;
        for (std::size_t at = t; at < all.size(); at += terms.size()) terms[t].value += all[at];
    }
    return terms;
}

std::vector<std::string> ReplicasOfRanks::description() const {
    std::vector<std::string> lines = own_->description();
    lines.push_back(fmt::format("dealt out to {} ranks by whole replicas, without messages",
                                communicator_.size()));
    return lines;
}

}  // namespace

std::unique_ptr<OpenMmForce> replicas_of_ranks(std::unique_ptr<Communicator> alone,
                                               std::unique_ptr<OpenMmForce> own,
                                               Communicator const& all) {
    return std::make_unique<ReplicasOfRanks>(std::move(alone), std::move(own), all);
}

}  // namespace catena
