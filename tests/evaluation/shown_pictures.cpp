#include "tests/evaluation/shown_pictures.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {

ShownPictures show_method(BenchScene& scene, std::string const& name, RunParameters const& parameters, double machine,
                          CostTable const& costs) {
    auto const method = make_method(name, method_setup(parameters, machine, costs));
    ShownPictures result;
    result.pictures.resize(reference_count(parameters));
    result.run = run_method(scene, *method, parameters, machine,
                            [&](std::size_t index, Picture const& shown, double) { result.pictures[index] = shown; });
    return result;
}

std::vector<Picture> read_pictures(Reference const& reference, std::size_t count) {
    FRAMELET_CHECK(reference.size() >= count);
    std::vector<Picture> pictures(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { pictures[i] = reference.picture(i); });
    return pictures;
}

std::vector<double> errors_of(std::vector<Picture> const& shown, std::vector<Picture> const& reference) {
    FRAMELET_CHECK(reference.size() >= shown.size());
    std::vector<double> errors(shown.size());
    tbb::parallel_for(std::size_t{0}, shown.size(),
                      [&](std::size_t i) { errors[i] = mean_squared_error(shown[i], reference[i]); });
    return errors;
}

double median_of(std::vector<double> values) {
    FRAMELET_CHECK(!values.empty());
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace framelet::bench
