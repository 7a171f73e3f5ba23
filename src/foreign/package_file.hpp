// A YAML file of the CALVADOS package: keys with values, some of which may be absent.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "scene/node.hpp"

namespace catena::foreign {

/// Advice for a key whose value is not the System's.
inline constexpr char const* run_again =
    "start the package's run.py again, which writes the System, or correct the value";

/// Advice for a System that is not what the package writes.
inline constexpr char const* write_system_again =
    "start the package's run.py again, which writes the System";

/// Advice for a file that was cut or changed.
inline constexpr char const* write_again = "write it again with the package's prepare.py";
inline constexpr char const* write_again_or_move =
    "write it again with the package's prepare.py, or move it out of the folder";

/// Holds the keys of config.yaml or components.yaml.
class PackageFile {
  public:
    /// Reads the file. Throws InputError if it is no YAML or holds no keys with values.
    explicit PackageFile(std::string const& file);

    scene::Node const& root() const { return *root_; }
    /// Returns the entry of that key if it has a value; nullptr if it is absent, empty or null.
    scene::Node const* find(std::string_view key) const;
    /// Returns the number of that key, or the default of the package.
    double number(std::string_view key, double otherwise) const;
    /// Returns the same for a number of 0 or more.
    double non_negative(std::string_view key, double otherwise) const;
    /// Returns the whole number of that key, as whole_of() does.
    std::int64_t whole(std::string_view key, double otherwise, std::int64_t least) const;
    /// Returns the truth of that key, false without one.
    bool truth(std::string_view key) const;
    /// Returns the text of that key, or the default of the package.
    std::string text(std::string_view key, char const* otherwise) const;
    /// Returns the place of that key in messages: "FILE: KEY, line 3", or the file alone.
    std::string place(std::string_view key) const;

  private:
    std::unique_ptr<scene::Node> root_;
};

/// Throws InputError if the key has another number than the System, which has `made` in units of
/// `unit`. `system` is the System's name.
void refuse_another(PackageFile const& config, char const* key, double made, double unit,
                    std::string const& system);

/// True if two numbers that were written in full agree.
bool are_equal(double a, double b);

/// Returns the value of an entry unless it is empty or null, else nullptr.
scene::Node const* valued(scene::Node const* entry);

/// Reads a finite number as the package's PyYAML does (YAML 1.1): 1_000_000, 0x10, 010 (octal) and
/// 1:30 (base 60) are numbers, too. Also reads 1e8, which is_text_of_package() tells. Throws
/// InputError for others.
double number_of(scene::Node const& node);
/// True for an unquoted number that PyYAML takes for a text, with which the package stops: 1e8.
bool is_text_of_package(scene::Node const& node);
/// Reads a truth as PyYAML and Python do: yes, off and False are words of it, 0 is false. Throws
/// InputError for texts, which Python takes for true.
bool truth_of(scene::Node const& node);
/// Reads a whole number of `least` or more, which may be written as 1e8 or 100000000.0.
std::int64_t whole_of(scene::Node const& node, std::int64_t least);

}  // namespace catena::foreign
