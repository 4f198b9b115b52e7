// What the programs' command lines have in common: how they are read, how --help looks, and what is said of a line that
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

/// Help in groups, at most `help_columns` wide, with range and default of each option at its end.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_group(std::string name, bool positional, std::vector<CLI::Option const*> options) const override;
    std::string make_option(CLI::Option const* option, bool positional) const override;
};
inline constexpr std::size_t help_columns = 100;

/// Sets the formatter, --help, --version and, for the build alone, --help-as: the manual page or bash's completion.
void prepare_command_line(CLI::App& app, ProgramNotes const& notes = {});

/// Adds --config: a file in the TOML that CLI11 reads, whose keys are the options without their dashes, and what stands
/// alone on the command line by its name in lower case. To be called after all other options; what the command line
/// says counts. Options that print something and exit are to be made not configurable before.
void add_config_option(CLI::App& app);

/// What `read` throws no InputError for.
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

/// A flag with a value of its own, as "--smooth{100}", takes another one as `--smooth=50` and as `--smooth 50`. The
/// next word is taken for its value where it could be one, or where more words stand alone than the program takes.
/// Throws CLI::ParseError.
void parse_command_line(CLI::App& app, int argc, char const* const* argv);

/// The exit code of a command line that is not to be run: 0 after --help and --version, else one line on stderr and 1
/// where the file that --config names cannot be read, 2 otherwise.
int exit_usage(CLI::App const& app, CLI::ParseError const& error);
/// The same for a value that cannot be used.
int exit_usage(CLI::App const& app, std::string const& text);

} // namespace framelet
