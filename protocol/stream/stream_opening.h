// Makes a stream of messages of a connected socket.
#pragma once

#include <memory>
#include <string>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>

#include "protocol/stream/framed_stream.h"

namespace framelet {

struct WebPage;
using StreamSocket = boost::asio::ip::tcp::socket;

/// Makes a stream over plain TCP. Sets TCP_NODELAY, and where there is TCP_NOTSENT_LOWAT keeps what waits in the system
/// short. With a page, which may have no files, the other side may as well be a browser, that asks for the page or
/// sends the frames in a WebSocket.
std::shared_ptr<FramedStream> plain_stream(StreamSocket socket, std::shared_ptr<WebPage const> page = {});
/// Make a stream over TLS, as the server or as the client; `host` is the name or the address that the certificate is
/// checked against (InputError where it is neither). A server's handshake is computed by `handshakes`, an executor of
/// one thread; for a connection that has ended by then it is not. Throw std::bad_alloc or std::system_error where there
/// is no memory.
std::shared_ptr<FramedStream> tls_server_stream(StreamSocket socket,
                                                std::shared_ptr<boost::asio::ssl::context> const& context,
                                                boost::asio::any_io_executor handshakes,
                                                std::shared_ptr<WebPage const> page = {});
std::shared_ptr<FramedStream> tls_client_stream(StreamSocket socket,
                                                std::shared_ptr<boost::asio::ssl::context> const& context,
                                                std::string const& host);

} // namespace framelet
