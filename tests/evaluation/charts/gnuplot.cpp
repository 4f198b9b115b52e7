#include "tests/evaluation/charts/gnuplot.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes when it goes out of scope.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "framelet-gnuplot-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw InputError("cannot make a folder in '" + fs::temp_directory_path().string() +
                             "': " + std::strerror(errno));
        }
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    fs::path const& path() const { return path_; }

private:
    fs::path path_;
};

void write_text(fs::path const& file, std::string_view text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) {
        throw InputError("cannot write '" + file.string() + "'");
    }
}

/// gnuplot echoes the offending command before it says what is wrong with it: the line that names a place in the script
/// is the message, if there is one.
std::string complaint_in(fs::path const& file) {
    std::ifstream stream(file);
    std::string first;
    for (std::string line; std::getline(stream, line);) {
        if (std::size_t const place = line.find("\" line "); place != std::string::npos) {
            return line.substr(place + 2);
        }
        if (first.empty()) {
            first = line;
        }
    }
    return first.empty() ? "it gave no reason" : first;
}

/// The child's exit status as waitpid gives it.
int run(fs::path const& script, fs::path const& complaints) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_CREAT, 0600);
    std::string name = "gnuplot", defaults = "-d", file = script.string();
    std::array<char*, 4> arguments{name.data(), defaults.data(), file.data(), nullptr};
    pid_t child = 0;
    int const error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT) {
        throw InputError("gnuplot was not found: install it (Debian: gnuplot-nox) to draw charts");
    }
    if (error != 0) {
        throw InputError(std::string("cannot start gnuplot: ") + std::strerror(error));
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        FRAMELET_CHECK(errno == EINTR);
    }
    return status;
}

std::string size_of(Plot const& plot) {
    return " size " + std::to_string(plot.width) + "," + std::to_string(plot.height) + " font 'DejaVu Sans,11'";
}

} // namespace

void run_gnuplot(std::string const& script) {
    TemporaryFolder const folder;
    fs::path const file = folder.path() / "script.gp";
    fs::path const complaints = folder.path() / "stderr.txt";
    write_text(file, script);
    if (run(file, complaints) != 0) {
        throw InputError("gnuplot failed: " + complaint_in(complaints));
    }
}

void render(Plot const& plot, std::filesystem::path const& stem) {
    std::string const svg = stem.string() + ".svg";
    std::string const png = stem.string() + ".png";
    write_text(svg, ""); // gnuplot's complaint would not name the file
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
