// Implements the coupling with OpenMM that is common to all ranks, and the one for a single rank.
#include "cuda/openmm/gpu_path.hpp"

#include <cmath>
#include <utility>

#include "clock.hpp"
#include "error.hpp"

namespace catena::cuda {

Vec3 mean(std::span<Vec3 const> x) {
    Vec3 sum = Vec3::zero();
    for (Vec3 const& each : x) sum = sum + each;
    return (1.0 / static_cast<double>(x.size())) * sum;
}

namespace {

/// Coupling for a run with a single rank.
class SingleRankPath final : public GpuPath {
  public:
    SingleRankPath(OpenMM::Context& context, DevicePathPlan plan)
        : GpuPath(context, std::move(plan), OrderAge::unchecked) {
        compute_with(on_device(context));
        list_ = std::make_unique<PairList>(
            *openmm_, plan_.keeps_list && why_pairs_cannot_be_shared().empty());
    }
    // The members' memory belongs to OpenMM's CUDA context.
    ~SingleRankPath() override { make_current(); }

    void begin(std::span<DeviceBeads* const> beads, bool timed) override {
        // concerns the previous evaluation, which has ended together with its step
        refuse_trouble();
        if (take_strayed() || age_.begins()) order_anew(beads);
        start(beads, timed);
        put_own(beads);
        put_layers();
        computes_later_ = list_->is_kept() && plan_.overlap;
        if (!computes_later_) choose_list_and_compute(beads);
        if (timed) events_->chains_begin.record(stream_of(*beads.front()));
    }
    void go_on(std::span<DeviceBeads* const> beads) override {
        if (timed_) events_->chains_end.record(stream_of(*beads.back()));
        if (computes_later_) choose_list_and_compute(beads);
    }
    void refuse_trouble() override {
        std::int64_t const bead = take_trouble();
        if (bead >= 0)
            throw ComputationError("the position of bead " + std::to_string(bead + 1) +
                                   ", or OpenMM's force on it, is not finite: use a smaller "
                                   "dynamics.step, or a start without overlaps");
    }

  private:
    /// The host reads if particles have moved far while the chains continue.
    void choose_list_and_compute(std::span<DeviceBeads* const> beads) {
        is_anew_ = false;
        if (list_->is_kept()) {
            placed_.record(stream_);
            exchange_.begin = seconds_now();
            placed_.wait();
            exchange_.end = seconds_now();
            // The GPU may have lagged: its clock is matched to the host's at a point that both have
            // reached.
            if (timed_) begun_ = exchange_.end - placed_.seconds_since(events_->begun);
            bool const far = std::exchange(flags_->data()->far, 0) != 0;
            is_anew_ = list_->choose(far || age_.begins());
            note_list(is_anew_, openmm_->list_lasts());
        }
        compute(beads);
        if (list_->is_kept()) age_.set_most(OrderAge::checked);
    }

    /// OpenMM returns only when a new list is complete. Layers then begin to compute before.
    void compute_contexts() override {
        bool const new_order = age_.begins();
        if (!is_anew_) openmm_->compute();
        for (auto const& layer : layers_) layer->choose_list_and_compute(new_order);
        if (is_anew_) openmm_->compute();
        list_->note_evaluation();
    }

    void order_anew(std::span<DeviceBeads* const> beads) {
        beads_.assign(beads.begin(), beads.end());
        std::vector<Vec3> const x = positions();
        look_for_trouble(x);
        refuse_trouble();
        order(x, {}, mean(x));
    }

    std::unique_ptr<PairList> list_;
    bool is_anew_ = false, computes_later_ = false;
    Event placed_{Event::For::clock};
};

}  // namespace

GpuPath::GpuPath(OpenMM::Context& home, DevicePathPlan plan, int evaluations)
    : plan_(std::move(plan)), home_(on_device(home)), age_(evaluations) {
    // Memory, events and arrays that OpenMM's CUDA context owns are allocated while it is current.
    if (!home_->make_current())
        throw ComputationError("OpenMM's CUDA context cannot be made current");
    flags_ = std::make_unique<PinnedBuffer<Flags>>(1);
    *flags_->data() = Flags{};
    events_ = std::make_unique<Events>();
    own_ = std::make_unique<Buffer<DeviceBead>>(plan_.particle.size());
    particles_.trouble = &flags_->data()->trouble;
    particles_.bead = own_->data();
    if (plan_.box) particles_.box = *plan_.box;
    if (!plan_.replica.empty()) {
        replicas_ = ReplicaPlaces(plan_.replica, plan_.reach);
        centres_ = std::make_unique<Buffer<double>>(3 * plan_.replica.size());
        particles_.centre = centres_->data();
        particles_.strayed = &flags_->data()->strayed;
    }
    for (DeviceLayer& layer : plan_.layers)
        layers_.push_back(std::make_unique<GpuLayer>(std::move(layer)));
}

// The members' memory belongs to OpenMM's CUDA context.
GpuPath::~GpuPath() { home_->make_current(); }

void GpuPath::compute_with(std::unique_ptr<OpenMmOnDevice> openmm) {
    openmm_ = std::move(openmm);
    stream_ = openmm_ ? static_cast<cudaStream_t>(openmm_->arrays().stream) : nullptr;
}

void GpuPath::start(std::span<DeviceBeads* const> beads, bool timed) {
    beads_.assign(beads.begin(), beads.end());
    timed_ = timed;
    begun_ = seconds_now();
    if (timed) events_->begun.record(stream_of(*beads.front()));
}

std::int64_t GpuPath::take_trouble() {
    std::int64_t const own = std::exchange(flags_->data()->trouble, -1);
    return own < 0 ? own : plan_.bead[static_cast<std::size_t>(own)];
}

void GpuPath::look_for_trouble(std::span<Vec3 const> x) {
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!std::isfinite(norm(x[i]))) flags_->data()->trouble = static_cast<std::int64_t>(i);
}

std::vector<OpenMmOnDevice*> GpuPath::contexts() const {
    std::vector<OpenMmOnDevice*> all{openmm_.get()};
    for (auto const& layer : layers_) all.push_back(&layer->openmm());
    return all;
}

std::vector<Vec3> GpuPath::positions() {
    if (beads_.empty())
        throw ComputationError("positions on the GPU were requested before the first evaluation");
    std::vector<Vec3> x;
    x.reserve(plan_.particle.size());
    for (DeviceBeads* group : beads_) {
        ConstView<3> const here = group->host_positions();
        for (std::int64_t k = 0; k < here.size; ++k) x.push_back(here.load(k));
    }
    return x;
}

void GpuPath::place_replicas(std::vector<Vec3> const& x) {
    replicas_.find(x);
    std::vector<double> centres;
    centres.reserve(3 * x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        for (double const c : replicas_.centre(i).data) centres.push_back(c);
    upload(*centres_, centres.data(), centres.size(), stream_);
    check(cudaStreamSynchronize(stream_), "receive the places of replicas");
    double const spacing = replicas_.spacing();
    particles_.box = {{spacing, spacing, spacing}};
    particles_.farthest = replicas_.farthest();
}

DeviceBead GpuPath::bead_of_replica(std::size_t i) const {
    DeviceBead bead;
    bead.place = place_[static_cast<std::size_t>(plan_.particle[i])];
    for (int c = 0; c < 3; ++c) bead.cell[c] = -replicas_.site(i)[c];
    return bead;
}

void GpuPath::order(std::vector<Vec3> const& x, std::span<Others const> others,
                    Vec3 const& middle) {
    particles_.origin = plan_.shifted ? middle : Vec3::zero();
    std::size_t particles = x.size();
    for (Others const& more : others) particles += more.particle.size();
    std::vector<double> of_particle(3 * particles);
    auto const set = [&](std::span<int const> particle, std::span<Vec3 const> position) {
        for (std::size_t i = 0; i < particle.size(); ++i)
            for (int c = 0; c < 3; ++c)
                of_particle[3 * static_cast<std::size_t>(particle[i]) +
                            static_cast<std::size_t>(c)] = (position[i] - particles_.origin)[c];
    };
    if (replicas_.empty()) {
        set(plan_.particle, x);
    } else {
        place_replicas(x);
        std::vector<Vec3> placed(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) placed[i] = x[i] - replicas_.shift(i);
        particles_.origin = Vec3::zero();
        set(plan_.particle, placed);
    }
    for (Others const& more : others) set(more.particle, more.position);
    std::vector<int> const& particle_at = openmm_->order(of_particle);
    place_.resize(particles);
    for (std::size_t i = 0; i < particles; ++i)
        place_[static_cast<std::size_t>(particle_at[i])] = static_cast<std::int32_t>(i);
    for (auto const& layer : layers_) layer->order(of_particle, place_);
    std::vector<DeviceBead> beads(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        beads[i] = replicas_.empty() ? bead_of(plan_.particle[i], x[i]) : bead_of_replica(i);
    upload(*own_, beads.data(), beads.size(), stream_);
    check(cudaStreamSynchronize(stream_), "receive OpenMM's order");
    for (DeviceBeads* group : beads_)
        check(cudaStreamSynchronize(stream_of(*group)), "finish its work");
    OpenMmArrays const arrays = openmm_->arrays();
    ++particles_.order;
    particles_.double_position =
        arrays.double_precision ? static_cast<double*>(arrays.position) : nullptr;
    particles_.position = arrays.double_precision ? nullptr : static_cast<float*>(arrays.position);
    particles_.correction = static_cast<float*>(arrays.correction);
    particles_.force = static_cast<std::int64_t*>(arrays.force);
    particles_.places = arrays.places;
    particles_.listed = nullptr;
    particles_.double_listed = nullptr;
    particles_.far = nullptr;
    age_.begin();
}

void GpuPath::note_list(bool anew, double lasts) {
    ++(anew ? pair_lists_.made : pair_lists_.kept);
    if (!anew) return;
    age_.note_list(lasts);
    listed_.take(openmm_->arrays(), stream_);
    if (particles_.double_position)
        particles_.double_listed = static_cast<double const*>(listed_.data());
    else
        particles_.listed = static_cast<float const*>(listed_.data());
    particles_.farthest_squared = static_cast<float>(lasts) * static_cast<float>(lasts);
    particles_.far = &flags_->data()->far;
}

std::vector<DevicePath::PairLists> GpuPath::pair_lists_of_layers() const {
    std::vector<PairLists> lists;
    for (auto const& layer : layers_) lists.push_back(layer->pair_lists());
    return lists;
}

void GpuPath::put_own(std::span<DeviceBeads* const> beads) {
    std::int64_t next = 0;
    for (DeviceBeads* group : beads) {
        group->put_positions(particles_.from(next));
        events_->positions.record(stream_of(*group));
        events_->positions.hold(stream_);
        next += group->count();
    }
}

void GpuPath::put_layers() {
    if (layers_.empty()) return;
    events_->all_positions.record(stream_);
    for (auto const& layer : layers_) layer->put(particles_, events_->all_positions);
}

void GpuPath::compute(std::span<DeviceBeads* const> beads) {
    if (timed_) events_->openmm_begin.record(stream_);
    compute_contexts();
    for (auto const& layer : layers_) layer->add_to(particles_, stream_);
    complete_forces();
    if (timed_) events_->openmm_end.record(stream_);
    events_->forces.record(stream_);
    for (DeviceBeads* group : beads)
        if (!plan_.overlap) events_->forces.hold(stream_of(*group));
    age_.note_evaluation();
}

void GpuPath::finish(std::span<DeviceBeads* const> beads) {
    std::int64_t next = 0;
    for (DeviceBeads* group : beads) {
        events_->forces.hold(stream_of(*group));
        group->add_forces(particles_.from(next));
        next += group->count();
    }
}

DevicePath::Clock GpuPath::clock() {
    events_->openmm_end.wait();
    events_->chains_end.wait();
    return {{at(events_->openmm_begin), at(events_->openmm_end)},
            {at(events_->chains_begin), at(events_->chains_end)},
            exchange_};
}

std::unique_ptr<DevicePath> make_device_path(OpenMM::Context& context, DevicePathPlan plan) {
    if (plan.halo) return make_halo_path(context, std::move(plan));
    return std::make_unique<SingleRankPath>(context, std::move(plan));
}

}  // namespace catena::cuda
