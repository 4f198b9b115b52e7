// Tests that a picture is the same, byte by byte, whatever the processor that the painters were compiled for.
#include "tests/picture/painted_bytes.h"

#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

namespace framelet {
namespace {

std::vector<std::uint8_t> printed_by(char const* program) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> const pipe(::popen(program, "r"), ::pclose);
    std::vector<std::uint8_t> out;
    std::vector<std::uint8_t> part(1 << 16);
    while (std::size_t const count = pipe ? std::fread(part.data(), 1, part.size(), pipe.get()) : 0) {
        out.insert(out.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return out;
}

TEST(PaintedBytes, AreThoseOfTheOldestProcessor) {
    std::vector<std::uint8_t> const here = painted_bytes();
    std::vector<std::uint8_t> const oldest = printed_by(FRAMELET_PAINTED_BYTES);
    ASSERT_EQ(here.size(), oldest.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        differing += here[i] != oldest[i] ? 1 : 0;
    }
    EXPECT_EQ(differing, 0u) << "of " << here.size();
}

} // namespace
} // namespace framelet
