// The header by which a proxy says who connects through it ([PROXY protocol], version 2). In: the first bytes of a
// connection. Out: an address.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <boost/asio/ip/address.hpp>

namespace framelet {

/// Bytes that each header begins with; the last two say how many follow.
inline constexpr std::size_t proxy_header_start = 16;
/// Most bytes that may follow: addresses, and what a proxy adds to them.
inline constexpr std::size_t most_of_proxy_header = 2048;

/// How many bytes follow these `proxy_header_start`. Nothing: it is no header of version 2, or too long a one.
std::optional<std::size_t> rest_of_proxy_header(std::span<std::uint8_t const> start);

struct ProxiedSource {
    bool is_valid = false; ///< the header makes sense
    /// Who connects. Nothing: the proxy itself, or somebody whom it does not know by address.
    std::optional<boost::asio::ip::address> address;
};

/// What a whole header says, of `proxy_header_start` bytes and those that follow.
ProxiedSource parse_proxy_header(std::span<std::uint8_t const> header);

} // namespace framelet
