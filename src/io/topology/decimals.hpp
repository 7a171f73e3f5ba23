// Text of numbers with a few decimals, as fmt writes it but in a tenth of the time. Text files hold
// such numbers by the ten million.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string_view>

namespace catena {

/// Text that fmt writes for "{:.{places}f}". The text lies in a buffer of the object itself.
/// Precondition: places from 0 to 3.
class Decimals {
  public:
    Decimals(double value, int places) {
        constexpr double ten_to_the[] = {1, 10, 100, 1000}, most = 1e12, doubt = 1e-3;
        double const scaled = std::abs(value) * ten_to_the[places], whole = std::floor(scaled),
                     rest = scaled - whole;
        // The product is rounded: a remainder this close to one half may belong on the other side.
        if (!(scaled < most) || std::abs(rest - 0.5) < doubt) {
            begin_ = text_;
            end_ = fmt::format_to_n(text_, sizeof(text_), "{:.{}f}", value, places).out;
            return;
        }
        begin_ = end_ = text_ + sizeof(text_);
        auto digits = static_cast<std::uint64_t>(whole) + (rest > 0.5 ? 1 : 0);
        for (int i = 0; i < places; ++i, digits /= 10) put(digits);
        if (places > 0) *--begin_ = '.';
        do {
            put(digits);
        } while (digits /= 10);
        if (std::signbit(value)) *--begin_ = '-';
    }
    Decimals(Decimals const&) = delete;
    Decimals& operator=(Decimals const&) = delete;

    std::string_view text() const { return {begin_, static_cast<std::size_t>(end_ - begin_)}; }

  private:
    void put(std::uint64_t digits) { *--begin_ = static_cast<char>('0' + digits % 10); }
    char text_[336];  // size suffices for the largest double, which has 309 digits
    char* begin_;
    char* end_;
};

}  // namespace catena
