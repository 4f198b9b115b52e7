// The common part of the programs' command lines: how they are read, how --help looks, and what is said of a line that
// cannot be used.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "common/command_line/program_notes.h"
#include "common/error.h"

namespace framelet {

/// Largest number of columns of --help.
inline constexpr std::size_t help_columns = 100;

/// Sets the formatter, --help, --version and, for the build alone, --help-as: the manual page or bash's completion.
void prepare_command_line(CLI::App& app, ProgramNotes const& notes = {});

/// Adds --config: a file in the TOML that CLI11 reads. Its keys are the options without their dashes, and the names of
/// positional arguments in lower case. The command line has precedence over it. To be called after all other options
/// have been added; options that print something and exit are to be made not configurable before.
void add_config_option(CLI::App& app);

/// Accepts a value for which `read` throws no InputError.
template <typename Read>
CLI::Validator readable_by(Read read) {
    return {[read](std::string& input) {
                try {
                    read(input);
                    return std::string();
                } catch (InputError const& error) {
                    return std::string(error.what());
                }
            },
            ""};
}

/// Parses the command line. A flag with a value of its own, as "--smooth{100}", takes another one as `--smooth=50` and
/// as `--smooth 50`: the next word is taken for its value where it could be one, or where more words stand alone than
/// the program takes. Throws CLI::ParseError.
void parse_command_line(CLI::App& app, int argc, char const* const* argv);

/// The complaint about a command line that cannot be used.
struct UsageProblem {
    std::string text; ///< one line, without the program's name
    int exit_code = 2; ///< 1 where the file that --config names cannot be read
};
/// `error` is none of --help and --version.
UsageProblem usage_problem(CLI::App const& app, CLI::ParseError const& error);
/// The same for a value that cannot be used.
UsageProblem usage_problem(std::string const& text);

/// Ends a command line that is not to be run: returns 0 after printing --help or --version; else prints the problem on
/// stderr and returns its exit code.
int exit_usage(CLI::App const& app, CLI::ParseError const& error);
/// The same for a value that cannot be used.
int exit_usage(CLI::App const& app, std::string const& text);

} // namespace framelet
