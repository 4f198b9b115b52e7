#include "common/command_line/option_text.h"

#include <algorithm>
#include <sstream>

namespace framelet {

bool has_optional_value(CLI::Option const* option) {
    return option != nullptr && !option->get_fnames().empty(); // flags have a name there where they stand for a value
}

OptionText option_text(CLI::Option const& option) {
    OptionText out;
    bool const positional = option.get_positional();
    if (positional) {
        out.names.push_back(option.get_name(true));
    }
    for (std::string const& name : option.get_snames()) {
        out.names.push_back("-" + name);
    }
    for (std::string const& name : option.get_lnames()) {
        out.names.push_back("--" + name);
    }
    // The type's name is "KIND:RANGE", where either may be missing.
    std::string const type = option.get_type_name();
    std::size_t const colon = std::min(type.find(':'), type.size());
    if (!positional && has_optional_value(&option)) {
        out.value = "[" + option.get_option_text() + "]";
    } else if (!positional && option.get_type_size() != 0) {
        std::string const kind = type.substr(0, colon);
        out.value = kind == "INT" || kind == "UINT" || kind == "FLOAT" ? "NUMBER" : kind;
    }
    std::vector<std::string> notes;
    if (colon + 1 < type.size()) {
        notes.push_back(type.substr(colon + 1));
    }
    if (!option.get_default_str().empty()) {
        notes.push_back("default: " + option.get_default_str());
    }
    for (CLI::Option const* const other : option.get_excludes()) {
        notes.push_back("not with " + other->get_name());
    }
    out.description = option.get_description() + (notes.empty() ? "" : " (" + CLI::detail::join(notes, "; ") + ")");
    return out;
}

std::string wrapped(std::string const& text, std::size_t columns, std::string const& indent) {
    std::string out, line;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!line.empty() && indent.size() + line.size() + 1 + word.size() > columns) {
            out += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return line.empty() ? out : out + indent + line + "\n";
}

std::vector<std::string> paragraphs_of(std::string const& text) {
    std::vector<std::string> out;
    for (std::size_t start = 0; start < text.size();) {
        std::size_t const end = std::min(text.find("\n\n", start), text.size());
        out.push_back(text.substr(start, end - start));
        start = end + 2;
    }
    return out;
}

std::vector<CLI::Option const*> positionals(CLI::App const& app) {
    return app.get_options([](CLI::Option const* option) { return option->get_positional(); });
}

std::vector<CLI::Option const*> options_of_group(CLI::App const& app, std::string const& group) {
    return app.get_options([&](CLI::Option const* option) {
        return !group.empty() && option->get_group() == group && option->nonpositional();
    });
}

std::vector<std::string> option_groups(CLI::App const& app) {
    std::vector<std::string> groups = app.get_groups();
    std::erase_if(groups, [&](std::string const& group) { return options_of_group(app, group).empty(); });
    // The first option of all is --help: its group comes last.
    if (CLI::Option const* const help = app.get_help_ptr()) {
        std::stable_partition(groups.begin(), groups.end(),
                              [&](std::string const& group) { return group != help->get_group(); });
    }
    return groups;
}

} // namespace framelet
