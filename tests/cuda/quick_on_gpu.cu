#include "tests/cuda/quick_on_gpu.hpp"

#include "cuda/device/owners.hpp"
#include "cuda/sweeps/branchless_math.cuh"

namespace catena::test {
namespace {

struct OfNumber {
    __device__ double operator()(double x) const {
        bool known = true;
        double const inverse = cuda::kernels::BranchlessInverse{known}(x);
        return known ? inverse : cuda::kernels::not_known();
    }
};
struct InAnyCase {
    __device__ double operator()(double x) const {
        return cuda::kernels::BranchlessFactorizer<false>{}.with_inverse(
            [&](auto const& inverse) { return inverse(x); });
    }
};
struct OfLength {
    __device__ double operator()(double x) const {
        return cuda::kernels::BranchlessInverseLength{}(Vec3{{x, 0, 0}});
    }
};
template <class Of>
__global__ void each(double* x, std::size_t count, Of of) {
    if (std::size_t const i = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
        i < count)
        x[i] = of(x[i]);
}
template <class Of>
std::vector<double> each_of(std::vector<double> x, Of of) {
    constexpr std::size_t threads = 256;
    cuda::Buffer<double> const on_gpu{std::span<double const>(x)};
    each<<<static_cast<unsigned>((x.size() + threads - 1) / threads), threads>>>(on_gpu.data(),
                                                                                 x.size(), of);
    cuda::check(cudaGetLastError(), "start a kernel");
    cuda::check(
        cudaMemcpy(x.data(), on_gpu.data(), x.size() * sizeof(double), cudaMemcpyDeviceToHost),
        "give back numbers");
    return x;
}

}  // namespace

std::vector<double> quick_inverses(std::vector<double> const& x) { return each_of(x, OfNumber{}); }
std::vector<double> inverses_in_any_case(std::vector<double> const& x) {
    return each_of(x, InAnyCase{});
}
std::vector<double> quick_inverse_lengths(std::vector<double> const& x) {
    return each_of(x, OfLength{});
}

}  // namespace catena::test
