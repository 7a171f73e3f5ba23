// The one exception type of the public classes.
#pragma once

#include <stdexcept>
#include <string>

namespace catena {

/// A failure with the message that the program gives: one line, for wrong input
/// "what is wrong (where): what to do". Exceptions that a force of your own throws pass unchanged.
class Error : public std::runtime_error {
  public:
    /// Reason of a failure: wrong input (exit status 2 of the program), or a computation that
    /// failed although its input was acceptable (exit status 1).
    enum class Reason { input, computation };

    Error(std::string const& message, Reason reason)
        : std::runtime_error(message), reason_(reason) {}
    Reason reason() const noexcept { return reason_; }

  private:
    Reason reason_;
};

}  // namespace catena
