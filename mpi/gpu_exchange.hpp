// Request of the environment variable CATENA_GPU_EXCHANGE.
#pragma once

#include <string>

namespace catena {

/// Path of messages between GPUs.
enum class GpuExchange { direct_where_possible, host };
/// Parses "auto" or "direct" (equivalent), or "host"; empty means auto. Throws InputError.
GpuExchange gpu_exchange_choice(std::string const& text);

}  // namespace catena
