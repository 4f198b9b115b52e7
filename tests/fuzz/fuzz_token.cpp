// Reads what users keep of secrets: files of tokens and of known servers, whatever is in them. Input: one byte, what
// the file is; its content.
#include <filesystem>
#include <string>

#include "common/error.h"
#include "protocol/messages/message.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/known_servers.h"
#include "protocol/stream/token.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace framelet;

/// Reads a token: what is read can be sent, and lets in nobody who knows less or other than it.
void read_token(std::filesystem::path const& file) {
    std::string const token = read_token_file(file);
    FRAMELET_CHECK(token.size() >= min_token_bytes);
    Message const sent = decode_message(encode_message(Hello{protocol_version, token}));
    FRAMELET_CHECK(same_token(std::get<Hello>(sent).token, token));
    FRAMELET_CHECK(!same_token(token.substr(1), token) && !same_token(token + token.back(), token));
    for (std::size_t i = 0; i < token.size(); ++i) {
        std::string other = token;
        other[i] = static_cast<char>(other[i] ^ 1);
        FRAMELET_CHECK(!same_token(other, token));
    }
}

/// A server is trusted with one certificate alone once its user has said so, whatever else the file says.
void judge(std::filesystem::path const& file) {
    std::string const server = "render.example:7070";
    if (judge_certificate(file, server, "AA:BB").is_unknown) {
        trust_certificate(file, server, "AA:BB");
        FRAMELET_CHECK(judge_certificate(file, server, "AA:BB").is_trusted);
        CertificateVerdict const other = judge_certificate(file, server, "AA:BC");
        FRAMELET_CHECK(!other.is_trusted && !other.is_unknown);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size < 1) {
        return 0;
    }
    InputFile const file(data + 1, size - 1, "");
    try {
        if (data[0] % 2 == 0) {
            read_token(file.path());
        } else {
            judge(file.path());
        }
    } catch (InputError const&) {
    }
    return 0;
}
