// Implements the lock of a run's folder by flock or by the existence of its file.
#include "run/run_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "error.hpp"

namespace catena {
namespace {

/// Contents of the lock's file.
struct Holder {
    std::string host;
    long process = 0;
    std::string
        started;  // start time of the process: the system reuses the numbers of ended processes
    std::string since;
};

std::string this_host() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 && name[0] != '\0' ? name : "unknown";
}

/// Returns the ticks from the host's start to the process's, or "" if there is no such process. The
/// value is the 22nd word of the process's status, the 20th behind the name in brackets.
std::string start_of(long process) {
    std::ifstream in(fmt::format("/proc/{}/stat", process));
    std::string text;
    std::getline(in, text);
    std::istringstream words(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    std::string word;
    for (int i = 0; i < 20 && words >> word; ++i) {
    }
    return words ? word : "";
}

/// Contents of the lock's file for this process.
std::string text_of_this() {
    std::time_t const now = std::time(nullptr);
    std::tm utc{};
    char since[32] = {};
    gmtime_r(&now, &utc);
    std::strftime(since, sizeof since, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return fmt::format("{} {} {} {}\n", this_host(), ::getpid(), start_of(::getpid()), since);
}

/// Reads the lock's file. Control characters become blanks; missing words remain empty.
Holder holder_in(int descriptor) {
    char text[512] = {};
    Holder holder;
    if (::pread(descriptor, text, sizeof text - 1, 0) <= 0) return holder;
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\0' ? c : ' ';
    std::istringstream(text) >> holder.host >> holder.process >> holder.started >> holder.since;
    return holder;
}

/// Reads the holder for up to 0.2 s: it may have locked the file without having written yet.
Holder holder_soon_in(int descriptor) {
    for (int i = 0; i < 20; ++i) {
        Holder holder = holder_in(descriptor);
        if (!holder.since.empty()) return holder;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
}

/// True unless the process has ended, or its number now belongs to another process.
bool is_alive(Holder const& holder) {
    if (holder.process <= 0 ||
        (::kill(static_cast<pid_t>(holder.process), 0) != 0 && errno == ESRCH))
        return false;
    std::string const started = start_of(holder.process);
    return started.empty() || started == holder.started;
}

[[noreturn]] void refuse_taken(Holder const& holder, std::string const& folder,
                               std::string const& more = "") {
    std::string const who = holder.since.empty()
                                ? ""
                                : fmt::format(": process {} on host {}, since {}", holder.process,
                                              holder.host, holder.since);
    throw InputError("another run is writing to this folder" + who, folder,
                     "wait for its end, or name another folder with --output" + more);
}

[[noreturn]] void refuse_file(std::string const& file, int error) {
    if (error == ENOSPC || error == EDQUOT || error == EIO)
        throw ComputationError("cannot write the lock of the run's folder (" + file +
                               "): " + std::generic_category().message(error));
    if (error == ELOOP)
        throw InputError("the lock of the run's folder is a link", file, "remove it");
    throw InputError(
        "the output folder cannot be locked: " + std::generic_category().message(error), file,
        "name another folder with --output");
}

/// Tries flock. Returns 0, EWOULDBLOCK, or the error of a file system without flock.
int try_lock(int descriptor, int kind) {
    int error = 0;
    do error = ::flock(descriptor, kind | LOCK_NB) == 0 ? 0 : errno;
    while (error == EINTR);
    return error;
}

/// Tries flock for up to 0.2 s, because another run may only be testing the lock.
int lock_patiently(int descriptor) {
    int error = try_lock(descriptor, LOCK_EX);
    for (int tries = 0; tries < 10 && error == EWOULDBLOCK; ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        error = try_lock(descriptor, LOCK_EX);
    }
    return error;
}

/// True if the file of that name is the opened one.
bool is_of_name(int descriptor, std::string const& file) {
    struct stat open{}, named{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(file.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

/// Opens a regular file, never a link, a pipe or a device. Returns -1 if the file cannot be opened,
/// with the cause in errno.
int open_lock(std::string const& file, int flags) {
    int const descriptor = ::open(file.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    struct stat about{};
    if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode)) return descriptor;
    ::close(descriptor);
    throw InputError("the lock of the run's folder is not a file", file, "remove it");
}

/// Writes the holder to the lock's file. Removes the file if that fails.
void write_holder(int descriptor, std::string const& file) {
    std::string const text = text_of_this();
    if (::ftruncate(descriptor, 0) != 0 ||
        ::pwrite(descriptor, text.data(), text.size(), 0) != std::ssize(text)) {
        int const error = errno;
        ::unlink(file.c_str());
        ::close(descriptor);
        refuse_file(file, error);
    }
}

/// Treats the existing file of another process as its lock on a file system without flock. The file
/// is removed if that process ran on this host and has ended.
void refuse_or_remove(int descriptor, std::string const& file, std::string const& folder) {
    Holder const holder = holder_soon_in(descriptor);
    bool const dead = holder.host == this_host() && !is_alive(holder);
    if (!dead) refuse_taken(holder, folder, "; if that process has ended, remove " + file);
    if (is_of_name(descriptor, file)) ::unlink(file.c_str());
}

}  // namespace

RunLock::RunLock(std::string const& folder) : file_(folder + "/" + run_lock_name) {
    for (int tries = 0; tries < 100; ++tries) {
        bool const made = (descriptor_ = open_lock(file_, O_RDWR | O_CREAT | O_EXCL)) >= 0;
        if (!made && errno != EEXIST) refuse_file(file_, errno);
        if (!made && (descriptor_ = open_lock(file_, O_RDWR)) < 0) {
            if (errno == ENOENT) continue;  // the holder has just ended
            refuse_file(file_, errno);
        }
        struct Closing {
            int& descriptor;
            bool keeps = false;
            ~Closing() {
                if (!keeps) ::close(std::exchange(descriptor, -1));
            }
        } closing{descriptor_};
        int const error = lock_patiently(descriptor_);
        if (error == EWOULDBLOCK) refuse_taken(holder_soon_in(descriptor_), folder);
        if (error != 0 && !made) {
            refuse_or_remove(descriptor_, file_, folder);
            continue;
        }
        if (!is_of_name(descriptor_, file_))
            continue;  // the last holder removed it between the opening and the lock
        closing.keeps = true;
        write_holder(descriptor_, file_);
        return;
    }
    throw InputError(
        "the output folder cannot be locked: other runs lock and release it repeatedly", folder,
        "name another folder with --output");
}

RunLock::~RunLock() {
    if (is_of_name(descriptor_, file_)) ::unlink(file_.c_str());
    ::close(descriptor_);
}

void RunLock::refuse_if_taken(std::string const& folder) {
    std::string const file = folder + "/" + run_lock_name;
    int const descriptor = open_lock(file, O_RDONLY);
    if (descriptor < 0) return;
    int const error = try_lock(descriptor, LOCK_SH);
    Holder const holder = error == 0 ? Holder{} : holder_soon_in(descriptor);
    ::close(descriptor);
    bool const by_file =
        error != 0 && error != EWOULDBLOCK && (holder.host != this_host() || is_alive(holder));
    if (error == EWOULDBLOCK || by_file) refuse_taken(holder, folder);
}

}  // namespace catena
