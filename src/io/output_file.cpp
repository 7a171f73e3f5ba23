// Implements checked output files by system calls of POSIX.
#include "io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "error.hpp"
#include "io/output.hpp"

namespace catena {
namespace {

constexpr std::size_t buffer_size = 1 << 16;  // bytes

[[noreturn]] void fail(std::string const& doing, std::string const& file, int error) {
    throw ComputationError("cannot " + doing + " (" + file +
                           "): " + std::generic_category().message(error));
}

int open_file(std::string const& file, int flags) {
    int const descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor < 0) fail("open for writing", file, errno);
    return descriptor;
}

}  // namespace

void sync_to_disk(int descriptor, std::string const& file) {
    if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS)
        fail("write to disk", file, errno);
}

void sync_folder_of(std::string const& file) {
    auto const parent = std::filesystem::path(file).parent_path();
    std::string const folder = parent.empty() ? "." : parent.string();
    int const descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) fail("open the folder", folder, errno);
    int const status = ::fsync(descriptor);
    int const error = errno;
    ::close(descriptor);
    // Some network file systems cannot sync folders; keeping the rename is their duty.
    if (status != 0 && error != EINVAL && error != ENOTSUP && error != EBADF)
        fail("write the folder to disk", folder, error);
}

void rename_file(std::string const& from, std::string const& to) {
    if (std::rename(from.c_str(), to.c_str()) != 0) fail("rename " + from, to, errno);
    sync_folder_of(to);
}

OutputFile OutputFile::create(std::string const& file) {
    return {open_file(file, O_WRONLY | O_CREAT | O_TRUNC), file};
}

OutputFile OutputFile::create_anew(std::string const& file) {
    if (::unlink(file.c_str()) != 0 && errno != ENOENT)
        fail(errno == EROFS ? "write" : "remove the old file", file, errno);
    return {open_file(file, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW), file};
}

bool OutputFile::is_in_place() const {
    struct stat open{}, named{};
    return ::fstat(descriptor_, &open) == 0 && ::lstat(name_.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

OutputFile OutputFile::append(std::string const& file, std::int64_t size) {
    OutputFile out(open_file(file, O_WRONLY), file);
    if (::ftruncate(out.descriptor_, size) != 0) fail("truncate", file, errno);
    if (::lseek(out.descriptor_, 0, SEEK_END) < 0) fail("seek to the end", file, errno);
    return out;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      name_(std::move(other.name_)),
      buffer_(std::move(other.buffer_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(name_, other.name_);
    std::swap(buffer_, other.buffer_);
    return *this;
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view text) {
    if (buffer_.size() + text.size() >= buffer_size) flush();
    if (text.size() >= buffer_size) return hand_over(text);
    buffer_ += text;
}

void OutputFile::flush() {
    hand_over(buffer_);
    buffer_.clear();
}

void OutputFile::hand_over(std::string_view rest) {
    while (!rest.empty()) {
        ssize_t const written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            int const error = errno;
            buffer_ = std::string(rest);
            fail("write", name_, error);
        }
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

void OutputFile::sync() {
    flush();
    sync_to_disk(descriptor_, name_);
}

void OutputFile::close() {
    if (descriptor_ < 0) return;
    flush();
    if (::close(std::exchange(descriptor_, -1)) != 0) fail("close", name_, errno);
}

AtomicFile::AtomicFile(std::string file)
    : file_(std::move(file)), out_(OutputFile::create_anew(file_ + ".writing")) {}

AtomicFile::~AtomicFile() {
    if (!published_) ::unlink(out_.name().c_str());
}

void AtomicFile::publish() {
    out_.sync();
    if (!out_.is_in_place())
        throw ComputationError("cannot write (" + file_ + "): another process writes there");
    out_.close();
    rename_file(out_.name(), file_);
    published_ = true;
}

void write_text_file(std::string const& file, std::string const& text) {
    auto const kind = std::filesystem::symlink_status(file).type();
    if (kind != std::filesystem::file_type::not_found &&
        kind != std::filesystem::file_type::regular) {
        // A rename would replace a device, a pipe or a link (/dev/stdout) by a file.
        OutputFile out = OutputFile::create(file);
        out.write(text);
        out.sync();
        return out.close();
    }
    replace_text_file(file, text);
}

void replace_text_file(std::string const& file, std::string const& text) {
    AtomicFile out(file);
    out.write(text);
    out.publish();
}

void make_output_folder(std::string const& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError("the output folder cannot be created: " + error.message(), folder,
                         "name another folder with --output");
}

std::string read_text_file(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError("cannot be read", file, "check that the file exists and is readable");
    std::ostringstream text;
    text << in.rdbuf();
    if (in.bad()) throw InputError("cannot be read", file, "check the disk");
    return std::move(text).str();
}

}  // namespace catena
