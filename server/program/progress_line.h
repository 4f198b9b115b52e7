// The line that shows how far the loading of a scene is. In: what is being done, the share of it that is done, for how
// long it has been done. Out: text.
#pragma once

#include <string>
#include <string_view>

namespace framelet {

/// The line, at most 80 columns: what, a bar, percent, the time since it began and, after the first second, how long it
/// will take yet if it goes on as it did. `fraction` 0..1, or what is nearest to it.
std::string progress_line(std::string_view what, double fraction, double seconds);

} // namespace framelet
