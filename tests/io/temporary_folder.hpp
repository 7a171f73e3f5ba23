// A folder of its own for each test, removed with all that is in it.
#pragma once

#include <filesystem>
#include <random>
#include <string>

namespace catena::test {

class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("catena-" + std::to_string(std::random_device()()))) {
        std::filesystem::create_directories(path_);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::string operator/(std::string const& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }

  private:
    std::filesystem::path path_;
};

inline std::string message_of(auto&& action) {
    try {
        action();
    } catch (std::exception const& error) {
        return error.what();
    }
    return "nothing was thrown";
}

}  // namespace catena::test
