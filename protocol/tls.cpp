#include "protocol/tls.h"

#include <boost/asio/ssl/context.hpp>
#include <openssl/x509_vfy.h>

#include "common/error.h"
#include "protocol/stream_opening.h"

namespace framelet {
namespace {

namespace ssl = boost::asio::ssl;

std::shared_ptr<ssl::context> make_context(ssl::context::method method) {
    auto context = std::make_shared<ssl::context>(method);
    // Earlier versions have suites without forward secrecy; both sides are of one release.
    FRAMELET_CHECK(SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_3_VERSION) == 1);
    SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    return context;
}

void require(boost::system::error_code const& error, std::string const& what, std::string const& file) {
    if (error) {
        throw InputError(what + " '" + file + "' cannot be used: " + error.message());
    }
}

} // namespace

void require_host(SSL* ssl, std::string host) {
    SSL_set_verify(ssl, SSL_VERIFY_PEER, nullptr);
    if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), host.c_str()) == 1) {
        return;
    }
    bool const named = !host.empty() && SSL_set1_host(ssl, host.c_str()) == 1 &&
                       SSL_ctrl(ssl, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name, host.data()) == 1;
    if (!named) {
        throw InputError("'" + host + "' is not a host name that a TLS certificate can be checked against");
    }
}

std::shared_ptr<ssl::context> make_tls_server_context(std::string const& certificate_file,
                                                      std::string const& key_file) {
    auto context = make_context(ssl::context::tls_server);
    boost::system::error_code error;
    // A key under a password is refused; otherwise the library would ask for it on the terminal.
    context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
    context->use_certificate_chain_file(certificate_file, error);
    require(error, "TLS certificate", certificate_file);
    // Also checks that the key is the certificate's.
    context->use_private_key_file(key_file, ssl::context::pem, error);
    require(error, "TLS key", key_file);
    return context;
}

std::shared_ptr<ssl::context> make_tls_client_context(std::string const& authority_file) {
    auto context = make_context(ssl::context::tls_client);
    context->set_verify_mode(ssl::verify_peer);
    boost::system::error_code error;
    if (authority_file.empty()) {
        context->set_default_verify_paths(error);
        require(error, "TLS authorities", "of the system");
    } else {
        context->load_verify_file(authority_file, error);
        require(error, "TLS authority", authority_file);
    }
    return context;
}

} // namespace framelet
