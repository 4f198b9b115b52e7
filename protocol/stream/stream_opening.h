// Of a connected socket, a stream of messages.
#pragma once

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

} // namespace framelet
