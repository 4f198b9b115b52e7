// Tests how names of files are written for a shell: bash reads what was meant.
#include "server/program/shell_word.h"

#include <cstdio>
#include <memory>

#include <gtest/gtest.h>
#include <unistd.h>

namespace framelet {
namespace {

/// The text that bash takes a word for.
std::string read_by_bash(std::string const& word) {
    std::string const file = testing::TempDir() + "shell_word_" + std::to_string(::getpid());
    {
        std::unique_ptr<std::FILE, int (*)(std::FILE*)> script(std::fopen(file.c_str(), "w"), std::fclose);
        std::fprintf(script.get(), "printf '%%s' %s\n", word.c_str());
    }
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(::popen(("bash " + file).c_str(), "r"), ::pclose);
    std::string text;
    for (int c = 0; (c = std::fgetc(out.get())) != EOF;) {
        text += static_cast<char>(c);
    }
    std::remove(file.c_str());
    return text;
}

TEST(ShellWord, PlainNamesStayAsTheyAre) {
    EXPECT_EQ(shell_word("scenes/windmill-2.glb"), "scenes/windmill-2.glb");
    EXPECT_EQ(shell_word("m\xc3\xbchle.glb"), "m\xc3\xbchle.glb");
}

TEST(ShellWord, OthersAreQuoted) {
    EXPECT_EQ(shell_word("my house.glb"), "'my house.glb'");
    EXPECT_EQ(shell_word("it's.glb"), "'it'\\''s.glb'");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("red\033[31m7.glb"), "$'red\\033[31m7.glb'");
}

TEST(ShellWord, BashReadsWhatWasMeant) {
    std::string every = "\x1b]0;title\x07 it's \\n \n";
    for (char c = 1; c < 127; ++c) {
        every += c;
    }
    for (std::string const& name : {every, std::string("a b'c\\d\"e$f`g*h"), std::string("plain.glb")}) {
        std::string const word = shell_word(name);
        EXPECT_EQ(word.find('\n'), std::string::npos);
        EXPECT_EQ(word.find('\033'), std::string::npos);
        EXPECT_EQ(read_by_bash(word), name);
    }
}

} // namespace
} // namespace framelet
