#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

/// What the kernel notes of the mapping that holds this address: "VmFlags" of /proc/self/smaps.
std::string flags_at(void const* memory) {
    auto const wanted = reinterpret_cast<std::uintptr_t>(memory);
    std::ifstream maps("/proc/self/smaps");
    bool is_here = false;
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t begin = 0, end = 0;
        char dash = 0;
        if (std::istringstream range(line); range >> std::hex >> begin >> dash >> end && dash == '-') {
            is_here = begin <= wanted && wanted < end;
        } else if (is_here && line.starts_with("VmFlags:")) {
            return line + ' ';
        }
    }
    return "";
}

TEST(HugePages, LargeBlocksAskForThem) {
    if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) {
        GTEST_SKIP() << "this system has none";
    }
    std::vector<char> const large(64 << 20);
    EXPECT_NE(flags_at(large.data() + large.size() / 2).find(" hg "), std::string::npos);
    std::vector<char> const small(1 << 20);
    EXPECT_EQ(flags_at(small.data() + small.size() / 2).find(" hg "), std::string::npos);
}

TEST(HugePages, WhatCannotBeHadIsThrown) {
    std::size_t volatile const absurd = std::numeric_limits<std::ptrdiff_t>::max();
    EXPECT_THROW(::operator delete(::operator new(absurd)), std::bad_alloc);
    EXPECT_EQ(::operator new(absurd, std::nothrow), nullptr);
    ::operator delete(::operator new(0));
}

} // namespace
} // namespace framelet
