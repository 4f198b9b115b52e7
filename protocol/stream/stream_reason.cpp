#include "protocol/stream/stream_reason.h"

#include <boost/asio/error.hpp>
#include <boost/asio/ssl/error.hpp>
#include <openssl/err.h>
#include <openssl/x509_vfy.h>

namespace framelet {
namespace {

namespace asio = boost::asio;

bool is_end(boost::system::error_code const& error) {
    return error == asio::error::eof || error == asio::ssl::error::stream_truncated;
}

} // namespace

std::string stream_reason(boost::system::error_code const& error, bool within_message) {
    if (is_end(error)) {
        return within_message ? "the other side closed the connection in the middle of a message"
                              : "the other side closed the connection";
    }
    if (error == asio::error::connection_reset || error == asio::error::broken_pipe) {
        return "connection reset by the other side";
    }
    bool const tls = error.category() == asio::error::get_ssl_category();
    return (tls ? "TLS failed: " : "connection failed: ") + error.message();
}

std::string handshake_reason(boost::system::error_code const& error, SSL* ssl) {
    std::string const failed = "TLS handshake failed: ";
    if (is_end(error) || error == asio::error::connection_reset || error == asio::error::broken_pipe) {
        return failed + "the other side closed the connection; it may not use TLS, or have no room";
    }
    std::string reason = failed + error.message();
    if (error.category() != asio::error::get_ssl_category()) {
        return reason;
    }
    long const verified = SSL_get_verify_result(ssl);
    int const code = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
    if (code == SSL_R_CERTIFICATE_VERIFY_FAILED && verified != X509_V_OK) {
        reason += std::string(" (") + X509_verify_cert_error_string(verified) + ")";
    }
    // These are the errors by which bytes that are not TLS show.
    if (code == SSL_R_WRONG_VERSION_NUMBER || code == SSL_R_HTTP_REQUEST || code == SSL_R_PACKET_LENGTH_TOO_LONG ||
        code == SSL_R_UNEXPECTED_MESSAGE || code == SSL_R_UNSUPPORTED_PROTOCOL) {
        reason += "; the other side may not use TLS";
    }
    return reason;
}

} // namespace framelet
