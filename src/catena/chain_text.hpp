// Chains of the public headers as YAML, so that the reader checks them like those of a file.
#pragma once

#include <string>

#include "catena/scene.hpp"

namespace catena {

/// Returns the chain as an entry of the list `chains`, with a line for each body. Numbers are
/// written with all their digits.
std::string text_of(Chain const&);

}  // namespace catena
