#include "protocol/stream/tls.h"

#include <array>
#include <fstream>
#include <memory>
#include <new>
#include <utility>

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>
#include <sys/stat.h>

#include "common/error.h"
#include "common/files/regular_file.h"

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

/// True where a line of the file has the text, which may be the end of "-----BEGIN RSA PRIVATE KEY-----".
bool holds(std::string const& file, std::string_view text) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.find(text) != std::string::npos) {
            return true;
        }
    }
    return false;
}

void require(boost::system::error_code const& error, std::string const& what, std::string const& file,
             RegularFile const& opened) {
    if (!error) {
        return;
    }
    bool const wants_key = what == "TLS key";
    bool const swapped = holds(opened.name(), wants_key ? "CERTIFICATE-----" : "PRIVATE KEY-----") &&
                         !holds(opened.name(), wants_key ? "PRIVATE KEY-----" : "CERTIFICATE-----");
    bool const is_locked = wants_key && holds(opened.name(), "ENCRYPTED");
    int const reason = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
    bool const is_foreign = wants_key && reason == X509_R_KEY_VALUES_MISMATCH;
    std::string const mistaken = wants_key ? "it is a certificate, not a private key: give the key here"
                                           : "it is a private key, not a certificate: give the certificate here";
    std::string const why = swapped     ? mistaken
                            : is_locked ? "it is locked with a password, for which a server cannot ask: give it without"
                            : is_foreign                           ? "it is the key of another certificate"
                            : !holds(opened.name(), "-----BEGIN ") ? "there is none in it"
                                                                   : error.message();
    throw InputError(what + " '" + file + "' cannot be used: " + why);
}

/// Throws InputError where there is no such file: a library would wait for a pipe.
RegularFile opened(std::string const& what, std::string const& file) {
    RegularFile found(file);
    if (!found) {
        throw InputError(what + " '" + file + "' cannot be used: " + found.problem());
    }
    return found;
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

/// Lets the library go on where it is not known who has signed: what else may be wrong (the host, the time) it looks at
/// after that.
int pass_unknown_origin(int is_right, X509_STORE_CTX* store) {
    return is_right == 1 || is_of_unknown_origin(X509_STORE_CTX_get_error(store)) ? 1 : 0;
}

bool is_trusted(X509_STORE_CTX* store, CertificateJudge const& judge) {
    X509_STORE_CTX_set_verify_cb(store, pass_unknown_origin);
    if (X509_verify_cert(store) != 1) {
        return false;
    }
    if (!is_of_unknown_origin(X509_STORE_CTX_get_error(store))) { // which stays from when it was passed
        judge("");
        return true;
    }
    bool const trusted = judge(fingerprint_of(X509_STORE_CTX_get0_cert(store)));
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

/// Where an SSL keeps what `give_up_handshake_where` was given.
int over_index() {
    static int const index = SSL_get_ex_new_index(0, nullptr, nullptr, nullptr, nullptr);
    return index;
}

int look_at_hello(SSL* ssl, int*, void*) {
    auto const* const is_over = static_cast<std::atomic<bool> const*>(SSL_get_ex_data(ssl, over_index()));
    return is_over != nullptr && *is_over ? SSL_CLIENT_HELLO_ERROR : SSL_CLIENT_HELLO_SUCCESS;
}

} // namespace

void give_up_handshake_where(SSL* ssl, std::atomic<bool> const& is_over) {
    if (SSL_set_ex_data(ssl, over_index(), const_cast<std::atomic<bool>*>(&is_over)) != 1) {
        throw std::bad_alloc();
    }
}

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
    SSL_CTX_set_client_hello_cb(context->native_handle(), look_at_hello, nullptr);
    RegularFile const certificate = opened("TLS certificate", certificate_file);
    context->use_certificate_chain_file(certificate.name(), error);
    require(error, "TLS certificate", certificate_file, certificate);
    // This also checks that the key is the certificate's.
    RegularFile const key = opened("TLS key", key_file);
    context->use_private_key_file(key.name(), ssl::context::pem, error);
    require(error, "TLS key", key_file, key);
    return context;
}

std::shared_ptr<ssl::context> make_tls_client_context(std::string const& authority_file, CertificateJudge judge) {
    auto context = make_context(TLS_client_method());
    context->set_verify_mode(ssl::verify_peer);
    boost::system::error_code error;
    if (authority_file.empty()) {
        context->set_default_verify_paths(error);
        if (error) {
            throw InputError("the system's TLS authorities cannot be used: " + error.message());
        }
    } else {
        RegularFile const authority = opened("TLS authority", authority_file);
        context->load_verify_file(authority.name(), error);
        require(error, "TLS authority", authority_file, authority);
        // What is named is trusted, though it be a server's own certificate, which somebody else has signed.
        X509_VERIFY_PARAM_set_flags(SSL_CTX_get0_param(context->native_handle()), X509_V_FLAG_PARTIAL_CHAIN);
    }
    if (!judge) {
        return context;
    }
    auto const judged = std::make_shared<JudgedContext>(JudgedContext{context, std::move(judge)});
    SSL_CTX_set_cert_verify_callback(context->native_handle(), verify, judged.get());
    return {judged, context.get()};
}

bool is_readable_by_all(std::string const& key_file) {
    RegularFile const found(key_file);
    return found && (found.mode() & S_IROTH) != 0;
}

std::string certificate_fingerprint(std::string const& certificate_file) {
    RegularFile const found = opened("TLS certificate", certificate_file);
    std::unique_ptr<BIO, decltype(&BIO_free)> const file(BIO_new_file(found.name().c_str(), "r"), BIO_free);
    std::unique_ptr<X509, decltype(&X509_free)> const certificate(
        file ? PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr) : nullptr, X509_free);
    if (!certificate) {
        throw InputError("TLS certificate '" + certificate_file + "' cannot be used: there is none in it");
    }
    return fingerprint_of(certificate.get());
}

} // namespace framelet
