// Asks a server by HTTP, at the port for those who watch over it. For tests only.
#pragma once

#include <string>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "tests/loopback/process.h"

namespace framelet::test {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;

inline tcp::socket connected(boost::asio::io_context& io, std::string const& address) {
    auto const colon = static_cast<std::ptrdiff_t>(address.rfind(':'));
    tcp::socket socket(io);
    boost::asio::connect(socket, tcp::resolver(io).resolve(std::string(address.begin(), address.begin() + colon),
                                                           std::string(address.begin() + colon + 1, address.end())));
    return socket;
}

inline http::response<http::string_body> ask(std::string const& address, std::string const& target,
                                             http::verb verb = http::verb::get) {
    boost::asio::io_context io;
    tcp::socket socket = connected(io, address);
    http::request<http::empty_body> request(verb, target, 11);
    request.set(http::field::host, address);
    http::write(socket, request);
    boost::beast::flat_buffer buffer;
    http::response<http::string_body> answer;
    http::read(socket, buffer, answer);
    return answer;
}

/// A port that nobody listens at, for the moment.
inline std::string free_port() {
    boost::asio::io_context io;
    tcp::acceptor const acceptor(io, {boost::asio::ip::address_v4::loopback(), 0});
    return std::to_string(acceptor.local_endpoint().port());
}

inline double metric(std::string const& page, std::string const& name) {
    std::size_t const at = page.find("\n" + name + " ");
    return at == std::string::npos ? -1 : std::stod(page.substr(at + name.size() + 2));
}

/// Address of the port for figures, as the server says it.
inline std::string metrics_address(ServerProcess& server) {
    std::string const before = "metrics at http://";
    std::string address;
    eventually([&] {
        std::string const told = server.process().output();
        std::size_t const at = told.find(before), slash = told.find("/metrics", at);
        bool const is_told = at != std::string::npos && slash != std::string::npos;
        address = is_told ? told.substr(at + before.size(), slash - at - before.size()) : "";
        return is_told;
    });
    return address;
}

} // namespace framelet::test
