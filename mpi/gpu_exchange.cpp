// Parser of CATENA_GPU_EXCHANGE.
#include "mpi/gpu_exchange.hpp"

#include "error.hpp"

namespace catena {

GpuExchange gpu_exchange_choice(std::string const& text) {
    if (text.empty() || text == "auto" || text == "direct")
        return GpuExchange::direct_where_possible;
    if (text == "host") return GpuExchange::host;
    throw InputError("`" + text + "` is not a way for GPUs to exchange numbers",
                     "CATENA_GPU_EXCHANGE", "use auto, direct or host");
}

}  // namespace catena
