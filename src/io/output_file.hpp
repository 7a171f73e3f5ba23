// Plain files of which every operation is checked: a full disk causes an error, never a short file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace catena {

/// Calls fsync. A device or pipe that cannot be synced is no error. Throws ComputationError naming
/// `file` and the cause.
void sync_to_disk(int descriptor, std::string const& file);

/// Syncs the folder of `file`, which makes a rename in it durable.
void sync_folder_of(std::string const& file);

/// Renames a file within one folder and makes the rename durable.
void rename_file(std::string const& from, std::string const& to);

/// Buffered writer that owns its descriptor. Every member throws ComputationError naming file and
/// cause.
class OutputFile {
  public:
    OutputFile() = default;
    /// Creates an empty file, or empties an existing one.
    static OutputFile create(std::string const& file);
    /// Creates a file that no other process uses. An existing file, link or pipe of that name is
    /// removed first, and links are not followed.
    static OutputFile create_anew(std::string const& file);
    /// Opens an existing file, shortens it to `size` bytes and appends.
    static OutputFile append(std::string const& file, std::int64_t size);
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) noexcept;
    /// Closes without reporting errors. Text that was not flushed is lost.
    ~OutputFile();

    /// Appends text to the buffer. Text whose write() throws is lost.
    void write(std::string_view text);
    /// Passes the buffer to the system.
    void flush();
    /// Flushes and returns after the data are on disk.
    void sync();
    /// Flushes and closes.
    void close();
    std::string const& name() const { return name_; }
    /// True if the file's name still refers to this file.
    bool is_in_place() const;

  private:
    /// Writes past the buffer. After a failure the unwritten rest is the buffer.
    void hand_over(std::string_view rest);
    OutputFile(int descriptor, std::string name)
        : descriptor_(descriptor), name_(std::move(name)) {}
    int descriptor_ = -1;
    std::string name_, buffer_;
};

/// File that appears under its name only when it is complete. Its text is written to a temporary
/// file in the same folder. publish() syncs and renames that file; the destructor removes
/// unpublished work.
class AtomicFile {
  public:
    explicit AtomicFile(std::string file);
    AtomicFile(AtomicFile const&) = delete;
    AtomicFile& operator=(AtomicFile const&) = delete;
    ~AtomicFile();
    void write(std::string_view text) { out_.write(text); }
    /// Publishes the file. Throws ComputationError if another process replaced the temporary file.
    void publish();

  private:
    std::string file_;
    OutputFile out_;
    bool published_ = false;
};

/// Writes a text file by means of AtomicFile. A link of that name is replaced, not followed.
void replace_text_file(std::string const& file, std::string const& text);

/// Creates a folder and those above it that are missing. Throws InputError naming the folder if
/// that fails.
void make_output_folder(std::string const& folder);

/// Returns the whole text of a file. Throws InputError naming the file if it cannot be read.
std::string read_text_file(std::string const& file);

}  // namespace catena
