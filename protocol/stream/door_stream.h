// The bytes of frames, however they come: as they are, or in a WebSocket. The first bytes of a connection say which;
// one that speaks HTTP is answered from memory. In: a connected stream, TCP or TLS. Out: one that SocketStream reads
// and writes. stream_opening.cpp alone includes it.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/beast/core/buffers_prefix.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "protocol/stream/web_door.h"

namespace framelet {

/// As asio's streams, for one reader and one writer at a time. Whoever is called back keeps it alive.
template <typename Next>
class DoorStream {
    using Error = boost::system::error_code;

public:
    using executor_type = typename Next::executor_type;

    DoorStream(Next next, std::shared_ptr<WebPage const> page)
        : state_(std::make_unique<State>(std::move(next), std::move(page))) {}

    executor_type get_executor() { return state_->next.get_executor(); }
    auto& lowest_layer() { return state_->next.lowest_layer(); }
    auto native_handle() { return state_->next.native_handle(); }
    bool speaks_http() const { return state_->speaks == Speaks::http; }
    /// True where a page has ended because it was left, closed or loaded again: browsers say so ([RFC 6455] 7.4.1).
    bool was_left() const {
        return state_->socket && state_->socket->reason().code == boost::beast::websocket::close_code::going_away;
    }

    template <typename Role, typename Handler>
    void async_handshake(Role role, Handler&& handler) {
        state_->next.async_handshake(role, std::forward<Handler>(handler));
    }

    template <typename Handler>
    void async_shutdown(Handler handler) {
        if (state_->speaks == Speaks::http) {
            handler(Error()); // an answer may be on its way
        } else {
            state_->next.async_shutdown(std::move(handler));
        }
    }

    /// `buffers` have room for the four bytes that are read first.
    template <typename Buffers, typename Handler>
    void async_read_some(Buffers const& buffers, Handler handler) {
        if (state_->failure) { // asio does not tell of an end twice
            boost::asio::post(get_executor(), ended(std::move(handler), state_->failure));
            return;
        }
        switch (state_->speaks) {
        case Speaks::nothing:
            state_->read_first(buffers, std::move(handler));
            break;
        case Speaks::frames:
            state_->next.async_read_some(buffers, std::move(handler));
            break;
        case Speaks::http:
            boost::asio::post(get_executor(), ended(std::move(handler), boost::asio::error::eof));
            break;
        case Speaks::web_socket:
            state_->read_socket(buffers, std::move(handler));
            break;
        }
    }

    /// What is written to one who speaks HTTP goes nowhere.
    template <typename Buffers, typename Handler>
    void async_write_some(Buffers const& buffers, Handler handler) {
        constexpr std::size_t most = 64 << 10; // of a message: less waits for its end then
        switch (state_->speaks) {
        case Speaks::nothing:
            state_->speaks = Speaks::frames;
            [[fallthrough]];
        case Speaks::frames:
            state_->next.async_write_some(buffers, std::move(handler));
            break;
        case Speaks::http:
            boost::asio::post(get_executor(),
                              [handler = std::move(handler), size = boost::asio::buffer_size(buffers)]() mutable {
                                  handler(Error(), size);
                              });
            break;
        case Speaks::web_socket:
            state_->socket->async_write_some(true, boost::beast::buffers_prefix(most, buffers), std::move(handler));
            break;
        }
    }

private:
    enum class Speaks { nothing, frames, http, web_socket };

    template <typename Handler>
    static auto ended(Handler handler, Error why) {
        return [handler = std::move(handler), why]() mutable { handler(why, 0); };
    }

    struct State {
        Next next;
        std::shared_ptr<WebPage const> page;
        Speaks speaks = Speaks::nothing;
        Error failure; ///< that came behind the first bytes
        std::array<char, 4> first{};
        boost::beast::flat_buffer buffer{2 * most_request_bytes};
        std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser;
        std::optional<WebResponse> answer;
        std::optional<boost::beast::websocket::stream<Next&>> socket;

        State(Next stream, std::shared_ptr<WebPage const> shown) : next(std::move(stream)), page(std::move(shown)) {}

        template <typename Buffers, typename Handler>
        void read_first(Buffers const& buffers, Handler handler) {
            auto came = [this, buffers, handler = std::move(handler)](Error error, std::size_t size) mutable {
                // As a length these would be beyond every limit.
                auto const is_text = [](char c) { return c >= ' ' && c < 0x7f; };
                if (error && size == 0) {
                    handler(error, 0);
                } else if (!error && speaks == Speaks::nothing && std::all_of(first.begin(), first.end(), is_text)) {
                    speaks = Speaks::http;
                    buffer.commit(boost::asio::buffer_copy(buffer.prepare(size), boost::asio::buffer(first)));
                    read_request(buffers, std::move(handler));
                } else {
                    speaks = Speaks::frames;
                    failure = error;
                    handler(Error(), boost::asio::buffer_copy(buffers, boost::asio::buffer(first, size)));
                }
            };
            boost::asio::async_read(next, boost::asio::buffer(first), std::move(came));
        }

        template <typename Buffers, typename Handler>
        void read_request(Buffers const& buffers, Handler handler) {
            parser.emplace();
            parser->header_limit(most_request_bytes);
            auto came = [this, buffers, handler = std::move(handler)](Error error, std::size_t) mutable {
                if (error && error.category() != boost::beast::http::make_error_code({}).category()) {
                    handler(error, 0);
                    return;
                }
                if (error == boost::beast::http::error::end_of_stream) {
                    handler(boost::asio::error::eof, 0);
                    return;
                }
                answer = error ? bad_request_answer() : web_answer(parser->get(), *page, is_on_loopback());
                if (answer) {
                    write_answer(buffers, std::move(handler));
                } else {
                    accept(buffers, std::move(handler));
                }
            };
            boost::beast::http::async_read(next, buffer, *parser, std::move(came));
        }

        template <typename Buffers, typename Handler>
        void write_answer(Buffers const& buffers, Handler handler) {
            auto written = [this, buffers, handler = std::move(handler)](Error error, std::size_t) mutable {
                if (error || !answer->keep_alive()) {
                    handler(error ? error : Error(boost::asio::error::eof), 0);
                } else {
                    read_request(buffers, std::move(handler));
                }
            };
            boost::beast::http::async_write(next, *answer, std::move(written));
        }

        template <typename Buffers, typename Handler>
        void accept(Buffers const& buffers, Handler handler) {
            socket.emplace(next);
            socket->binary(true);
            socket->auto_fragment(false);
            socket->read_message_max(0); // where a message ends means nothing
            auto accepted = [this, buffers, handler = std::move(handler)](Error error) mutable {
                if (error) {
                    handler(error, 0);
                } else {
                    speaks = Speaks::web_socket;
                    read_socket(buffers, std::move(handler));
                }
            };
            socket->async_accept(parser->get(), std::move(accepted));
        }

        template <typename Buffers, typename Handler>
        void read_socket(Buffers const& buffers, Handler handler) {
            auto came = [this, buffers, handler = std::move(handler)](Error error, std::size_t size) mutable {
                if (!error && size == 0) { // an empty message
                    read_socket(buffers, std::move(handler));
                } else if (!error && !socket->got_binary()) {
                    handler(boost::asio::error::invalid_argument, 0);
                } else {
                    handler(error == boost::beast::websocket::error::closed ? Error(boost::asio::error::eof) : error,
                            size);
                }
            };
            socket->async_read_some(buffers, std::move(came));
        }

        bool is_on_loopback() {
            Error error;
            auto const here = next.lowest_layer().local_endpoint(error);
            return !error && here.address().is_loopback();
        }
    };

    std::unique_ptr<State> state_;
};

} // namespace framelet
