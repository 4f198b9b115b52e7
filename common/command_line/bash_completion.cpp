#include "common/command_line/bash_completion.h"

#include <algorithm>
#include <map>

#include "common/command_line/option_text.h"

namespace framelet {
namespace {

/// Shell code that completes the word after an option, by what the option says of its value.
std::string action_for(std::string const& value) {
    return value == "FILE" ? "_filedir; " : value == "FOLDER" ? "_filedir -d; " : "";
}

std::string words_of(std::vector<std::string> const& words) {
    return "COMPREPLY=($(compgen -W '" + CLI::detail::join(words, " ") + "' -- \"$cur\"))";
}

/// Shell code that completes a word that stands alone.
std::string action_alone(CLI::App const& app) {
    std::vector<std::string> commands;
    for (CLI::App const* const command : app.get_subcommands({})) {
        commands.push_back(command->get_name());
    }
    if (!commands.empty()) {
        return words_of(commands);
    }
    std::vector<CLI::Option const*> const alone = positionals(app);
    bool const host = !alone.empty() && alone.front()->get_name(true).starts_with("HOST");
    return alone.empty() ? ":" : host ? "_known_hosts_real -- \"$cur\"" : "_filedir";
}

std::string body(CLI::App const& app, std::string const& indent) {
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> by_action;
    for (std::string const& group : option_groups(app)) {
        for (CLI::Option const* const option : options_of_group(app, group)) {
            OptionText const text = option_text(*option);
            names.insert(names.end(), text.names.begin(), text.names.end());
            if (!text.value.empty() && text.value.front() != '[') {
                auto& same = by_action[action_for(text.value)];
                same.insert(same.end(), text.names.begin(), text.names.end());
            }
        }
    }
    std::string out;
    if (!by_action.empty()) {
        out += indent + "case $prev in\n";
        for (auto const& [action, options] : by_action) {
            out += indent + "    " + CLI::detail::join(options, "|") + ") " + action + "return ;;\n";
        }
        out += indent + "esac\n";
    }
    out += indent + "$split && return\n";
    out += indent + "if [[ $cur == -* ]]; then\n" + indent + "    " + words_of(names) + "\n";
    out += indent + "else\n" + indent + "    " + action_alone(app) + "\n" + indent + "fi\n";
    return out;
}

} // namespace

std::string bash_completion(CLI::App const& app) {
    std::string function = "_" + app.get_name();
    std::ranges::replace(function, '-', '_');
    std::string out = "# bash completion for " + app.get_name() + "\n" + function + "()\n{\n";
    out += "    local cur prev words cword split\n    _init_completion -s || return\n";
    for (CLI::App const* const command : app.get_subcommands({})) {
        out += "    if [[ \" ${words[*]:1:cword-1} \" == *\" " + command->get_name() + " \"* ]]; then\n";
        out += body(*command, "        ") + "        return\n    fi\n";
    }
    return out + body(app, "    ") + "} &&\ncomplete -F " + function + " " + app.get_name() + "\n";
}

} // namespace framelet
