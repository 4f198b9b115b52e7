// Of a connected socket, a stream of messages.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>

#include "protocol/stream/framed_stream.h"

namespace framelet {

using StreamSocket = boost::asio::ip::tcp::socket;

/// Plain TCP. Sets TCP_NODELAY, and where there is TCP_NOTSENT_LOWAT keeps what waits in the system short.
std::shared_ptr<FramedStream> plain_stream(StreamSocket socket);
/// TLS as the server or as the client; `host` is the name or the address that the certificate is checked against
/// (InputError where it is neither).
std::shared_ptr<FramedStream> tls_server_stream(StreamSocket socket,
                                                std::shared_ptr<boost::asio::ssl::context> const& context);
std::shared_ptr<FramedStream> tls_client_stream(StreamSocket socket,
                                                std::shared_ptr<boost::asio::ssl::context> const& context,
                                                std::string const& host);

/// Contexts for TLS 1.3 and later. Throw InputError that names the file.
std::shared_ptr<boost::asio::ssl::context> make_tls_server_context(std::string const& certificate_file,
                                                                   std::string const& key_file);
/// Whether to trust a certificate for which no authority vouches, by its fingerprint; empty: one does, and what is
/// returned does not count.
using CertificateJudge = std::function<bool(std::string const& fingerprint)>;
/// `authority_file` empty: the system's certificate authorities. `judge` is called in each handshake, unless the
/// certificate is worth nothing; without it only what an authority vouches for is trusted.
std::shared_ptr<boost::asio::ssl::context> make_tls_client_context(std::string const& authority_file,
                                                                   CertificateJudge judge = {});

/// SHA-256 of a file's first certificate (PEM), as `openssl x509 -fingerprint` prints it. Throws InputError.
std::string certificate_fingerprint(std::string const& certificate_file);

} // namespace framelet
