#include "protocol/stream/token.h"

#include <chrono>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

class TokenFile : public testing::Test {
protected:
    std::filesystem::path const file_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("token_") + testing::UnitTest::GetInstance()->current_test_info()->name());

    void TearDown() override { std::filesystem::remove(file_); }
    void put(std::string const& content) { std::ofstream(file_, std::ios::binary) << content; }
    void expect_refused(std::string const& word, std::chrono::seconds patience = std::chrono::seconds(5)) {
        try {
            read_token_file(file_, patience);
            ADD_FAILURE() << "accepted, should name " << word;
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
        }
    }
};

TEST_F(TokenFile, FirstLineTrimmed) {
    for (char const* content : {"a secret of many", "a secret of many\n", " \ta secret of many \r\nmore\n"}) {
        put(content);
        EXPECT_EQ(read_token_file(file_), "a secret of many");
    }
    put(std::string(4096, 'x') + "\n");
    EXPECT_EQ(read_token_file(file_).size(), 4096u);
}

TEST_F(TokenFile, Refused) {
    expect_refused("cannot be read");
    for (char const* content : {"", "\n", "  \r\nsecret\n"}) {
        put(content);
        expect_refused("empty");
    }
    put("fifteen letters\n");
    expect_refused("--make-token");
    put(std::string(4097, 'x'));
    expect_refused("longer");
    put(std::string(1 << 20, 'x'));
    expect_refused("longer");
    put(std::string(16, '\x01'));
    expect_refused("UTF-8");
}

/// As of a shell's <(...), which may take a moment to say it.
TEST_F(TokenFile, APipeIsReadUpToItsFirstLine) {
    ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
    int const pipe = ::open(file_.c_str(), O_RDWR | O_CLOEXEC); // which never ends
    std::jthread const writer([pipe] {
        for (std::string const part : {"a secret ", "of many\nmore\n"}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            EXPECT_EQ(::write(pipe, part.data(), part.size()), static_cast<ssize_t>(part.size()));
        }
    });
    EXPECT_EQ(read_token_file(file_), "a secret of many");
    ::close(pipe);
}

TEST_F(TokenFile, APipeThatSaysNothingIsNotWaitedForForGood) {
    ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
    expect_refused("no line has come out of it for 1 s", std::chrono::seconds(1));
    int const pipe = ::open(file_.c_str(), O_RDWR | O_CLOEXEC);
    expect_refused("no line has come out of it for 1 s", std::chrono::seconds(1));
    ::close(pipe);
}

TEST_F(TokenFile, FolderIsRefused) {
    std::filesystem::create_directory(file_);
    expect_refused("cannot be read");
}

TEST(Token, MadeOnesAreLongAndDiffer) {
    std::string const token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    EXPECT_NE(token, make_token());
}

TEST(Token, TicketsDiffer) {
    Ticket const ticket = make_ticket();
    EXPECT_TRUE(ticket);
    EXPECT_NE(ticket, make_ticket());
    EXPECT_NE(ticket, (Ticket{ticket.high, ticket.low ^ 1}));
    EXPECT_NE(ticket, (Ticket{ticket.high ^ 1, ticket.low}));
    EXPECT_FALSE(Ticket{});
}

TEST(Token, Comparison) {
    EXPECT_TRUE(same_token("", ""));
    EXPECT_TRUE(same_token("secret", "secret"));
    EXPECT_FALSE(same_token("secret", "secreT"));
    EXPECT_FALSE(same_token("secret", "secret "));
    EXPECT_FALSE(same_token("", "secret"));
}

} // namespace
} // namespace framelet
