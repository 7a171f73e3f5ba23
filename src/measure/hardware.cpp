// Description of the machine and the compiler.
#include "measure/hardware.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <thread>

namespace catena {

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        std::size_t const colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos && colon + 2 < line.size())
            return line.substr(colon + 2);
    }
    utsname machine{};
    return ::uname(&machine) == 0 ? machine.machine : "unknown";
}

int processor_threads() { return static_cast<int>(std::thread::hardware_concurrency()); }

int tasks_running() {
    std::array<int, 5> counts{};
    for (int& count : counts) {
        // "0.20 0.18 0.12 1/80 11206": the fourth field holds the running tasks and all tasks.
        std::ifstream file("/proc/loadavg");
        std::string skipped;
        char slash = 0;
        int all = 0;
        if (!(file >> skipped >> skipped >> skipped >> count >> slash >> all)) return 1;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::nth_element(counts.begin(), counts.begin() + 2, counts.end());
    return std::max(1, counts[2]);
}

#define CATENA_TEXT_OF(value) #value
#define CATENA_TEXT(value) CATENA_TEXT_OF(value)

std::string compiler_name() {
#if defined(__clang__)
    return "clang " CATENA_TEXT(__clang_major__) "." CATENA_TEXT(__clang_minor__) "." CATENA_TEXT(
        __clang_patchlevel__);
#elif defined(__GNUC__)
    return "gcc " CATENA_TEXT(__GNUC__) "." CATENA_TEXT(__GNUC_MINOR__) "." CATENA_TEXT(
        __GNUC_PATCHLEVEL__);
#else
    return "unknown";
#endif
}

std::string instruction_set() {
#if defined(__AVX512F__)
    return "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
    return "AVX2 and FMA";
#elif defined(__x86_64__)
    return "x86-64 baseline";
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "unknown";
#endif
}

}  // namespace catena
