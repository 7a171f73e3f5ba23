// HDF5 breaks on damaged files. Catena tries them in a copy of the process and refuses them; what breaks outside HDF5 is a finding there
// too.
#pragma once

#include <dlfcn.h>
#include <sanitizer/asan_interface.h>
#include <sys/mman.h>

#include <atomic>
#include <cstring>

namespace catena::fuzz {

/// Of this process and its copies: whether Catena's own code broke.
inline std::atomic<bool>& own_fault() {
    static void* const shared = ::mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return *static_cast<std::atomic<bool>*>(shared);
}

}  // namespace catena::fuzz

/// The address sanitizer calls it before its report.
extern "C" inline __attribute__((used)) void __asan_on_error() {
    Dl_info at{};
    if (::dladdr(__asan_get_report_pc(), &at) == 0 || std::strstr(at.dli_fname, "libhdf5") == nullptr) catena::fuzz::own_fault() = true;
}
