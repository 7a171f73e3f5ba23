// Commands, their options and their help, and what one command line says. Only command_parser.cpp
// includes CLI11, whose headers take long to compile.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace catena::command {

/// The list of options of one command. Each option stores its text where its declaration says, once
/// the command line is parsed. Help shows the options in the order of their declaration.
class OptionList {
  public:
    explicit OptionList(CLI::App& command) : command_(&command) {}
    /// Declares an argument, such as a file, which is told by its place. Help shows it as `name`.
    void argument(std::string const& name, std::string& text, std::string const& meaning);
    /// Declares any number of arguments.
    void arguments(std::string const& name, std::vector<std::string>& texts,
                   std::string const& meaning);
    /// Declares an option with one value. `type` is what help shows for the value.
    void value(std::string const& name, std::string& text, std::string const& type,
               std::string const& meaning);
    /// Declares an option with one value that may be repeated.
    void values(std::string const& name, std::vector<std::string>& texts, std::string const& type,
                std::string const& meaning);
    /// Declares an option without a value; `given` tells whether it is on the command line.
    void flag(std::string const& name, bool& given, std::string const& meaning);
    /// Sets what help shows last, such as examples.
    void footer(std::string const& text);

  private:
    CLI::App* command_;
};

/// The commands of a program, and the parser of its command line.
class CommandParser {
  public:
    /// `meaning` describes the program in one line.
    CommandParser(std::string const& meaning, std::string const& program);
    ~CommandParser();

    /// Returns the options of the program itself, which need no command.
    OptionList program_options();
    /// Adds a command and returns its options. `meaning` describes the command in one line.
    OptionList add_command(std::string const& name, std::string const& meaning);

    /// Parses the command line and stores the texts of the options. Returns the help if it was
    /// asked for, and an empty text otherwise. Throws InputError with one line for unknown commands
    /// and options, for values that are missing or empty, and for arguments that are too many.
    std::string parse(int argc, char const* const* argv);
    /// Returns the command on the command line that was parsed; empty if there was none.
    std::string command() const;

  private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace catena::command
