// The driver on a device: the lists of the canonical tree (dca/tree.hpp), a kernel a list. All mathematics is in dca/tree_sweeps.hpp.
#pragma once

#include <chrono>

#include "cuda/device_group.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::cuda {

using dca::Merge, dca::Root, dca::Run, dca::TopCopy;

__device__ inline std::int64_t thread() { return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; }

template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}

template <class Sweeps, class Item>
struct AssembleMatrices {
    Sweeps sweeps;
    __device__ void operator()(Item const& item) const { sweeps.assemble_matrices(item); }
};
template <class Sweeps>
struct CloseMatrices {
    Sweeps sweeps;
    __device__ void operator()(Root const& root) const { sweeps.close_matrices(root); }
};
template <class Sweeps, class Item>
struct AssembleBiases {
    Sweeps sweeps;
    LoadsView loads;
    __device__ void operator()(Item const& item) const { sweeps.assemble_biases(loads, item); }
};
template <class Sweeps>
struct CloseBiases {
    Sweeps sweeps;
    __device__ void operator()(Root const& root) const { sweeps.close_biases(root); }
};
template <class Sweeps>
struct DisassembleMerge {
    Sweeps sweeps;
    __device__ void operator()(Merge const& merge) const { sweeps.disassemble_forces(merge); }
};
template <class Sweeps>
struct DisassembleRun {
    Sweeps sweeps;
    LoadsView loads;
    AccelerationsView out;
    __device__ void operator()(Run const& run) const { sweeps.disassemble_forces(loads, out, run); }
};
template <class Directions>
struct CopyForce {
    Directions* forces;
    __device__ void operator()(TopCopy const& copy) const { forces[copy.to] = forces[copy.from]; }
};

/// The first joint whose matrix is not positive definite.
template <class Sweeps>
__global__ void find_indefinite(Sweeps sweeps, std::int64_t joints, std::int64_t halo, std::int64_t none, unsigned long long* first) {
    std::int64_t const k = thread();
    if (k >= joints || k == halo || k == none) return;
    for (int i = 0; i < sweeps.restricted[k]; ++i)
        if (double const p = sweeps.joints[k].factor(i, i); !(p > 0) || isinf(p)) atomicMin(first, static_cast<unsigned long long>(k));
}

/// Uploads configuration and loads, downloads accelerations and joint forces.
template <class Leaf>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Sweeps = dca::TreeSweeps<Leaf>;

  public:
    TreeSolver(ChainGroup const& group, Communicator const& communicator)
        : host_(group),
          communicator_(communicator),
          group_(group),
          runs_(group.schedule.runs),
          roots_(group.schedule.roots),
          top_roots_(group.schedule.top_roots),
          top_copies_(group.schedule.top_copies),
          levels_(buffers_of(group.schedule.levels)),
          top_levels_(buffers_of(group.schedule.top_levels)),
          matrices_(static_cast<std::size_t>(group.schedule.slots)),
          biases_(matrices_.size()),
          joints_(static_cast<std::size_t>(group.schedule.joints)),
          offsets_(joints_.size()),
          forces_(joints_.size()),
          indefinite_(1),
          direction_(group.beads || group.linked ? group.size : 0),
          tip_direction_(group.has_tips() ? group.size : 0),
          rotation_(group.beads ? 0 : group.size),
          moving_r2_(group.moving_meeting() ? group.size : 0),
          moving_axes2_(group.moving_meeting() ? group.size : 0),
          torque_(group.beads ? 0 : group.size),
          force_(group.size),
          omega_(group.beads ? 0 : group.size),
          bias_(group.size + 1),
          tip_bias_(group.has_tips() ? group.size : 0),
          alpha_(group.beads ? 0 : group.size),
          acceleration_(group.size),
          joint_force_(group.size + 1),
          tip_force_(group.has_tips() ? group.size : 0),
          sweeps_{Leaf(group_.view()), group_.restricted(), matrices_.data(), biases_.data(),
                  joints_.data(),      offsets_.data(),     forces_.data()} {
        check(cudaDeviceSynchronize(), "take the model");  // which went up on another stream
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        auto const start = now();
        sweeps_.leaf.set({up(configuration.direction, direction_), up(configuration.rotation, rotation_),
                          up(configuration.tip_direction, tip_direction_), up(configuration.r2, moving_r2_),
                          up(configuration.axes2, moving_axes2_)});
        each(runs_, AssembleMatrices<Sweeps, Run>{sweeps_});
        for (auto const& level : levels_) each(level, AssembleMatrices<Sweeps, Merge>{sweeps_});
        if (!host_.schedule.shared.empty()) gather_shared(matrices_);
        for (auto const& level : top_levels_) each(level, AssembleMatrices<Sweeps, Merge>{sweeps_});
        each(roots_, CloseMatrices<Sweeps>{sweeps_});
        each(top_roots_, CloseMatrices<Sweeps>{sweeps_});
        check_definite();
        ++report_.matrix_sweeps;
        report_.matrix_seconds += now() - start;
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        LoadsView const given{up(loads.torque, torque_), up(loads.force, force_), up(loads.omega, omega_), up(loads.bias, bias_, 1),
                              up(loads.tip_bias, tip_bias_, 0)};
        AccelerationsView const found{wanted(out.alpha, alpha_), wanted(out.acceleration, acceleration_),
                                      wanted(out.joint_force, joint_force_), wanted(out.tip_force, tip_force_)};
        each(runs_, AssembleBiases<Sweeps, Run>{sweeps_, given});
        for (auto const& level : levels_) each(level, AssembleBiases<Sweeps, Merge>{sweeps_, given});
        if (!host_.schedule.shared.empty()) gather_shared(biases_);
        for (auto const& level : top_levels_) each(level, AssembleBiases<Sweeps, Merge>{sweeps_, given});
        each(roots_, CloseBiases<Sweeps>{sweeps_});
        each(top_roots_, CloseBiases<Sweeps>{sweeps_});
        for (std::size_t l = top_levels_.size(); l-- > 0;) each(top_levels_[l], DisassembleMerge<Sweeps>{sweeps_});
        each(top_copies_, CopyForce<Vector<double, K>>{forces_.data()});
        for (std::size_t l = levels_.size(); l-- > 0;) each(levels_[l], DisassembleMerge<Sweeps>{sweeps_});
        each(runs_, DisassembleRun<Sweeps>{sweeps_, given, found});
        if (out.alpha.origin) alpha_.download(out.alpha, stream_.get());
        if (out.acceleration.origin) acceleration_.download(out.acceleration, stream_.get());
        Vector<double, K> after = Vector<double, K>::zero();  // the joint after this rank's last body
        if (out.joint_force) {
            down(out.joint_force, joint_force_);
            check(cudaMemcpyAsync(&after, forces_.data() + host_.schedule.halo, sizeof(after), cudaMemcpyDeviceToHost, stream_.get()),
                  "give back a force");
        }
        if (out.tip_force) down(out.tip_force, tip_force_);
        stream_.wait();
        if (out.joint_force) out.joint_force.template store<K>(host_.schedule.bodies, after);
        ++report_.bias_sweeps;
        report_.bias_seconds += now() - start;
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(host_, communicator_, r);
        r.memory_bytes = Sweeps::bytes(host_.schedule);
        return r;
    }

  private:
    static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
    static std::vector<Buffer<Merge>> buffers_of(std::vector<std::vector<Merge>> const& levels) {
        std::vector<Buffer<Merge>> buffers;
        for (auto const& level : levels) buffers.emplace_back(level);
        return buffers;
    }
    template <class Item, class Action>
    void each(Buffer<Item> const& items, Action const& action) const {
        if (items.size() == 0) return;
        unsigned const threads = 128, blocks = static_cast<unsigned>((items.size() + threads - 1) / threads);
        over<<<blocks, threads, 0, stream_.get()>>>(items.data(), static_cast<std::int64_t>(items.size()), action);
        check(cudaGetLastError(), "start a sweep");
    }

    template <int D>
    ConstView<D> up(ConstView<D> const& host, DeviceField<D> const& device) const {
        if (!host.origin) return {};
        device.upload(host, stream_.get());
        return device.view();
    }
    /// `more`: joints after the last body.
    ConstDirectionsView up(ConstDirectionsView const& host, DeviceField<K> const& device, std::int64_t more) const {
        if (!host || host_.size == 0) return {};
        View<K> const to = device.view();
        check(cudaMemcpy2DAsync(to.origin, static_cast<std::size_t>(to.pitch) * sizeof(double), host.origin,
                                static_cast<std::size_t>(host.pitch) * sizeof(double),
                                static_cast<std::size_t>(host_.size + more) * sizeof(double), K, cudaMemcpyHostToDevice, stream_.get()),
              "take the biases");
        return {to.origin, to.pitch};
    }
    void down(DirectionsView const& host, DeviceField<K> const& device) const {
        if (host_.size == 0) return;
        View<K> const from = device.view();
        check(cudaMemcpy2DAsync(host.origin, static_cast<std::size_t>(host.pitch) * sizeof(double), from.origin,
                                static_cast<std::size_t>(from.pitch) * sizeof(double),
                                static_cast<std::size_t>(host_.size) * sizeof(double), K, cudaMemcpyDeviceToHost, stream_.get()),
              "give back the forces");
    }
    template <int D>
    static View<D> wanted(View<D> const& host, DeviceField<D> const& device) {
        return host.origin ? device.view() : View<D>{};
    }
    static DirectionsView wanted(DirectionsView const& host, DeviceField<K> const& device) {
        return host ? DirectionsView{device.view().origin, device.view().pitch} : DirectionsView{};
    }

    void check_definite() {
        unsigned long long const none = ~0ULL;
        unsigned long long first = none;
        check(cudaMemcpyAsync(indefinite_.data(), &none, sizeof(none), cudaMemcpyHostToDevice, stream_.get()), "look at the pivots");
        unsigned const threads = 128, blocks = static_cast<unsigned>((joints_.size() + threads - 1) / threads);
        find_indefinite<<<blocks, threads, 0, stream_.get()>>>(sweeps_, static_cast<std::int64_t>(joints_.size()), host_.schedule.halo,
                                                               host_.schedule.none, indefinite_.data());
        check(cudaMemcpyAsync(&first, indefinite_.data(), sizeof(first), cudaMemcpyDeviceToHost, stream_.get()), "look at the pivots");
        stream_.wait();
        if (first != none) refuse_indefinite(host_, communicator_.rank(), static_cast<std::int64_t>(first));
    }

    /// One collective: the units of chains that several ranks share, to all ranks.
    template <class Segment>
    void gather_shared(Buffer<Segment> const& segments) {
        auto const start = now();
        std::vector<Segment> own;
        std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator_.size()), 0);
        for (dca::SharedUnit const& unit : host_.schedule.shared) {
            bytes[unit.owner] += sizeof(Segment);
            if (unit.source < 0) continue;
            own.emplace_back();
            check(cudaMemcpyAsync(&own.back(), segments.data() + unit.source, sizeof(Segment), cudaMemcpyDeviceToHost, stream_.get()),
                  "give back a segment");
            stream_.wait();
        }
        std::vector<Segment> all(host_.schedule.shared.size());
        communicator_.all_gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)), bytes);
        for (std::size_t i = 0; i < all.size(); ++i)
            check(cudaMemcpyAsync(segments.data() + host_.schedule.shared[i].slot, &all[i], sizeof(Segment), cudaMemcpyHostToDevice,
                                  stream_.get()),
                  "take a segment");
        stream_.wait();
        report_.exchange_seconds += now() - start;
    }

    ChainGroup const& host_;
    Communicator const& communicator_;
    Stream stream_;
    DeviceGroup group_;
    Buffer<Run> runs_;
    Buffer<Root> roots_, top_roots_;
    Buffer<TopCopy> top_copies_;
    std::vector<Buffer<Merge>> levels_, top_levels_;
    Buffer<typename Sweeps::Matrices> matrices_;
    Buffer<typename Sweeps::Biases> biases_;
    Buffer<typename Sweeps::Joint> joints_;
    Buffer<Vector<double, K>> offsets_, forces_;
    Buffer<unsigned long long> indefinite_;
    DeviceField<3> direction_, tip_direction_;
    DeviceField<4> rotation_;
    DeviceField<3> moving_r2_;
    DeviceField<9> moving_axes2_;
    DeviceField<3> torque_, force_, omega_;
    DeviceField<K> bias_, tip_bias_;
    DeviceField<3> alpha_, acceleration_;
    DeviceField<K> joint_force_, tip_force_;
    Sweeps sweeps_;
    SolverReport report_;
};

}  // namespace catena::cuda
