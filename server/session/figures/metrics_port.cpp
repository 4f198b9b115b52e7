#include "server/session/figures/metrics_port.h"

#include <chrono>
#include <exception>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
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
    } else if (target == "/ready") {
        // HAProxy takes 404 as the wish for no more viewers, and 503 as the end of those that are here.
        answer.result(!figures.healthy ? http::status::service_unavailable
                      : figures.ready  ? http::status::ok
                                       : http::status::not_found);
        answer.body() = figures.ready ? "ready\n" : "no more viewers now\n";
    } else {
        answer.result(http::status::not_found);
        answer.body() = "there are /metrics, /health and /ready\n";
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
    Listener listener;
    std::function<ServerFigures()> figures;
    std::vector<std::weak_ptr<Visit>> visits;
    std::thread thread;

    Impl(asio::ip::address const& address, std::uint16_t port)
        : listener({address}, port, "choose another port for --metrics, or --metrics-bind") {}

    void answer(tcp::socket socket) {
        std::erase_if(visits, [](auto const& visit) { return visit.expired(); });
        if (visits.size() == most_connections) { // whoever has a question has most likely asked it by now
            if (auto const oldest = visits.front().lock()) {
                oldest->stream.close();
            }
            visits.erase(visits.begin());
        }
        auto const visit = std::make_shared<Visit>(std::move(socket), figures);
        visits.push_back(visit);
        visit->read();
    }

    void run() {
        for (;;) {
            try {
                listener.accept_again();
                listener.io.run();
                return;
            } catch (std::exception const&) { // it costs the one who asked, not those who come later
                std::this_thread::sleep_for(Listener::pause);
            }
        }
    }
};

MetricsPort::MetricsPort(std::string const& bind, std::uint16_t port) {
    Error error;
    auto const address = asio::ip::make_address(bind, error);
    if (error) {
        throw InputError("cannot listen on " + bind + ":" + std::to_string(port) +
                         " for --metrics: it is no address: choose another --metrics-bind");
    }
    impl_ = std::make_unique<Impl>(address, port);
}

MetricsPort::~MetricsPort() {
    if (impl_->thread.joinable()) {
        impl_->listener.io.stop();
        impl_->thread.join();
    }
}

void MetricsPort::start(std::function<ServerFigures()> figures) {
    impl_->figures = std::move(figures);
    impl_->listener.listen();
    impl_->listener.accept([impl = impl_.get()](tcp::socket socket) { impl->answer(std::move(socket)); });
    impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

std::string MetricsPort::address() const {
    return text_of(impl_->listener.endpoints().front());
}

} // namespace framelet
