// Implements the seal in front of a finished file.
#include "io/file_seal.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/checksum.hpp"
#include "io/descriptor.hpp"
#include "io/output_file.hpp"

namespace catena {
namespace {

constexpr std::int64_t piece_size = 4 << 20;
constexpr std::string_view name = "Catena, sealed file", words = " bytes, checksum ",
                           by_places = "by places ";
/// Text of the seal, without its padding to seal_size.
std::string seal_of(Sealed const& of) {
    return fmt::format("{}: {}{}{}{:016x}\n", name, of.bytes, words, by_places, of.checksum);
}

/// Returns the seal's bytes, fewer if the file is shorter.
std::string first_bytes(Descriptor const& file) {
    std::string seal(seal_size, '\0');
    seal.resize(file.read(seal.data(), seal.size(), 0));
    return seal;
}

}  // namespace

Sealed sum_pieces(std::string const& file, int reader, int readers, std::string const& shown,
                  std::string const& doing) {
    Descriptor const open(file, O_RDONLY, shown, doing);
    std::vector<char> bytes(piece_size);
    Sealed found;
    for (std::int64_t piece = reader;; piece += readers) {
        std::size_t const count =
            open.read(bytes.data(), bytes.size(), seal_size + piece * piece_size);
        if (count == 0) return found;
        Checksum sum;
        sum.add(std::string_view(bytes.data(), count));
        found.bytes += static_cast<std::int64_t>(count);
        found.checksum += checksum_at(static_cast<std::uint64_t>(piece), sum.value());
    }
}

void put_seal(std::string const& file, Sealed const& sealed, std::string const& shown,
              std::string const& doing) {
    Descriptor const open(file, O_RDWR, shown, doing);
    std::string seal = seal_of(sealed);
    seal.resize(seal_size);
    open.write(seal, 0);
    sync_to_disk(open.get(), shown);
}

SealKind kind_of_seal(std::string const& file) {
    if (!std::filesystem::is_regular_file(file)) return SealKind::none;
    std::string const seal = first_bytes(Descriptor(file, O_RDONLY, file, "read"));
    if (!seal.starts_with(name)) return SealKind::none;
    std::size_t const digits = 16, at = seal.find(words), begin = at + words.size();
    bool const earlier = at != std::string::npos &&
                         seal.find_first_not_of("0123456789abcdef", begin) == begin + digits &&
                         seal[begin + digits] == '\n';
    return earlier ? SealKind::earlier : SealKind::own;
}

std::string broken_seal(std::string const& file) {
    Sealed const found = sum_pieces(file, 0, 1, file, "read");
    std::string const seal = first_bytes(Descriptor(file, O_RDONLY, file, "read"));
    std::uint64_t const told = seal.size() > name.size() + 2
                                   ? std::strtoull(seal.c_str() + name.size() + 2, nullptr, 10)
                                   : 0;
    if (seal.size() < seal_size || static_cast<std::uint64_t>(found.bytes) < told)
        return fmt::format("cut short, {} of {} bytes", std::filesystem::file_size(file),
                           told + std::uint64_t{seal_size});
    std::string expected = seal_of(found);
    expected.resize(seal_size);
    return seal == expected ? "" : "its checksum does not match its contents";
}

}  // namespace catena
