#include "client/window/file_dialog.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

/// All that comes until nobody has the other end of the pipe any more.
std::string read_all(int descriptor) {
    std::string out;
    std::array<char, 4096> bytes;
    for (;;) {
        ssize_t const count = ::read(descriptor, bytes.data(), bytes.size());
        if (count > 0) {
            out.append(bytes.data(), static_cast<std::size_t>(count));
        } else if (count == 0 || errno != EINTR) {
            return out;
        }
    }
}

/// A program that asks for files and prints their names, a line each.
struct DialogProgram {
    std::filesystem::path file;
    std::vector<std::string> arguments;
};

DialogProgram find_dialog() {
    try {
        return {find_program("zenity"), {"--file-selection", "--multiple", "--separator=\n", "--title=Open a scene"}};
    } catch (InputError const&) {
    }
    try {
        return {find_program("kdialog"),
                {"--title", "Open a scene", "--multiple", "--separate-output", "--getopenfilename", "."}};
    } catch (InputError const&) {
        throw InputError("there is no program that asks for files: install zenity or kdialog, or drop the file here");
    }
}

} // namespace

void FileDialog::open() {
    if (answer_.valid()) {
        return;
    }
    DialogProgram const dialog = find_dialog();
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
    }
    try {
        program_.emplace(dialog.file, dialog.arguments, ChildFiles{.output = pipe[1], .errors = {}, .is_alone = true});
    } catch (...) {
        ::close(pipe[0]);
        ::close(pipe[1]);
        throw;
    }
    ::close(pipe[1]);
    answer_ = std::async(std::launch::async, [from = pipe[0], tell = on_answer_] {
        std::string out = read_all(from);
        ::close(from);
        tell();
        return out;
    });
}

std::vector<std::string> FileDialog::poll() {
    std::vector<std::string> files;
    if (answer_.valid() && answer_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        std::istringstream lines(answer_.get());
        program_.reset();
        for (std::string line; std::getline(lines, line);) {
            if (!line.empty()) {
                files.push_back(line);
            }
        }
    }
    return files;
}

} // namespace framelet
