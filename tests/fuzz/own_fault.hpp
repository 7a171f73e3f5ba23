// HDF5 breaks on damaged files. Catena tries them in a copy of the process and refuses them; what
// breaks outside HDF5 is a finding there too.
#pragma once

#include <dlfcn.h>
#include <sanitizer/asan_interface.h>
#include <sys/mman.h>

#include <atomic>
#include <cstring>

namespace catena::fuzz {

/// Of this process and its copies: whether Catena's own code broke.
inline std::atomic<bool>& own_fault() {
    static void* const shared = ::mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE,
                                       MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return *static_cast<std::atomic<bool>*>(shared);
}

}  // namespace catena::fuzz

/// The address sanitizer calls it before its report. Not inline: the sanitizer's own weak one would
/// be taken. One source of a target includes this.
extern "C" void __asan_on_error();
extern "C" void __asan_on_error() {
    Dl_info at{};
    if (::dladdr(__asan_get_report_pc(), &at) == 0 ||
        std::strstr(at.dli_fname, "libhdf5") == nullptr)
        catena::fuzz::own_fault() = true;
}
/// The sanitizer of undefined behaviour calls it before its report; HDF5 is not compiled with it.
extern "C" void __ubsan_on_report();
extern "C" void __ubsan_on_report() { catena::fuzz::own_fault() = true; }
