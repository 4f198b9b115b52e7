#include "common/command_line.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>

namespace framelet {

namespace {

constexpr std::size_t text_column = 30;

/// `text` in lines that begin at `text_column`; the first follows `left`, or stands below it where that is too long.
std::string in_columns(std::string const& left, std::string const& text) {
    std::string out = left;
    std::size_t column = left.size();
    auto const next_line = [&] {
        out += "\n";
        column = 0;
    };
    if (column + 2 > text_column) {
        next_line();
    }
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column > text_column && column + 1 + word.size() > help_columns) {
            next_line();
        }
        std::string const gap = column > text_column ? " " : std::string(text_column - column, ' ');
        out += gap + word;
        column += gap.size() + word.size();
    }
    return out + "\n";
}

bool is_option(std::string const& word) {
    return word.size() > 1 && word.front() == '-';
}

/// Flags have a name here where they stand for a value.
bool has_optional_value(CLI::Option const* option) {
    return option != nullptr && !option->get_fnames().empty();
}

bool could_be_value(CLI::Option* option, std::string word) {
    return option->get_validator(0)->operator()(word).empty();
}

} // namespace

std::string HelpFormatter::make_group(std::string name, bool positional,
                                      std::vector<CLI::Option const*> options) const {
    std::string out = name + ":\n";
    for (CLI::Option const* const option : options) {
        out += make_option(option, positional);
    }
    return positional ? "\n" + out + "\n" : out;
}

std::string HelpFormatter::make_option(CLI::Option const* option, bool positional) const {
    std::vector<std::string> names;
    for (std::string const& name : option->get_snames()) {
        names.push_back("-" + name);
    }
    for (std::string const& name : option->get_lnames()) {
        names.push_back("--" + name);
    }
    // "KIND:RANGE", where either may be missing.
    std::string const type = option->get_type_name();
    std::size_t const colon = std::min(type.find(':'), type.size());
    std::string kind = type.substr(0, colon);
    kind = kind == "INT" || kind == "UINT" || kind == "FLOAT" ? "NUMBER" : kind;

    std::string left = "  " + (positional ? option->get_name(true) : CLI::detail::join(names, ", "));
    if (!positional && has_optional_value(option)) {
        left += " [" + option->get_option_text() + "]";
    } else if (!positional && option->get_type_size() != 0) {
        left += " " + kind;
    }
    std::vector<std::string> notes;
    if (colon + 1 < type.size()) {
        notes.push_back(type.substr(colon + 1));
    }
    if (!option->get_default_str().empty()) {
        notes.push_back("default: " + option->get_default_str());
    }
    for (CLI::Option const* const other : option->get_excludes()) {
        notes.push_back("not with " + other->get_name());
    }
    std::string const note = notes.empty() ? "" : " (" + CLI::detail::join(notes, "; ") + ")";
    return in_columns(left, option->get_description() + note);
}

void prepare_command_line(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_help_flag("-h,--help", "Print this help and exit")->group("Help");
    app.set_version_flag("--version", app.get_name() + " " FRAMELET_VERSION, "Print the version and exit")
        ->group("Help");
}

void parse_command_line(CLI::App& app, int argc, char const* const* argv) {
    std::vector<std::string> const words(argv + std::min(argc, 1), argv + argc);
    std::size_t alone = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!is_option(words[i])) {
            ++alone;
        } else if (CLI::Option const* const option = app.get_option_no_throw(words[i])) {
            i += option->get_items_expected_min() > 0 ? 1 : 0; // its value
        }
    }
    std::size_t const wanted = app.get_options([](CLI::Option const* o) { return o->get_positional(); }).size();
    std::vector<std::string> joined;
    for (std::size_t i = 0; i < words.size(); ++i) {
        joined.push_back(words[i]);
        CLI::Option* const option = is_option(words[i]) ? app.get_option_no_throw(words[i]) : nullptr;
        if (has_optional_value(option) && i + 1 < words.size() && !is_option(words[i + 1]) &&
            (alone > wanted || could_be_value(option, words[i + 1]))) {
            joined.back() += "=" + words[++i];
            --alone;
        }
    }
    std::reverse(joined.begin(), joined.end()); // as CLI11 wants them
    app.parse(std::move(joined));
}

int exit_usage(CLI::App const& app, CLI::ParseError const& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : exit_usage(app, error.what());
}

int exit_usage(CLI::App const& app, std::string const& text) {
    std::string line = text;
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::cerr << app.get_name() << ": " << line << " (--help lists the options)\n";
    return 2;
}

} // namespace framelet
