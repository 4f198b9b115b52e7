#include "common/command_line/command_line.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/command_line/bash_completion.h"
#include "common/command_line/man_page.h"
#include "common/command_line/number_range.h"
#include "common/counted.h"

namespace framelet {
namespace {

struct Line {
    CLI::App app{"Does something.", "program"};
    std::string host;
    double lag = 0;
    int port = 7;
    bool plain = false;

    explicit Line(bool needs_host = true) {
        prepare_command_line(app);
        app.option_defaults()->group("Places");
        app.add_option("HOST[:PORT]", host, "Where to look")->required(needs_host);
        app.add_option("--port", port, "A port of which much is to be said, so much that it takes more than one line")
            ->check(number_in(0, 65535))
            ->capture_default_str();
        app.option_defaults()->group("Looks");
        CLI::Option* const other = app.add_flag("--plain", plain, "Nothing of that");
        app.add_flag("--lag{100}", lag, "Late")->option_text("MS")->check(number_in(0.0, 1000.0))->excludes(other);
    }

    void read(std::vector<char const*> words) {
        words.insert(words.begin(), "program");
        parse_command_line(app, static_cast<int>(words.size()), words.data());
    }

    std::string complaint(std::vector<char const*> const& words) {
        try {
            read(words);
            return "";
        } catch (CLI::ParseError const& error) {
            return error.what();
        }
    }
};

TEST(CommandLine, AnOptionalValueIsTakenInBothSpellings) {
    struct Case {
        std::vector<char const*> words;
        double lag;
    };
    for (Case const& one : {Case{{"here"}, 0}, Case{{"here", "--lag"}, 100}, Case{{"here", "--lag=50"}, 50},
                            Case{{"here", "--lag", "50"}, 50}, Case{{"--lag", "50", "here"}, 50},
                            Case{{"--lag", "here"}, 100}, Case{{"--port", "8", "--lag", "here", "--port", "9"}, 100}}) {
        Line line;
        line.app.get_option("--port")->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
        EXPECT_EQ(line.complaint(one.words), "");
        EXPECT_EQ(line.lag, one.lag);
        EXPECT_EQ(line.host, "here");
    }
    Line line(false);
    line.read({"--lag", "50"});
    EXPECT_EQ(line.lag, 50);
    EXPECT_EQ(line.host, "");
}

TEST(CommandLine, WhatIsUnknownIsNamedInItsOrderWithWhatItMayBe) {
    EXPECT_EQ(Line().complaint({"here", "--overlay", "foo"}), "unknown: --overlay foo");
    EXPECT_EQ(Line().complaint({"here", "--plian"}), "unknown: --plian; did you mean --plain?");
    EXPECT_EQ(Line().complaint({"here", "--prt=8"}), "unknown: --prt=8; did you mean --port?");
    CLI::App app("Does something.", "program");
    prepare_command_line(app);
    app.require_subcommand(1);
    app.add_subcommand("view", "Show it");
    for (auto const& [words, says] :
         {std::pair(std::vector<char const*>{"program", "vew", "a"}, "unknown: vew a; did you mean view?"),
          std::pair(std::vector<char const*>{"program"}, "subcommand is required"),
          std::pair(std::vector<char const*>{"program", "view", "--hlp"}, "unknown: --hlp; did you mean --help?")}) {
        try {
            parse_command_line(app, static_cast<int>(words.size()), words.data());
            ADD_FAILURE() << says;
        } catch (CLI::ParseError const& error) {
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
        }
    }
}

TEST(CommandLine, AValueThatCannotBeIsNamedWithThoseThatCan) {
    EXPECT_EQ(Line().complaint({"here", "--lag", "5000"}), "--lag: '5000' is not a number from 0 to 1000");
    EXPECT_EQ(Line().complaint({"here", "--lag", "much"}), "--lag: 'much' is not a number from 0 to 1000");
    EXPECT_EQ(Line().complaint({"here", "--lag=nan"}), "--lag: 'nan' is not a number from 0 to 1000");
    for (std::string const port : {"99999", "-1", "1.5", "x"}) {
        EXPECT_EQ(Line().complaint({"here", "--port", port.c_str()}),
                  "--port: '" + port + "' is not a whole number from 0 to 65535");
    }
    EXPECT_EQ(Line().complaint({}), "HOST[:PORT] is required");
}

TEST(CommandLine, HelpHasGroupsAndDefaultsAndFitsTheScreen) {
    Line const line;
    std::istringstream help(line.app.help());
    for (std::string text; std::getline(help, text);) {
        EXPECT_LE(text.size(), help_columns) << text;
    }
    for (char const* const part : {"\nPlaces:\n  --port NUMBER ", "(0 to 65535; default: 7)\n", "\nLooks:\n  --plain ",
                                   "\n  --lag [MS]                  Late (0 to 1000; not with --plain)\n",
                                   "Usage: program [OPTIONS] HOST[:PORT]\n"}) {
        EXPECT_NE(help.str().find(part), std::string::npos) << part << " in\n" << help.str();
    }
}

/// The complaint about a file with this text, read as --config beside these words.
std::string complaint_of_file(Line& line, std::string const& text, std::vector<char const*> words = {}) {
    std::string const file =
        testing::TempDir() + "framelet_options" + std::to_string(::getpid()) + ".toml"; // the cases run side by side
    std::ofstream(file) << text;
    add_config_option(line.app);
    words.insert(words.end(), {"--config", file.c_str()});
    std::string const complaint = line.complaint(words);
    std::filesystem::remove(file);
    return complaint;
}

TEST(CommandLine, AFileSetsWhatTheLineDoesNot) {
    Line line;
    EXPECT_EQ(complaint_of_file(line, "# a remark\nhost = \"over there\"\nport = 9\nplain = true\n", {"--port", "8"}),
              "");
    EXPECT_EQ(line.host, "over there");
    EXPECT_EQ(line.port, 8);
    EXPECT_TRUE(line.plain);
    for (auto const& [value, lag] : {std::pair("50", 50.0), std::pair("true", 100.0), std::pair("false", 0.0)}) {
        Line flag;
        EXPECT_EQ(complaint_of_file(flag, std::string("plain = false\nlag = ") + value, {"here"}), "");
        EXPECT_EQ(flag.lag, lag);
        EXPECT_FALSE(flag.plain);
    }
    Line off;
    EXPECT_EQ(complaint_of_file(off, "plain = true", {"here", "--plain=false"}), "");
    EXPECT_FALSE(off.plain);
}

TEST(CommandLine, WhatIsWrongInAFileIsNamedWithFileAndKey) {
    struct Case {
        char const* text;
        char const* says;
    };
    for (auto const& [text, says] :
         {Case{"prot = 1", "no option 'prot'"}, Case{"port = 99999", "port: '99999' is not a whole number"},
          Case{"port = 1 2", "port: it takes one value"}, Case{"port", "port: 'true' is not"},
          Case{"plain = perhaps", "plain: 'perhaps' is neither"}, Case{"[places]\nport = 1", "'places'"},
          Case{"help = true", "no option 'help'"}, Case{"config = \"other\"", "no option 'config'"}}) {
        Line line;
        std::string const complaint = complaint_of_file(line, text, {"here"});
        EXPECT_NE(complaint.find(says), std::string::npos) << complaint;
        EXPECT_NE(complaint.find(".toml'"), std::string::npos) << complaint;
    }
}

/// A program with a command, and with texts that roff and the shell would take for their own.
struct Commands {
    CLI::App app{"Does 'this'. And that.", "framelet-program"};
    ProgramNotes notes{"One.\n\n.Two \\three --four ~.", {{0, "fine"}, {2, "bad usage"}}, {"other"}};
    std::vector<std::string> scenes;
    std::string file;

    Commands() {
        prepare_command_line(app, notes);
        CLI::App* const command = app.add_subcommand("show", "Show it");
        command->option_defaults()->group("Places");
        command->add_option("SCENE", scenes, "What to show")->required();
        command->add_option("--from", file, "Where from")->type_name("FILE")->default_str("here");
    }
};

TEST(ManPage, HasTheSectionsAndEscapesWhatIsNotRoff) {
    Commands const program;
    std::string const page = man_page(program.app, program.notes);
    for (char const* const part :
         {".TH \"FRAMELET-PROGRAM\" 1 ", ".SH NAME\nframelet\\-program \\-\ndoes \\&'this'\n",
          "\\fBframelet\\-program show\\fR [\\fIOPTIONS\\fR] \\fISCENE\\fR...\n",
          "One.\n.PP\n\\&.Two \\ethree \\-\\-four \\(ti.\n",
          ".SS Of show: Places\n.TP\n\\fB\\-\\-from\\fR \\fIFILE\\fR\nWhere from (default: here)\n",
          ".SH \"EXIT STATUS\"\n.TP\n.B 0\nfine\n", ".SH \"SEE ALSO\"\n.BR other (1)\n"}) {
        EXPECT_NE(page.find(part), std::string::npos) << part << " in\n" << page;
    }
    EXPECT_EQ(page.find("help-as"), std::string::npos);
    EXPECT_NE(man_page(Line().app, {}).find("\\fBprogram\\fR [\\fIOPTIONS\\fR] \\fIHOST[:PORT]\\fR\n"),
              std::string::npos)
        << "one of it";
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 80u) << line;
    }
}

TEST(Completion, KnowsCommandsOptionsAndFiles) {
    Commands const program;
    std::string const script = bash_completion(program.app);
    for (char const* const part : {"complete -F _framelet_program framelet-program\n", "--from) _filedir; return ;;\n",
                                   "compgen -W 'show' ", "compgen -W '--from -h --help' ", "== *\" show \"*"}) {
        EXPECT_NE(script.find(part), std::string::npos) << part << " in\n" << script;
    }
    EXPECT_NE(bash_completion(Line().app).find("--port) return ;;\n"), std::string::npos);
}

TEST(Counted, OneIsNoPlural) {
    EXPECT_EQ(counted(1, "camera"), "1 camera");
    EXPECT_EQ(counted(0, "camera"), "0 cameras");
    EXPECT_EQ(counted(2, "batch", "batches"), "2 batches");
    EXPECT_EQ(counted(999, "triangle"), "999 triangles");
    EXPECT_EQ(counted(1234567, "triangle"), "1,234,567 triangles");
}

} // namespace
} // namespace framelet
