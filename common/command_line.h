// What the programs' command lines have in common: how they are read, how --help looks, and what is said of a line that
// cannot be used.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace framelet {

/// Help in groups, at most `help_columns` wide, with range and default of each option at its end.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_group(std::string name, bool positional, std::vector<CLI::Option const*> options) const override;
    std::string make_option(CLI::Option const* option, bool positional) const override;
};
inline constexpr std::size_t help_columns = 100;

/// Sets the formatter and --version.
void prepare_command_line(CLI::App& app);

/// A flag with a value of its own, as "--smooth{100}", takes another one as `--smooth=50` and as `--smooth 50`. The
/// next word is taken for its value where it could be one, or where more words stand alone than the program takes.
/// Throws CLI::ParseError.
void parse_command_line(CLI::App& app, int argc, char const* const* argv);

/// The exit code of a command line that is not to be run: 0 after --help and --version, else 2 and one line on stderr.
int exit_usage(CLI::App const& app, CLI::ParseError const& error);
/// The same for a value that cannot be used.
int exit_usage(CLI::App const& app, std::string const& text);

} // namespace framelet
