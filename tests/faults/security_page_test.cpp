// Checks docs/SECURITY.md: each promise names tests, and all that it names are there.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace framelet::test {
namespace {

std::filesystem::path const source = FRAMELET_SOURCE_DIR;

std::string text_of(std::filesystem::path const& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Names of all tests as suite.name, and of fuzz targets by their own names.
std::set<std::string> tests_of_the_sources() {
    std::set<std::string> names{"framelet-bench soak"};
    std::regex const test(R"(TEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
    for (auto const& entry : std::filesystem::recursive_directory_iterator(source / "tests")) {
        if (entry.path().extension() != ".cpp") {
            continue;
        }
        if (entry.path().filename().string().starts_with("fuzz_")) {
            names.insert(entry.path().stem().string());
        }
        std::string const text = text_of(entry.path());
        for (std::sregex_iterator match(text.begin(), text.end(), test), end; match != end; ++match) {
            names.insert((*match)[1].str() + "." + (*match)[2].str());
        }
    }
    return names;
}

TEST(SecurityPage, EveryPromiseNamesTestsThatAreThere) {
    std::set<std::string> const tests = tests_of_the_sources();
    ASSERT_TRUE(tests.contains("SecurityPage.EveryPromiseNamesTestsThatAreThere"));
    std::istringstream page(text_of(source / "docs/SECURITY.md"));
    std::regex const quoted("`([^`]+)`");
    int promises = 0;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with("| ") || line.starts_with("| promise")) {
            continue;
        }
        ++promises;
        std::string const named = line.substr(line.find(" | "));
        std::sregex_iterator name(named.begin(), named.end(), quoted), end;
        EXPECT_NE(name, end) << line;
        for (; name != end; ++name) {
            EXPECT_TRUE(tests.contains((*name)[1].str())) << (*name)[1].str();
        }
    }
    EXPECT_GT(promises, 20);
}

} // namespace
} // namespace framelet::test
