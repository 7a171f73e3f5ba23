// The hash that fingerprints are made with.
#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Hash of a sequence of values. Lengths of texts and lists enter too, so that their boundaries
/// count.
class Fingerprint {
  public:
    void word(std::uint64_t value) {
        a_ = std::rotl(a_ ^ value, 27) * 0x9E3779B185EBCA87u + 0x165667B19E3779F9u;
        b_ = (std::rotl(b_, 31) + value) * 0xC2B2AE3D27D4EB4Fu ^ (b_ >> 29);
    }
    void add(double value) { word(std::bit_cast<std::uint64_t>(value)); }
    void add(std::int64_t value) { word(static_cast<std::uint64_t>(value)); }
    void add(std::uint64_t value) { word(value); }
    void add(int value) { word(static_cast<std::uint64_t>(value)); }
    void add(bool value) { word(value ? 1 : 0); }
    void add(std::string const& text) {
        word(text.size());
        for (std::size_t i = 0; i < text.size(); i += 8) {
            std::uint64_t packed = 0;
            for (std::size_t j = i; j < text.size() && j < i + 8; ++j)
                packed |= std::uint64_t{static_cast<unsigned char>(text[j])} << (8 * (j - i));
            word(packed);
        }
    }
    template <class Enum>
        requires std::is_enum_v<Enum>
    void add(Enum value) {
        word(static_cast<std::uint64_t>(value));
    }
    template <std::size_t N>
    void add(std::array<double, N> const& values) {
        for (double const value : values) add(value);
    }
    void add(Vec3 const& v) { add_all(v.data); }
    void add(Mat3 const& m) { add_all(m.data); }
    void add(Sym3 const& m) { add_all(m.data); }
    void add(std::optional<double> const& value) {
        add(value.has_value());
        add(value.value_or(0));
    }
    template <class A, class B>
    void add(std::pair<A, B> const& values) {
        add(values.first);
        add(values.second);
    }
    template <class T>
    void add(std::vector<T> const& values) {
        word(values.size());
        for (T const& value : values) add(value);
    }
    template <class... T>
    void add_each(T const&... values) {
        (add(values), ...);
    }
    std::string short_text() const { return fmt::format("{:016x}", mixed(a_ + b_)); }
    std::string text() const { return fmt::format("{:016x}{:016x}", mixed(a_), mixed(b_)); }

  private:
    template <std::size_t N>
    void add_all(double const (&values)[N]) {
        for (double const value : values) add(value);
    }
    static std::uint64_t mixed(std::uint64_t h) {
        h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
        h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
        return h ^ (h >> 33);
    }
    std::uint64_t a_ = 0x243F6A8885A308D3u, b_ = 0x13198A2E03707344u;  // digits of pi
};

/// Adds optional parts of a scene under their name, and only if present. Scenes without them keep
/// their fingerprint.
template <class... T>
void add_named(Fingerprint& print, char const* name, bool there, T const&... values) {
    if (!there) return;
    print.add(std::string(name));
    print.add_each(values...);
}

/// Returns the content of a file; empty for an empty path. Throws InputError if it cannot be read.
std::string content_of(std::string const& path);
/// Returns the fingerprint of a text, 16 hexadecimal digits.
std::string text_print(std::string const& text);
/// Returns that of a file's content. Throws as content_of() does.
std::string content_print(std::string const& path);

}  // namespace catena::scene
