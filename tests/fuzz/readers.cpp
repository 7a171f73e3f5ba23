// Any bytes as a file for one of Catena's readers: FUZZ_SCENE, FUZZ_TABLE, FUZZ_PDB or FUZZ_FASTA chooses it. What is no such file ends in
// InputError; all else (a crash, a sanitizer's report, more memory than allowed, no end) is a fault.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "error.hpp"
#include "scene/node.hpp"
#if defined(FUZZ_PDB)
#include "scene/pdb_sites.hpp"
#elif defined(FUZZ_FASTA)
#include "scene/fasta.hpp"
#elif defined(FUZZ_TABLE)
#include "scene/files.hpp"
#endif

namespace {

/// A file in memory that readers open by its path.
class Bytes {
  public:
    Bytes(std::uint8_t const* data, std::size_t size) : descriptor_(::memfd_create("bytes", 0)) {
        if (descriptor_ < 0 || ::write(descriptor_, data, size) != static_cast<ssize_t>(size))
            throw std::runtime_error("no file in memory");
    }
    ~Bytes() { ::close(descriptor_); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

void read([[maybe_unused]] std::uint8_t const* data, [[maybe_unused]] std::size_t size) {
    [[maybe_unused]] catena::scene::Node const at;
#if defined(FUZZ_SCENE)
    catena::scene::parse_document(std::string(reinterpret_cast<char const*>(data), size), "scene.yaml");
#elif defined(FUZZ_TABLE)
    catena::scene::read_position_table(Bytes(data, size).path(), at);
#elif defined(FUZZ_PDB)
    for (bool const single : {false, true}) catena::scene::read_pdb(Bytes(data, size).path(), at, single);
#elif defined(FUZZ_FASTA)
    catena::scene::read_fasta(Bytes(data, size).path(), at, {});
#endif
}

}  // namespace

#if defined(FUZZ_FASTA)
void catena::Scene::note(std::string) {}  // of sequences in scenes, which are not read here
#endif

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    try {
        read(data, size);
    } catch (catena::InputError const& error) {
        for (char const* c = error.what(); *c; ++c)
            if (static_cast<unsigned char>(*c) < 0x20) __builtin_trap();  // a message is one line without control characters
    }
    return 0;
}
