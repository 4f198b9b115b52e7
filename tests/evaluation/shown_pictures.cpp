#include "tests/evaluation/shown_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/rival_choice.h"

namespace framelet::bench {

ShownPictures show_method(BenchScene& scene, std::string const& name, RunParameters const& parameters, double machine,
                          CostTable const& costs) {
    auto const method = make_method(name, method_setup(parameters, machine, costs));
    ShownPictures result;
    result.rivals = parameters.rivals;
    result.pictures.resize(reference_count(parameters));
    result.run = run_method(scene, *method, parameters, machine,
                            [&](std::size_t index, Picture const& shown, double) { result.pictures[index] = shown; });
    return result;
}

ShownPictures show_best(BenchScene& scene, std::string const& name, RunParameters const& parameters, double machine,
                        CostTable const& costs, std::vector<Picture> const& truth) {
    ShownPictures best;
    double least = INFINITY;
    for (RivalParts const& choice : rival_choices(name, parameters.rivals)) {
        RunParameters chosen = parameters;
        chosen.rivals = choice;
        ShownPictures shown = show_method(scene, name, chosen, machine, costs);
        std::vector<double> const errors = errors_of(shown.pictures, truth);
        double const error = std::accumulate(errors.begin(), errors.end(), 0.0);
        if (error < least) {
            least = error;
            best = std::move(shown);
        }
    }
    return best;
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
