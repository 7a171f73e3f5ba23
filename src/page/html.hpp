// Text that is safe in a page, numbers as people read them, and the look of every page.
#pragma once

#include <string>
#include <string_view>

namespace catena {

std::string escaped(std::string_view text);

/// "total_energy" -> "Total energy".
std::string readable_name(std::string_view key);

/// Six digits, without a tail of zeros.
std::string readable_number(double value);

/// A page that needs nothing but itself, in light and dark.
std::string html_page(std::string const& title, std::string const& body);

}  // namespace catena
