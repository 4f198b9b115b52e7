#include "protocol/stream/known_servers.h"

#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

class KnownServers : public testing::Test {
protected:
    void TearDown() override { std::filesystem::remove(file_); }

    std::filesystem::path const file_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("known_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(KnownServers, ANewOneIsTrustedOnceTheUserSaysSo) {
    for (int i = 0; i < 2; ++i) {
        CertificateVerdict const asked = judge_certificate(file_, "one:7070", "AA:01");
        EXPECT_FALSE(asked.is_trusted);
        EXPECT_TRUE(asked.is_unknown) << "that it was asked about is not remembered";
        EXPECT_NE(asked.complaint.find("AA:01"), std::string::npos) << asked.complaint;
    }
    trust_certificate(file_, "one:7070", "AA:01");
    CertificateVerdict const again = judge_certificate(file_, "one:7070", "AA:01");
    EXPECT_TRUE(again.is_trusted);
    EXPECT_EQ(again.complaint, "");
    EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms(0600));
}

TEST_F(KnownServers, AnotherCertificateIsRefused) {
    trust_certificate(file_, "one:7070", "AA:01");
    trust_certificate(file_, "two:7070", "BB:02");
    CertificateVerdict const changed = judge_certificate(file_, "one:7070", "BB:02");
    EXPECT_FALSE(changed.is_trusted);
    EXPECT_FALSE(changed.is_unknown) << "this is not the user's to say with a click";
    for (std::string const& word : {std::string("one:7070"), std::string("BB:02"), file_.string()}) {
        EXPECT_NE(changed.complaint.find(word), std::string::npos) << changed.complaint;
    }
    EXPECT_TRUE(judge_certificate(file_, "one:7070", "AA:01").is_trusted) << "nothing has been forgotten";
}

TEST_F(KnownServers, AnotherSpellingIsNoOtherServer) {
    trust_certificate(file_, "one.example:7070", "AA:01");
    trust_certificate(file_, "[2001:DB8::0:1]:7070", "AA:01");
    for (char const* const same : {"ONE.example:7070", "one.example.:7070", "[2001:db8::1]:7070"}) {
        CertificateVerdict const other = judge_certificate(file_, same, "BB:02");
        EXPECT_FALSE(other.is_trusted || other.is_unknown) << same;
        EXPECT_TRUE(judge_certificate(file_, same, "AA:01").is_trusted) << same;
    }
    EXPECT_TRUE(judge_certificate(file_, "one.example:7071", "BB:02").is_unknown);
}

TEST_F(KnownServers, OneThatAnAuthorityVouchedForStaysSo) {
    EXPECT_TRUE(judge_certificate(file_, "one:7070", "").is_trusted);
    EXPECT_FALSE(judge_certificate(file_, "one:7070", "AA:01").is_trusted);
    EXPECT_TRUE(judge_certificate(file_, "one:7070", "").is_trusted);
}

/// Some editors leave the last line of a file without an end.
TEST_F(KnownServers, AFileWhoseLastLineHasNoEndIsAddedTo) {
    std::ofstream(file_) << "one:7070 AA:01";
    trust_certificate(file_, "two:7070", "BB:02");
    EXPECT_TRUE(judge_certificate(file_, "two:7070", "BB:02").is_trusted);
    EXPECT_FALSE(judge_certificate(file_, "two:7070", "CC:03").is_trusted) << "it has been remembered";
    EXPECT_TRUE(judge_certificate(file_, "one:7070", "AA:01").is_trusted);
}

TEST_F(KnownServers, APipeInItsPlaceIsNeitherReadNorWritten) {
    ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
    int const pipe = ::open(file_.c_str(), O_RDWR | O_CLOEXEC); // so that nobody waits for the other end
    std::string const line = "one:7070 AA:01\n";
    ASSERT_EQ(::write(pipe, line.data(), line.size()), static_cast<ssize_t>(line.size()));
    EXPECT_FALSE(judge_certificate(file_, "one:7070", "AA:01").is_trusted);
    EXPECT_THROW(trust_certificate(file_, "two:7070", "BB:02"), InputError);
    ::close(pipe);
    EXPECT_TRUE(judge_certificate(file_, "one:7070", "AA:01").is_unknown);
    EXPECT_THROW(trust_certificate(file_, "two:7070", "BB:02"), InputError);
}

TEST_F(KnownServers, WhatCannotBeRememberedIsNotTrusted) {
    std::filesystem::create_directory(file_);
    EXPECT_THROW(trust_certificate(file_, "one:7070", "AA:01"), InputError);
    EXPECT_THROW(trust_certificate("", "one:7070", "AA:01"), InputError);
    EXPECT_FALSE(judge_certificate("", "one:7070", "AA:01").is_trusted);
}

} // namespace
} // namespace framelet
