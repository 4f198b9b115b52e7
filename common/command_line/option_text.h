// A command line in words: what --help, the manual page and the shell's completion have in common.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace framelet {

/// A flag that stands for a value and takes another one, as "--smooth{100}".
bool has_optional_value(CLI::Option const* option);

struct OptionText {
    std::vector<std::string> names; ///< with dashes; of what stands alone its name
    std::string value; ///< as "FILE", or "[KIND]" where it may be left out; empty: it takes none
    std::string description; ///< range, default and what it excludes at its end
};
OptionText option_text(CLI::Option const& option);

/// In lines of at most `columns`, each with this before it.
std::string wrapped(std::string const& text, std::size_t columns, std::string const& indent = "");

/// What stands alone, in order.
std::vector<CLI::Option const*> positionals(CLI::App const& app);
/// All others of a group, without those that nobody is told of.
std::vector<CLI::Option const*> options_of_group(CLI::App const& app, std::string const& group);
/// The groups that have some.
std::vector<std::string> option_groups(CLI::App const& app);

} // namespace framelet
