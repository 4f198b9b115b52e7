#include "server/session/figures/metrics_port.h"

#include <chrono>
#include <memory>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "common/error.h"
#include "server/session/listener.h"

namespace framelet {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Error = boost::system::error_code;

namespace {

constexpr std::chrono::seconds patience{5}; ///< with one that asks slowly, or does not read

http::response<http::string_body> answer_to(http::request<http::empty_body> const& request,
                                            ServerFigures const& figures) {
    http::response<http::string_body> answer{http::status::ok, request.version()};
    answer.keep_alive(false);
    answer.set(http::field::content_type, "text/plain; charset=utf-8");
    auto const target = request.target();
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        answer.result(http::status::method_not_allowed);
        answer.set(http::field::allow, "GET, HEAD");
    } else if (target == "/metrics") {
        answer.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
        answer.body() = metrics_text(figures);
    } else if (target == "/health") {
        answer.result(figures.healthy ? http::status::ok : http::status::service_unavailable);
        answer.body() = figures.healthy ? "ok\n" : "the server does not get on\n";
    } else {
        answer.result(http::status::not_found);
        answer.body() = "there are /metrics and /health\n";
    }
    answer.prepare_payload();
    if (request.method() == http::verb::head) { // as long as it would be, but without it
        answer.body().clear();
    }
    return answer;
}

/// One question and its answer; lives as long as something of it is awaited.
struct Visit : std::enable_shared_from_this<Visit> {
    Visit(tcp::socket socket, std::function<ServerFigures()> const& to_ask)
        : stream(std::move(socket)), figures(to_ask) {}

    void read() {
        stream.expires_after(patience);
        parser.header_limit(8192);
        http::async_read(stream, buffer, parser, [self = shared_from_this()](Error error, std::size_t) {
            if (!error) {
                self->write();
            }
        });
    }

    void write() {
        answer = answer_to(parser.get(), figures());
        http::async_write(stream, answer, [self = shared_from_this()](Error, std::size_t) {
            Error ignored;
            self->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream;
    std::function<ServerFigures()> const& figures;
    beast::flat_buffer buffer{16384};
    http::request_parser<http::empty_body> parser;
    http::response<http::string_body> answer;
};

} // namespace

struct MetricsPort::Impl {
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    asio::steady_timer again{io};
    std::function<ServerFigures()> figures;
    std::vector<std::weak_ptr<Visit>> visits;
    bool waits = false; ///< for a connection, or for the pause to be over
    std::thread thread;

    void accept() {
        acceptor.async_accept([this](Error error, tcp::socket socket) {
            waits = false;
            if (error) { // for want of file descriptors, most likely: it would say so again at once
                again.expires_after(Listener::pause);
                again.async_wait([this](Error aborted) {
                    waits = false;
                    if (!aborted) {
                        accept();
                    }
                });
                waits = true;
                return;
            }
            std::erase_if(visits, [](auto const& visit) { return visit.expired(); });
            if (visits.size() < most_connections) {
                auto const visit = std::make_shared<Visit>(std::move(socket), figures);
                visits.push_back(visit);
                visit->read();
            }
            accept();
        });
        waits = true;
    }

    void run() {
        for (bool is_to_recover = false;;) {
            try {
                if (std::exchange(is_to_recover, false) && !waits) {
                    accept();
                }
                io.run();
                return;
            } catch (std::bad_alloc const&) { // it costs the one who asked, not those who come later
                is_to_recover = true;
                std::this_thread::sleep_for(Listener::pause);
            }
        }
    }
};

MetricsPort::MetricsPort(std::string const& bind, std::uint16_t port) : impl_(std::make_unique<Impl>()) {
    auto const fail = [&](std::string const& why) {
        return InputError("cannot listen on " + bind + ":" + std::to_string(port) + " for --metrics: " + why +
                          ": choose another port or --metrics-bind");
    };
    Error error;
    auto const address = asio::ip::make_address(bind, error);
    if (error) {
        throw fail("it is no address");
    }
    tcp::acceptor& acceptor = impl_->acceptor;
    acceptor.open(address.is_v6() ? tcp::v6() : tcp::v4(), error);
    if (!error) {
        acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    }
    if (!error) {
        acceptor.bind({address, port}, error);
    }
    if (error) {
        throw fail(error.message());
    }
}

MetricsPort::~MetricsPort() {
    if (impl_->thread.joinable()) {
        impl_->io.stop();
        impl_->thread.join();
    }
}

void MetricsPort::start(std::function<ServerFigures()> figures) {
    impl_->figures = std::move(figures);
    Error error;
    impl_->acceptor.listen(static_cast<int>(most_connections), error);
    if (error) {
        throw InputError("cannot listen on " + address() + " for --metrics: " + error.message() +
                         ": choose another port");
    }
    impl_->accept();
    impl_->thread = std::thread([this] { impl_->run(); });
}

std::string MetricsPort::address() const {
    return text_of(impl_->acceptor.local_endpoint());
}

} // namespace framelet
