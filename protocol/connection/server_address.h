// The address of a server, as a user writes it, and what it takes to be let in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocol/messages/message.h"

namespace framelet {

inline constexpr std::uint16_t default_port = 7070;

struct ServerAddress {
    std::string host = "127.0.0.1";
    std::uint16_t port = default_port;

    bool operator==(ServerAddress const&) const = default;
    /// "HOST:PORT", with brackets around an IPv6 address.
    std::string text() const;
};

/// Reads HOST, HOST:PORT, [IPV6] or [IPV6]:PORT; without a port it is `default_port`. Throws InputError.
ServerAddress parse_server_address(std::string const& text);
/// Reads the address of another program likewise; without a port it is `port_without`. Throws InputError.
ServerAddress parse_address(std::string const& text, std::uint16_t port_without);

/// True for a URL that stands for an encrypted connection: "tls://HOST" or "https://HOST".
bool asks_for_tls(std::string const& text);
/// The same address as that URL, or as none.
std::string with_tls(std::string const& text, bool tls);

struct ConnectionOptions {
    ServerAddress server;
    std::string token; ///< empty: on this machine that which a server of the same user has left
    bool tls = false;
    bool insecure = false; ///< without TLS the token is sent to other machines too, which whoever is between can read
    std::string authority_file; ///< certificates to trust for TLS; empty: the system's certificate authorities
    bool clock_only = false; ///< no pictures are wanted, only the scene's clock
    std::optional<WorkOffer> work{}; ///< no pictures are wanted, but orders of paths
    bool reconnect = false; ///< a session that ends before its time is followed by another as soon as there is a server
    double connect_seconds = 10; ///< most time until name, connection and handshake are done
    double silence_seconds = 5; ///< time without a message after which the server is given up

    /// The server as a user may name it another time: "HOST:PORT", or "tls://HOST:PORT".
    std::string server_name() const { return with_tls(server.text(), tls); }
};

} // namespace framelet
