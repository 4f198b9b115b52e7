// A command line in words: what --help, the manual page and the shell's completion have in common.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace framelet {

/// True for a flag that stands for a value and takes another one, as "--smooth{100}".
bool has_optional_value(CLI::Option const* option);

struct OptionText {
    std::vector<std::string> names; ///< with dashes; of a positional argument its name
    std::string value; ///< as "FILE", or "[KIND]" where it may be left out; empty: the option takes none
    std::string description; ///< ends with range, default and what the option excludes
};
OptionText option_text(CLI::Option const& option);

/// `text` in lines of at most `columns`, each with `indent` before it.
std::string wrapped(std::string const& text, std::size_t columns, std::string const& indent = "");

/// The paragraphs of a text, which have an empty line between them.
std::vector<std::string> paragraphs_of(std::string const& text);

/// The positional arguments, in order.
std::vector<CLI::Option const*> positionals(CLI::App const& app);
/// All other options of a group; hidden ones, whose group is empty, are of none.
std::vector<CLI::Option const*> options_of_group(CLI::App const& app, std::string const& group);
/// The groups that have options; that of --help comes last.
std::vector<std::string> option_groups(CLI::App const& app);

} // namespace framelet
