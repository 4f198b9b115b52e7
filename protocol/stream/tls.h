// TLS: which certificate each side shows, and whom it believes. In: files, a connection before its handshake and the
// name of the host.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/ssl/context.hpp>
#include <openssl/ssl.h>

namespace framelet {

/// Make contexts for TLS 1.3 and later. Throw InputError that names the file, also where that is a pipe.
std::shared_ptr<boost::asio::ssl::context> make_tls_server_context(std::string const& certificate_file,
                                                                   std::string const& key_file);
/// Says whether to trust a certificate for which no authority vouches, by its fingerprint; empty: one does, and what is
/// returned does not count.
using CertificateJudge = std::function<bool(std::string const& fingerprint)>;
/// `authority_file` empty: the system's certificate authorities. `judge` is called in each handshake, unless the
/// certificate is worth nothing; without it only what an authority vouches for is trusted.
std::shared_ptr<boost::asio::ssl::context> make_tls_client_context(std::string const& authority_file,
                                                                   CertificateJudge judge = {});

/// True where users of the machine beyond owner and group can read the file.
bool is_readable_by_all(std::string const& key_file);

/// SHA-256 of a file's first certificate (PEM), as `openssl x509 -fingerprint` prints it. Throws InputError.
std::string certificate_fingerprint(std::string const& certificate_file);

/// Makes the handshake, as a server, fail before anything is computed for it where `is_over` by then, which is to live
/// as long as `ssl`.
void give_up_handshake_where(SSL* ssl, std::atomic<bool> const& is_over);

/// Makes the handshake fail unless the certificate is valid and for `host`, a name or an address. InputError where
/// `host` is neither.
void require_host(SSL* ssl, std::string host);

} // namespace framelet
