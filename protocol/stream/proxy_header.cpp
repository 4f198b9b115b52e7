#include "protocol/stream/proxy_header.h"

#include <algorithm>
#include <array>

namespace framelet {
namespace {

constexpr std::array<std::uint8_t, 12> signature{0x0d, 0x0a, 0x0d, 0x0a, 0x00, 0x0d,
                                                 0x0a, 0x51, 0x55, 0x49, 0x54, 0x0a};
constexpr std::uint8_t from_proxy_itself = 0x20, for_somebody = 0x21; // version 2, command
constexpr std::uint8_t over_ipv4 = 1, over_ipv6 = 2; // upper half of the byte after it

/// The first address of the header, which is who connects; nothing where it is cut off.
template <class Address>
std::optional<boost::asio::ip::address> address_at(std::span<std::uint8_t const> bytes) {
    typename Address::bytes_type address;
    std::size_t const both_and_ports = 2 * address.size() + 4;
    if (bytes.size() < both_and_ports) {
        return std::nullopt;
    }
    std::copy_n(bytes.begin(), address.size(), address.begin());
    return Address(address);
}

} // namespace

std::optional<std::size_t> rest_of_proxy_header(std::span<std::uint8_t const> start) {
    if (start.size() < proxy_header_start || !std::equal(signature.begin(), signature.end(), start.begin())) {
        return std::nullopt;
    }
    std::uint8_t const command = start[signature.size()];
    std::size_t const rest = std::size_t{start[14]} << 8 | start[15];
    if ((command != from_proxy_itself && command != for_somebody) || rest > most_of_proxy_header) {
        return std::nullopt;
    }
    return rest;
}

ProxiedSource parse_proxy_header(std::span<std::uint8_t const> header) {
    auto const rest = rest_of_proxy_header(header);
    if (!rest || header.size() != proxy_header_start + *rest) {
        return {};
    }
    if (header[signature.size()] == from_proxy_itself) {
        return {true, std::nullopt};
    }
    auto const addresses = header.subspan(proxy_header_start);
    std::optional<boost::asio::ip::address> found;
    switch (header[signature.size() + 1] >> 4) {
    case over_ipv4:
        found = address_at<boost::asio::ip::address_v4>(addresses);
        break;
    case over_ipv6:
        found = address_at<boost::asio::ip::address_v6>(addresses);
        break;
    default: // a socket of its machine, or not said
        return {true, std::nullopt};
    }
    return {found.has_value(), found};
}

} // namespace framelet
