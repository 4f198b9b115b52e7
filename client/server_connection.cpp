#include "client/server_connection.h"

#include <chrono>
#include <future>
#include <sstream>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/error.h"
#include "protocol/local_token.h"
#include "protocol/stream_opening.h"

namespace framelet {

namespace asio = boost::asio;

namespace {

constexpr auto tick = std::chrono::milliseconds(100);

std::string seconds_text(double seconds) {
    std::ostringstream out;
    out << seconds << " s";
    return out.str();
}

/// Of this machine itself.
bool is_loopback(asio::ip::address const& address) {
    if (address.is_v6() && address.to_v6().is_v4_mapped()) {
        return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).is_loopback();
    }
    return address.is_loopback();
}

} // namespace

struct ServerConnection::Impl {
    ConnectionOptions options;
    Handlers handlers;
    std::string server; ///< for messages
    asio::io_context io;
    asio::ip::tcp::resolver resolver{io};
    asio::ip::tcp::socket socket{io};
    asio::steady_timer deadline{io};
    asio::steady_timer watch{io};
    std::shared_ptr<asio::ssl::context> tls;
    std::shared_ptr<FramedStream> stream;
    std::promise<void> opened;
    Welcome welcome;
    bool open = false; ///< Welcome has come
    bool ended = false; ///< nothing is reported any more
    /// Counted in ticks of the watch and not by the clock, so that a machine that slept hears what arrived meanwhile.
    int silent_ticks = 0;
    std::thread thread;

    Impl(ConnectionOptions const& o, Handlers h) : options(o), handlers(std::move(h)), server(o.server.text()) {}

    void end(std::string const& reason) {
        if (ended) {
            return;
        }
        ended = true;
        resolver.cancel();
        deadline.cancel();
        watch.cancel();
        boost::system::error_code ignored;
        socket.close(ignored);
        if (stream) {
            stream->close();
        }
        if (open) {
            handlers.on_lost(reason);
        } else {
            opened.set_exception(std::make_exception_ptr(ConnectionError(reason)));
        }
    }

    void begin() {
        deadline.expires_after(std::chrono::duration_cast<asio::steady_timer::duration>(
            std::chrono::duration<double>(options.connect_seconds)));
        deadline.async_wait([this](boost::system::error_code error) {
            if (!error) {
                end("cannot connect to " + server + ": no answer within " + seconds_text(options.connect_seconds) +
                    ": check the address, and whether a firewall is in the way");
            }
        });
        resolver.async_resolve(options.server.host, std::to_string(options.server.port),
                               [this](boost::system::error_code error, auto const& endpoints) {
                                   if (error) {
                                       end("cannot connect to " + server + ": there is no host of that name");
                                   } else {
                                       connect(endpoints);
                                   }
                               });
    }

    void connect(asio::ip::tcp::resolver::results_type const& endpoints) {
        asio::async_connect(
            socket, endpoints, [this](boost::system::error_code error, asio::ip::tcp::endpoint const& endpoint) {
                if (error == asio::error::connection_refused) {
                    end("cannot connect to " + server + ": connection refused: is framelet-server running there?");
                } else if (error) {
                    end("cannot connect to " + server + ": " + error.message());
                } else if (!options.token.empty() && !options.tls && !options.insecure &&
                           !is_loopback(endpoint.address())) {
                    end("the token is not sent to " + server +
                        " in clear: use --tls, or --insecure if you know that nobody can listen");
                } else if (!ended) {
                    shake_hands(token_for(endpoint));
                }
            });
    }

    /// What the user gave, or what a server of the same user on this machine has left for its viewers.
    std::string token_for(asio::ip::tcp::endpoint const& endpoint) const {
        if (!options.token.empty() || !is_loopback(endpoint.address())) {
            return options.token;
        }
        return read_local_token(ServerAddress{endpoint.address().to_string(), endpoint.port()}.text());
    }

    void shake_hands(std::string const& token) {
        stream = options.tls ? tls_client_stream(std::move(socket), tls, options.server.host)
                             : plain_stream(std::move(socket));
        FramedStream::Handlers events;
        events.on_message = [this](Message message) { receive(std::move(message)); };
        events.on_close = [this](std::string const& reason) {
            end(open ? "the connection to the server at " + server + " ended: " + reason
                     : "cannot connect to " + server + ": it did not open a session: " + reason +
                           (options.tls ? "" : ": does it want --tls, or has it no room?"));
        };
        events.on_sent = [this](std::size_t) {
            if (open) {
                handlers.on_sent();
            }
        };
        // The greeting is small; batches may be large, once we know who talks to us.
        stream->start(std::move(events), max_upstream_message_bytes);
        stream->send(Hello{protocol_version, token, coding::all});
    }

    void receive(Message message) {
        silent_ticks = 0;
        if (ended) {
            return;
        }
        if (auto const* failure = std::get_if<Failure>(&message)) {
            end((open ? "the server at " + server + " ended the session: "
                      : "the server at " + server + " refused the connection: ") +
                failure->text);
        } else if (auto* greeting = std::get_if<Welcome>(&message); greeting != nullptr && !open) {
            greet(std::move(*greeting));
        } else if (!open || greeting != nullptr) {
            end("the server at " + server + " broke the protocol: a message out of turn");
        } else {
            try {
                handlers.on_message(std::move(message));
            } catch (ProtocolError const& error) {
                end("the server at " + server + " broke the protocol: " + error.what());
            }
        }
    }

    void greet(Welcome greeting) {
        if (greeting.version != protocol_version) {
            end("the server at " + server + " speaks version " + std::to_string(greeting.version) +
                " of the protocol, this program version " + std::to_string(protocol_version) +
                ": use programs of one release");
            return;
        }
        welcome = std::move(greeting);
        open = true;
        deadline.cancel();
        stream->set_max_body(max_message_bytes);
        watch_for_silence();
        opened.set_value();
    }

    void watch_for_silence() {
        watch.expires_after(tick);
        watch.async_wait([this](boost::system::error_code error) {
            if (error || ended) {
                return;
            }
            if (++silent_ticks * std::chrono::duration<double>(tick).count() > options.silence_seconds) {
                end("the server at " + server + " stopped answering");
            } else {
                watch_for_silence();
            }
        });
    }
};

ServerConnection::ServerConnection(ConnectionOptions const& options, Handlers handlers)
    : impl_(std::make_unique<Impl>(options, std::move(handlers))) {
    if (options.tls) {
        impl_->tls = make_tls_client_context(options.authority_file);
    }
    std::future<void> opened = impl_->opened.get_future();
    asio::post(impl_->io, [impl = impl_.get()] { impl->begin(); });
    impl_->thread = std::thread([impl = impl_.get()] { impl->io.run(); });
    try {
        opened.get();
    } catch (...) {
        impl_->io.stop();
        impl_->thread.join();
        throw;
    }
}

ServerConnection::~ServerConnection() {
    impl_->io.stop();
    impl_->thread.join();
    if (impl_->stream) {
        impl_->stream->close();
    }
}

Welcome const& ServerConnection::welcome() const {
    return impl_->welcome;
}

void ServerConnection::send(Message const& message) {
    impl_->stream->send(message);
}

bool ServerConnection::all_sent() const {
    return impl_->stream->unsent_bytes() == 0;
}

} // namespace framelet
