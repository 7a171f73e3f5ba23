// Implements the unpacking of gzip files on top of zlib.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

#include "error.hpp"
#include "structure/mmcif_file.hpp"

namespace catena::scene {

namespace {

/// Largest accepted size of an unpacked file, bytes. It stops files that are made to fill memory.
constexpr std::size_t largest_file = std::size_t{4} << 30;

/// A zlib stream that is released at the end of its scope.
class Inflation {
  public:
    Inflation() { ready_ = inflateInit2(&stream, 15 + 16) == Z_OK; }  // 16: a gzip header
    ~Inflation() {
        if (ready_) inflateEnd(&stream);
    }
    Inflation(Inflation const&) = delete;
    Inflation& operator=(Inflation const&) = delete;
    bool ready() const { return ready_; }

    z_stream stream{};

  private:
    bool ready_ = false;
};

}  // namespace

std::string unpacked(std::string_view packed, std::string const& path) {
    auto const refuse = [&](char const* what, char const* remedy) {
        throw InputError(what, path, remedy);
    };
    Inflation inflation;
    z_stream& stream = inflation.stream;
    if (!inflation.ready()) refuse("zlib cannot unpack the file", "unpack it: gunzip");
    std::string text;
    std::array<char, 1 << 16> buffer;
    int state = Z_OK;
    // A gzip file may consist of several members, one after the other.
    for (;;) {
        if (stream.avail_in == 0) {
            auto const piece =
                static_cast<uInt>(std::min<std::size_t>(packed.size(), std::size_t{1} << 30));
            if (piece == 0) break;
            // zlib does not write to its input; its interface lacks the const.
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // NOLINT
            stream.avail_in = piece;
            packed.remove_prefix(piece);
        }
        if (state == Z_STREAM_END && inflateReset(&stream) != Z_OK) break;
        do {
            stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
            stream.avail_out = static_cast<uInt>(buffer.size());
            state = inflate(&stream, Z_NO_FLUSH);
            if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
                refuse("the compressed file is damaged", "fetch the file again");
            text.append(buffer.data(), buffer.size() - stream.avail_out);
            if (text.size() > largest_file)
                refuse("the compressed file holds more than 4 GB", "unpack it and keep one model");
        } while (stream.avail_out == 0 && state == Z_OK);
    }
    if (state != Z_STREAM_END) refuse("the compressed file ends too early", "fetch the file again");
    return text;
}

}  // namespace catena::scene
