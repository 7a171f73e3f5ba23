// Implements the sums of counted and predicted messages.
#include "run/message_count.hpp"

#include <nlohmann/json.hpp>

namespace catena {
namespace {

/// Averages of messages per step.
nlohmann::json per_step(Traffic const& sum, std::int64_t steps) {
    nlohmann::json found;
    sum.for_each([&](char const* name, std::int64_t count) {
        found[name] = static_cast<double>(count) / static_cast<double>(steps);
    });
    return found;
}

}  // namespace

MessageCount::MessageCount(Scene const& scene, Communicator const& communicator,
                           ChainSystem const& system)
    : communicator_(communicator), system_(system) {
    for (auto const& group : system.groups()) messages_.emplace_back(*group, scene);
}

Traffic MessageCount::so_far() const { return communicator_.traffic() - system_.openmm_traffic(); }

void MessageCount::add(Traffic const& of_step, Stepper const& stepper) {
    ++steps_;
    counted_ += of_step;
    for (std::size_t i = 0; i < messages_.size(); ++i)
        predicted_ += messages_[i].a_step(stepper.sweeps(),
                                          cut_of(*system_.groups()[i], communicator_.gather_way()),
                                          stepper.parts(), stepper.solved());
}

nlohmann::json MessageCount::json() const {
    std::int64_t const differ = communicator_.sum(counted_ == predicted_ ? 0 : 1);
    if (steps_ == 0) return nullptr;
    return {{"counted", per_step(counted_, steps_)},
            {"predicted", per_step(predicted_, steps_)},
            {"ranks_that_differ", differ}};
}

}  // namespace catena
