#include "common/command_line/man_page.h"

#include <cctype>
#include <sstream>

#include "common/command_line/option_text.h"
#include "framelet_version.h"

namespace framelet {
namespace {

constexpr std::size_t line_columns = 78;

/// A word in roff that is read as it stands, whatever roff makes of its characters.
std::string plain(std::string const& word) {
    std::string out;
    for (char const c : word) {
        switch (c) {
        case '\\':
            out += "\\e";
            break;
        case '-':
            out += word.front() == '-' || word.starts_with("framelet") ? "\\-" : "-";
            break; // options and programs are typed with a minus
        case '~':
            out += "\\(ti";
            break;
        case '^':
            out += "\\(ha";
            break;
        case '`':
            out += "\\(ga";
            break;
        default:
            out += c;
        }
    }
    return out;
}

/// A paragraph. No line of it may begin as roff's own commands do.
std::string prose(std::string const& text) {
    std::string words;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
        bool const command = word.front() == '.' || word.front() == '\'';
        words += (command ? "\\&" : "") + plain(word) + " ";
    }
    return wrapped(words, line_columns);
}

std::string bold(std::string const& text) {
    return "\\fB" + plain(text) + "\\fR";
}
std::string italic(std::string const& text) {
    return "\\fI" + plain(text) + "\\fR";
}

std::string synopsis(CLI::App const& app, std::string const& name) {
    std::string out = bold(name) + " [" + italic("OPTIONS") + "]";
    for (CLI::Option const* const option : positionals(app)) {
        std::string const word = italic(option->get_name(true)) + (option->get_items_expected_max() > 1 ? "..." : "");
        out += option->get_required() ? " " + word : " [" + word + "]";
    }
    return out + "\n";
}

std::string entry(CLI::Option const& option) {
    OptionText const text = option_text(option);
    std::string names;
    for (std::string const& name : text.names) {
        names += (names.empty() ? "" : ", ") + (option.get_positional() ? italic(name) : bold(name));
    }
    bool const optional = text.value.starts_with('[');
    std::string const value = optional ? text.value.substr(1, text.value.size() - 2) : text.value;
    names += value.empty() ? "" : optional ? " [" + italic(value) + "]" : " " + italic(value);
    return ".TP\n" + names + "\n" + prose(text.description);
}

/// The options of a program or of one of its commands, which `prefix` names; a command's --help is not listed again.
std::string options(CLI::App const& app, std::string const& prefix) {
    std::string out;
    for (CLI::Option const* const option : positionals(app)) {
        out += entry(*option);
    }
    for (std::string const& group : option_groups(app)) {
        if (app.get_parent() != nullptr && group == app.get_help_ptr()->get_group()) {
            continue;
        }
        out += ".SS " + prefix + plain(group) + "\n";
        for (CLI::Option const* const option : options_of_group(app, group)) {
            out += entry(*option);
        }
    }
    return out;
}

std::string in_capitals(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return text;
}

/// The description as the line of `whatis` has it: "does this and that".
std::string short_description(std::string text) {
    text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
    return text.substr(0, text.find('.'));
}

std::string see_also(std::vector<std::string> const& pages) {
    std::string out;
    for (std::string const& page : pages) {
        out += ".BR " + plain(page) + " (1)" + (&page == &pages.back() ? "" : ",") + "\n";
    }
    return out;
}

} // namespace

std::string man_page(CLI::App const& app, ProgramNotes const& notes) {
    std::string const name = app.get_name();
    std::vector<CLI::App const*> const commands = app.get_subcommands({});
    std::string out = ".TH \"" + in_capitals(name) + "\" 1 \"\" \"framelet " FRAMELET_VERSION "\" \"User Commands\"\n";
    out += ".nh\n.ad l\n"; // no hyphenation: no option is split
    out += ".SH NAME\n" + plain(name) + " \\-\n" + prose(short_description(app.get_description()));
    out += ".SH SYNOPSIS\n";
    for (CLI::App const* const command : commands) {
        out += synopsis(*command, name + " " + command->get_name()) + ".br\n";
    }
    out += synopsis(app, name) + ".SH DESCRIPTION\n" + prose(app.get_description());
    for (std::string const& paragraph : paragraphs_of(notes.text)) {
        out += ".PP\n" + prose(paragraph);
    }
    if (!commands.empty()) {
        out += ".SH COMMANDS\n";
    }
    for (CLI::App const* const command : commands) {
        out += ".TP\n" + bold(command->get_name()) + "\n" + prose(command->get_description());
    }
    out += ".SH OPTIONS\n";
    for (CLI::App const* const command : commands) {
        out += options(*command, "Of " + command->get_name() + ": ");
    }
    out += options(app, "");
    if (!notes.exit_codes.empty()) {
        out += ".SH \"EXIT STATUS\"\n";
    }
    for (ExitCode const& exit : notes.exit_codes) {
        out += ".TP\n.B " + std::to_string(exit.code) + "\n" + prose(exit.means);
    }
    if (!notes.see_also.empty()) {
        out += ".SH \"SEE ALSO\"\n" + see_also(notes.see_also);
    }
    return out;
}

} // namespace framelet
