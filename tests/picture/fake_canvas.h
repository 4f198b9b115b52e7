// A canvas that needs no graphics card: it paints in memory and forgets it. In: jobs. Out: reports.
#pragma once

#include <vector>

#include "common/picture/block_canvas.h"
#include "common/warp/warp_block.h"

namespace framelet {

class FakeCanvas final : public BlockCanvas {
public:
    bool begin(void const* owner, bool is_new, Viewport size) override {
        bool const is_blank = is_new || owner != owner_ || size != size_;
        owner_ = owner;
        size_ = size;
        return is_blank;
    }
    void paint(CanvasJobs const& jobs, std::vector<BlockReport>& reports) override {
        reports.clear();
        painted = asked = in_place = 0;
        for (RowJobs const& row : jobs.row_jobs) {
            for (BlockJob const& job : row.blocks) {
                if (fails) {
                    throw CanvasError("no");
                }
                WarpedBlock block;
                paint_warped_block(std::span(row.patches).subspan(job.first_patch, job.patches), job.column, job.row,
                                   jobs.viewport, block);
                BlockReport& report = reports.emplace_back();
                report.holes = job.is_in_place ? 0 : block.holes;
                for (std::int32_t const group : block.group) {
                    report.slots |= group < 0 ? 0 : 1u << slot_of_group(group);
                }
                painted += job.is_painted ? 1 : 0;
                in_place += job.is_in_place ? 1 : 0;
                ++asked;
            }
        }
    }

    bool fails = false;
    int painted = 0, asked = 0, in_place = 0; ///< blocks of the last picture

private:
    void const* owner_ = nullptr;
    Viewport size_{0, 0};
};

} // namespace framelet
