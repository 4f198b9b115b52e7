#include "common/command_line/command_line.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

#include "common/command_line/bash_completion.h"
#include "common/command_line/man_page.h"
#include "common/command_line/option_text.h"
#include "common/files/regular_file.h"
#include "common/program_line.h"
#include "framelet_version.h"

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

/// The reader of the configuration file. CLI11 takes its values without naming the file where one is wrong: this class
/// looks at each key and value before, so that the complaint can name file and key.
class ConfigFile : public CLI::ConfigTOML {
public:
    explicit ConfigFile(CLI::App* app) : app_(app) {}

    /// Opens a file and returns a name of what is open, for CLI11, which by itself would wait for a pipe.
    std::string open(std::string const& file) {
        name_ = file;
        return opened_.emplace(file).name();
    }
    /// Why the file cannot be read.
    std::string problem() const {
        return "configuration file '" + name_ + "' cannot be read: " + opened_.value().problem();
    }

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        std::vector<CLI::ConfigItem> checked;
        for (CLI::ConfigItem& item : CLI::ConfigTOML::from_config(input)) {
            if (!item.parents.empty()) {
                throw complaint("it has a section or a key with a dot in it, '" + item.parents.front() +
                                "': write options alone, one a line, as port = 7070");
            }
            std::string const key = item.name;
            CLI::Option* const option = find(item);
            if (option == nullptr || !option->get_configurable()) {
                throw complaint("there is no option '" + key + "' for it to set");
            }
            if (check(*option, key + ": ", item)) {
                checked.push_back(std::move(item));
            }
        }
        return checked;
    }

private:
    CLI::ConfigError complaint(std::string const& text) const {
        return {"configuration file '" + name_ + "': " + text, CLI::ExitCodes::ConfigError};
    }

    /// Finds the option of an item and gives the item the name by which CLI11 finds it; null where there is none.
    CLI::Option* find(CLI::ConfigItem& item) const {
        for (CLI::Option* const option : app_->get_options()) {
            std::string const& alone = option->get_positional() ? option->get_name(true) : "";
            std::string const word = CLI::detail::to_lower(alone.substr(0, alone.find('[')));
            if (!word.empty() && word == item.name) {
                item.name = alone;
                return option;
            }
        }
        return app_->get_option_no_throw("--" + item.name);
    }

    /// Checks an item's value; false where the item says no more than its absence would: a flag that is not set. Throws
    /// CLI::ConfigError where the option cannot have the value.
    bool check(CLI::Option& option, std::string const& key, CLI::ConfigItem& item) const {
        if (item.inputs.size() != 1 && option.get_items_expected_max() <= 1) {
            throw complaint(key + "it takes one value; a text with spaces or commas stands in quotes");
        }
        bool const is_flag = option.get_items_expected_min() == 0;
        if (is_flag && item.inputs.front() == "false") {
            return false;
        }
        if (is_flag && !has_optional_value(&option)) {
            if (item.inputs.front() != "true") {
                throw complaint(key + "'" + item.inputs.front() + "' is neither true nor false");
            }
            return true;
        }
        if (is_flag && item.inputs.front() == "true") {
            item.inputs.front().clear(); // CLI11 then takes the value that the flag has by itself
            return true;
        }
        for (std::string input : item.inputs) {
            for (int i = 0; auto const* const validator = validator_of(option, i); ++i) {
                if (std::string const problem = (*validator)(input); !problem.empty()) {
                    throw complaint(key + problem);
                }
            }
        }
        return true;
    }

    static CLI::Validator const* validator_of(CLI::Option& option, int index) {
        try {
            return option.get_validator(index);
        } catch (CLI::OptionNotFound const&) { // there are no more
            return nullptr;
        }
    }

    CLI::App* app_;
    std::string name_; ///< of the file
    std::optional<RegularFile> opened_;
};

/// Prints help in groups, with range and default of each option at its end.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_group(std::string name, bool positional, std::vector<CLI::Option const*> options) const override {
        std::string out = name + ":\n";
        for (CLI::Option const* const option : options) {
            out += make_option(option, positional);
        }
        return positional ? "\n" + out + "\n" : out;
    }

    std::string make_option(CLI::Option const* option, bool /*positional*/) const override {
        OptionText const text = option_text(*option);
        std::string const value = text.value.empty() ? "" : " " + text.value;
        return in_columns("  " + CLI::detail::join(text.names, ", ") + value, text.description);
    }
};

bool could_be_value(CLI::Option* option, std::string word) {
    return option->get_validator(0)->operator()(word).empty();
}

std::string footer_of(ProgramNotes const& notes) {
    std::string out;
    for (std::string const& paragraph : paragraphs_of(notes.text)) {
        out += wrapped(paragraph, help_columns) + "\n";
    }
    out += notes.exit_codes.empty() ? "" : "Exit codes:\n";
    for (ExitCode const& exit : notes.exit_codes) {
        std::string lines = wrapped(exit.means, help_columns, "     ");
        std::string const code = std::to_string(exit.code);
        out += lines.replace(2, code.size(), code);
    }
    return out.substr(0, out.find_last_not_of('\n') + 1); // CLI11 ends the line
}

/// Number of letters that have to be added, left out or changed to make one word of the other (Levenshtein).
std::size_t spelling_distance(std::string const& a, std::string const& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t corner = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            std::size_t const changed = corner + (a[i] == b[j] ? 0 : 1);
            corner = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// The complaint about unknown words: these, and what the first of them was most likely meant for.
std::string unknown_text(CLI::App const& app) {
    std::vector<std::string> const words = app.remaining(true);
    std::string const meant = words.front().substr(0, words.front().find('='));
    std::vector<std::string> names;
    auto const add_options = [&](CLI::App const& of) {
        for (CLI::Option const* const option : of.get_options()) {
            if (!option->get_group().empty() && !option->get_positional()) {
                names.push_back(option->get_name());
            }
        }
    };
    if (is_option(meant)) {
        add_options(app);
        for (CLI::App const* const command : app.get_subcommands()) {
            add_options(*command);
        }
    } else {
        for (CLI::App const* const command : app.get_subcommands([](CLI::App const*) { return true; })) {
            names.push_back(command->get_name());
        }
    }
    std::string out = "unknown: " + CLI::detail::join(words, " ");
    constexpr std::size_t most_wrong = 2;
    auto const nearest =
        std::ranges::min_element(names, {}, [&](auto const& n) { return spelling_distance(n, meant); });
    if (nearest != names.end() && spelling_distance(*nearest, meant) <= most_wrong) {
        out += "; did you mean " + *nearest + "?";
    }
    return out;
}

int print(CLI::App const& app, UsageProblem const& problem) {
    print_line(app.get_name(), problem.text);
    return problem.exit_code;
}

} // namespace

void prepare_command_line(CLI::App& app, ProgramNotes const& notes) {
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_help_flag("-h,--help", "Print this help and exit")->group("Help");
    app.set_version_flag("--version", app.get_name() + " " FRAMELET_VERSION, "Print the version and exit")
        ->group("Help");
    app.footer(footer_of(notes));
    app.add_option_function<std::string>("--help-as",
                                         [&app, notes](std::string const& kind) {
                                             std::cout << (kind == "man" ? man_page(app, notes) : bash_completion(app));
                                             throw CLI::Success();
                                         })
        ->check(CLI::IsMember({"man", "bash"}))
        ->group("")
        ->configurable(false);
}

void add_config_option(CLI::App& app) {
    auto const file = std::make_shared<ConfigFile>(&app);
    app.set_config(
           "--config", "",
           "Take options from this file that are not on the command line: a line OPTION = VALUE each, the option "
           "without dashes, a flag = true")
        ->type_name("FILE")
        ->group("Help")
        ->transform([file](std::string const& name) { return file->open(name); });
    app.config_formatter(file);
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
    std::reverse(joined.begin(), joined.end()); // CLI11 takes the last word first
    try {
        app.parse(std::move(joined));
    } catch (CLI::ParseError const& error) {
        auto const is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
        bool const lacks_command = is(CLI::ExitCodes::RequiredError) && app.get_require_subcommand_min() > 0 &&
                                   app.get_subcommands().empty() && app.remaining_size() > 0;
        if (!is(CLI::ExitCodes::ExtrasError) && !lacks_command) {
            throw;
        }
        throw CLI::ParseError(unknown_text(app), CLI::ExitCodes::ExtrasError);
    }
}

UsageProblem usage_problem(CLI::App const& app, CLI::ParseError const& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::FileError)) { // no other file is read
        return {std::static_pointer_cast<ConfigFile>(app.get_config_formatter())->problem(), 1};
    }
    return usage_problem(error.what());
}

UsageProblem usage_problem(std::string const& text) {
    std::string line = text;
    std::replace(line.begin(), line.end(), '\n', ' ');
    return {line + " (--help lists the options)"};
}

int exit_usage(CLI::App const& app, CLI::ParseError const& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : print(app, usage_problem(app, error));
}

int exit_usage(CLI::App const& app, std::string const& text) {
    return print(app, usage_problem(text));
}

} // namespace framelet
