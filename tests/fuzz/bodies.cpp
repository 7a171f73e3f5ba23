// Chains of rigid bodies in HDF5 files. Where HDF5 itself breaks on one, in the copy of the process that tries it, the reader refuses the
// file; what breaks outside HDF5 is a finding there too.
#include <dlfcn.h>
#include <sanitizer/asan_interface.h>

#include <atomic>
#include <cstring>

#include "error.hpp"
#include "scene/hdf5_bodies.hpp"
#include "tests/fuzz/target.hpp"

namespace {

/// Of this process and its copies: whether Catena's own code broke.
std::atomic<bool>& own_fault() {
    static void* const shared = ::mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return *static_cast<std::atomic<bool>*>(shared);
}

}  // namespace

extern "C" void __asan_on_error() {
    Dl_info at{};
    if (::dladdr(__asan_get_report_pc(), &at) == 0 || std::strstr(at.dli_fname, "libhdf5") == nullptr) own_fault() = true;
}

/// For messages.
char const* catena::name_of(JointType) { return "-"; }

void catena::fuzz::read(std::string_view bytes) {
    own_fault() = false;
    NamedFile const file(bytes);
    try {
        BodyArrays const bodies = scene::read_hdf5_bodies(file.path(), bytes.size() % 2 == 0 ? Base::fixed : Base::free);
        require(!bodies.mass.empty() && bodies.inertia.size() == bodies.mass.size() && bodies.joint.size() == bodies.mass.size());
    } catch (InputError const&) {
        require(!own_fault());
        throw;
    }
}
