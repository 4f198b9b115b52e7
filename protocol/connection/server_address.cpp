#include "protocol/connection/server_address.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include <boost/asio/ip/address_v6.hpp>

#include "common/error.h"

namespace framelet {

std::string ServerAddress::text() const {
    bool const literal = host.find(':') != std::string::npos;
    return (literal ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

ServerAddress parse_server_address(std::string const& text) {
    return parse_address(text, default_port);
}

namespace {

bool is_ipv6(std::string const& text) {
    boost::system::error_code error;
    boost::asio::ip::make_address_v6(text, error);
    return !error;
}

/// The scheme of a URL, in small letters; empty where the text is none.
std::string scheme_of(std::string const& text) {
    std::size_t const end = text.find("://");
    std::size_t const begin = text.find_first_not_of(" \t\r\n");
    std::string out = end == std::string::npos ? "" : text.substr(begin, end - begin);
    std::ranges::transform(out, out.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return out;
}

/// What of the text is HOST[:PORT]: without blanks around it, and of a URL neither scheme nor user nor path.
std::string without_url(std::string text) {
    text.erase(0, text.find_first_not_of(" \t\r\n"));
    text.erase(text.find_last_not_of(" \t\r\n") + 1);
    std::size_t const scheme = text.find("://");
    text.erase(0, scheme == std::string::npos ? 0 : scheme + 3);
    text.erase(std::min(text.find_first_of("/?#"), text.size()));
    return text.substr(text.find('@') + 1);
}

} // namespace

bool asks_for_tls(std::string const& text) {
    std::string const scheme = scheme_of(text);
    return scheme == "tls" || scheme == "https";
}

std::string with_tls(std::string const& text, bool tls) {
    if (asks_for_tls(text) == tls) {
        return text;
    }
    return tls ? "tls://" + without_url(text) : without_url(text);
}

ServerAddress parse_address(std::string const& from, std::uint16_t port_without) {
    std::string const text = without_url(from);
    auto const fail = [&](std::string const& what) {
        return InputError("cannot use \"" + from + "\" as a server: " + what +
                          ": write HOST or HOST:PORT, as in 127.0.0.1:" + std::to_string(port_without));
    };
    constexpr std::array<std::string_view, 5> known_schemes{"", "framelet", "http", "https", "tls"};
    if (std::string const scheme = scheme_of(from); std::ranges::find(known_schemes, scheme) == known_schemes.end()) {
        throw fail("it is not reached by " + scheme + "://");
    }
    ServerAddress out;
    std::string port = std::to_string(port_without);
    if (text.starts_with('[')) {
        std::size_t const end = text.find(']');
        if (end == std::string::npos || (end + 1 < text.size() && text[end + 1] != ':')) {
            throw fail("the bracket is not closed");
        }
        out.host = text.substr(1, end - 1);
        port = end + 1 == text.size() ? port : text.substr(end + 2);
    } else {
        std::size_t const colon = text.rfind(':');
        bool const is_literal = colon != text.find(':');
        if (is_literal && (text.size() - colon > 4 || !is_ipv6(text))) { // "::1:7070" may be either
            throw fail("an IPv6 address with a port needs brackets around it, as in [::1]:7070");
        }
        out.host = is_literal ? text : text.substr(0, colon);
        port = is_literal || colon == std::string::npos ? port : text.substr(colon + 1);
    }
    auto const printable = [](char c) { return c > ' ' && c < 127; };
    if (out.host.empty() || out.host.size() > 253 || !std::all_of(out.host.begin(), out.host.end(), printable)) {
        throw fail("there is no host name in it");
    }
    auto const [end, error] = std::from_chars(port.data(), port.data() + port.size(), out.port);
    if (error != std::errc() || end != port.data() + port.size() || out.port == 0) {
        throw fail("the port is not a number from 1 to 65535");
    }
    return out;
}

} // namespace framelet
