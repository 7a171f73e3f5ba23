// Implements the reader of HDF5's global heap ("GCOL" collections) with bounds checks.
#include "bodies/hdf5_texts.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace catena::scene {

namespace {

/// Size of an element on disk: four bytes of length, eight of the collection's address, four of the
/// object's number.
std::uint64_t constexpr element_size = 16;
/// Size of a collection's header: signature, version, size.
std::uint64_t constexpr collection_head = 16;
/// Size of an object's header: number, references, size.
std::uint64_t constexpr object_head = 16;

/// Throws the error for a damaged file.
[[noreturn]] void damaged(char const* what) {
    throw std::runtime_error(std::string("damaged text, ") + what);
}

/// Reads a little-endian number of `width` bytes.
std::uint64_t number(std::string const& bytes, std::uint64_t at, std::uint64_t width) {
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < width; ++i)
        value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
}

/// Creation properties of the file: sizes of addresses, user block.
hdf5::Properties creation_of(hdf5::File const& file) {
    return hdf5::Properties(H5Fget_create_plist(file.get()));
}

/// True if the elements lie in this file, contiguously, with addresses of eight bytes.
bool is_plain(hdf5::File const& file, hdf5::Dataset const& data, std::uint64_t count) {
    hdf5::Properties const how(H5Dget_create_plist(data.get()));
    std::size_t address = 0, length = 0;
    return how && H5Pget_layout(how.get()) == H5D_CONTIGUOUS &&
           H5Pget_external_count(how.get()) == 0 &&
           H5Pget_sizes(creation_of(file).get(), &address, &length) >= 0 && address == 8 &&
           length == 8 && H5Dget_storage_size(data.get()) == count * element_size;
}

}  // namespace

VariableTexts::VariableTexts(hdf5::File const& file, hdf5::Dataset const& data, std::size_t count) {
    void* descriptor = nullptr;
    hsize_t block = 0;
    if (!is_plain(file, data, count) ||
        H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) < 0 ||
        H5Pget_userblock(creation_of(file).get(), &block) < 0)
        throw std::runtime_error("texts of variable length that are chunked or compressed");
    descriptor_ = *static_cast<int const*>(descriptor);
    base_ = block;
    elements_ = H5Dget_offset(data.get());
    struct stat about{};
    if (::fstat(descriptor_, &about) != 0) damaged("the file cannot be read");
    size_ = static_cast<std::uint64_t>(about.st_size);
    if (elements_ > size_ || count > (size_ - elements_) / element_size)
        damaged("the dataset extends beyond the end of the file");
}

std::string VariableTexts::at(std::size_t k) {
    std::string const element = bytes(elements_ + k * element_size, element_size);
    std::uint64_t const length = number(element, 0, 4), address = number(element, 4, 8);
    // An empty text has no object in the heap.
    if (length == 0) return {};
    Collection const& objects = collection(address);
    auto const found = objects.find(static_cast<unsigned>(number(element, 12, 4)));
    if (found == objects.end()) damaged("there is no text at the address in the dataset");
    if (length > found->second.size())
        damaged("the text is shorter than the length in the dataset");
    std::string text = found->second.substr(0, length);
    return text.substr(0, text.find('\0'));
}

std::string VariableTexts::bytes(std::uint64_t from, std::uint64_t count) const {
    if (from > size_ || count > size_ - from) damaged("an address lies beyond the end of the file");
    std::string read(count, '\0');
    for (std::uint64_t done = 0; done < count;) {
        ssize_t const some =
            ::pread(descriptor_, read.data() + done, count - done, static_cast<off_t>(from + done));
        if (some < 0 && errno == EINTR) continue;
        if (some <= 0) damaged("the file cannot be read");
        done += static_cast<std::uint64_t>(some);
    }
    return read;
}

VariableTexts::Collection const& VariableTexts::collection(std::uint64_t address) {
    auto const found = collections_.find(address);
    return found != collections_.end()
               ? found->second
               : collections_.emplace(address, parsed(address)).first->second;
}

VariableTexts::Collection VariableTexts::parsed(std::uint64_t at) {
    if (at > size_ || base_ > size_ - at) damaged("an address lies beyond the end of the file");
    std::string const head = bytes(base_ + at, collection_head);
    std::uint64_t const size = number(head, 8, 8);
    if (!head.starts_with("GCOL") || head[4] != 1 || size < collection_head)
        damaged("there is no heap at the address in the dataset");
    std::string const all = bytes(base_ + at, size);
    // Sound collections are disjoint, so that their sizes cannot add up to more than the file.
    parsed_ += size;
    if (parsed_ > size_) damaged("two heaps overlap");
    Collection objects;
    for (std::uint64_t place = collection_head; size - place >= object_head;) {
        auto const of = static_cast<unsigned>(number(all, place, 2));
        std::uint64_t const length = number(all, place + 8, 8);
        if (of == 0) break;  // the rest of the collection is free
        place += object_head;
        if (length > size - place) damaged("an object extends beyond its heap");
        if (!objects.emplace(of, all.substr(place, length)).second)
            damaged("two objects have the same number");
        // Objects are padded to multiples of eight bytes.
        std::uint64_t const padded = (length + 7) / 8 * 8;
        if (padded > size - place) break;
        place += padded;
    }
    return objects;
}

}  // namespace catena::scene
