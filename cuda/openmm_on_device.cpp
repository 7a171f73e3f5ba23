#include "cuda/openmm_on_device.hpp"

#include <OpenMM.h>
#include <cuda.h>
#include <openmm/cuda/CudaContext.h>
#include <openmm/cuda/CudaPlatform.h>

#include "force/openmm_impl.hpp"

namespace catena::cuda {
namespace {

OpenMM::CudaContext& gpu_of(OpenMM::ContextImpl& context) {
    return *static_cast<OpenMM::CudaPlatform::PlatformData*>(context.getPlatformData())->contexts.at(0);
}

void* address(OpenMM::CudaArray& array) { return array.isInitialized() ? reinterpret_cast<void*>(array.getDevicePointer()) : nullptr; }

class OnDevice final : public OpenMmOnDevice {
  public:
    explicit OnDevice(OpenMM::Context& context) : context_(context), impl_(impl_of(context)), gpu_(gpu_of(impl_)) {
        cuCtxGetCurrent(&before_);
    }
    ~OnDevice() override {
        CUcontext now = nullptr;
        if (cuCtxGetCurrent(&now) == CUDA_SUCCESS && now == gpu_.getContext()) cuCtxSetCurrent(before_);
    }
    bool make_current() noexcept override { return cuCtxSetCurrent(gpu_.getContext()) == CUDA_SUCCESS; }
    OpenMmArrays arrays() override {
        return {address(gpu_.getPosq()),      gpu_.getUseMixedPrecision() ? address(gpu_.getPosqCorrection()) : nullptr,
                gpu_.getUseDoublePrecision(), address(gpu_.getLongForceBuffer()),
                gpu_.getPaddedNumAtoms(),     gpu_.getCurrentStream()};
    }
    std::vector<int> const& order(std::vector<double> const& positions) override {
        std::vector<OpenMM::Vec3> particles(positions.size() / 3);
        for (std::size_t i = 0; i < particles.size(); ++i) particles[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
        gpu_.forceReorder();
        context_.setPositions(particles);  // and reorders
        return gpu_.getAtomIndex();
    }
    void compute() override { impl_.calcForcesAndEnergy(true, false, all_groups); }

  private:
    static constexpr int all_groups = -1;
    OpenMM::Context& context_;
    OpenMM::ContextImpl& impl_;
    OpenMM::CudaContext& gpu_;
    CUcontext before_ = nullptr;
};

}  // namespace
}  // namespace catena::cuda

extern "C" __attribute__((visibility("default"))) catena::cuda::OpenMmOnDevice* catena_openmm_on_device(OpenMM::Context& context) {
    return new catena::cuda::OnDevice(context);
}
