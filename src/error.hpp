// What goes wrong, told apart by who can mend it: the user (status 2) or nobody at once (status 1).
#pragma once

#include <stdexcept>
#include <string>

namespace catena {

/// The user's input is wrong. The message is one line: "<what is wrong> (<where>): <what to do>".
/// Exit status 2.
class InputError : public std::runtime_error {
  public:
    InputError(std::string const& what, std::string const& where, std::string const& remedy)
        : std::runtime_error(what + " (" + where + "): " + remedy) {}
    explicit InputError(std::string const& line) : std::runtime_error(line) {}
};

/// The computation failed although its input was acceptable. Exit status 1.
class ComputationError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A package that this build was made without. Exit status 2: another build or another scene is the
/// remedy.
inline InputError built_without(std::string const& package, std::string const& use,
                                std::string const& remedy) {
    return InputError("built without " + package, use, remedy);
}

/// A part of the contract that a later version brings. Exit status 2.
inline InputError not_in_this_version(std::string const& what) {
    return InputError("not in this version: " + what);
}

}  // namespace catena
