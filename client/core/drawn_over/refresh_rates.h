// How often a second each cell of the picture gets new samples, of about the last second. In: batches as they come,
// and the time. Out: rates, and a picture in grey that is washed with their colours. A value.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/framelet/framelet.h"
#include "common/image.h"

namespace framelet {

class RefreshRates {
public:
    /// Side of a cell, pixels; cells lie in rows from the picture's corner.
    static constexpr int side = framelet_side;
    /// Rates at the ends of the colours, a second. What is slower has none: the picture is grey there.
    static constexpr float most = 60, least = 0.1f;

    explicit RefreshRates(ImagePlane const& plane);

    /// Counts a batch of this plane. A framelet that covers a part of a cell counts as that part.
    void add(Batch const& batch);
    /// Says how late it is, seconds. Rates fade as time goes by.
    void advance(double now);

    float per_second(int column, int row) const { return rates_[index(column, row)]; }
    /// True while some rate has a colour, which fades.
    bool fades() const;
    /// Washes the picture, which has the viewport's size: yellow where much comes, over red to dark blue, on a
    /// logarithmic scale.
    void draw(Picture& picture) const;

private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }

    ImagePlane plane_;
    int columns_, rows_;
    std::vector<float> rates_;
    std::optional<double> now_;
};

} // namespace framelet
