// A certificate and its key in files, for tests of TLS.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include "protocol/stream/tls.h"

namespace framelet {

template <typename Thing, void (*free_it)(Thing*)>
struct Free {
    void operator()(Thing* thing) const { free_it(thing); }
};
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY, EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Free<X509, X509_free>>;

/// A certificate for localhost and 127.0.0.1, signed with its own key, as files in a folder of the test's.
class Identity {
public:
    /// `seconds`: how long it is valid yet.
    explicit Identity(std::string const& name, long seconds = 3600) {
        std::string pattern = (std::filesystem::temp_directory_path() / "framelet-tls-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        Key const key(EVP_EC_gen("P-256"));
        Certificate const certificate(X509_new());
        X509_set_version(certificate.get(), X509_VERSION_3);
        ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
        X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -7200);
        X509_gmtime_adj(X509_getm_notAfter(certificate.get()), seconds);
        X509_set_pubkey(certificate.get(), key.get());
        X509_NAME* const subject = X509_get_subject_name(certificate.get());
        auto const* const text = reinterpret_cast<unsigned char const*>(name.c_str());
        X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, text, -1, -1, 0);
        X509_set_issuer_name(certificate.get(), subject);
        X509_EXTENSION* const names =
            X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1");
        X509_add_ext(certificate.get(), names, -1);
        X509_EXTENSION_free(names);
        X509_sign(certificate.get(), key.get(), EVP_sha256());

        write(certificate_file(), [&](BIO* out) { return PEM_write_bio_X509(out, certificate.get()); });
        write(key_file(), [&](BIO* out) {
            return PEM_write_bio_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
        });
        std::string password = "password";
        write(locked_key_file(), [&](BIO* out) {
            return PEM_write_bio_PrivateKey(out, key.get(), EVP_aes_128_cbc(), nullptr, 0, nullptr, password.data());
        });
    }
    ~Identity() { std::filesystem::remove_all(folder_); }
    Identity(Identity const&) = delete;
    Identity& operator=(Identity const&) = delete;

    std::string certificate_file() const { return (folder_ / "certificate.pem").string(); }
    std::string key_file() const { return (folder_ / "key.pem").string(); }
    std::string locked_key_file() const { return (folder_ / "locked.pem").string(); }
    std::shared_ptr<boost::asio::ssl::context> server() const {
        return make_tls_server_context(certificate_file(), key_file());
    }
    std::shared_ptr<boost::asio::ssl::context> client() const { return make_tls_client_context(certificate_file()); }

private:
    template <typename Writer>
    void write(std::string const& file, Writer const& writer) {
        BIO* const out = BIO_new_file(file.c_str(), "w");
        EXPECT_NE(out, nullptr);
        EXPECT_EQ(writer(out), 1);
        BIO_free(out);
    }

    std::filesystem::path folder_;
};

} // namespace framelet
