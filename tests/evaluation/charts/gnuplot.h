// Runs gnuplot as a child process: script text in, picture files out.
#pragma once

#include <filesystem>
#include <string>

namespace framelet::bench {

/// Runs `gnuplot` (from PATH, no settings of the user's) on a script and waits for it. Throws InputError where gnuplot
/// is not installed or where the script fails; the message has gnuplot's own complaint.
void run_gnuplot(std::string const& script);

/// One drawing, whatever kind of file it is drawn to.
struct Plot {
    std::string data; ///< data blocks, defined once
    std::string commands; ///< run once for each file, from gnuplot's default settings
    int width = 1000; ///< pixels
    int height = 560; ///< pixels
};

/// Draws to `stem`.svg and `stem`.png (`stem` is a path without ending; dots in its name stay), in a folder that is
/// made where there is none. Throws InputError where a file cannot be written.
void render(Plot const& plot, std::filesystem::path const& stem);

/// A string constant of gnuplot's; control characters become blanks.
std::string quoted(std::string const& text);

/// Shortest decimal text that reads back as the same value, in no locale.
std::string number(double value);

} // namespace framelet::bench
