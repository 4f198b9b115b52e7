#include "tests/evaluation/charts/gnuplot.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>
#include <sys/wait.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

namespace fs = std::filesystem;

void write_text(fs::path const& file, std::string_view text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) {
        throw InputError("cannot write '" + file.string() + "'");
    }
}

/// The message in gnuplot's output, which echoes the offending command before it says what is wrong with it: the line
/// that names a place in the script is the message, if there is one.
std::string complaint_in(std::string const& text) {
    std::istringstream stream(text);
    std::string first;
    for (std::string line; std::getline(stream, line);) {
        if (std::size_t const found = line.find("\" line "); found != std::string::npos) {
            return line.substr(found + 2);
        }
        first = first.empty() ? line : first;
    }
    return first.empty() ? "it gave no reason" : first;
}

std::string size_of(Plot const& plot) {
    return " size " + std::to_string(plot.width) + "," + std::to_string(plot.height) + " font 'DejaVu Sans,11'";
}

} // namespace

void run_gnuplot(std::string const& script) {
    // The script is in a file that has no name, which the child inherits: nothing is left behind, whatever happens.
    std::unique_ptr<FILE, int (*)(FILE*)> const file(std::tmpfile(), std::fclose);
    if (!file || std::fwrite(script.data(), 1, script.size(), file.get()) != script.size() || std::fflush(file.get())) {
        throw InputError("cannot write a script for gnuplot into a temporary file");
    }
    std::string const command =
        "gnuplot -d /dev/fd/" + std::to_string(fileno(file.get())) + " 2>&1 >/dev/null </dev/null";
    FILE* const pipe = popen(command.c_str(), "r");
    FRAMELET_CHECK(pipe != nullptr);
    std::string complaints;
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
        complaints += buffer.data();
    }
    int const status = pclose(pipe);
    constexpr int not_found = 127; // exit code of the shell
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
        throw InputError("gnuplot was not found: install it (Debian: gnuplot-nox) to draw charts");
    }
    if (status != 0) {
        throw InputError("gnuplot failed: " + complaint_in(complaints));
    }
}

void render(Plot const& plot, std::filesystem::path const& stem) {
    std::string const svg = stem.string() + ".svg";
    std::string const png = stem.string() + ".png";
    std::error_code ignored; // where there is no folder, the writing below fails and says so
    fs::create_directories(stem.parent_path(), ignored);
    write_text(svg, ""); // tried first, since gnuplot's complaint would not name the file
    write_text(png, "");
    std::string const size = size_of(plot);
    std::string script = "set encoding utf8\n" + plot.data;
    script += "set terminal svg enhanced background '#ffffff'" + size + "\n";
    script += "set output " + quoted(svg) + "\n" + plot.commands + "unset output\nreset\n";
    script += "png = strstrt(GPVAL_TERMINALS, 'pngcairo') > 0 ? 'pngcairo' : 'png truecolor'\n";
    script += "set terminal @png enhanced background '#ffffff'" + size + "\n";
    script += "set output " + quoted(png) + "\n" + plot.commands + "unset output\n";
    run_gnuplot(script);
}

std::string quoted(std::string const& text) {
    std::string out = "'";
    for (char const c : text) {
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        if (c == '\'') {
            out += c;
        }
    }
    return out + "'";
}

std::string number(double value) {
    std::array<char, 32> buffer;
    auto const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

} // namespace framelet::bench
