#include "tests/evaluation/methods/response/transport.h"

namespace framelet {

void transport(std::span<double> changes) {
    double asked = 0, given = 0; // magnitudes of the positive and of the negative changes
    for (double const change : changes) {
        (change > 0 ? asked : given) += change > 0 ? change : -change;
    }
    for (double& change : changes) {
        if (change > 0 && asked > given) {
            change *= given / asked;
        } else if (change < 0 && given > asked) {
            change *= asked / given;
        }
    }
}

} // namespace framelet
