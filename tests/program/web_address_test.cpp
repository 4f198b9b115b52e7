#include "server/program/web_address.h"

#include <fstream>
#include <iterator>

#include <sys/stat.h>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(WebAddress, NamesTheEndpointAndKeepsTheTokenInTheFragment) {
    EXPECT_EQ(web_address("127.0.0.1:7070", false, ""), "http://127.0.0.1:7070/");
    EXPECT_EQ(web_address("[::1]:7070", true, "abc-1_2"), "https://[::1]:7070/#token=abc-1_2");
}

TEST(WebAddress, EncodesWhatAnAddressCannotHave) {
    EXPECT_EQ(web_address("127.0.0.1:1", false, "a b+\"<\xc3\xa4"), "http://127.0.0.1:1/#token=a%20b%2B%22%3C%C3%A4");
}

TEST(WebAddress, OfAllAddressesIsThatOfTheMachine) {
    std::string const address = web_address("0.0.0.0:7070", false, "");
    EXPECT_EQ(address.find("0.0.0.0"), std::string::npos);
    EXPECT_EQ(address, web_address("[::]:7070", false, ""));
}

TEST(WebAddressFile, LeadsThereIsOfThisUserAloneAndGoesAway) {
    std::filesystem::path path;
    {
        WebAddressFile const file("http://127.0.0.1:7070/#token=abc");
        path = file.path();
        struct stat status {};
        ASSERT_EQ(::stat(path.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777, 0600u);
        std::ifstream in(path);
        std::string const text{std::istreambuf_iterator<char>(in), {}};
        EXPECT_NE(text.find("url=http://127.0.0.1:7070/#token=abc\""), std::string::npos);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

} // namespace
} // namespace framelet
