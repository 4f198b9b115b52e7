#include "protocol/stream/tls.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <utility>

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>

#include "common/error.h"

namespace framelet {
namespace {

namespace ssl = boost::asio::ssl;

std::shared_ptr<ssl::context> make_context(SSL_METHOD const* method) {
    // Made here, since Asio goes on with a null pointer where there is no memory left to note the error either.
    std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> made(SSL_CTX_new(method), SSL_CTX_free);
    if (!made) {
        throw std::bad_alloc();
    }
    auto context = std::make_shared<ssl::context>(made.get());
    static_cast<void>(made.release()); // the context frees it
    // Earlier versions have suites without forward secrecy; both sides are of one release.
    FRAMELET_CHECK(SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_3_VERSION) == 1);
    SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    return context;
}

/// True where a line of the file, as "-----BEGIN RSA PRIVATE KEY-----", says that a thing of this kind follows.
bool holds(std::string const& file, std::string const& kind) {
    std::ifstream lines(file);
    std::string const end = kind + "-----";
    for (std::string line; std::getline(lines, line);) {
        line.erase(line.find_last_not_of(" \r") + 1);
        if (line.starts_with("-----BEGIN ") && line.ends_with(end)) {
            return true;
        }
    }
    return false;
}

void require(boost::system::error_code const& error, std::string const& what, std::string const& file) {
    if (!error) {
        return;
    }
    bool const wants_key = what == "TLS key";
    bool const swapped = std::filesystem::is_regular_file(file) &&
                         holds(file, wants_key ? "CERTIFICATE" : "PRIVATE KEY") &&
                         !holds(file, wants_key ? "PRIVATE KEY" : "CERTIFICATE");
    std::error_code code;
    bool const is_locked = wants_key && holds(file, "ENCRYPTED");
    int const reason = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
    bool const is_foreign = wants_key && reason == X509_R_KEY_VALUES_MISMATCH;
    std::string const mistaken = wants_key ? "it is a certificate, not a private key: give the key here"
                                           : "it is a private key, not a certificate: give the certificate here";
    std::string const why = swapped                                         ? mistaken
                            : is_locked                                     ? "it is locked with a password, for which "
                                                                              "a server cannot ask: give it without"
                            : is_foreign                                    ? "it is the key of another certificate"
                            : !std::filesystem::exists(file, code)          ? "there is no such file"
                            : !std::filesystem::is_regular_file(file, code) ? "it is not a file"
                            : !holds(file, "-----BEGIN")                    ? "there is none in it"
                                                                            : error.message();
    throw InputError(what + " '" + file + "' cannot be used: " + why);
}

/// Throws std::bad_alloc where there is no memory for it.
std::string fingerprint_of(X509 const* certificate) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) {
        throw std::bad_alloc();
    }
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += i > 0 ? ":" : "";
        text += "0123456789ABCDEF"[digest[i] >> 4];
        text += "0123456789ABCDEF"[digest[i] & 15];
    }
    return text;
}

/// True where nobody who is known has signed the certificate; whatever else may be wrong with one is wrong whoever
/// signed it.
bool is_of_unknown_origin(int error) {
    return error == X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT || error == X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN ||
           error == X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY || error == X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE;
}

struct JudgedContext {
    std::shared_ptr<ssl::context> context;
    CertificateJudge judge;
};

bool is_trusted(X509_STORE_CTX* store, CertificateJudge const& judge) {
    if (X509_verify_cert(store) == 1) {
        judge("");
        return true;
    }
    bool const trusted =
        is_of_unknown_origin(X509_STORE_CTX_get_error(store)) && judge(fingerprint_of(X509_STORE_CTX_get0_cert(store)));
    if (trusted) {
        X509_STORE_CTX_set_error(store, X509_V_OK);
    }
    return trusted;
}

/// Verifies in place of the library's own function, which it calls first. Nothing may be thrown through the library.
int verify(X509_STORE_CTX* store, void* judged) {
    try {
        return is_trusted(store, static_cast<JudgedContext const*>(judged)->judge) ? 1 : 0;
    } catch (std::exception const&) {
        X509_STORE_CTX_set_error(store, X509_V_ERR_OUT_OF_MEM);
        return 0;
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
    auto context = make_context(TLS_server_method());
    boost::system::error_code error;
    // A key under a password is refused; otherwise the library would ask for it on the terminal.
    context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
    context->use_certificate_chain_file(certificate_file, error);
    require(error, "TLS certificate", certificate_file);
    // This also checks that the key is the certificate's.
    context->use_private_key_file(key_file, ssl::context::pem, error);
    require(error, "TLS key", key_file);
    return context;
}

std::shared_ptr<ssl::context> make_tls_client_context(std::string const& authority_file, CertificateJudge judge) {
    auto context = make_context(TLS_client_method());
    context->set_verify_mode(ssl::verify_peer);
    boost::system::error_code error;
    if (authority_file.empty()) {
        context->set_default_verify_paths(error);
        require(error, "TLS authorities", "of the system");
    } else {
        context->load_verify_file(authority_file, error);
        require(error, "TLS authority", authority_file);
    }
    if (!judge) {
        return context;
    }
    auto const judged = std::make_shared<JudgedContext>(JudgedContext{context, std::move(judge)});
    SSL_CTX_set_cert_verify_callback(context->native_handle(), verify, judged.get());
    return {judged, context.get()};
}

std::string certificate_fingerprint(std::string const& certificate_file) {
    std::unique_ptr<BIO, decltype(&BIO_free)> const file(BIO_new_file(certificate_file.c_str(), "r"), BIO_free);
    std::unique_ptr<X509, decltype(&X509_free)> const certificate(
        file ? PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr) : nullptr, X509_free);
    if (!certificate) {
        throw InputError("TLS certificate '" + certificate_file + "' cannot be used: there is none in it");
    }
    return fingerprint_of(certificate.get());
}

} // namespace framelet
