#include "force/device_path.hpp"

#include <dlfcn.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "cuda/openmm_on_device.hpp"
#include "cuda/owners.hpp"
#include "cuda/solver.hpp"

namespace catena::cuda {
namespace {

namespace fs = std::filesystem;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Beside the program or library that holds this function and where both are installed together, where the build is to be installed, and
/// where it leaves the module.
std::vector<fs::path> module_folders() {
    std::vector<fs::path> folders;
    Dl_info here{};
    if (dladdr(reinterpret_cast<void const*>(&why_no_device_path), &here) != 0 && here.dli_fname != nullptr) {
        std::error_code ignored;
        fs::path const folder = fs::weakly_canonical(here.dli_fname, ignored).parent_path();
        folders = {folder, folder.parent_path() / CATENA_LIBRARY_FOLDER};
    }
    for (char const* const folder : {CATENA_MODULE_FOLDERS}) folders.emplace_back(folder);
    return folders;
}

struct Module {
    ModuleEntry entry = nullptr;
    std::string why_not;
};

Module load() {
    if (!why_not().empty()) return {nullptr, why_not()};
    for (fs::path const& folder : module_folders()) {
        std::error_code ignored;
        if (!fs::exists(folder / module_file, ignored)) continue;
        void* const library = dlopen((folder / module_file).c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const entry = library ? dlsym(library, module_entry) : nullptr;
        if (entry) return {reinterpret_cast<ModuleEntry>(entry), ""};
        char const* const reason = dlerror();
        return {nullptr, reason ? reason : std::string(module_file) + " has no entry"};
    }
    return {nullptr, std::string(module_file) + " is not there: this build found no headers of OpenMM's CUDA platform"};
}

Module const& module() {
    static Module const loaded = load();
    return loaded;
}

class CudaDevicePath final : public DevicePath {
  public:
    CudaDevicePath(OpenMM::Context& context, DevicePathPlan plan) : plan_(std::move(plan)), openmm_(module().entry(context)) {
        // What lives in OpenMM's context is made there.
        if (!openmm_->make_current()) throw ComputationError("OpenMM's CUDA context cannot be made current");
        stream_ = static_cast<cudaStream_t>(openmm_->arrays().stream);
        own_ = std::make_unique<Own>(plan_.particle.size());
        particles_.trouble = own_->trouble.data();
    }

    ~CudaDevicePath() override { openmm_->make_current(); }  // what it owns lives there

    bool make_current() noexcept override { return openmm_->make_current(); }

    void begin(std::span<DeviceBeads* const> beads, bool timed) override {
        refuse_trouble();  // of the evaluation before, which is over where its step is
        timed_ = timed;
        if (of_this_order_ == 0) order(beads);
        of_this_order_ = (of_this_order_ + 1) % evaluations_of_an_order;
        begun_ = now();
        cudaStream_t const first = stream_of(*beads.front());
        if (timed) own_->begun.record(first);
        put(beads);
        if (timed) own_->openmm_begin.record(stream_);
        openmm_->compute();
        if (timed) own_->openmm_end.record(stream_);
        own_->forces.record(stream_);
        for (DeviceBeads* group : beads)
            if (!plan_.overlap) own_->forces.hold(stream_of(*group));
        if (timed) own_->chains_begin.record(first);
    }

    void mark(std::span<DeviceBeads* const> beads) override {
        if (timed_) own_->chains_end.record(stream_of(*beads.back()));
    }

    void finish(std::span<DeviceBeads* const> beads) override {
        std::int64_t next = 0;
        for (DeviceBeads* group : beads) {
            own_->forces.hold(stream_of(*group));
            group->add_forces(particles_.from(next));
            next += group->count();
        }
    }

    void refuse_trouble() override {
        std::int64_t const bead = std::exchange(*own_->trouble.data(), -1);
        if (bead >= 0)
            throw ComputationError("the position of bead " + std::to_string(bead + 1) +
                                   ", or OpenMM's force on it, is not finite: take a smaller step, or a start without overlaps");
    }

    Clock clock() override {
        own_->openmm_end.wait();
        own_->chains_end.wait();
        auto const at = [&](Event const& event) { return begun_ + event.seconds_since(own_->begun); };
        return {{at(own_->openmm_begin), at(own_->openmm_end)}, {at(own_->chains_begin), at(own_->chains_end)}};
    }

  private:
    /// OpenMM's own integrators leave their particles in one order as long.
    static constexpr int evaluations_of_an_order = 250;

    struct Own {
        explicit Own(std::size_t count) : beads(count), bead(count) { *trouble.data() = -1; }
        PinnedBuffer<DeviceBead> beads;
        Buffer<DeviceBead> bead;
        PinnedBuffer<std::int64_t> trouble{1};
        Event begun{Event::For::clock}, chains_begin{Event::For::clock}, chains_end{Event::For::clock}, openmm_begin{Event::For::clock},
            openmm_end{Event::For::clock};
        Event positions{Event::For::order}, forces{Event::For::order};
    };

    static cudaStream_t stream_of(DeviceBeads const& group) { return static_cast<cudaStream_t>(group.stream()); }

    /// OpenMM waits for the positions; it has read those before: the streams waited for its forces.
    void put(std::span<DeviceBeads* const> beads) {
        std::int64_t next = 0;
        for (DeviceBeads* group : beads) {
            group->put_positions(particles_.from(next));
            own_->positions.record(stream_of(*group));
            own_->positions.hold(stream_);
            next += group->count();
        }
    }

    void order(std::span<DeviceBeads* const> beads) {
        std::vector<Vec3> x;
        for (DeviceBeads* group : beads) {
            ConstView<3> const positions = group->host_positions();
            for (std::int64_t k = 0; k < positions.size; ++k) x.push_back(positions.load(k));
        }
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!std::isfinite(norm(x[i]))) *own_->trouble.data() = static_cast<std::int64_t>(i);
        refuse_trouble();
        particles_.origin = plan_.shifted ? mean(x) : Vec3::zero();
        std::vector<double> of_particle(3 * x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            for (int c = 0; c < 3; ++c) of_particle[3 * static_cast<std::size_t>(plan_.particle[i]) + c] = (x[i] - particles_.origin)[c];
        std::vector<int> const& particle_at = openmm_->order(of_particle);
        std::vector<std::int32_t> place(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) place[static_cast<std::size_t>(particle_at[i])] = static_cast<std::int32_t>(i);
        for (std::size_t i = 0; i < x.size(); ++i) {
            DeviceBead& bead = own_->beads.data()[i];
            bead.place = place[static_cast<std::size_t>(plan_.particle[i])];
            for (int c = 0; plan_.box && c < 3; ++c) bead.cell[c] = static_cast<std::int32_t>(std::floor(x[i][c] / (*plan_.box)[c]));
        }
        upload(beads);
    }

    void upload(std::span<DeviceBeads* const> beads) {
        check(cudaMemcpyAsync(own_->bead.data(), own_->beads.data(), x_bytes(), cudaMemcpyHostToDevice, stream_), "take OpenMM's order");
        check(cudaStreamSynchronize(stream_), "take OpenMM's order");
        for (DeviceBeads* group : beads) check(cudaStreamSynchronize(stream_of(*group)), "finish its work");
        OpenMmArrays const arrays = openmm_->arrays();
        particles_.bead = own_->bead.data();
        ++particles_.order;
        particles_.double_position = arrays.double_precision ? static_cast<double*>(arrays.position) : nullptr;
        particles_.position = arrays.double_precision ? nullptr : static_cast<float*>(arrays.position);
        particles_.correction = static_cast<float*>(arrays.correction);
        particles_.force = static_cast<std::int64_t const*>(arrays.force);
        particles_.places = arrays.places;
        if (plan_.box) particles_.box = *plan_.box;
    }

    std::size_t x_bytes() const { return plan_.particle.size() * sizeof(DeviceBead); }

    static Vec3 mean(std::vector<Vec3> const& x) {
        Vec3 sum = Vec3::zero();
        for (Vec3 const& each : x) sum = sum + each;
        return (1.0 / static_cast<double>(x.size())) * sum;
    }

    DevicePathPlan plan_;
    std::unique_ptr<OpenMmOnDevice> openmm_;
    cudaStream_t stream_ = nullptr;
    std::unique_ptr<Own> own_;
    DeviceParticles particles_;
    int of_this_order_ = 0;  // evaluations
    bool timed_ = false;
    double begun_ = 0;
};

}  // namespace

std::string const& why_no_device_path() { return module().why_not; }

int chosen_device() {
    int device = 0;
    check(cudaGetDevice(&device), "say which it is");
    return device;
}

std::unique_ptr<DevicePath> make_device_path(OpenMM::Context& context, DevicePathPlan plan) {
    return std::make_unique<CudaDevicePath>(context, std::move(plan));
}

}  // namespace catena::cuda
