#include "protocol/stream/token.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <poll.h>
#include <unistd.h>

#include "common/error.h"
#include "common/one_line.h"
#include "protocol/messages/text_limits.h"

namespace framelet {
namespace {

/// Fills them with what nobody can guess. Throws std::runtime_error where there is none to be had, as without memory.
void fill_randomly(unsigned char* bytes, std::size_t count) {
    if (RAND_bytes(bytes, static_cast<int>(count)) != 1) {
        throw std::runtime_error("the system has no random numbers or no memory left");
    }
}

struct OpenFile {
    explicit OpenFile(std::filesystem::path const& file)
        : descriptor(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
    ~OpenFile() {
        if (descriptor >= 0) {
            ::close(descriptor);
        }
    }
    OpenFile(OpenFile const&) = delete;
    OpenFile& operator=(OpenFile const&) = delete;
    int const descriptor;
};

/// The beginning of a file or a pipe: a line, all there is, or more than a line may have. Throws InputError where it
/// cannot be read; `what` is for its message.
std::string read_beginning(std::filesystem::path const& file, std::string const& what, std::chrono::seconds patience) {
    using std::chrono::steady_clock;
    OpenFile const open(file);
    auto const end = steady_clock::now() + patience;
    std::string text;
    std::array<char, 512> some;
    while (text.size() < max_token_bytes + some.size() && text.find('\n') == std::string::npos) {
        auto const left = std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now());
        pollfd wanted{open.descriptor, POLLIN, 0}; // one that has not been opened is passed over
        if (open.descriptor >= 0 && ::poll(&wanted, 1, std::max(0, static_cast<int>(left.count()))) == 0) {
            throw InputError(what + " cannot be read: no line has come out of it for " +
                             std::to_string(patience.count()) + " s");
        }
        ssize_t const bytes = ::read(open.descriptor, some.data(), some.size());
        if (bytes < 0 && errno != EINTR && errno != EAGAIN) {
            throw InputError(what + " cannot be read");
        }
        if (bytes == 0) {
            break;
        }
        text.append(some.data(), static_cast<std::size_t>(std::max<ssize_t>(bytes, 0)));
    }
    return text;
}

} // namespace

bool same_token(std::string_view left, std::string_view right) {
    return left.size() == right.size() && CRYPTO_memcmp(left.data(), right.data(), left.size()) == 0;
}

std::string make_token() {
    std::array<unsigned char, 16> random{};
    fill_randomly(random.data(), random.size());
    std::string token;
    for (unsigned char const byte : random) {
        token += "0123456789abcdef"[byte >> 4];
        token += "0123456789abcdef"[byte & 15];
    }
    return token;
}

Ticket make_ticket() {
    Ticket ticket;
    fill_randomly(reinterpret_cast<unsigned char*>(&ticket), sizeof ticket);
    return ticket;
}

std::string token_in(std::string line, std::string const& what) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    line.erase(0, line.find_first_not_of(" \t"));
    if (line.size() < min_token_bytes) {
        throw InputError(what + " is shorter than " + std::to_string(min_token_bytes) +
                         " characters and could be guessed: framelet-server --make-token prints one that cannot");
    }
    if (line.size() > max_token_bytes) {
        throw InputError(what + " is longer than 4096 bytes");
    }
    if (!is_one_line(line)) {
        throw InputError(what + " is not UTF-8 text");
    }
    return line;
}

std::string read_token_file(std::filesystem::path const& file, std::chrono::seconds patience) {
    std::string const what = "token file '" + file.string() + "'";
    std::string const text = read_beginning(file, what, patience);
    std::string line = text.substr(0, text.find('\n'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) {
        throw InputError(what + " has an empty first line; put the token there");
    }
    return token_in(std::move(line), what + ": the first line");
}

} // namespace framelet
