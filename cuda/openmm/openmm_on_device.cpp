// Module that gives access to OpenMM's CUDA platform; it is compiled into a shared library of its
// own.
#include "cuda/openmm/openmm_on_device.hpp"

#include <OpenMM.h>
#include <cuda.h>
#include <openmm/cuda/CudaContext.h>
#include <openmm/cuda/CudaNonbondedUtilities.h>
#include <openmm/cuda/CudaPlatform.h>

#include <string>
#include <utility>

#include "force/openmm_impl.hpp"

namespace OpenMM {
/// Symbol of OpenMM's library that its headers do not declare. It is weak because another version
/// may lack it.
class CudaKernelSources {
  public:
    __attribute__((weak)) static std::string const nonbonded;
};
}  // namespace OpenMM

namespace catena::cuda {
namespace {

/// Words in the source of OpenMM's pair kernel that share() replaces. Tiles with exclusions are in
/// no list; the first two words are the range of them that a context computes. OpenMM derives that
/// range from the number of contexts in the process. The third word is the distance within which a
/// block of particles may be wrapped about its centre. It does not allow for motion since the
/// blocks' bounds were computed. OpenMM itself computes these bounds whenever it makes or keeps a
/// list; keep_list() skips that.
constexpr char const *first_tile = "FIRST_EXCLUSION_TILE", *last_tile = "LAST_EXCLUSION_TILE",
                     *wrapped = "MAX_CUTOFF";

/// True if this version's kernel has the words that share() replaces.
bool shares_pairs() {
    if (&OpenMM::CudaKernelSources::nonbonded == nullptr) return false;
    std::string const& source = OpenMM::CudaKernelSources::nonbonded;
    auto const has = [&](char const* word) { return source.find(word) != std::string::npos; };
    return has(first_tile) && has(last_tile) && has(wrapped);
}

/// Returns `text` with every `word` replaced by `value`.
std::string with(std::string text, std::string const& word, std::string const& value) {
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += value.size())
        text.replace(at, word.size(), value);
    return text;
}

OpenMM::CudaContext& gpu_of(OpenMM::ContextImpl& context) {
    return *static_cast<OpenMM::CudaPlatform::PlatformData*>(context.getPlatformData())
                ->contexts.at(0);
}

void* address(OpenMM::CudaArray& array) {
    return array.isInitialized() ? reinterpret_cast<void*>(array.getDevicePointer()) : nullptr;
}

/// A stream of its own for some of a Context's work. This one is for versions of OpenMM whose
/// Contexts have one stream only: it stays in use.
template <class Gpu>
struct OwnStream {
    void open(Gpu&) {}
    template <class Action>
    auto use(Gpu&, Action const& action) const {
        return action();
    }
};
template <class Gpu>
    requires requires(Gpu& gpu) { gpu.setCurrentQueue(gpu.createQueue()); }
class OwnStream<Gpu> {
  public:
    void open(Gpu& gpu) { queue_ = gpu.createQueue(); }
    /// Returns what `action` returns, whose work runs in this stream if it is open.
    template <class Action>
    auto use(Gpu& gpu, Action const& action) const {
        if (!queue_) return action();
        /// Restores the default stream, also after an exception.
        struct Use {
            Gpu& gpu;
            ~Use() { gpu.restoreDefaultQueue(); }
        } const restored{gpu};
        gpu.setCurrentQueue(queue_);
        return action();
    }

  private:
    decltype(std::declval<Gpu&>().createQueue()) queue_;
};

/// Access to one Context; see OpenMmOnDevice.
class OnDevice final : public OpenMmOnDevice {
  public:
    explicit OnDevice(OpenMM::Context& context)
        : context_(context), impl_(impl_of(context)), gpu_(gpu_of(impl_)) {
        cuCtxGetCurrent(&before_);
    }
    ~OnDevice() override {
        CUcontext now = nullptr;
        if (cuCtxGetCurrent(&now) == CUDA_SUCCESS && now == gpu_.getContext())
            cuCtxSetCurrent(before_);
    }
    bool make_current() noexcept override {
        return cuCtxSetCurrent(gpu_.getContext()) == CUDA_SUCCESS;
    }
    void take_own_stream() override { own_stream_.open(gpu_); }
    OpenMmArrays arrays() override {
        return {address(gpu_.getPosq()),
                gpu_.getUseMixedPrecision() ? address(gpu_.getPosqCorrection()) : nullptr,
                gpu_.getUseDoublePrecision(),
                address(gpu_.getLongForceBuffer()),
                gpu_.getPaddedNumAtoms(),
                own_stream_.use(gpu_, [this] { return gpu_.getCurrentStream(); })};
    }
    std::vector<int> const& order(std::vector<double> const& positions) override {
        std::vector<OpenMM::Vec3> particles(positions.size() / 3);
        for (std::size_t i = 0; i < particles.size(); ++i)
            particles[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
        gpu_.forceReorder();
        context_.setPositions(particles);  // this also reorders
        return gpu_.getAtomIndex();
    }
    void compute() override {
        own_stream_.use(gpu_, [this] { return impl_.calcForcesAndEnergy(true, false, groups_); });
    }
    void share(int groups, int part, int parts) override {
        groups_ = groups;
        OpenMM::CudaArray& exclusions = pairs().getExclusionTiles();
        auto const tiles =
            exclusions.isInitialized() ? static_cast<std::int64_t>(exclusions.getSize()) : 0;
        std::string const begin = std::to_string(tiles * part / parts),
                          end = std::to_string(tiles * (part + 1) / parts);
        std::string const padded =
            gpu_.doubleToString(pairs().padCutoff(pairs().getMaxCutoffDistance()));
        pairs().setKernelSource(with(
            with(with(OpenMM::CudaKernelSources::nonbonded, first_tile, begin), last_tile, end),
            wrapped, padded));
    }
    void make_list(double begin, double end) override { pairs().setAtomBlockRange(begin, end); }
    /// An empty range of blocks makes OpenMM skip the preparation and compute the pairs of the
    /// present list.
    void keep_list() override { pairs().setAtomBlockRange(0, 0); }
    double list_lasts() override {
        double const reach = pairs().getMaxCutoffDistance();
        return (pairs().padCutoff(reach) - reach) / 2;
    }
    double tiles() override {
        OpenMM::CudaArray& counts = pairs().getInteractionCount();
        if (!counts.isInitialized()) return 0;
        std::vector<unsigned int> found(counts.getSize());
        counts.download(found);
        double constexpr pairs_of_a_tile = 32 * 32;
        return found.at(0) + found.at(1) / pairs_of_a_tile;
    }

  private:
    OpenMM::CudaNonbondedUtilities& pairs() { return gpu_.getNonbondedUtilities(); }

    int groups_ = -1;  // all groups
    OpenMM::Context& context_;
    OpenMM::ContextImpl& impl_;
    OpenMM::CudaContext& gpu_;
    OwnStream<OpenMM::CudaContext> own_stream_;
    CUcontext before_ = nullptr;
};

}  // namespace
}  // namespace catena::cuda

extern "C" __attribute__((visibility("default"))) catena::cuda::OpenMmOnDevice*
catena_openmm_on_device(OpenMM::Context& context) {
    return new catena::cuda::OnDevice(context);
}
extern "C" __attribute__((visibility("default"))) bool catena_openmm_shares_pairs() {
    return catena::cuda::shares_pairs();
}
