#include "tests/evaluation/soak/memory_judgement.h"

#include <gtest/gtest.h>

namespace framelet::bench {
namespace {

/// So many calms a quarter, each holding `slope` bytes more than the one before, beside what its storm leaves.
std::array<std::vector<double>, 4> calms(std::size_t a_quarter, double slope) {
    std::array<std::vector<double>, 4> bytes;
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        for (std::size_t i = 0; i < a_quarter; ++i) {
            double const left_by_storm = 3e6 * static_cast<double>(i % 3);
            double const noise = 1e5 * static_cast<double>((quarter + i) % 2);
            bytes[quarter].push_back(100e6 + left_by_storm + noise +
                                     slope * static_cast<double>(quarter * a_quarter + i));
        }
    }
    return bytes;
}

TEST(MemoryJudgement, SaysThatTooFewCalmsAreNotJudged) {
    for (std::size_t const a_quarter : {0u, 1u, 4u}) {
        MemoryJudgement const judged = judge_memory(calms(a_quarter, 50e6), "the server's");
        EXPECT_FALSE(judged.growth);
        EXPECT_FALSE(judged.grows);
        EXPECT_NE(judged.text.find("the server's memory is NOT JUDGED: " + std::to_string(a_quarter) + " pairs"),
                  std::string::npos)
            << judged.text;
    }
}

TEST(MemoryJudgement, ALeakGrowsAndWhatStormsLeaveDoesNot) {
    for (std::size_t const a_quarter : {5u, 60u}) {
        auto const a_round = 5e6 / static_cast<double>(a_quarter);
        MemoryJudgement const leak = judge_memory(calms(a_quarter, a_round), "the server's");
        EXPECT_TRUE(leak.grows) << leak.text;
        ASSERT_TRUE(leak.growth);
        EXPECT_NEAR(leak.growth->mean, 5e6, 1e5);
        MemoryJudgement const still = judge_memory(calms(a_quarter, 0), "the server's");
        EXPECT_FALSE(still.grows) << still.text;
        EXPECT_NE(still.text.find(std::to_string(a_quarter) + " pairs"), std::string::npos) << still.text;
    }
}

/// A round more in one of the quarters has no partner.
TEST(MemoryJudgement, ComparesOnlyWhatHasAPartner) {
    auto bytes = calms(5, 0);
    bytes[3].push_back(900e6);
    EXPECT_FALSE(judge_memory(bytes, "the server's").grows);
    bytes[3].resize(4);
    EXPECT_FALSE(judge_memory(bytes, "the server's").growth);
}

} // namespace
} // namespace framelet::bench
