#include "protocol/stream/known_servers.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include <boost/asio/ip/address.hpp>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "common/files/regular_file.h"
#include "protocol/stream/user_folders.h"

namespace framelet {
namespace {

/// Stands in place of a fingerprint where an authority vouches for the certificate.
constexpr char const* vouched = "authorities";

/// The same for all spellings of an address.
std::string canonical(std::string server) {
    std::ranges::transform(server, server.begin(), [](char c) { return 'A' <= c && c <= 'Z' ? char(c + 32) : c; });
    std::size_t const colon = server.rfind(':');
    std::string host = server.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) {
        host = host.substr(1, host.size() - 2);
    }
    boost::system::error_code error;
    auto const address = boost::asio::ip::make_address(host, error);
    if (!error) {
        host = address.to_string();
    } else if (host.ends_with('.')) { // says that the name is whole
        host.pop_back();
    }
    return host + (colon == std::string::npos ? "" : server.substr(colon));
}

std::optional<std::string> find(std::filesystem::path const& file, std::string const& server) {
    RegularFile const opened(file);
    std::ifstream lines(opened.name());
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name, known;
        if (words >> name >> known && canonical(name) == canonical(server)) {
            return known;
        }
    }
    return std::nullopt;
}

/// True for a file whose last line has no end, as some editors leave it.
bool ends_amid_a_line(std::filesystem::path const& file) {
    RegularFile const opened(file);
    std::ifstream bytes(opened.name(), std::ios::binary | std::ios::ate);
    if (!bytes || bytes.tellg() <= 0) {
        return false;
    }
    bytes.seekg(-1, std::ios::end);
    return bytes.get() != '\n';
}

/// Adds a line for a server; false where it could not be written, or is not a file.
bool add(std::filesystem::path const& file, std::string const& server, std::string const& known) {
    constexpr int adds = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    int const descriptor = ::open(file.c_str(), adds, 0600);
    struct stat found {};
    bool const is_file = descriptor >= 0 && ::fstat(descriptor, &found) == 0 && S_ISREG(found.st_mode);
    std::string const line = (ends_amid_a_line(file) ? "\n" : "") + server + " " + known + "\n";
    // The line is written by one call, because other viewers may add theirs.
    bool const written = is_file && ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    ::close(descriptor);
    return written;
}

} // namespace

std::filesystem::path known_servers_file() {
    for (std::filesystem::path const& folder : state_folders()) {
        if (make_private_folder(folder)) {
            return folder / "known_servers";
        }
    }
    return {};
}

CertificateVerdict judge_certificate(std::filesystem::path const& file, std::string const& server,
                                     std::string const& fingerprint) {
    std::optional<std::string> const known = find(file, server);
    if (fingerprint.empty()) {
        if (!known) {
            add(file, server, vouched);
        }
        return {true, false, ""};
    }
    if (known == fingerprint) {
        return {true, false, ""};
    }
    if (known) {
        return {false, false,
                "the certificate of the server at " + server +
                    " is not the one that it had before: somebody may be between. If you know that it has a new "
                    "one, with the SHA-256 fingerprint " +
                    fingerprint + ", remove the line of " + server + " from '" + file.string() + "'"};
    }
    return {false, true,
            "no authority vouches for the certificate of the server at " + server +
                ", and it is new here. Its SHA-256 fingerprint is " + fingerprint +
                ": where the server printed the same, trust it where a terminal or framelet-viewer asks, or name the "
                "certificate with --tls-ca"};
}

void trust_certificate(std::filesystem::path const& file, std::string const& server, std::string const& fingerprint) {
    if (!add(file, server, fingerprint)) {
        throw InputError("there is no file to remember the certificate of the server at " + server + " in ('" +
                         file.string() + "' cannot be written): name the certificate with --tls-ca");
    }
}

} // namespace framelet
