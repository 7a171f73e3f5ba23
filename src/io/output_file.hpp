// Plain files written with every step checked: a full disk is an error, never a short file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace catena {

/// fsync; a device or pipe that cannot be synced is no error. Throws ComputationError naming `file`
/// and the cause.
void sync_to_disk(int descriptor, std::string const& file);

/// Makes a rename in the folder of `file` lasting.
void sync_folder_of(std::string const& file);

/// Renames within one folder and makes it lasting.
void rename_file(std::string const& from, std::string const& to);

/// Buffered writer that owns its descriptor. Every member throws ComputationError naming file and
/// cause.
class OutputFile {
  public:
    OutputFile() = default;
    /// Starts an empty file, whatever was there.
    static OutputFile create(std::string const& file);
    /// The same, but for a file that nobody else has: what was there is removed, a link or a pipe
    /// too, and nothing is followed.
    static OutputFile create_anew(std::string const& file);
    /// Opens a file that exists, cuts it to `size` bytes and goes on behind them.
    static OutputFile append(std::string const& file, std::int64_t size);
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) noexcept;
    /// Closes without a word; what was not flushed may be lost.
    ~OutputFile();

    /// Text whose write() throws is lost.
    void write(std::string_view text);
    /// Hands the buffer to the system.
    void flush();
    /// As flush, and on disk when this returns.
    void sync();
    void close();
    std::string const& name() const { return name_; }
    /// Whether its name still leads to it.
    bool is_in_place() const;

  private:
    void hand_over(std::string_view rest);
    OutputFile(int descriptor, std::string name)
        : descriptor_(descriptor), name_(std::move(name)) {}
    int descriptor_ = -1;
    std::string name_, buffer_;
};

/// A file that appears under its name only when it is whole: written beside it, synced and renamed
/// by `publish`; unpublished work is removed.
class AtomicFile {
  public:
    explicit AtomicFile(std::string file);
    AtomicFile(AtomicFile const&) = delete;
    AtomicFile& operator=(AtomicFile const&) = delete;
    ~AtomicFile();
    void write(std::string_view text) { out_.write(text); }
    void publish();

  private:
    std::string file_;
    OutputFile out_;
    bool published_ = false;
};

/// Puts the text under this name by an AtomicFile: a link of that name is replaced, not followed.
void replace_text_file(std::string const& file, std::string const& text);

/// With the folders above it, where they are not there yet; InputError naming it when it cannot be
/// made.
void make_output_folder(std::string const& folder);

/// The whole of a text file; InputError naming it when it cannot be read.
std::string read_text_file(std::string const& file);

}  // namespace catena
