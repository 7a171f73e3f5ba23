// Implements commands, options and help with CLI11, and refuses what CLI11 could not assign.
#include "console/command_parser.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "console/option_values.hpp"
#include "error.hpp"

namespace catena::command {
namespace {

/// Option that is reserved for a later version.
constexpr std::string_view later_option = "--precision";

/// Returns views of the texts.
std::vector<std::string_view> views(std::vector<std::string> const& texts) {
    return {texts.begin(), texts.end()};
}

/// Throws InputError for an unknown command.
[[noreturn]] void refuse_command(CLI::App const& app, std::string const& word) {
    std::vector<std::string> names;
    for (CLI::App const* command : app.get_subcommands({})) names.push_back(command->get_name());
    throw InputError("`" + word + "` is not a command", "command line",
                     remedy_for(word, views(names)));
}

/// Throws InputError for an unknown option, with the nearest known one as remedy.
[[noreturn]] void refuse_option(CLI::App const& command, std::string const& word) {
    std::string const option = word.substr(0, word.find('='));
    std::vector<std::string> known;
    for (CLI::Option const* each : command.get_options())
        for (std::string const& name : each->get_lnames()) known.push_back("--" + name);
    if (option == later_option)
        throw not_in_this_version(option + " of catena " + command.get_name());
    std::string const see = "catena " + (command.get_parent() ? command.get_name() + " " : "") +
                            "--help lists the options";
    std::string const remedy = remedy_for(option, views(known));
    throw InputError("`" + option + "` is not an option", "command line",
                     remedy.starts_with("did") ? remedy : see);
}

/// Throws InputError if words are left that CLI11 could not assign. `command` is null if the
/// command line has none.
void refuse_extras(CLI::App const& app, CLI::App const* command) {
    std::vector<std::string> const left = app.remaining(true);
    if (left.empty()) return;
    auto const option = std::find_if(left.begin(), left.end(), [](std::string const& word) {
        return word.size() > 1 && word[0] == '-';
    });
    if (option != left.end()) refuse_option(command ? *command : app, *option);
    if (!command) refuse_command(app, left.front());
    throw InputError("`" + left.front() + "` is one argument too many", "command line",
                     "see catena " + command->get_name() + " --help");
}

/// Throws InputError if an option has an empty value.
void refuse_empty(CLI::App const& command) {
    for (CLI::Option const* option : command.get_options())
        for (std::string const& value : option->results())
            if (value.empty())
                throw InputError(option->get_name() + " is empty", "command line",
                                 "give a value, or leave it out");
}

/// Replaces line breaks by spaces and removes trailing ones.
std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

/// Returns the command on the command line; null if there is none.
CLI::App const* chosen(CLI::App const& app) {
    auto const all = app.get_subcommands();
    return all.empty() ? nullptr : all.front();
}

}  // namespace

void OptionList::argument(std::string const& name, std::string& text, std::string const& meaning) {
    value(name, text, "", meaning);
}
void OptionList::arguments(std::string const& name, std::vector<std::string>& texts,
                           std::string const& meaning) {
    command_->add_option(name, texts, meaning)->type_name("");
}
void OptionList::value(std::string const& name, std::string& text, std::string const& type,
                       std::string const& meaning) {
    command_->add_option(name, text, meaning)->type_name(type);
}
void OptionList::values(std::string const& name, std::vector<std::string>& texts,
                        std::string const& type, std::string const& meaning) {
    command_->add_option(name, texts, meaning)->type_name(type)->allow_extra_args(false);
}
void OptionList::flag(std::string const& name, bool& given, std::string const& meaning) {
    command_->add_flag(name, given, meaning);
}
void OptionList::footer(std::string const& text) { command_->footer(text); }

CommandParser::CommandParser(std::string const& meaning, std::string const& program)
    : app_(std::make_unique<CLI::App>(meaning, program)) {
    app_->allow_extras();  // so do commands: refuse_extras() knows what is meant
}
CommandParser::~CommandParser() = default;

OptionList CommandParser::program_options() { return OptionList(*app_); }

OptionList CommandParser::add_command(std::string const& name, std::string const& meaning) {
    return OptionList(*app_->add_subcommand(name, meaning));
}

std::string CommandParser::parse(int argc, char const* const* argv) {
    // Only one command is accepted, so that "catena bench solve" does not count as two.
    app_->require_subcommand(0, 1);
    try {
        app_->parse(argc, argv);
    } catch (CLI::CallForHelp const&) {
        return app_->help();
    } catch (CLI::ParseError const& error) {
        throw InputError(one_line(error.what()), "command line", "see catena --help");
    }
    CLI::App const* const command = chosen(*app_);
    refuse_extras(*app_, command);
    if (command) refuse_empty(*command);
    return "";
}

std::string CommandParser::command() const {
    CLI::App const* const command = chosen(*app_);
    return command ? command->get_name() : "";
}

}  // namespace catena::command
