// Implements Catena's steps for benchmarks.
#include "bench/step_makers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cuda/device/gpu.hpp"
#include "error.hpp"

namespace catena::command {
CatenaSteps::CatenaSteps(Scene scene, Communicator const& communicator)
    : scene_(std::move(scene)),
      system_(scene_, Axes::world, communicator),
      stepper_(make_stepper(system_, scene_.dynamics)) {}

void CatenaSteps::advance(StepTimeline* timeline) {
    stepper_->prepare(timeline);
    stepper_->step(n_++, timeline);
}

void CatenaSteps::wait() {
    last_error_ = stepper_->constraint_error();
    error_ = larger(error_, last_error_);
}

void CatenaSteps::step(int count) {
    system_.make_current();
    for (int i = 0; i < count; ++i) advance(nullptr);
    wait();
}

std::vector<StepTimeline> CatenaSteps::timelines(int count) {
    system_.make_current();
    std::vector<StepTimeline> timelines(static_cast<std::size_t>(count));
    for (StepTimeline& timeline : timelines) {
        timeline.step = n_;
        advance(&timeline);
    }
    wait();
    return timelines;
}

void CatenaSteps::adapt() { stepper_->adapt(watch_, last_error_, tolerance()); }

SceneMotion CatenaSteps::observe() {
    system_.make_current();
    stepper_->prepare(nullptr);
    stepper_->observe({});
    return system_.snapshot();
}

double CatenaSteps::energy() {
    system_.make_current();
    stepper_->prepare(nullptr);
    double sum = 0;
    for (EnergyTerm const& term : system_.potential_energy()) sum += term.value;
    return sum;
}

Backend backend_of(BenchRequest const& request) {
    if (!request.backends.empty()) return request.backends.front();
    return cuda::why_not().empty() ? Backend::cuda : Backend::automatic;
}

OwnRun own_run(Scene const& scene, Backend backend) {
    DynamicsSpec const& d = scene.dynamics;
    return {d.step, d.temperature, d.friction, d.seed, uses_gpu(backend) ? 0 : -1};
}

void need_one_rank(Communicator const& communicator, char const* name) {
    if (communicator.size() > 1)
        throw InputError("this benchmark is for one rank", fmt::format("catena bench {}", name),
                         "run it without mpirun");
}

}  // namespace catena::command
