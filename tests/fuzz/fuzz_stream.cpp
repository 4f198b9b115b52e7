// Reads what arrives on a connection, byte by byte, from one who sends it all at once and then says no more. Input: one
// byte, whether it is a viewer that listens, and whether a browser may be one; what the peer sends.
#include <span>

#include <boost/asio/write.hpp>

#include <sys/socket.h>

#include "common/error.h"
#include "protocol/stream/stream_opening.h"
#include "protocol/stream/web_door.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    using boost::asio::ip::tcp;
    if (size < 1) {
        return 0;
    }
    boost::asio::io_context io(1);
    int ends[2];
    FRAMELET_CHECK(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0);
    tcp::socket peer(io, tcp::v4(), ends[1]);
    boost::asio::write(peer, boost::asio::buffer(data + 1, size - 1)); // the system's buffer holds it
    peer.shutdown(tcp::socket::shutdown_send);

    std::shared_ptr<WebPage> page;
    if ((data[0] & 2) != 0) {
        page = std::make_shared<WebPage>();
        page->files = {{"index.html", "page", "zip", "\"1\""}};
    }
    auto const stream = plain_stream(tcp::socket(io, tcp::v4(), ends[0]), page);
    bool closed = false;
    FramedStream::Handlers handlers;
    handlers.on_message = [&, listens = data[0] % 2 != 0](Message const& message) {
        FRAMELET_CHECK(!closed);
        if (listens && std::holds_alternative<Welcome>(message)) {
            stream->set_max_body(max_message_bytes);
        }
    };
    handlers.on_close = [&](std::string const& reason) {
        FRAMELET_CHECK(!closed && !reason.empty());
        closed = true;
    };
    stream->start(std::move(handlers), max_upstream_message_bytes);
    io.run();
    FRAMELET_CHECK(closed && stream->unsent_bytes() == 0);
    return 0;
}
