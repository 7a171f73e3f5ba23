// Implements the check for valid UTF-8 and the replacement of control characters.
#include "io/printable.hpp"

#include <array>
#include <cstddef>

namespace catena {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

/// Returns the bytes of the UTF-8 character at the start of `text`, or 0 if there is none. RFC 3629
/// excludes overlong forms, surrogates and characters beyond U+10FFFF.
std::size_t character_at(std::string_view text) {
    // Ranges of the first and the second byte, and the length.
    struct Form {
        unsigned char first, last, second_from, second_to;
        std::size_t bytes;
    };
    static constexpr std::array<Form, 9> forms{{{0x00, 0x7F, 0x80, 0xBF, 1},
                                                {0xC2, 0xDF, 0x80, 0xBF, 2},
                                                {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                                {0xE1, 0xEC, 0x80, 0xBF, 3},
                                                {0xED, 0xED, 0x80, 0x9F, 3},
                                                {0xEE, 0xEF, 0x80, 0xBF, 3},
                                                {0xF0, 0xF0, 0x90, 0xBF, 4},
                                                {0xF1, 0xF3, 0x80, 0xBF, 4},
                                                {0xF4, 0xF4, 0x80, 0x8F, 4}}};
    auto const byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    for (Form const& form : forms) {
        if (byte(0) < form.first || byte(0) > form.last) continue;
        if (text.size() < form.bytes) return 0;
        for (std::size_t k = 1; k < form.bytes; ++k)
            if (byte(k) < (k == 1 ? form.second_from : 0x80) ||
                byte(k) > (k == 1 ? form.second_to : 0xBF))
                return 0;
        return form.bytes;
    }
    return 0;
}

/// True for U+2028 to U+202E and U+2066 to U+2069: line separators, and marks that reverse the
/// direction of the text that follows.
bool rearranges_lines(std::string_view character) {
    bool const marks =
        character.starts_with("\xE2\x80") && character[2] >= '\xA8' && character[2] <= '\xAE';
    return marks ||
           (character.starts_with("\xE2\x81") && character[2] >= '\xA6' && character[2] <= '\xA9');
}

bool is_control(std::string_view character) {
    auto const first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1)
        return (first < 0x20 && first != '\n' && first != '\t') || first == 0x7F;
    return (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0) ||
           rearranges_lines(character);
}

}  // namespace

std::string printable(std::string_view text) {
    std::string safe;
    safe.reserve(text.size());
    while (!text.empty()) {
        std::size_t const bytes = character_at(text);
        std::string_view const character = text.substr(0, bytes);
        if (bytes == 0)
            safe += replacement;
        else if (is_control(character))
            safe += '?';
        else
            safe += character;
        text.remove_prefix(bytes == 0 ? 1 : bytes);
    }
    return safe;
}

}  // namespace catena
