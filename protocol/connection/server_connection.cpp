#include "protocol/connection/server_connection.h"

#include <chrono>
#include <concepts>
#include <exception>
#include <future>
#include <mutex>
#include <new>
#include <random>
#include <sstream>
#include <thread>
#include <utility>

#include <boost/asio/steady_timer.hpp>

#include "common/error.h"
#include "protocol/connection/address_race.h"
#include "protocol/connection/back_off.h"
#include "protocol/connection/token_refusal.h"
#include "protocol/connection/token_route.h"
#include "protocol/connection/unknown_certificate.h"
#include "protocol/messages/wrong_token.h"
#include "protocol/stream/known_servers.h"
#include "protocol/stream/local_token.h"
#include "protocol/stream/stream_opening.h"
#include "protocol/stream/tls.h"

namespace framelet {

namespace asio = boost::asio;

namespace {

constexpr auto tick = std::chrono::milliseconds(100);

std::string seconds_text(double seconds) {
    std::ostringstream out;
    out << seconds << " s";
    return out.str();
}

asio::steady_timer::duration duration_of(double seconds) {
    return std::chrono::duration_cast<asio::steady_timer::duration>(std::chrono::duration<double>(seconds));
}

} // namespace

struct ServerConnection::Impl {
    enum class Retry { later, never };

    ConnectionOptions options;
    Handlers handlers;
    std::string server; ///< its address, for messages
    asio::io_context io;
    asio::ip::tcp::resolver resolver{io};
    AddressRace race{io};
    asio::steady_timer deadline{io}, watch{io}, pause{io};
    std::shared_ptr<asio::ssl::context> tls;
    std::promise<void> opened;
    Welcome welcome; ///< of the first session

    mutable std::mutex stream_mutex;
    std::shared_ptr<FramedStream> stream; ///< of the newest session that was opened

    // All that follows is used by the connection's thread only.
    std::uint64_t attempt = 0;
    std::shared_ptr<FramedStream> attempted; ///< stream of this attempt, once it is connected
    std::string distrust; ///< why this attempt's certificate is refused; empty: it is not
    std::string unknown_fingerprint; ///< of that certificate, where the user is to be asked
    bool is_token_wrong = false; ///< for which this attempt is refused
    bool has_ticket = false; ///< this attempt's Hello has a ticket
    bool open = false; ///< this attempt's Welcome has come
    bool was_open = false; ///< some attempt's Welcome has come
    /// Ticks of the watch since the last message. They are counted instead of time by the clock, so that a machine that
    /// slept hears what arrived meanwhile.
    int silent_ticks = 0;
    std::chrono::steady_clock::time_point opened_at;
    BackOff back_off;
    std::minstd_rand random{std::random_device{}()};

    bool is_over = false; ///< no other attempt follows
    bool is_to_tell_interruption = false;

    std::thread thread;

    Impl(ConnectionOptions const& o, Handlers h) : options(o), handlers(std::move(h)), server(o.server.text()) {}

    /// Wraps a callback so that it does nothing once this attempt is over.
    template <typename Callback>
    auto heard(Callback callback) {
        return [ this, callback = std::move(callback), number = attempt ]<typename... Arguments>(
            Arguments && ... arguments) requires std::invocable<Callback const&, Arguments...> {
            if (number == attempt) {
                callback(std::forward<Arguments>(arguments)...);
            }
        };
    }

    /// Ends the attempt or the session that came of it: tells the handlers, and begins another attempt later where one
    /// is to follow.
    void end(std::string const& reason, Retry retry = Retry::later) {
        if (is_over) {
            return;
        }
        ++attempt;
        resolver.cancel();
        deadline.cancel();
        watch.cancel();
        race.cancel();
        if (attempted) {
            attempted->close();
        }
        // The rest may want memory that is missing, and is then done once more.
        is_to_tell_interruption = std::exchange(open, false) || is_to_tell_interruption;
        if (!was_open) {
            auto const error = !unknown_fingerprint.empty()
                                   ? std::make_exception_ptr(UnknownCertificate(reason, server, unknown_fingerprint))
                               : is_token_wrong        ? std::make_exception_ptr(TokenRefusal(reason))
                               : retry == Retry::never ? std::make_exception_ptr(ConnectionRefusal(reason))
                                                       : std::make_exception_ptr(ConnectionError(reason));
            is_over = true;
            opened.set_exception(error);
        } else if (retry == Retry::never || !options.reconnect || !handlers.on_reopened) {
            handlers.on_lost(reason);
            is_over = true;
        } else {
            bool const interrupted = is_to_tell_interruption;
            if (interrupted) {
                handlers.on_interrupted(reason);
                is_to_tell_interruption = false;
            }
            begin_later(interrupted);
        }
    }

    /// Runs the connection until there is nothing more to do or it is stopped. Where something fails, mostly because
    /// memory is missing, the session ends.
    void run() {
        for (std::exception_ptr failure;;) {
            try {
                if (failure) {
                    end_after(std::exchange(failure, nullptr));
                }
                io.run();
                return;
            } catch (std::exception const&) {
                failure = std::current_exception();
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        }
    }

    void end_after(std::exception_ptr const& failure) {
        try {
            std::rethrow_exception(failure);
        } catch (std::bad_alloc const&) {
            end("no memory left for what comes from the server at " + server);
        } catch (std::exception const& error) {
            end("the session with the server at " + server + " cannot go on: " + error.what());
        }
    }

    void begin_later(bool interrupted) {
        // The pauses stay long where each session ends at once: such a server is not to be asked four times a second.
        if (interrupted && std::chrono::steady_clock::now() - opened_at > duration_of(BackOff::most_seconds)) {
            back_off.reset();
        }
        pause.expires_after(duration_of(back_off.next(std::generate_canonical<double, 32>(random))));
        pause.async_wait(heard([this](boost::system::error_code error) {
            if (!error) {
                begin();
            }
        }));
    }

    void begin() {
        attempted.reset();
        deadline.expires_after(duration_of(options.connect_seconds));
        deadline.async_wait(heard([this](boost::system::error_code error) {
            if (!error) {
                end("cannot connect to " + server + ": no answer within " + seconds_text(options.connect_seconds) +
                    (attempted ? ": something takes connections there, but is it a framelet-server?"
                               : ": check the address, and whether a firewall is in the way"));
            }
        }));
        resolver.async_resolve(options.server.host, std::to_string(options.server.port),
                               heard([this](boost::system::error_code error, auto const& endpoints) {
                                   if (error) {
                                       end("cannot connect to " + server + ": there is no host of that name");
                                   } else {
                                       connect(endpoints);
                                   }
                               }));
    }

    void connect(asio::ip::tcp::resolver::results_type const& found) {
        std::vector<asio::ip::tcp::endpoint> const addresses(found.begin(), found.end());
        race.start(addresses, heard([this](boost::system::error_code error, asio::ip::tcp::socket socket) {
                       if (error == asio::error::connection_refused) {
                           end("cannot connect to " + server +
                               ": connection refused: is framelet-server running there?");
                           return;
                       }
                       auto const address = error ? asio::ip::tcp::endpoint() : socket.remote_endpoint(error);
                       if (error) {
                           end("cannot connect to " + server + ": " + error.message());
                       } else if (!may_send_token(options, address.address())) {
                           end("the token is not sent to " + server +
                                   " in clear: use --tls, or --insecure if you know that nobody can listen",
                               Retry::never);
                       } else {
                           shake_hands(std::move(socket), token_for(address));
                       }
                   }));
    }

    /// The token that the user gave, or the one that a server of the same user on this machine has left for its
    /// viewers.
    std::string token_for(asio::ip::tcp::endpoint const& endpoint) const {
        if (!options.token.empty() || !is_loopback(endpoint.address())) {
            return options.token;
        }
        return read_local_token(ServerAddress{endpoint.address().to_string(), endpoint.port()}.text());
    }

    void shake_hands(asio::ip::tcp::socket socket, std::string const& token) {
        attempted = options.tls ? tls_client_stream(std::move(socket), tls, options.server.host)
                                : plain_stream(std::move(socket));
        FramedStream::Handlers events;
        events.on_message = heard([this](Message message) { receive(std::move(message)); });
        events.on_close = heard([this](std::string const& reason) {
            if (!distrust.empty()) {
                end(distrust, Retry::never);
                return;
            }
            end(open ? "the connection to the server at " + server + " ended: " + reason
                     : "cannot connect to " + server + ": it did not open a session: " + reason +
                           (options.tls || reason.ends_with('?') ? "" : ": does it want --tls, or has it no room?"));
        });
        events.on_sent = heard([this](std::size_t) {
            if (open) {
                handlers.on_sent();
            }
        });
        // The greeting is small; batches may be large, once we know who talks to us.
        attempted->start(std::move(events), max_upstream_message_bytes);
        Hello hello{protocol_version, token, options.clock_only || options.work ? coding::none : coding::all};
        hello.work = options.work;
        if (was_open && handlers.on_asking) {
            handlers.on_asking(hello);
        }
        has_ticket = static_cast<bool>(hello.ticket);
        attempted->send(hello);
    }

    /// Judges the server's certificate by its fingerprint, during the TLS handshake.
    bool trusts(std::string const& fingerprint) {
        CertificateVerdict verdict = judge_certificate(known_servers_file(), server, fingerprint);
        if (!verdict.is_trusted) {
            distrust = std::move(verdict.complaint);
            unknown_fingerprint = verdict.is_unknown ? fingerprint : "";
        }
        return verdict.is_trusted;
    }

    void receive(Message message) {
        silent_ticks = 0;
        if (auto const* failure = std::get_if<Failure>(&message)) {
            is_token_wrong = failure->text == wrong_token_text;
            end((open ? "the server at " + server + " ended the session: "
                      : "the server at " + server + " refused the connection: ") +
                    failure->text,
                failure->again ? Retry::later : Retry::never);
        } else if (auto* greeting = std::get_if<Welcome>(&message); greeting != nullptr && !open) {
            greet(std::move(*greeting));
        } else if (!open || greeting != nullptr) {
            end("the server at " + server + " broke the protocol: a message out of turn", Retry::never);
        } else {
            try {
                handlers.on_message(std::move(message));
            } catch (ProtocolError const& error) {
                end("the server at " + server + " broke the protocol: " + error.what(), Retry::never);
            }
        }
    }

    void greet(Welcome greeting) {
        if (greeting.version != protocol_version) {
            end("the server at " + server + " speaks version " + std::to_string(greeting.version) +
                    " of the protocol, this program version " + std::to_string(protocol_version) +
                    ": use programs of one release",
                Retry::never);
            return;
        }
        if (greeting.resumed && !has_ticket) {
            end("the server at " + server + " broke the protocol: it resumes what was not asked for", Retry::never);
            return;
        }
        open = true;
        opened_at = std::chrono::steady_clock::now();
        deadline.cancel();
        attempted->set_max_body(max_message_bytes);
        watch_for_silence();
        {
            std::scoped_lock const lock(stream_mutex);
            stream = attempted;
        }
        if (std::exchange(was_open, true)) {
            handlers.on_reopened(std::move(greeting));
        } else {
            welcome = std::move(greeting);
            opened.set_value();
        }
    }

    void watch_for_silence() {
        watch.expires_after(tick);
        watch.async_wait(heard([this](boost::system::error_code error) {
            if (error) {
                return;
            }
            if (++silent_ticks * std::chrono::duration<double>(tick).count() > options.silence_seconds) {
                end("the server at " + server + " stopped answering");
            } else {
                watch_for_silence();
            }
        }));
    }

    /// Tells the server that this viewer ends, so that it keeps nothing for one that does not come back. Nothing
    /// depends on it, and it takes no longer than a user waits for a window to close.
    void say_goodbye() {
        constexpr auto most_time = std::chrono::milliseconds(200);
        ++attempt; // no callback is heard any more
        try {
            for (asio::steady_timer* const timer : {&deadline, &watch, &pause}) {
                timer->cancel();
            }
            resolver.cancel();
            attempted->send(Failure{"it was closed"});
            attempted->close_after_sending();
            io.restart();
            io.run_for(most_time);
        } catch (std::exception const&) { // the server notices by itself
        }
    }

    std::shared_ptr<FramedStream> open_stream() const {
        std::scoped_lock const lock(stream_mutex);
        return stream;
    }
};

ServerConnection::ServerConnection(ConnectionOptions const& options, Handlers handlers)
    : impl_(std::make_unique<Impl>(options, std::move(handlers))) {
    if (options.tls) {
        CertificateJudge judge;
        if (options.authority_file.empty()) { // a certificate that is named is the only one that is trusted
            judge = [impl = impl_.get()](std::string const& fingerprint) { return impl->trusts(fingerprint); };
        }
        impl_->tls = make_tls_client_context(options.authority_file, std::move(judge));
    }
    std::future<void> opened = impl_->opened.get_future();
    asio::post(impl_->io, [impl = impl_.get()] { impl->begin(); });
    impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
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
    if (impl_->open) {
        impl_->say_goodbye();
    }
}

Welcome const& ServerConnection::welcome() const {
    return impl_->welcome;
}

void ServerConnection::send(Message const& message) {
    impl_->open_stream()->send(message);
}

void ServerConnection::acknowledge(Ack const& ack) {
    send(ack);
}

bool ServerConnection::all_sent() const {
    return impl_->open_stream()->unsent_bytes() == 0;
}

} // namespace framelet
