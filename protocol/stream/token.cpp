#include "protocol/stream/token.h"

#include <array>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include "common/error.h"
#include "protocol/messages/text.h"

namespace framelet {
namespace {

/// Fills them with what nobody can guess. Throws std::runtime_error where there is none to be had, as without memory.
void fill_randomly(unsigned char* bytes, std::size_t count) {
    if (RAND_bytes(bytes, static_cast<int>(count)) != 1) {
        throw std::runtime_error("the system has no random numbers or no memory left");
    }
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

std::string read_token_file(std::filesystem::path const& file) {
    std::ifstream stream(file, std::ios::binary);
    // A little more than allowed is read, so that a file that never ends (a device) is refused as well.
    std::string text(max_token_bytes + 256, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.empty() && !stream.eof()) {
        throw InputError("token file '" + file.string() + "' cannot be read");
    }
    std::string line = text.substr(0, text.find('\n'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) {
        throw InputError("token file '" + file.string() + "' has an empty first line; put the token there");
    }
    return token_in(std::move(line), "token file '" + file.string() + "': the first line");
}

} // namespace framelet
