// Names where a connection comes from, as limits count it. In: an address. Out: a text that is the same for all
// addresses that one machine can easily choose from.
#pragma once

#include <algorithm>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace framelet {

/// An IPv4 address itself, also where it came mapped into an IPv6 one, otherwise the network of 64 bits: whoever has
/// one IPv6 address has all of these.
inline std::string source_of(boost::asio::ip::address const& address) {
    namespace ip = boost::asio::ip;
    if (address.is_v4()) {
        return address.to_string();
    }
    if (address.to_v6().is_v4_mapped()) {
        return ip::make_address_v4(ip::v4_mapped, address.to_v6()).to_string();
    }
    ip::address_v6::bytes_type bytes = address.to_v6().to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), 0);
    return ip::address_v6(bytes).to_string() + "/64";
}

} // namespace framelet
