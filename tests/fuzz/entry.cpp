// Any bytes as a file for one of Catena's readers. What is no such file ends in InputError; all
// else (a crash, a sanitizer's report, more memory than allowed, no end) is a fault.
#include <cstddef>
#include <cstdint>

#include "error.hpp"
#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    try {
        catena::fuzz::read({reinterpret_cast<char const*>(data), size});
    } catch (catena::InputError const& error) {
        for (char const* c = error.what(); *c;
             ++c)  // a message is one line without control characters
            catena::fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    }
    return 0;
}
