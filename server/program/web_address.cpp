#include "server/program/web_address.h"

#include <array>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "protocol/stream/user_folders.h"

namespace framelet {
namespace {

std::string machine_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

/// As addresses have it: letters and digits, of all else the bytes' numbers.
std::string percent_encoded(std::string_view text) {
    constexpr char const* digits = "0123456789ABCDEF";
    std::string out;
    for (char const c : text) {
        if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_') {
            out += c;
        } else {
            auto const byte = static_cast<unsigned char>(c);
            out += {'%', digits[byte >> 4], digits[byte & 15]};
        }
    }
    return out;
}

bool has_desktop() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

} // namespace

std::string web_address(std::string const& endpoint, bool is_encrypted, std::string const& token) {
    std::size_t const colon = endpoint.rfind(':');
    std::string host = endpoint.substr(0, colon);
    if (host == "0.0.0.0" || host == "[::]") {
        host = machine_name();
    }
    return (is_encrypted ? "https://" : "http://") + host + endpoint.substr(colon) + "/" +
           (token.empty() ? "" : "#token=" + percent_encoded(token));
}

WebAddressFile::WebAddressFile(std::string const& address) {
    std::string const text =
        "<!DOCTYPE html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; url=" + address +
        "\"><title>framelet</title>\n";
    for (std::filesystem::path const& folder : runtime_folders()) {
        if (!make_private_folder(folder)) {
            continue;
        }
        path_ = folder / ("web." + std::to_string(::getpid()) + ".html");
        ::unlink(path_.c_str()); // of a process that had this number before
        int const descriptor = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
        bool const is_written =
            descriptor >= 0 && ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
        ::close(descriptor);
        if (is_written) {
            return;
        }
        ::unlink(path_.c_str());
    }
    throw InputError("there is no folder of yours for the file that leads a browser to the page: set XDG_RUNTIME_DIR "
                     "to one");
}

WebAddressFile::~WebAddressFile() {
    ::unlink(path_.c_str());
}

bool open_in_browser(std::filesystem::path const& file) {
    if (!has_desktop()) {
        return false;
    }
    std::string program = "xdg-open";
    std::string path = file.string();
    std::array<char*, 3> arguments{program.data(), path.data(), nullptr};
    pid_t child = 0;
    return ::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) == 0;
}

} // namespace framelet
