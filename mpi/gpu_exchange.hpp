// What the environment variable CATENA_GPU_EXCHANGE asks for.
#pragma once

#include <string>

namespace catena {

enum class GpuExchange { direct_where_possible, host };
/// "auto" or "direct" (the same), "host"; empty: auto. Throws InputError.
GpuExchange gpu_exchange_choice(std::string const& text);

}  // namespace catena
