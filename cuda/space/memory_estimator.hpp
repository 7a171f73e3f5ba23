// A Space (dca/host_space.hpp) that only counts the memory that DeviceSpace would allocate. It
// computes nothing.
#pragma once

#include "cuda/space/memory.hpp"
#include "cuda/space/shared_models.hpp"
#include "dca/host_space.hpp"
#include "dca/team_tree.hpp"
#include "tree/stage_encoding.hpp"

namespace catena::cuda {

/// Sums the memory of the objects that this thread makes during the lifetime of a Count. Arrays do
/// not know the space they belong to; the present Count is therefore a thread-local variable.
class Count {
  public:
    Count() : outer_(present()) { present() = this; }
    ~Count() { present() = outer_; }
    Count(Count const&) = delete;
    Count& operator=(Count const&) = delete;
    DeviceMemory const& sum() const { return sum_; }

    /// Adds an allocation to the present Count, if there is one.
    static void add(std::int64_t bytes) {
        if (!present() || bytes == 0) return;
        present()->sum_.bytes += bytes;
        ++present()->sum_.allocations;
    }
    /// Adds columns of numbers; their transfer needs temporary memory of the same size.
    static void add_columns(std::int64_t bytes) {
        add(bytes);
        if (present()) present()->sum_.transient = std::max(present()->sum_.transient, bytes);
    }

  private:
    static Count*& present() {
        static thread_local Count* count = nullptr;
        return count;
    }
    /// The Count that was present before this one.
    Count* outer_;
    DeviceMemory sum_;
};

/// Returns the bytes of columns up to body `end`, padded as in DeviceColumns.
inline std::int64_t bytes_of_columns(std::int64_t end, int columns) {
    return static_cast<std::int64_t>(sizeof(double)) * columns *
           (gpu_order::lanes + gpu_order::padded(end));
}

/// Space with the members of DeviceSpace; arrays have no memory.
class MemoryEstimator : public HostAccess {
  public:
    static constexpr bool answers_at_once = false;

    /// Array of `count` elements; its size is counted and not kept.
    template <class T>
    class Array {
      public:
        Array() = default;
        explicit Array(std::size_t count) {
            Count::add(static_cast<std::int64_t>(count * sizeof(T)));
        }
        T* data() const { return nullptr; }
        std::size_t size() const { return 0; }
    };
    /// Direct exchange between GPUs; there is none.
    struct Direct {
        explicit operator bool() const { return false; }
    };
    Direct connect(dca::Schedule const&, int, int) const { return {}; }
    template <class Numbers, class... Beside>
    void exchange(Direct const&, Numbers const&, Beside const&...) const {}
    template <class Numbers, class AnyTree, class Sweep, class... Beside>
    bool shared_passes(Direct const&, Numbers const&, AnyTree const&, AnyTree const&, Sweep const&,
                       Beside const&...) const {
        return false;
    }
    template <int D>
    void exchange(Communicator const&, BodyExchange<D> const&) const {}
    template <int D, class First>
    void exchange(Communicator const&, BodyExchange<D> const&, First const&) const {}
    /// Host memory, which is not counted.
    template <class T>
    class HostArray {
      public:
        explicit HostArray(std::size_t) {}
        T* data() const { return nullptr; }
    };
    /// Constant array, copied from the host.
    template <class T>
    class List : public Array<T> {
      public:
        explicit List(std::vector<T> const& host) : Array<T>(host.size()) {}
    };
    /// Field of D numbers per body.
    template <int D>
    class FieldOf {
      public:
        FieldOf() = default;
        explicit FieldOf(std::int64_t size) : size_(size) {
            if (size > 0) Count::add_columns(bytes_of_columns(size + 1, D));
        }
        View<D> view() const { return {nullptr, 0, size_}; }
        std::int64_t size() const { return size_; }

      private:
        std::int64_t size_ = 0;
    };
    /// Constant field, as cuda::FixedField.
    template <int D>
    class Fixed : public FieldOf<D> {
      public:
        explicit Fixed(Field<D> const& host) : FieldOf<D>(host.size()) {}
        ConstView<D> view() const { return {}; }
    };
    /// Constant field that stores one tile if bodies are alike, as cuda::AlikeField.
    template <int D>
    class Alike : public FieldOf<D> {
      public:
        explicit Alike(Field<D> const& host)
            : FieldOf<D>(one_tile_serves(host) ? gpu_order::tile : host.size()) {}
        ConstView<D> view() const { return {}; }
    };
    /// Field of a number of directions known at run time.
    class Directions {
      public:
        Directions() = default;
        Directions(std::int64_t size, int directions) {
            if (size > 0) Count::add_columns(bytes_of_columns(size, directions));
        }
        DirectionsView view() const { return {}; }
    };
    class ModelArrays;
    class Model;
    Model model(ChainGroup const& group) const;
    /// Records, as cuda::DeviceRecords.
    template <class T, dca::Order order>
    class Records {
      public:
        explicit Records(std::int64_t count) {
            Count::add(static_cast<std::int64_t>(sizeof(double)) *
                       dca::padded_on_gpu(order, count) * dca::RecordsView<T, order>::numbers);
        }
        dca::RecordsView<T, order> view() { return {}; }
    };
    /// Tree of sweeps, as cuda::DeviceTree.
    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
             std::vector<dca::Root> const& roots, std::int64_t slots,
             std::span<std::uint8_t const> restricted, dca::StageRecords const& records) {
            // Shared memory per block and blocks at once of an H100; plans for other GPUs need
            // about as much.
            constexpr std::int64_t shared_bytes = 227 << 10, at_once = 132;
            dca::StageSizes const sizes = dca::stage_sizes(records, shared_bytes, at_once);
            dca::StagePlan const plan =
                dca::plan_stages(runs, levels, roots, slots, restricted, sizes);
            count(runs);
            dca::StagesTogether const together(plan, sizes);
            for (dca::Stage const& stage : plan.stages) {
                Count::add(static_cast<std::int64_t>(sizeof(dca::StageWord)) * stage.blocks() *
                           dca::layout_of(stage).words());
                count(stage.roots);
                Count::add(static_cast<std::int64_t>(sizeof(double)) *
                           dca::kept_numbers(stage, records));
            }
            if (!together) return;
            // Letters and counters of the launch that performs both passes of the last two stages.
            constexpr std::int64_t of_letter = 16, of_launches = 4;
            Count::add(of_letter * static_cast<std::int64_t>(together.numbers_up(records)));
            Count::add(of_letter * static_cast<std::int64_t>(together.numbers_down(records)));
            Count::add(of_launches * static_cast<std::int64_t>(together.blocks()));
        }
    };
    /// Tree of scans, as cuda::DeviceScan.
    class ScanTree {
      public:
        ScanTree(std::vector<dca::Run> const& runs,
                 std::vector<std::vector<dca::Merge>> const& levels,
                 std::vector<dca::Root> const& roots, std::int64_t slots) {
            count(runs);
            for (dca::ScanStage const& stage :
                 dca::plan_scan(runs, levels, roots, slots, dca::most_of_scan)) {
                count(stage.slot);
                count(stage.merges);
                count(stage.tops);
                count(stage.blocks);
                count(stage.level_end);
            }
        }
    };

    /// Blocks of the largest size. Smaller blocks, which spread few chains over the GPU, need up to
    /// 2 MB more.
    class Blocks {
      public:
        explicit Blocks(ChainGroup const& group) {
            dca::TeamPlan const plan = dca::plan_teams(group.pieces, 64);
            Count::add(static_cast<std::int64_t>(plan.place.size() * sizeof(dca::PartPlace)));
            Count::add(static_cast<std::int64_t>(plan.levels.size() * sizeof(std::int32_t)));
        }
    };
    template <int K>
    static constexpr bool has_blocks = K == 1;
    template <int K>
    static constexpr bool has_teams = has_blocks<K>;
    bool pays_by_blocks(ChainGroup const&) const { return true; }
    // Loops and sweeps do nothing.

    template <class Action>
    void each_block(Blocks const&, Action const&) const {}
    template <class Action>
    void for_each(std::int64_t, Action const&) const {}
    template <class T, class Action>
    void over(List<T> const&, Action const&) const {}
    template <class AnyTree, class Sweep>
    void climb(AnyTree const&, Sweep const&) const {}
    template <class AnyTree, class Sweep>
    void descend(AnyTree const&, Sweep const&) const {}
    template <class AnyTree, class Sweep>
    void climb_and_descend(AnyTree const&, Sweep const&) const {}
    static bool has_threads_to_spare(std::int64_t) { return false; }
    // Queries return zeros or empty fields, and copies do nothing.

    template <class Value>
    double largest(std::int64_t, Value const&) const {
        return 0;
    }
    template <class T>
    T get(T const*) const {
        return {};
    }
    template <class T>
    void put(T*, T const&) const {}
    template <int D>
    Vector<double, D> get(ConstView<D>, std::int64_t) const {
        return Vector<double, D>::zero();
    }
    template <int D>
    void put(View<D>, std::int64_t, Vector<double, D> const&) const {}
    template <int D>
    Field<D> read(FieldOf<D> const&) const {
        return {};
    }
    DirectionsField read(Directions const&) const { return {}; }
    void write(Directions&, DirectionsField const&) const {}
    template <int D, class Edit>
    void edit(FieldOf<D>&, Edit const&) const {}
    template <int D, class Set>
    void set(FieldOf<D>&, Set const&) const {}
    static Executor const& on_host() { return this_thread(); }
    /// Host copy of a field; it needs no GPU memory.
    template <int D>
    struct Mirror {};
    template <int D>
    View<D> pull(FieldOf<D>&, Mirror<D>&) const {
        return {};
    }
    template <int D>
    void push(FieldOf<D>&, Mirror<D> const&) const {}
    template <class Action>
    std::vector<double> time_chained(int, int, bool, Action const&) const {
        return {};
    }
    void wait() const {}
    int threads() const { return 1; }

  private:
    SharedModels<Model, ModelArrays> models_;
    /// Counts the memory of a list.
    template <class T>
    static void count(std::vector<T> const& items) {
        Count::add(static_cast<std::int64_t>(items.size() * sizeof(T)));
    }
};

/// Arrays of a group's model, as cuda::ModelArrays.
class MemoryEstimator::ModelArrays {
  public:
    ModelArrays(ChainGroup const& group, bool with_inertias)
        : is_first_(group.ends.is_first),
          is_last_(group.ends.is_last),
          restricted_(group.joints.restricted),
          jointed_tip_(group.ends.jointed_tip),
          tip_screw_(group.ends.tip_screw),
          inverse_mass_(group.bodies.inverse_mass),
          inverse_inertia_(group.bodies.inverse_inertia),
          r1_(group.bodies.r1),
          r2_(group.bodies.r2),
          axes1_(group.bodies.axes1),
          axes2_(group.bodies.axes2),
          screw_(group.joints.screw),
          mass_(with_inertias ? group.bodies.mass : group.mass_of_sweeps()),
          inertia_(with_inertias ? group.bodies.inertia : group.inertia_of_sweeps()) {}

  private:
    List<std::uint8_t> is_first_, is_last_, restricted_;
    List<std::int32_t> jointed_tip_;
    List<Vector<double, 4>> tip_screw_;
    Alike<1> inverse_mass_;
    Alike<6> inverse_inertia_;
    Alike<3> r1_, r2_;
    Alike<6> axes1_, axes2_;
    Fixed<4> screw_;
    Alike<1> mass_;
    Alike<6> inertia_;
};
/// Handle of a group's model, as cuda::DeviceModel.
class MemoryEstimator::Model {
  public:
    explicit Model(ChainGroup const& group)
        : arrays_(std::make_shared<ModelArrays const>(group, false)) {}
    GroupView view() const { return {}; }
    std::uint8_t const* restricted() const { return nullptr; }
    ConstView<1> mass() const { return {}; }
    ConstView<6> inertia() const { return {}; }

  private:
    friend class SharedModels<Model, ModelArrays>;
    explicit Model(std::shared_ptr<ModelArrays const> arrays) : arrays_(std::move(arrays)) {}
    std::shared_ptr<ModelArrays const> arrays_;
};
inline MemoryEstimator::Model MemoryEstimator::model(ChainGroup const& group) const {
    return models_.model(group);
}

/// Counts the memory of DeviceCrossing.
class CountingCrossing {
    template <int D>
    using FieldOf = MemoryEstimator::FieldOf<D>;

  public:
    CountingCrossing(ChainGroup const& group, MemoryEstimator const&)
        : direction_(group.beads || group.linked ? group.size : 0),
          tip_direction_(group.ends.has_tips() ? group.size : 0),
          rotation_(group.beads ? 0 : group.size),
          moving_r2_(group.joints.moving_meeting() ? group.size : 0),
          moving_axes2_(group.joints.moving_meeting() ? group.size : 0),
          torque_(group.beads ? 0 : group.size),
          force_(group.size),
          omega_(group.beads ? 0 : group.size),
          bias_(group.size + 1, group.directions),
          tip_bias_(group.ends.has_tips() ? group.size : 0, group.directions),
          alpha_(group.beads ? 0 : group.size),
          acceleration_(group.size),
          joint_force_(group.size + 1, group.directions),
          tip_force_(group.ends.has_tips() ? group.size : 0, group.directions) {}
    template <class HostView>
    HostView take(HostView const& host) const {
        return host;
    }
    AccelerationsView wanted(AccelerationsView const& host) const { return host; }
    void fetch(AccelerationsView const&) const {}
    void download(MemoryEstimator::Array<double> const&, std::vector<double>&) const {}
    void upload(std::vector<double> const&, MemoryEstimator::Array<double> const&) const {}

  private:
    FieldOf<3> direction_, tip_direction_;
    FieldOf<4> rotation_;
    FieldOf<3> moving_r2_;
    FieldOf<6> moving_axes2_;
    FieldOf<3> torque_, force_, omega_;
    MemoryEstimator::Directions bias_, tip_bias_;
    FieldOf<3> alpha_, acceleration_;
    MemoryEstimator::Directions joint_force_, tip_force_;
};

}  // namespace catena::cuda
