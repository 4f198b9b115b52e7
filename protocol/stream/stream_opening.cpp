#include "protocol/stream/stream_opening.h"

#include <new>
#include <sstream>
#include <utility>

#include <openssl/err.h>

#if __has_include(<netinet/tcp.h>)
#include <netinet/tcp.h>
#endif

#include "protocol/stream/door_stream.h"
#include "protocol/stream/socket_stream.h"
#include "protocol/stream/tls.h"

namespace framelet {
namespace {

using SecureStream = asio::ssl::stream<StreamSocket>;

/// The largest number of bytes that the system may hold before there is room for them on the way: more would only grow
/// old there.
[[maybe_unused]] constexpr int most_unsent_bytes = 128 << 10;

/// Sets the options of a socket. Errors are ignored: the peer may be gone already, which reading will find out.
void set_options(StreamSocket::lowest_layer_type& socket) {
    boost::system::error_code ignored;
    socket.set_option(asio::ip::tcp::no_delay(true), ignored);
#ifdef TCP_NOTSENT_LOWAT
    using UnsentBytes = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
    socket.set_option(UnsentBytes(most_unsent_bytes), ignored);
#endif
}

std::string address_of(StreamSocket::lowest_layer_type const& socket) {
    boost::system::error_code error;
    auto const endpoint = socket.remote_endpoint(error);
    std::ostringstream text;
    text << endpoint;
    return error ? "unknown" : text.str();
}

/// Throws std::bad_alloc where OpenSSL cannot say on this thread what is wrong: Asio would take nothing for a
/// connection. Once it can it always can.
void require_error_queue() {
    ERR_raise(ERR_LIB_USER, ERR_R_MALLOC_FAILURE);
    if (ERR_get_error() == 0) {
        throw std::bad_alloc();
    }
}

template <typename Stream>
std::shared_ptr<FramedStream> stream_of(Stream stream, asio::ssl::stream_base::handshake_type role,
                                        asio::any_io_executor handshakes, std::shared_ptr<WebPage const> page) {
    set_options(stream.lowest_layer());
    std::string peer = address_of(stream.lowest_layer());
    if (page) {
        DoorStream<Stream> door(std::move(stream), std::move(page));
        return std::make_shared<SocketStream<DoorStream<Stream>>>(std::move(door), std::move(peer), role,
                                                                  std::move(handshakes));
    }
    return std::make_shared<SocketStream<Stream>>(std::move(stream), std::move(peer), role, std::move(handshakes));
}

} // namespace

std::shared_ptr<FramedStream> plain_stream(StreamSocket socket, std::shared_ptr<WebPage const> page) {
    return stream_of(std::move(socket), asio::ssl::stream_base::client, {}, std::move(page));
}

std::shared_ptr<FramedStream> tls_server_stream(StreamSocket socket, std::shared_ptr<asio::ssl::context> const& context,
                                                asio::any_io_executor handshakes, std::shared_ptr<WebPage const> page) {
    require_error_queue();
    return stream_of(SecureStream(std::move(socket), *context), asio::ssl::stream_base::server, std::move(handshakes),
                     std::move(page));
}

std::shared_ptr<FramedStream> tls_client_stream(StreamSocket socket, std::shared_ptr<asio::ssl::context> const& context,
                                                std::string const& host) {
    require_error_queue();
    SecureStream stream(std::move(socket), *context);
    require_host(stream.native_handle(), host);
    asio::any_io_executor own = stream.get_executor();
    return stream_of(std::move(stream), asio::ssl::stream_base::client, std::move(own), {});
}

} // namespace framelet
