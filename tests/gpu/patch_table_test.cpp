#include "client/gpu/patch_table.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(PatchTable, TheFirstPatchOfAGroupLeadsIt) {
    std::vector<std::int32_t> groups;
    std::vector<std::uint32_t> leaders;
    std::vector<std::uint32_t> found;
    std::uint32_t index = 0;
    for (std::int32_t const group : {7, 5, 7, 9, 5}) {
        found.push_back(leader_of(group, index++, groups, leaders));
    }
    EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 1, 0, 3, 1}));
    EXPECT_EQ(leader_of(100, 300, groups, leaders), PatchTable::most_claims - 1) << "no more bits than that";
}

} // namespace
} // namespace framelet
